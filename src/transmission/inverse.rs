//! The inverse of a transmission: the input for a given output.

use crate::hysteresis::{BoucWen, BoucWenState};
use crate::Real;

/// The inverse of a transmission, which computes the input for a desired output.
///
/// [`Transmission::inverse`](super::Transmission::inverse) creates an `Inverse`, and checks that
/// the input is unique. An `Inverse` and its transmission use the same type of state. After
/// [`step`](Self::step), the state equals that of the forward model after the same input.
///
/// ```
/// use bowden::hysteresis::{BoucWenState, BoucWen};
/// use bowden::transmission::Transmission;
/// # fn main() -> Result<(), bowden::Error> {
/// let cable = Transmission::torque(0.9978, 7.004, 0.05174, BoucWen::try_new(0.09582, 0.6, 3.871)?)?;
/// let inverse = cable.inverse()?;
/// let (mut feed_forward, mut plant) = (BoucWenState::new(), BoucWenState::new());
/// for desired in [0.0, 2.0, 5.0, 4.9, -3.0_f64] {
///     let tau_i = inverse.step(&mut feed_forward, desired);
///     assert!((cable.step(&mut plant, tau_i) - desired).abs() < 1e-12);
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Inverse<T> {
    pub(super) shape: BoucWen<T>,
    /// Sign of the gain: the equation is solved for `sign·y = gain·u + hysteresis·eta`.
    pub(super) sign: T,
    pub(super) gain: T,
    pub(super) hysteresis: T,
    pub(super) offset: T,
}

/// Largest number of evaluations of the forward model in one step. Bisection by itself needs 64.
const MOST_EVALUATIONS: u32 = 100;

impl<T: Real> Inverse<T> {
    /// The input [input unit] for which the forward model gives `desired_output`.
    ///
    /// For this input, the output of the forward model equals `desired_output` up to a small error.
    /// The error is at most 16 machine epsilons times the sum of the magnitudes in the equation,
    /// including the last input. If this bound is below the smallest normal number, the smallest
    /// normal number applies instead. The solver is a secant method inside a bracket that contains
    /// the solution. It usually needs one or two evaluations of the forward model, and at most 100.
    ///
    /// The first step does not change eta, as in the forward model. In two cases, a step leaves the
    /// state unchanged and returns the last input, or zero if there is none:
    /// - the desired output is not finite;
    /// - the input, or the path to this input, exceeds the range of floats.
    pub fn step(&self, state: &mut BoucWenState<T>, desired_output: T) -> T {
        let last = state.input();
        let target = self.sign * (desired_output - self.offset);
        // Rounded outwards, so that the solution lies inside even without hysteresis.
        let rounding = T::from_f64(4.0) * T::epsilon() * (target.abs() + self.hysteresis.abs());
        let span = self.hysteresis.abs() + rounding;
        let (lowest, highest) = ((target - span) / self.gain, (target + span) / self.gain);
        if !(lowest.is_finite() && highest.is_finite()) {
            return last.unwrap_or_else(T::zero);
        }
        let Some(start) = last else {
            let input = (target - self.hysteresis * state.eta()) / self.gain;
            self.shape.step(state, input);
            return input;
        };
        let (input, eta) = self.solve(start, state.eta(), target, lowest, highest);
        state.arrive(input, eta)
    }

    /// The root of `gain·u + hysteresis·eta(u) - target`, which rises with `u`, and eta at the
    /// root.
    fn solve(&self, start: T, eta: T, target: T, lowest: T, highest: T) -> (T, T) {
        let mut tolerance = target.abs() + (self.gain * start).abs() + self.hysteresis.abs();
        tolerance *= T::from_f64(4.0) * T::epsilon();
        let mut error = self.gain * start + self.hysteresis * eta - target;
        // |eta| <= 1 bounds the solution, and the sign of the error shows its side of the start.
        // The start itself may lie outside after a change of model.
        let (mut low, mut high) = (lowest, highest);
        let direction = if error > T::zero() {
            -T::one()
        } else {
            T::one()
        };
        if error > T::zero() && start < high {
            high = start;
        } else if error <= T::zero() && start > low {
            low = start;
        }
        let (mut best, mut best_error) = ((start, eta), error.abs());
        if best_error <= tolerance {
            return best;
        }
        let way = self.shape.way(eta, direction);
        let mut slope = self.gain + self.hysteresis * way.slope();
        let is_between = |at: T, low: T, high: T| at > low && at < high;
        // The curvature has one sign: if Newton's step leaves the bracket, its other end is a
        // better guess than its middle.
        let (mut input, mut next) = (start, start - error / slope);
        let is_far = !is_between(next, low, high);
        if is_far {
            next = if direction > T::zero() { high } else { low };
        }
        let (mut is_first, mut half) = (true, best_error * T::from_f64(0.5));
        for _ in 0..MOST_EVALUATIONS {
            if next == input {
                break;
            }
            let (before, moved) = (error, next - input);
            input = next;
            let there = way.after(input - start);
            error = self.gain * input + self.hysteresis * there - target;
            if error.abs() < best_error {
                best = (input, there);
                best_error = error.abs();
                if best_error <= tolerance {
                    break;
                }
            }
            if error > T::zero() {
                high = input;
            } else {
                low = input;
            }
            // The slope at the end of a parabola; from the third point on the secant's.
            let secant = (error - before) / moved;
            slope = if is_first {
                secant + (secant - slope)
            } else {
                secant
            };
            next = input - error / slope;
            // If a step does not halve the error (a slope near zero): halve the bracket.
            let is_slow = error.abs() > half && !(is_first && is_far);
            if is_slow || !is_between(next, low, high) {
                next = low + (high - low) * T::from_f64(0.5);
            }
            half = error.abs() * T::from_f64(0.5);
            is_first = false;
        }
        best
    }
}
