//! The transmission, its inverse, and what noise does to it.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

#[path = "shared/mod.rs"]
mod shared;

use bowden::hysteresis::{BoucWen, BoucWenState};
use bowden::signal::{Play, PlayState};
use bowden::transmission::{Mode, Transmission};
use bowden::{Error, Real};
use proptest::prelude::*;
use shared::*;
use std::f64::consts::TAU;

fn shape<T: Real>(rho: f64, sigma: f64, n: f64) -> BoucWen<T> {
    BoucWen::try_new(T::from_f64(rho), T::from_f64(sigma), T::from_f64(n)).unwrap()
}

#[test]
fn torque_mode_is_equation_six_and_displacement_mode_equation_one() {
    let shape = shape(0.1, 0.5, 2.0);
    let torque = Transmission::torque(0.75, 4.0, 0.5, shape).unwrap();
    assert_eq!(torque.output(8.0, 0.25), 0.75 * 8.0 - 4.0 * 0.25 - 0.5);
    let force = Transmission::displacement(2.0, 4.0, 0.5, shape).unwrap();
    assert_eq!(force.output(8.0, 0.25), 2.0 * 8.0 + 4.0 * 0.25 + 0.5);
    for (own, mode, gain) in [
        (torque, Mode::Torque, 0.75),
        (force, Mode::Displacement, 2.0),
    ] {
        assert_eq!((own.mode(), own.gain(), own.kappa_eta()), (mode, gain, 4.0));
        assert_eq!((own.offset(), *own.shape()), (0.5, shape));
    }
}

#[test]
fn refusals_carry_the_parameters_name() {
    let (shape, nan) = (shape(0.1, 0.5, 2.0), f64::NAN);
    for (made, name) in [
        (Transmission::torque(nan, 1.0, 0.0, shape), "b"),
        (Transmission::torque(1.0, 1.0, nan, shape), "t0"),
        (
            Transmission::displacement(1.0, f64::INFINITY, 0.0, shape),
            "kappa_eta",
        ),
    ] {
        assert_eq!(made, Err(Error::NonFinite(name)));
    }
}

#[test]
fn a_bad_sample_returns_the_output_at_the_last_good_input() {
    let cable = paper::<f64>(98.36);
    let mut state = BoucWenState::new();
    assert_eq!(cable.step(&mut state, f64::NAN), 0.0);
    cable.step(&mut state, 0.0);
    let good = cable.step(&mut state, 5.0);
    let before = state;
    assert_eq!(cable.step(&mut state, f64::NEG_INFINITY), good);
    assert_eq!(state, before);
}

#[test]
fn the_inverse_exists_up_to_the_sigma_where_the_output_turns_back() {
    // B/(2·kappa_eta·rho) = 0.7434 for the first set of the paper.
    assert!(paper::<f64>(0.7433).inverse().is_ok());
    for sigma in [0.7436, 98.36] {
        let inverse = paper::<f64>(sigma).inverse();
        assert!(matches!(inverse, Err(Error::Inadmissible(_))));
    }
    // A spring's hysteresis adds to the slope: any sigma will do.
    let steep = shape(0.095_82, 98.36, 3.871);
    for (gain, kappa_eta, exists) in [
        (1.0, 7.0, true),
        (1.0, -7.0, false),
        (-1.0, -7.0, true),
        (0.0, 7.0, false),
    ] {
        let spring = Transmission::displacement(gain, kappa_eta, 0.0, steep).unwrap();
        assert_eq!(spring.inverse().is_ok(), exists, "{gain} {kappa_eta}");
    }
}

/// Any torque transmission or spring; most have no inverse.
fn any_transmission<T: Real>() -> impl Strategy<Value = Transmission<T>> {
    let shapes = (0.001..100.0_f64, 0.5..200.0_f64, 1.0..6.0_f64);
    let signed = || (1e-4..100.0_f64, any::<bool>()).prop_map(|(x, up)| if up { x } else { -x });
    (any::<bool>(), signed(), signed(), shapes).prop_map(|(torque, b, kappa, (rho, sigma, n))| {
        let build = [Transmission::displacement, Transmission::torque][usize::from(torque)];
        let shape = shape(rho, sigma, n);
        build(T::from_f64(b), T::from_f64(kappa), T::from_f64(0.05), shape).unwrap()
    })
}

