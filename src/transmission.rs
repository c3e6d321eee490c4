//! The cable transmission: displacement to force, torque to torque, and back.
//!
//! Displacement, (1)-(2): `F = kappa_x·x + kappa_eta·eta + offset`.
//! Torque, (5)-(7): `tau_o = B·tau_i - kappa_eta·eta - T0`.
//! In both `eta` is the hysteresis of [`Shape`], advanced by the input.
//!
//! # The inverse
//! Which input gives this output? There is one answer where the output rises with the
//! input on every branch. The slope of eta in the input lies in
//! `[0, rho·max(1, 2·sigma)]`, and 2·sigma >= 1, so in torque mode the condition is
//! `sigma <= B/(2·kappa_eta·rho)`: 0.743 for the first set of the paper, which has
//! sigma = 98.36. Such a set serves playback and identification; as a plant in a
//! closed loop its output would fall while its input rises.
//! That slope is the equation's. The step that `f32` takes keeps to it as proved up to n = 4 and
//! as measured up to n = 10; from about n = 12 on it may be 1.39 times as steep, see
//! [`hysteresis`](crate::hysteresis). There, take sigma below the bound over 1.39.
//! [`Transmission::greatest_invertible_sigma`] is that bound, and
//! [`Transmission::nearest_invertible`] a transmission within it.
//!
//! # Noise in front of the hysteresis
//! A model that is fed a noisy measurement takes every wobble for a reversal: noise of
//! 0.05 N·m rms on `tau_i` moves `kappa_eta·eta` of the first set by 3.7 N·m rms. A
//! [`Play`](crate::signal::Play) with half-width four times the noise's standard
//! deviation in front of the model cuts that to 0.74 (sigma = 1/2: from 1.8 to 0.11; test
//! `noise_destroys_the_state_and_a_play_guards_it` in `tests/transmission.rs`). It
//! delays a reversal by its width, so it belongs in front of a measured input, not
//! in front of a commanded one.

use crate::error::finite;
use crate::hysteresis::{BoucWen, Shape};
use crate::signal::clamp;
use crate::{Error, Real};

/// The greatest sigma that a [`Shape`] takes.
const MOST: f64 = 1e9;

/// What goes in and comes out of a [`Transmission`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Mode {
    /// Proximal torque [N·m] to distal torque [N·m], equations (5)-(7).
    Torque,
    /// Displacement to force, equations (1)-(2); or voltage to displacement.
    Displacement,
}

/// A linear gain with a hysteresis and an offset: equations (1)-(2), (5)-(7).
///
/// ```
/// use bowden::hysteresis::{BoucWen, Shape};
/// use bowden::transmission::Transmission;
/// # fn main() -> Result<(), bowden::Error> {
/// let shape = Shape::try_new(0.09582, 98.36, 3.871)?;
/// let cable = Transmission::torque(0.9978, 7.004, 0.05174, shape)?; // [N·m]
/// let mut state = BoucWen::new();
/// cable.step(&mut state, 0.0);
/// let tau_o = cable.step(&mut state, 16.0_f64);
/// assert!((tau_o - 9.1).abs() < 0.1); // the cable keeps 6.9 N·m to itself
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        try_from = "Unchecked<T>",
        bound(
            serialize = "T: Real + serde::Serialize",
            deserialize = "T: Real + serde::Deserialize<'de>"
        )
    )
)]
pub struct Transmission<T> {
    mode: Mode,
    gain: T,
    kappa_eta: T,
    offset: T,
    shape: Shape<T>,
}

impl<T: Real> Transmission<T> {
    /// Torque to torque: `tau_o = b·tau_i - kappa_eta·eta - t0`, (5)-(7).
    ///
    /// `b` is the torque ratio `1 - kappa_tau`, `kappa_eta` [N·m] the hysteresis
    /// torque at saturation, `t0` [N·m] the pretension. Physical are `0 < b <= 1` and
    /// `kappa_eta >= 0`; any finite value is accepted, as a fit must be able to say what
    /// it found.
    ///
    /// # Errors
    /// [`Error::NonFinite`] with `"b"`, `"kappa_eta"` or `"t0"`.
    pub fn torque(b: T, kappa_eta: T, t0: T, shape: Shape<T>) -> Result<Self, Error> {
        Ok(Self {
            mode: Mode::Torque,
            gain: finite(b, "b")?,
            kappa_eta: finite(kappa_eta, "kappa_eta")?,
            offset: finite(t0, "t0")?,
            shape,
        })
    }

