//! The cable transmission (displacement to force, or torque to torque) and its inverse.
//!
//! - Displacement mode, equations (1)-(2): `F = kappa_x·x + kappa_eta·eta + offset`.
//! - Torque mode, equations (5)-(7): `tau_o = B·tau_i - kappa_eta·eta - T0`.
//!
//! In both modes, `eta` is the hysteresis state of [`BoucWen`], which the input drives.
//!
//! # The inverse
//! The inverse computes the input for a given output. The input is unique if the output rises with
//! the input on every branch. The slope of eta with respect to the input lies in
//! `[0, 2·sigma·rho]`. In torque mode the condition is therefore `sigma <= B/(2·kappa_eta·rho)`.
//! For the first parameter set of Nguyen et al. (2018) this bound is 0.743, but sigma is 98.36. Use
//! such a set only for simulation and identification, because the output falls while the input
//! rises after a reversal.
//!
//! This condition follows from the slope of the equation. Up to n = 4 (proved) and up to n = 10
//! (measured), the slope of the `f32` step does not exceed this slope. For n of about 12 or more,
//! the slope of the step may be up to 1.39 times the slope of the equation (see
//! [`hysteresis`](crate::hysteresis)). For such n, choose sigma below the bound divided by 1.39.
//! [`Transmission::greatest_invertible_sigma`] returns the bound.
//! [`Transmission::nearest_invertible`] returns a transmission that satisfies it.
//!
//! # Noise at the hysteresis input
//! Noise on the input causes false reversals. With this first parameter set, noise of 0.05 N·m rms
//! on `tau_i` changes `kappa_eta·eta` by 3.7 N·m rms. A [`Play`](crate::signal::Play) upstream of
//! the model, with a half-width of four standard deviations of the noise, reduces this error to
//! 0.74 N·m rms. For sigma = 1/2, the play reduces the error from 1.8 to 0.11 N·m rms. Use a play
//! only on a measured input, because it delays each reversal by its width.

use crate::error::must_be_finite;
use crate::hysteresis::{BoucWen, BoucWenState};
use crate::signal::clamp;
use crate::{Error, Real};

mod inverse;

pub use inverse::Inverse;

/// The largest sigma that a [`BoucWen`] accepts.
const MOST: f64 = 1e9;

crate::data! {
    /// Input and output quantities of a [`Transmission`].
    #[derive(Eq)]
    pub enum Mode {
        /// Proximal torque [N·m] to distal torque [N·m], equations (5)-(7).
        Torque,
        /// Displacement to force or voltage to displacement, equations (1)-(2).
        Displacement,
    }
}

crate::checked::stored! {
    /// A linear gain with hysteresis and an offset: equations (1)-(2) and (5)-(7).
    ///
    /// ```
    /// use bowden::hysteresis::{BoucWenState, BoucWen};
    /// use bowden::transmission::Transmission;
    /// # fn main() -> Result<(), bowden::Error> {
    /// let shape = BoucWen::try_new(0.09582, 98.36, 3.871)?;
    /// let cable = Transmission::torque(0.9978, 7.004, 0.05174, shape)?; // [N·m]
    /// let mut state = BoucWenState::new();
    /// cable.step(&mut state, 0.0);
    /// let tau_o = cable.step(&mut state, 16.0_f64);
    /// assert!((tau_o - 9.1).abs() < 0.1); // friction takes 6.9 N·m
    /// # Ok(())
    /// # }
    /// ```
    pub struct Transmission<T> {
        mode: Mode,
        gain: T,
        kappa_eta: T,
        offset: T,
        shape: BoucWen<T>,
    }
    => {
        match mode {
            Mode::Torque => Self::torque(gain, kappa_eta, offset, shape),
            Mode::Displacement => Self::displacement(gain, kappa_eta, offset, shape),
        }
    }
}