fn with_shape<T: Real>(cable: &Transmission<T>, rho: T, sigma: T) -> Transmission<T> {
    let shape = BoucWen::try_new(rho, sigma, cable.shape().n()).unwrap();
    let build = match cable.mode() {
        Mode::Torque => Transmission::torque,
        Mode::Displacement => Transmission::displacement,
    };
    build(cable.gain(), cable.kappa_eta(), cable.offset(), shape).unwrap()
}

/// The greatest sigma has an inverse, one a few roundings above it has none.
fn the_bound_is_tight<T: Real>(cable: &Transmission<T>) {
    let rho = cable.shape().rho();
    let beyond = |x: T| x * (T::one() + T::from_f64(16.0) * T::epsilon());
    match cable.greatest_invertible_sigma() {
        Some(most) => {
            assert!(with_shape(cable, rho, most).inverse().is_ok());
            if most < T::from_f64(1e8) {
                assert!(with_shape(cable, rho, beyond(most)).inverse().is_err());
            }
        }
        None => assert!(with_shape(cable, rho, T::from_f64(0.5)).inverse().is_err()),
    }
}

/// What has an inverse stays; what has none is changed no further than it must be.
fn the_nearest_is_no_further_than_it_must<T: Real>(cable: &Transmission<T>) {
    let nearest = cable.nearest_invertible().unwrap();
    assert!(nearest.inverse().is_ok());
    assert_eq!(
        with_shape(&nearest, cable.shape().rho(), cable.shape().sigma()),
        *cable
    );
    let (was, is) = (cable.shape(), nearest.shape());
    if cable.inverse().is_ok() {
        assert_eq!(nearest, *cable);
    } else if is.rho() == was.rho() {
        assert_eq!(cable.greatest_invertible_sigma(), Some(is.sigma()));
    } else {
        assert!(is.sigma() == T::from_f64(0.5) && is.rho() < was.rho());
        let beyond = is.rho() * (T::one() + T::from_f64(16.0) * T::epsilon());
        assert!(with_shape(cable, beyond, is.sigma()).inverse().is_err());
    }
}

proptest! {
    #[test]
    fn the_greatest_sigma_is_the_bound_to_rounding_and_the_nearest_is_no_further_than_it_must_be(
        double in any_transmission::<f64>(),
        single in any_transmission::<f32>(),
    ) {
        the_bound_is_tight(&double);
        the_bound_is_tight(&single);
        the_nearest_is_no_further_than_it_must(&double);
        the_nearest_is_no_further_than_it_must(&single);
    }

    #[test]
    fn at_the_bound_the_inverse_still_gives_what_was_asked_for(
        cable in any_transmission::<f32>(),
        outputs in prop::collection::vec(-50.0..50.0_f32, 2..30),
    ) {
        // A spring that is steep far out is finer than the spacing of its inputs.
        prop_assume!(cable.inverse().is_err());
        let cable = cable.nearest_invertible().unwrap();
        let inverse = cable.inverse().unwrap();
        let (mut back, mut forth) = (BoucWenState::new(), BoucWenState::new());
        for wanted in outputs {
            let input = inverse.step(&mut back, wanted);
            let got = cable.step(&mut forth, input);
            let magnitudes = wanted.abs() + (cable.gain() * input).abs() + cable.kappa_eta().abs();
            // 16 epsilons of the magnitudes are promised; the last input counts among them,
            // and the hysteresis moves it by up to 2·kappa_eta between two samples.
            prop_assert!((got - wanted).abs() <= 16.0 * f32::EPSILON * (magnitudes + 150.0));
        }
    }
}

#[test]
fn without_a_gain_there_is_no_nearest_inverse() {
    let flat = Transmission::torque(0.0, 7.0, 0.0, *paper(0.6).shape()).unwrap();
    assert_eq!(flat.greatest_invertible_sigma(), None);
    let nearest = flat.nearest_invertible();
    assert!(matches!(nearest, Err(Error::Inadmissible(_))));
    let endless = shape(f64::MIN_POSITIVE, 1e9, 1.0);
    let tiny = Transmission::torque(1e-300, 1e300, 0.0, endless).unwrap();
    assert_eq!(tiny.nearest_invertible(), Err(Error::OutOfRange("rho")));
}

/// Root mean square error of the plant's output, fed forward through another model.
fn error_through(plant: &Transmission<f64>, model: &Transmission<f64>, reach: f64) -> f64 {
    let inverse = model.inverse().unwrap();
    let (mut feed, mut state) = (BoucWenState::new(), BoucWenState::new());
    let error = |k: u32| {
        let wanted = reach * (TAU * f64::from(k) / 1000.0).sin();
        let got = plant.step(&mut state, inverse.step(&mut feed, wanted));
        (got - wanted).powi(2)
    };
    let squares: Vec<f64> = (0..4000).map(error).collect();
    (squares[2000..].iter().sum::<f64>() / 2000.0).sqrt()
}

