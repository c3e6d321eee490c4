//! What a [`Pid`](super::Pid) is made of, before it is checked.

use super::Pid;
use crate::control::{Fallback, Limits};
use crate::error::finite;
use crate::{Error, Real};

/// What the gain `k_d` multiplies.
///
/// ```
/// use bowden::control::Damping;
/// assert_eq!(Damping::on_error(), Damping::Rate { weight: 1.0 });
/// assert_eq!(Damping::on_measurement(), Damping::Rate { weight: 0.0 });
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Damping<T> {
    /// The filtered derivative of `y − c·y_r`, PID (14).
    Rate {
        /// Set-point weight c within 0..=1: 1 on the error, 0 on the measurement.
        weight: T,
    },
    /// The measured distal velocity as it is, PIV (16); nothing is filtered.
    Velocity,
}

impl<T: Real> Damping<T> {
    /// Derivative of the error, as in (14): a step of the reference kicks.
    #[must_use]
    pub fn on_error() -> Self {
        Self::Rate { weight: T::one() }
    }

    /// Derivative of the measurement: a step of the reference does not kick.
    #[must_use]
    pub fn on_measurement() -> Self {
        Self::Rate { weight: T::zero() }
    }
}

/// What keeps the integral from growing while the command is limited.
///
/// Limited means: by the range or by the slew rate.
///
/// ```
/// use bowden::control::{AntiWindup, Limits, Pid, PidInput, PidSettings, PidState};
/// let integral = |anti_windup| {
///     let limits = Limits::try_new(-10.0, 10.0)?;
///     let pid = Pid::try_new(PidSettings { anti_windup, limits, ..PidSettings::new(2.0, 5.0) })?;
///     let mut state = PidState::new();
///     for _ in 0..1000 {
///         pid.step(&mut state, &PidInput::new(0.001, 8.0, 0.0)); // wants 16 and more
///     }
///     Ok::<f64, bowden::Error>(state.integral())
/// };
/// assert!((integral(AntiWindup::None)? - 40.0).abs() < 1e-9);
/// assert_eq!(integral(AntiWindup::Clamp)?, 10.0);
/// assert_eq!(integral(AntiWindup::Conditional)?, 0.0);
/// // Back-calculation gives up what the limits cut off, to the command itself and less.
/// assert!(integral(AntiWindup::BackCalculation { tracking_time: 0.05 })? < 0.0);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum AntiWindup<T> {
    /// Nothing: the integral winds up.
    None,
    /// The integral term stays within the range of the command, widened to hold zero.
    Clamp,
    /// What the limits cut off flows back into the integral.
    ///
    /// The part cut off at one sample enters at the next one, times
    /// `1 − e^(−dt/T_t)`: with the other terms at rest it decays as `e^(−t/T_t)`, at any
    /// rate and for any `dt`.
    BackCalculation {
        /// T_t, above zero \[s\]; `k_p/k_i` is a usual choice.
        tracking_time: T,
    },
    /// A change that would push a limited command further out is left out.
    ///
    /// A change in the other direction is always taken, so that the integral unwinds.
    Conditional,
}

