//! What a [`Pid`](super::Pid) is made of, before it is checked.

use super::Pid;
use crate::control::status::OUTSIDE;
use crate::control::{Fallback, Limits};
use crate::error::{above_zero, must_be_finite, not_below_zero};
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
    pub const fn on_error() -> Self {
        Self::Rate { weight: T::ONE }
    }

    /// Derivative of the measurement: a step of the reference does not kick.
    #[must_use]
    pub const fn on_measurement() -> Self {
        Self::Rate { weight: T::ZERO }
    }
}

/// What keeps the integral from growing while the command is limited.
///
/// Limited means: by the range or by the slew rate, unless a variant says otherwise.
///
/// ```
/// use bowden::control::{AntiWindup, Limits, Pid, PidInput, PidSettings, PidState};
/// let integral = |anti_windup| {
///     let limits = Limits::try_new(-10.0, 10.0)?;
///     let pid = Pid::try_new(PidSettings { anti_windup, limits, ..PidSettings::unlimited(2.0, 5.0) })?;
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
    /// `dt/(T_t + dt)`: with the other terms at rest it decays by `T_t/(T_t + dt)` a sample,
    /// as `e^(−t/T_t)` where dt is short, and never overshoots.
    BackCalculation {
        /// T_t, above zero \[s\]; `k_p/k_i` is a usual choice.
        tracking_time: T,
    },
    /// A change that would push a command beyond the range further out is left out.
    ///
    /// A change in the other direction is always taken, so that the integral unwinds. What
    /// the slew rate cuts off, which passes by itself, is back-calculated with
    /// T_t = `k_p/k_i`: were it treated as the range, the integral would stand still for as
    /// long as the command moves.
    Conditional,
}

/// Settings of a [`Pid`](super::Pid), with public fields; [`Pid::try_new`] checks them.
///
/// A stored form without `limits`, `longest_dt` or `fallback` is refused: a table that was lost must
/// not take them away. One of a simulation states them as `unlimited` gives them.
///
/// ```
/// use bowden::control::{Damping, Fallback, Limits, Pid, PidSettings};
/// let pid = Pid::try_new(PidSettings {
///     k_d: 2.0,
///     derivative_time: 0.1, // [s]
///     damping: Damping::on_measurement(),
///     ..PidSettings::new(
///         30.0,
///         18.0_f64,
///         Limits::try_new(-20.0, 60.0)?, // [N·m]
///         0.005,                         // longest dt [s]
///         Fallback::try_new(20, 0.0)?,   // after 20 bad samples: [N·m]
///     )
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
    pub limits: Limits<T>,
    /// Longest `dt` that is a sample, above zero \[s\]: five nominal steps, say.
    ///
    /// A longer one (a counter that wrapped, a task that was starved) is a bad sample.
    pub longest_dt: T,
    /// What goes out when samples stay bad; a safe command lies within `limits`.
    pub fallback: Fallback<T>,
}

#[cfg(feature = "serde")]
fn conditional<T>() -> AntiWindup<T> {
    AntiWindup::Conditional
}

/// A number within 0..=1, or the error with its name.
macro_rules! share {
    ($value:expr, $zero:expr, $one:expr, $name:expr) => {
        not_below_zero!($value, $zero, $name);
        if $value > $one {
            return Err(Error::OutOfRange($name));
        }
    };
}

/// Every check of the settings, for any float and for constants.
macro_rules! checks {
    ($settings:ident, $T:ty) => {{
        let (s, zero, one) = ($settings, <$T as Real>::ZERO, <$T as Real>::ONE);
        must_be_finite!(s.k_p, "k_p");
        must_be_finite!(s.k_i, "k_i");
        must_be_finite!(s.k_d, "k_d");
        if (s.k_p > zero && s.k_i < zero) || (s.k_p < zero && s.k_i > zero) {
            return Err(Error::Inadmissible("k_p and k_i have the same sign"));
        }
        if let Damping::Rate { weight } = s.damping {
            share!(weight, zero, one, "derivative weight");
            let above = s.k_p > zero || s.k_i > zero;
            let below = s.k_p < zero || s.k_i < zero;
            if (above && s.k_d < zero) || (below && s.k_d > zero) {
                return Err(Error::Inadmissible("k_d has the sign of k_p and k_i"));
            }
        }
        share!(s.setpoint_weight, zero, one, "setpoint_weight");
        not_below_zero!(s.derivative_time, zero, "derivative_time");
        if let AntiWindup::BackCalculation { tracking_time } = s.anti_windup {
            above_zero!(tracking_time, zero, "tracking_time");
        }
        above_zero!(s.longest_dt, zero, "longest_dt");
        if let Some(safe) = s.fallback.command() {
            if safe < s.limits.low() || safe > s.limits.high() {
                return Err(Error::Inadmissible(OUTSIDE));
            }
        }
        Ok(())
    }};
}

macro_rules! constant {
    ($float:ty) => {
        impl PidSettings<$float> {
            const fn const_check(&self) -> Result<(), Error> {
                checks!(self, $float)
            }
        }

        impl Pid<$float> {
            /// [`try_new`](Self::try_new) at compile time, see [`constant!`](crate::constant).
            ///
            /// # Errors
            /// As [`try_new`](Self::try_new).
            pub const fn const_new(settings: PidSettings<$float>) -> Result<Self, Error> {
                match settings.const_check() {
                    Ok(()) => Ok(Self { settings }),
                    Err(error) => Err(error),
                }
            }
        }
    };
}
constant!(f32);
constant!(f64);

impl<T: Real> PidSettings<T> {
    /// A plain PI (15) for a machine: what the drive may get, and what happens in a fault.
    ///
    /// Full set-point weight, conditional anti-windup. `longest_dt` in \[s\].
    #[must_use]
    pub const fn new(
        k_p: T,
        k_i: T,
        limits: Limits<T>,
        longest_dt: T,
        fallback: Fallback<T>,
    ) -> Self {
        Self {
            limits,
            longest_dt,
            fallback,
            ..Self::unlimited(k_p, k_i)
        }
    }

    /// The same for a simulation: no limits, any `dt`, the last command for ever.
    #[must_use]
    pub const fn unlimited(k_p: T, k_i: T) -> Self {
        Self {
            k_p,
            k_i,
            k_d: T::ZERO,
            damping: Damping::on_error(),
            derivative_time: T::ZERO,
            setpoint_weight: T::ONE,
            anti_windup: AntiWindup::Conditional,
            limits: Limits::unlimited(),
            longest_dt: T::HIGHEST,
            fallback: Fallback::hold_for_ever(),
        }
    }

    /// Everything that a field's docs promise.
    pub(super) fn check(&self) -> Result<(), Error> {
        checks!(self, T)
    }
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