#[test]
fn a_rounder_knee_costs_less_than_a_lower_loop() {
    let cable = |kappa_eta, sigma| {
        Transmission::torque(1.0, kappa_eta, 0.0, shape(2.0, sigma, 1.0)).unwrap()
    };
    for sigma in [0.5, 3.0] {
        // B = 1, kappa_eta = 1, rho = 2: even sigma = 1/2 turns back.
        let plant = cable(1.0, sigma);
        let rounder = plant.nearest_invertible().unwrap();
        assert_eq!((rounder.shape().rho(), rounder.shape().sigma()), (1.0, 0.5));
        for reach in [5.0, 20.0] {
            let models = [rounder, cable(0.5, 0.5)];
            let [a, b] = models.map(|model| error_through(&plant, &model, reach));
            assert!(b > 2.0 * a, "sigma {sigma}, reach {reach}: {a} {b}");
        }
    }
}

#[test]
fn a_bad_desired_output_holds_the_input_and_the_first_one_is_for_eta_as_it_is() {
    let inverse = paper::<f64>(0.6).inverse().unwrap();
    let input = inverse.step(&mut BoucWenState::with_eta(0.4).unwrap(), 1.0);
    near(paper(0.6).output(input, 0.4), 1.0, 1e-14); // rounding
    let mut state = BoucWenState::new();
    assert_eq!(inverse.step(&mut state, f64::NAN), 0.0);
    assert_eq!(state, BoucWenState::new());
    inverse.step(&mut state, 1.0);
    let held = inverse.step(&mut state, 3.0);
    let before = state;
    for bad in [f64::NAN, f64::INFINITY, f64::MAX, f64::MIN] {
        let got = inverse.step(&mut state, bad);
        assert!(got == held && state == before || got.is_finite());
        state = before;
    }
}

/// From one end of the floats to the other the change of the input is none: the model takes the
/// longest one for it, the inverse says no.
fn a_change_that_overflows_is_out_of_reach<T: Real>(least_gain: f64, rho: f64) {
    let (gain, zero) = (T::from_f64(least_gain), T::zero());
    let cable = Transmission::torque(gain, zero, zero, shape(rho, 0.6, 3.9)).unwrap();
    let inverse = cable.inverse().unwrap();
    let (mut solver, mut plant) = (BoucWenState::new(), BoucWenState::new());
    for desired in [0.0, 2.0, -3.9, 3.5, 0.1] {
        let (before, input) = (solver, inverse.step(&mut solver, T::from_f64(desired)));
        cable.step(&mut plant, input);
        assert_eq!(plant, solver);
        assert_eq!(solver == before, desired == 3.5);
    }
}

#[test]
fn a_change_that_overflows_is_out_of_the_inverses_reach() {
    a_change_that_overflows_is_out_of_reach::<f64>(3.46e-308, 0.1);
    a_change_that_overflows_is_out_of_reach::<f64>(3.46e-308, 5e-309);
    a_change_that_overflows_is_out_of_reach::<f32>(1.9e-38, 0.1);
    a_change_that_overflows_is_out_of_reach::<f32>(1.9e-38, 3e-39);
}

/// Largest error of forward(inverse(y)), in machine epsilons of the sum of its terms.
fn round_trip<T: Real>(cable: &Transmission<T>, outputs: &[f64]) -> f64 {
    let inverse = cable.inverse().unwrap();
    let (mut solver, mut plant) = (BoucWenState::new(), BoucWenState::new());
    let (mut most, mut last) = (0.0_f64, T::zero());
    for &y in outputs {
        let u = inverse.step(&mut solver, T::from_f64(y));
        let got = cable.step(&mut plant, u);
        assert_eq!(solver, plant, "the solver is where the plant is");
        // The difference of the inputs is rounded like the larger of them.
        let inputs = cable.gain().abs() * (u.abs() + last.abs());
        let terms = T::from_f64(y).abs() + inputs + cable.kappa_eta().abs() + cable.offset().abs();
        last = u;
        most = most.max(((got - T::from_f64(y)).abs() / terms / T::epsilon()).as_f64());
    }
    most
}