    /// Displacement to force: `F = kappa_x·x + kappa_eta·eta + offset`, (1)-(2).
    ///
    /// `kappa_x` is [output unit/input unit], `kappa_eta` and `offset` [output unit]. A
    /// cable or spring has both positive; an actuator whose displacement lags its
    /// voltage has `kappa_eta < 0`.
    ///
    /// # Errors
    /// [`Error::NonFinite`] with `"kappa_x"`, `"kappa_eta"` or `"offset"`.
    pub fn displacement(
        kappa_x: T,
        kappa_eta: T,
        offset: T,
        shape: Shape<T>,
    ) -> Result<Self, Error> {
        Ok(Self {
            mode: Mode::Displacement,
            gain: finite(kappa_x, "kappa_x")?,
            kappa_eta: finite(kappa_eta, "kappa_eta")?,
            offset: finite(offset, "offset")?,
            shape,
        })
    }

    /// What goes in and comes out.
    #[inline]
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// `B` in torque mode, `kappa_x` in displacement mode [output unit/input unit].
    #[inline]
    #[must_use]
    pub fn gain(&self) -> T {
        self.gain
    }

    /// Share of the hysteresis [output unit], with the sign of its mode's equation.
    #[inline]
    #[must_use]
    pub fn kappa_eta(&self) -> T {
        self.kappa_eta
    }

    /// `T0` (subtracted) in torque mode, the offset (added) else [output unit].
    #[inline]
    #[must_use]
    pub fn offset(&self) -> T {
        self.offset
    }

    /// Shape of the hysteresis.
    #[inline]
    #[must_use]
    pub fn shape(&self) -> &Shape<T> {
        &self.shape
    }

    /// The output [output unit] at an input [input unit] and a hysteresis state.
    #[inline]
    #[must_use]
    pub fn output(&self, input: T, eta: T) -> T {
        match self.mode {
            Mode::Torque => self.gain * input - self.kappa_eta * eta - self.offset,
            Mode::Displacement => self.gain * input + self.kappa_eta * eta + self.offset,
        }
    }

    /// Takes the input of one sample, returns the output [output unit].
    ///
    /// The first sample leaves eta where it starts. A sample that is not finite leaves
    /// the state and returns the output at the last good input, zero if there is none.
    #[inline]
    pub fn step(&self, state: &mut BoucWen<T>, input: T) -> T {
        let eta = self.shape.step(state, input);
        match state.input() {
            Some(good) => self.output(good, eta),
            None => T::zero(),
        }
    }

    /// The same for a finite input.
    #[inline]
    pub(crate) fn step_finite(&self, state: &mut BoucWen<T>, input: T) -> T {
        self.shape.step(state, input);
        self.output(input, state.eta())
    }

    /// The greatest sigma with which this transmission has an inverse.
    ///
    /// `|gain|/(2·|kappa_eta|·rho)`, rounded down as far as [`inverse`](Self::inverse)
    /// needs; the greatest that a [`Shape`] takes where the hysteresis adds to the gain (a
    /// spring), as the output then never turns back. `None` where no sigma helps: the gain
    /// is zero, or the bound lies below 1/2, which is `rho > |gain|/|kappa_eta|`.
    ///
    /// ```
    /// use bowden::hysteresis::Shape;
    /// use bowden::transmission::Transmission;
    /// let cable = |sigma| Transmission::torque(0.952, 2.29, 0.05, Shape::try_new(0.382, sigma, 1.02)?);
    /// let most = cable(2.97)?.greatest_invertible_sigma().unwrap_or(0.5);
    /// assert!((most - 0.5441_f32).abs() < 1e-4);
    /// assert!(cable(2.97)?.inverse().is_err());
    /// assert!(cable(most)?.inverse().is_ok());
    /// # Ok::<(), bowden::Error>(())
    /// ```
    #[must_use]
    pub fn greatest_invertible_sigma(&self) -> Option<T> {
        if self.gain == T::zero() {
            return None;
        }
        let (gain, rho) = (self.gain.abs(), self.shape.rho());
        let bound = gain / (T::of(2.0) * self.kappa_eta.abs() * rho);
        // 0/0 is a bound that nothing sets.
        let bound = if bound < T::of(MOST) {
            bound
        } else {
            T::of(MOST)
        };
        let bound = if self.is_aided() { T::of(MOST) } else { bound };
        self.rounded_down(bound, |sigma| self.turns_back(sigma, rho))
            .filter(|sigma| *sigma >= T::of(0.5))
    }