/// Settings of a [`Pid`](super::Pid), with public fields; [`Pid::try_new`] checks them.
///
/// ```
/// use bowden::control::{Damping, Pid, PidSettings};
/// let pid = Pid::try_new(PidSettings {
///     k_d: 2.0,
///     derivative_time: 0.1, // [s]
///     damping: Damping::on_measurement(),
///     ..PidSettings::new(30.0, 18.0_f64)
/// })?;
/// assert_eq!(pid.settings().k_d, 2.0);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        deny_unknown_fields,
        bound(
            serialize = "T: Real + serde::Serialize",
            deserialize = "T: Real + serde::Deserialize<'de>"
        )
    )
)]
pub struct PidSettings<T> {
    /// Proportional gain \[command unit/output unit\]; finite.
    pub k_p: T,
    /// Integral gain \[command unit/(output unit·s)\]; finite, of the sign of `k_p`.
    pub k_i: T,
    /// Gain of the damping; finite, with [`Damping::Rate`] of the sign of `k_p`.
    ///
    /// \[command unit·s/output unit\], for PIV \[command unit·s/rad\]. At zero nothing is
    /// filtered.
    #[cfg_attr(feature = "serde", serde(default = "T::zero"))]
    pub k_d: T,
    /// What `k_d` multiplies.
    #[cfg_attr(feature = "serde", serde(default = "Damping::on_error"))]
    pub damping: Damping<T>,
    /// Time constant of the derivative's filter, from zero (none) up \[s\].
    #[cfg_attr(feature = "serde", serde(default = "T::zero"))]
    pub derivative_time: T,
    /// Set-point weight b of the proportional term, within 0..=1.
    #[cfg_attr(feature = "serde", serde(default = "T::one"))]
    pub setpoint_weight: T,
    /// What the integral does while the command is limited.
    #[cfg_attr(feature = "serde", serde(default = "conditional"))]
    pub anti_windup: AntiWindup<T>,
    /// Range and slew rate of the command.
    #[cfg_attr(feature = "serde", serde(default = "Limits::none"))]
    pub limits: Limits<T>,
    /// What goes out when samples stay bad; a safe command lies within `limits`.
    #[cfg_attr(feature = "serde", serde(default = "Fallback::hold"))]
    pub fallback: Fallback<T>,
}

#[cfg(feature = "serde")]
fn conditional<T>() -> AntiWindup<T> {
    AntiWindup::Conditional
}

impl<T: Real> PidSettings<T> {
    /// A plain PI (15): full set-point weight, conditional anti-windup, no limits.
    #[must_use]
    pub fn new(k_p: T, k_i: T) -> Self {
        Self {
            k_p,
            k_i,
            k_d: T::zero(),
            damping: Damping::on_error(),
            derivative_time: T::zero(),
            setpoint_weight: T::one(),
            anti_windup: AntiWindup::Conditional,
            limits: Limits::none(),
            fallback: Fallback::hold(),
        }
    }

    /// Everything that a field's docs promise.
    pub(super) fn check(&self) -> Result<(), Error> {
        finite(self.k_p, "k_p")?;
        finite(self.k_i, "k_i")?;
        finite(self.k_d, "k_d")?;
        if opposed(self.k_p, self.k_i) {
            return Err(Error::Inadmissible("k_p and k_i have the same sign"));
        }
        if let Damping::Rate { weight } = self.damping {
            share(weight, "derivative weight")?;
            if opposed(self.k_p, self.k_d) || opposed(self.k_i, self.k_d) {
                return Err(Error::Inadmissible("k_d has the sign of k_p and k_i"));
            }
        }
        share(self.setpoint_weight, "setpoint_weight")?;
        if finite(self.derivative_time, "derivative_time")? < T::zero() {
            return Err(Error::OutOfRange("derivative_time"));
        }
        if let AntiWindup::BackCalculation { tracking_time } = self.anti_windup {
            if finite(tracking_time, "tracking_time")? <= T::zero() {
                return Err(Error::OutOfRange("tracking_time"));
            }
        }
        self.fallback.check_within(&self.limits)
    }
}

/// Whether one is above zero and the other below.
fn opposed<T: Real>(a: T, b: T) -> bool {
    (a > T::zero() && b < T::zero()) || (a < T::zero() && b > T::zero())
}

fn share<T: Real>(value: T, name: &'static str) -> Result<(), Error> {
    if finite(value, name)? < T::zero() || value > T::one() {
        return Err(Error::OutOfRange(name));
    }
    Ok(())
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<PidSettings<T>> for Pid<T> {
    type Error = Error;
    fn try_from(settings: PidSettings<T>) -> Result<Self, Error> {
        Self::try_new(settings)
    }
}

impl<T: Real> From<Pid<T>> for PidSettings<T> {
    fn from(pid: Pid<T>) -> Self {
        *pid.settings()
    }
}