#[test]
fn a_reference_at_one_kilohertz_comes_out_as_it_went_in() {
    let outputs: Vec<f64> = (0..4000)
        .map(|k| f64::from(k) * 1e-3)
        .map(|t| 6.0 * (TAU * 0.7 * t).sin() + 2.0 * (TAU * 2.3 * t).sin())
        .collect();
    // 16 epsilons of the sum of all terms are documented.
    assert!(round_trip::<f64>(&paper(0.6), &outputs) < 16.0);
    assert!(round_trip::<f64>(&paper(0.743), &outputs) < 16.0);
    assert!(round_trip::<f32>(&paper(0.6), &outputs) < 16.0);
}

/// Rms error of kappa_eta·eta [N·m] that noise of 0.05 N·m rms on the input causes.
fn noise_error(sigma: f64, half_width: f64) -> f64 {
    let cable = paper::<f64>(sigma);
    let play = Play::try_new(half_width).unwrap();
    let mut guard = PlayState::new();
    let (mut clean, mut noisy, mut noise) = (BoucWenState::new(), BoucWenState::new(), Random(1));
    let (mut sum, samples) = (0.0, 20_000);
    for k in 0..samples {
        let t = f64::from(k) * 1e-3;
        let slow = 25.0 + 10.0 * (TAU * 0.25 * t).sin();
        let tau_i = slow + 3.0 * (TAU * 0.2 * 3_f64.sqrt() * t).sin();
        let exact = cable.shape().step(&mut clean, tau_i);
        // Gaussian by the sum of twelve uniform numbers.
        let gaussian = (0..12).map(|_| noise.next()).sum::<f64>() - 6.0;
        let measured = play.step(&mut guard, tau_i + 0.05 * gaussian);
        let eta = cable.shape().step(&mut noisy, measured);
        sum += (cable.kappa_eta() * (eta - exact)).powi(2);
    }
    (sum / f64::from(samples)).sqrt()
}

#[test]
fn noise_destroys_the_state_and_a_play_guards_it() {
    // One draw of 20 s; other draws differ by less than 10 %.
    for (sigma, half_width, expected) in [
        (98.36, 0.0, 3.7),
        (0.5, 0.0, 1.8),
        (98.36, 0.2, 0.74),
        (0.5, 0.2, 0.11),
    ] {
        near(noise_error(sigma, half_width), expected, 0.1 * expected);
    }
}

fn inverts_any_jump<T: Real>(numbers: [f64; 6], outputs: &[f64]) -> Result<(), TestCaseError> {
    let [gain, kappa_eta, offset, rho, sigma, n] = numbers.map(T::from_f64);
    let shape = BoucWen::try_new(rho, sigma, n);
    prop_assume!(shape.is_ok());
    let shape = shape.unwrap();
    for cable in [
        Transmission::torque(gain, kappa_eta, offset, shape),
        Transmission::displacement(gain, kappa_eta, offset, shape),
        Transmission::displacement(-gain, kappa_eta, offset, shape),
    ] {
        prop_assert!(round_trip(&cable.unwrap(), outputs) < 16.0);
    }
    Ok(())
}

proptest! {
    #![proptest_config(seeded(128, 2))]

    /// Sigma anywhere up to the condition, where there is room above 1/2; below it by more than its
    /// roundings. The search in `f32` has a step of its own, which must be the forward model's.
    #[test]
    fn every_admissible_transmission_inverts_any_jump(
        gain in 0.1..5.0_f64,
        kappa_eta in -10.0..10.0_f64,
        offset in -1.0..1.0_f64,
        rho in 1e-3..1.0_f64,
        n in 1.0..8.0_f64,
        margin in 0.0..1.0_f64,
        outputs in prop::collection::vec(-50.0..50.0_f64, 2..20),
    ) {
        let most = gain / (2.0 * kappa_eta.abs() * rho);
        prop_assume!(most > 0.5);
        let sigma = 0.5 + margin * (most.min(200.0) - 0.5);
        inverts_any_jump::<f64>([gain, kappa_eta, offset, rho, sigma * 0.999_999, n], &outputs)?;
        inverts_any_jump::<f32>([gain, kappa_eta, offset, rho, sigma * 0.999_99, n], &outputs)?;
    }

    #[test]
    fn the_inverse_never_fails_on_any_float(outputs in prop::collection::vec(prop::num::f32::ANY, 1..30)) {
        let inverse = paper::<f32>(0.7).inverse().unwrap();
        let mut state = BoucWenState::new();
        for y in outputs {
            prop_assert!(inverse.step(&mut state, y).is_finite());
            prop_assert!(state.eta().abs() <= 1.0);
        }
    }
}
