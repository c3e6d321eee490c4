//! The transmission turned round.

use crate::numbers::Numbers;
use bowden::hysteresis::BoucWenState;
use bowden::Real;

/// Whatever the transmission and the desired output: a finite input, eta within ±1, a bad
/// output leaves the state, and what the solver did is what the transmission does.
pub fn check(data: &[u8]) {
    let mut from = Numbers::new(data);
    let _ = match from.flag() {
        Some(true) => run::<f32>(&mut from),
        _ => run::<f64>(&mut from),
    };
}

fn run<T: Real>(from: &mut Numbers) -> Option<()> {
    let cable = from.transmission::<T>()?;
    let inverse = cable.inverse().ok()?;
    let mut solver = BoucWenState::new();
    let mut plant = BoucWenState::new();
    loop {
        let desired: T = from.any()?;
        let before = solver;
        let input = inverse.step(&mut solver, desired);
        assert!(input.is_finite());
        assert!(solver.eta().abs() <= T::one());
        if !desired.is_finite() {
            assert!(solver == before, "a bad output leaves the state");
        }
        if solver != before {
            cable.step(&mut plant, input);
            assert!(plant == solver, "the solver's state is the transmission's");
            assert!(reaches(&cable, before, input, desired, solver.eta()));
        }
    }
}

/// Whether the forward model gives `desired` to 16 epsilons of the magnitudes in its
/// equation, as documented, and to what one ulp of the input does on the steepest part.
///
/// Asked where a path of one sample is short enough for the step's own accuracy.
fn reaches<T: Real>(
    cable: &bowden::transmission::Transmission<T>,
    before: BoucWenState<T>,
    input: T,
    desired: T,
    eta: T,
) -> bool {
    let shape = cable.shape();
    let last = before.input().unwrap_or(input);
    let tame =
        |x: T, low: f64, high: f64| x.abs() >= T::from_f64(low) && x.abs() <= T::from_f64(high);
    let asked = tame(shape.rho(), 1e-3, 10.0)
        && tame(shape.sigma(), 0.5, 2.0)
        && tame(shape.n(), 1.0, 20.0)
        && tame(cable.gain(), 0.1, 10.0)
        && tame(cable.kappa_eta(), 0.0, 10.0)
        && tame(cable.offset(), 0.0, 10.0)
        && tame(desired, 0.0, 40.0)
        && tame(last, 0.0, 400.0);
    let steepest = cable.gain().abs()
        + cable.kappa_eta().abs() * T::from_f64(2.0) * shape.sigma() * shape.rho();
    let size = desired.abs()
        + cable.offset().abs()
        + cable.kappa_eta().abs()
        + steepest * (input.abs() + last.abs());
    // Below the least normal number an input has no relative precision left.
    let tolerance = T::from_f64(16.0) * T::epsilon() * size + T::min_positive_value();
    !asked || (cable.output(input, eta) - desired).abs() <= tolerance
}