crate::checked! {
    Transmission<T>;

    /// Torque mode, equations (5)-(7): `tau_o = b·tau_i - kappa_eta·eta - t0`.
    ///
    /// `b` is the torque ratio `1 - kappa_tau`, `kappa_eta` [N·m] is the hysteresis torque at
    /// saturation, and `t0` [N·m] is the preload. Physical values are `0 < b <= 1` and
    /// `kappa_eta >= 0`. The constructor accepts any finite value, so the type can represent every
    /// result of a fit.
    ///
    /// # Errors
    /// [`Error::NonFinite`] with `"b"`, `"kappa_eta"` or `"t0"`.
    pub fn torque(b: T, kappa_eta: T, t0: T, shape: BoucWen<T>) {
        must_be_finite!(b, "b");
        must_be_finite!(kappa_eta, "kappa_eta");
        must_be_finite!(t0, "t0");
        let (mode, gain, offset) = (Mode::Torque, b, t0);
        Ok(Transmission { mode, gain, kappa_eta, offset, shape })
    }

    /// Displacement mode, equations (1)-(2): `F = kappa_x·x + kappa_eta·eta + offset`.
    ///
    /// The unit of `kappa_x` is [output unit/input unit], and the unit of `kappa_eta` and `offset`
    /// is [output unit]. Both gains are positive for a cable or a spring. An actuator whose
    /// displacement lags its voltage has `kappa_eta < 0`.
    ///
    /// # Errors
    /// [`Error::NonFinite`] with `"kappa_x"`, `"kappa_eta"` or `"offset"`.
    pub fn displacement(kappa_x: T, kappa_eta: T, offset: T, shape: BoucWen<T>) {
        must_be_finite!(kappa_x, "kappa_x");
        must_be_finite!(kappa_eta, "kappa_eta");
        must_be_finite!(offset, "offset");
        let (mode, gain) = (Mode::Displacement, kappa_x);
        Ok(Transmission { mode, gain, kappa_eta, offset, shape })
    }
}

impl<T: Real> Transmission<T> {
    /// Torque or displacement mode, which determines the input and output quantities.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// `B` in torque mode, `kappa_x` in displacement mode [output unit/input unit].
    pub fn gain(&self) -> T {
        self.gain
    }

    /// Gain of the hysteresis [output unit], with its sign in the equation of the mode.
    pub fn kappa_eta(&self) -> T {
        self.kappa_eta
    }

    /// `T0` (subtracted) in torque mode, otherwise the offset (added) [output unit].
    pub fn offset(&self) -> T {
        self.offset
    }

    /// Parameters of the hysteresis.
    pub fn shape(&self) -> &BoucWen<T> {
        &self.shape
    }

    /// The output [output unit] for an input [input unit] and a hysteresis state.
    #[inline]
    #[must_use]
    pub fn output(&self, input: T, eta: T) -> T {
        match self.mode {
            Mode::Torque => self.gain * input - self.kappa_eta * eta - self.offset,
            Mode::Displacement => self.gain * input + self.kappa_eta * eta + self.offset,
        }
    }

    /// Advances by the input of one sample and returns the output [output unit].
    ///
    /// The first sample does not change eta. A sample that is not finite leaves the state
    /// unchanged. The step then returns the output at the last good input, or zero if there is
    /// none.
    #[inline]
    pub fn step(&self, state: &mut BoucWenState<T>, input: T) -> T {
        let eta = self.shape.step(state, input);
        match state.input() {
            Some(good) => self.output(good, eta),
            None => T::zero(),
        }
    }

    /// The same as [`step`](Self::step), for a finite input.
    #[inline]
    pub(crate) fn step_finite(&self, state: &mut BoucWenState<T>, input: T) -> T {
        self.shape.step(state, input);
        self.output(input, state.eta())
    }