    /// The nearest transmission that has an inverse; itself if it has one.
    ///
    /// A sigma above [`greatest_invertible_sigma`](Self::greatest_invertible_sigma) is
    /// lowered to that. Where no sigma helps, sigma becomes 1/2 and rho is lowered to
    /// `|gain|/|kappa_eta|`: the knee of the loop becomes rounder, but its height, which a
    /// feed-forward must overcome in all motions that are long, stays what it was. (With
    /// kappa_eta lowered instead, every saturated sample would be wrong: on loops of ten
    /// times 1/rho and more that costs more than twice the rms error, test
    /// `a_rounder_knee_costs_less_than_a_lower_loop` in `tests/transmission.rs`.)
    ///
    /// At the bound the slope of the output is zero where a saturated loop turns, so the
    /// inverse's input moves at no limited rate there, though by a limited step; a slew
    /// limit behind it does no harm.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] where the gain is zero; [`Error::OutOfRange`] with `"rho"`
    /// where no float is small enough for it.
    pub fn nearest_invertible(&self) -> Result<Self, Error> {
        if self.gain == T::zero() || self.inverse().is_ok() {
            return self.inverse().map(|_| *self);
        }
        let (half, n) = (T::of(0.5), self.shape.n());
        let shape = match self.greatest_invertible_sigma() {
            Some(sigma) => Shape::try_new(self.shape.rho(), sigma, n)?,
            None => {
                let bound = clamp(
                    self.gain.abs() / self.kappa_eta.abs(),
                    T::zero(),
                    self.shape.rho(),
                );
                let rho = self.rounded_down(bound, |rho| self.turns_back(half, rho));
                Shape::try_new(rho.ok_or(Error::OutOfRange("rho"))?, half, n)?
            }
        };
        Ok(Self { shape, ..*self })
    }

    /// The nearest value to a bound, not above it, that does not turn the output back.
    fn rounded_down(&self, bound: T, turns_back: impl Fn(T) -> bool) -> Option<T> {
        let mut value = bound;
        // Three roundings on either side of the comparison; subnormals lose more.
        for _ in 0..8 {
            if !turns_back(value) {
                return Some(value);
            }
            value *= T::one() - T::epsilon();
        }
        None
    }

    /// Whether the hysteresis moves the output the way the gain does.
    fn is_aided(&self) -> bool {
        let against = match self.mode {
            Mode::Torque => self.kappa_eta,
            Mode::Displacement => -self.kappa_eta,
        };
        self.kappa_eta == T::zero() || (against < T::zero()) == (self.gain > T::zero())
    }

    /// Whether somewhere on a loop of this sigma and rho the output turns back.
    fn turns_back(&self, sigma: T, rho: T) -> bool {
        let against = self.kappa_eta.abs() * (T::of(2.0) * sigma * rho);
        !self.is_aided() && (against.is_nan() || against > self.gain.abs())
    }

    /// The inverse: which input gives this output.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] where the output does not rise (or, for a negative gain,
    /// fall) with the input on every branch, see the module documentation.
    pub fn inverse(&self) -> Result<Inverse<T>, Error> {
        if self.gain == T::zero() {
            return Err(Error::Inadmissible(
                "the inverse needs a gain that is not zero",
            ));
        }
        if self.turns_back(self.shape.sigma(), self.shape.rho()) {
            return Err(Error::Inadmissible(
                "the inverse needs sigma <= |gain|/(2*|kappa_eta|*rho), or the output turns back",
            ));
        }
        let (hysteresis, offset) = match self.mode {
            Mode::Torque => (-self.kappa_eta, -self.offset),
            Mode::Displacement => (self.kappa_eta, self.offset),
        };
        // A falling output is a rising one of the opposite sign.
        let sign = if self.gain < T::zero() {
            -T::one()
        } else {
            T::one()
        };
        Ok(Inverse {
            shape: self.shape,
            sign,
            gain: self.gain.abs(),
            hysteresis: sign * hysteresis,
            offset,
        })
    }
}

/// The input that gives a desired output, along the path of the hysteresis.
///
/// Made by [`Transmission::inverse`], whose condition makes the answer unique. The state
/// is the transmission's own: after [`step`](Self::step) it is where the forward model
/// is after the same input.
///
/// ```
/// use bowden::hysteresis::{BoucWen, Shape};
/// use bowden::transmission::Transmission;
/// # fn main() -> Result<(), bowden::Error> {
/// let cable = Transmission::torque(0.9978, 7.004, 0.05174, Shape::try_new(0.09582, 0.6, 3.871)?)?;
/// let inverse = cable.inverse()?;
/// let (mut feed_forward, mut plant) = (BoucWen::new(), BoucWen::new());
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
    shape: Shape<T>,
    /// Sign of the gain: the equation is solved for `sign·y = gain·u + hysteresis·eta`.
    sign: T,
    gain: T,
    hysteresis: T,
    offset: T,
}

/// Most evaluations of the forward model in one step: bisection alone needs 64.
const MOST_EVALUATIONS: u32 = 100;

impl<T: Real> Inverse<T> {
    /// The input [input unit] at which the forward model gives `desired_output`.
    ///
    /// The forward model then returns `desired_output` to 16 machine epsilons of the
    /// magnitudes in its equation, the last input's included, or to the least normal number.
    /// The secant method along the path, begun with its slope, inside a bracket that always
    /// holds the answer: one or two evaluations are usual, 100 the most. A state that has
    /// seen no input keeps its eta in this step, as the forward model does. A desired output
    /// that is not finite, or whose input or the way to it is out of the reach of floats, leaves the
    /// state and returns the last input (zero if there is none).
    pub fn step(&self, state: &mut BoucWen<T>, desired_output: T) -> T {
        let last = state.input();
        let target = self.sign * (desired_output - self.offset);
        // Rounded outwards, so that the answer is inside even without hysteresis.
        let rounding = T::of(4.0) * T::epsilon() * (target.abs() + self.hysteresis.abs());
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

    /// Root of `gain·u + hysteresis·eta(u) - target`, which rises with `u`, and eta there.
    fn solve(&self, start: T, eta: T, target: T, lowest: T, highest: T) -> (T, T) {
        let mut tolerance = target.abs() + (self.gain * start).abs() + self.hysteresis.abs();
        tolerance *= T::of(4.0) * T::epsilon();
        let mut error = self.gain * start + self.hysteresis * eta - target;
        // |eta| <= 1 bounds the answer, and the sign of the error says on which side of
        // the start it lies. The start itself may lie outside after a change of model.
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
        // The whole curve bends one way: where Newton's step leads out of the bracket, its other
        // end is a better guess than its middle.
        let (mut input, mut next) = (start, start - error / slope);
        let is_far = !is_between(next, low, high);
        if is_far {
            next = if direction > T::zero() { high } else { low };
        }
        let (mut is_first, mut half) = (true, best_error * T::of(0.5));
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
            // Where a step does not halve the error (a slope near zero): halve the bracket.
            let is_slow = error.abs() > half && !(is_first && is_far);
            if is_slow || !is_between(next, low, high) {
                next = low + (high - low) * T::of(0.5);
            }
            half = error.abs() * T::of(0.5);
            is_first = false;
        }
        best
    }
}

/// What is read before it is checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(bound(deserialize = "T: Real + serde::Deserialize<'de>"))]
struct Unchecked<T> {
    mode: Mode,
    gain: T,
    kappa_eta: T,
    offset: T,
    shape: Shape<T>,
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Unchecked<T>> for Transmission<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        match raw.mode {
            Mode::Torque => Self::torque(raw.gain, raw.kappa_eta, raw.offset, raw.shape),
            Mode::Displacement => {
                Self::displacement(raw.gain, raw.kappa_eta, raw.offset, raw.shape)
            }
        }
    }
}