    /// The largest sigma for which this transmission has an inverse.
    ///
    /// The value is `|gain|/(2·|kappa_eta|·rho)`, rounded down so that [`inverse`](Self::inverse)
    /// accepts it. If the hysteresis acts in the direction of the gain, as in a spring, the output
    /// never reverses. The value is then the largest sigma that [`BoucWen`] accepts. `None` means
    /// that no sigma gives an inverse, because the gain is zero or the bound is below 1/2 (`rho`
    /// above `|gain|/|kappa_eta|`).
    ///
    /// ```
    /// use bowden::hysteresis::BoucWen;
    /// use bowden::transmission::Transmission;
    /// let cable = |sigma| Transmission::torque(0.952, 2.29, 0.05, BoucWen::try_new(0.382, sigma, 1.02)?);
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
        let bound = gain / (T::from_f64(2.0) * self.kappa_eta.abs() * rho);
        // 0/0 is a bound without a constraint.
        let bound = if bound < T::from_f64(MOST) && !self.is_aided() {
            bound
        } else {
            T::from_f64(MOST)
        };
        self.rounded_down(bound, |sigma| self.turns_back(sigma, rho))
            .filter(|sigma| *sigma >= T::from_f64(0.5))
    }

    /// The nearest transmission with an inverse.
    ///
    /// If this transmission has an inverse, the method returns it unchanged.
    ///
    /// A sigma above [`greatest_invertible_sigma`](Self::greatest_invertible_sigma) is lowered to
    /// this bound. If no sigma gives an inverse, sigma becomes 1/2 and rho is lowered to
    /// `|gain|/|kappa_eta|`. The knee of the loop then becomes rounder, but the loop keeps its
    /// height.
    ///
    /// At the bound, the slope of the output is zero immediately after a reversal from saturation.
    /// At such a reversal, the rate of the computed input is unbounded, but the change in one
    /// sample is bounded. You can therefore apply a slew-rate limit to the computed input.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] if the gain is zero; [`Error::OutOfRange`] with `"rho"` if the
    /// required rho is too small for the float type.
    pub fn nearest_invertible(&self) -> Result<Self, Error> {
        if self.gain == T::zero() || self.inverse().is_ok() {
            return self.inverse().map(|_| *self);
        }
        let (half, n) = (T::from_f64(0.5), self.shape.n());
        let shape = match self.greatest_invertible_sigma() {
            Some(sigma) => BoucWen::try_new(self.shape.rho(), sigma, n)?,
            None => {
                let bound = clamp(
                    self.gain.abs() / self.kappa_eta.abs(),
                    T::zero(),
                    self.shape.rho(),
                );
                let rho = self.rounded_down(bound, |rho| self.turns_back(half, rho));
                BoucWen::try_new(rho.ok_or(Error::OutOfRange("rho"))?, half, n)?
            }
        };
        Ok(Self { shape, ..*self })
    }

    /// The nearest value to a bound, not above it, for which the output does not reverse.
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

    /// Whether hysteresis and gain move the output in the same direction.
    fn is_aided(&self) -> bool {
        let against = match self.mode {
            Mode::Torque => self.kappa_eta,
            Mode::Displacement => -self.kappa_eta,
        };
        self.kappa_eta == T::zero() || (against < T::zero()) == (self.gain > T::zero())
    }

    /// Whether the output reverses somewhere on a loop with this sigma and rho.
    fn turns_back(&self, sigma: T, rho: T) -> bool {
        let against = self.kappa_eta.abs() * (T::from_f64(2.0) * sigma * rho);
        !self.is_aided() && (against.is_nan() || against > self.gain.abs())
    }

    /// The inverse, which computes the input for a given output.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] if the gain is zero, or if the output does not rise with the input
    /// on every branch (for a negative gain: fall). See the [module](crate::transmission).
    pub fn inverse(&self) -> Result<Inverse<T>, Error> {
        if self.gain == T::zero() {
            return Err(Error::Inadmissible("the inverse needs a non-zero gain"));
        }
        if self.turns_back(self.shape.sigma(), self.shape.rho()) {
            return Err(Error::Inadmissible(
                "the inverse needs sigma <= |gain|/(2*|kappa_eta|*rho)",
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
