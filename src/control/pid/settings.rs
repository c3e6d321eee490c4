//! Unchecked settings of a [`Pid`](super::Pid).

use super::Pid;
use crate::control::status::OUTSIDE;
use crate::control::{Fallback, Limits};
use crate::error::{above_zero, must_be_finite, not_below_zero};
use crate::{Error, Real};

crate::data! {
    /// The signal that the gain `k_d` multiplies.
    ///
    /// ```
    /// use bowden::control::DerivativeSource;
    /// assert_eq!(DerivativeSource::on_error(), DerivativeSource::Rate { weight: 1.0 });
    /// assert_eq!(DerivativeSource::on_measurement(), DerivativeSource::Rate { weight: 0.0 });
    /// ```
    pub enum DerivativeSource<T> {
        /// The filtered derivative of `y − c·y_r`, as in PID (14).
        Rate {
            /// Set-point weight c, from 0 (derivative of the measurement) to 1 (derivative of the
            /// error).
            weight: T,
        },
        /// The measured distal velocity, unfiltered, as in PIV (16).
        Velocity,
    }
}

impl<T: Real> DerivativeSource<T> {
    /// Derivative of the error, as in (14): a reference step causes a derivative kick.
    pub const fn on_error() -> Self {
        Self::Rate { weight: T::ONE }
    }

    /// Derivative of the measurement, the default: a reference step causes no derivative kick.
    pub const fn on_measurement() -> Self {
        Self::Rate { weight: T::ZERO }
    }
}

crate::data! {
    /// Anti-windup: the treatment of the integral while the command is limited.
    ///
    /// The limits are the range and the slew-rate limit, unless a variant specifies one of them.
    ///
    /// ```
    /// use bowden::control::{AntiWindup, Limits, Pid, PidInput, PidSettings, PidState};
    /// let integral = |anti_windup| {
    ///     let limits = Limits::try_new(-10.0, 10.0)?;
    ///     let pid = Pid::try_new(PidSettings { anti_windup, limits, ..PidSettings::unlimited(2.0, 5.0) })?;
    ///     let mut state = PidState::new();
    ///     for _ in 0..1000 {
    ///         pid.step(&mut state, &PidInput::new(0.001, 8.0, 0.0)); // the demand is 16 or more
    ///     }
    ///     Ok::<f64, bowden::Error>(state.integral())
    /// };
    /// assert!((integral(AntiWindup::None)? - 40.0).abs() < 1e-9);
    /// assert_eq!(integral(AntiWindup::Clamp)?, 10.0);
    /// assert_eq!(integral(AntiWindup::Conditional)?, 0.0);
    /// // Back-calculation removes the part that the limits cut off.
    /// assert!(integral(AntiWindup::BackCalculation { tracking_time: 0.05 })? < 0.0);
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub enum AntiWindup<T> {
        /// No anti-windup: the integral winds up.
        None,
        /// The integral term is clamped to the range of the command. If necessary, the range is
        /// widened to include zero and the value for which the command equals its limit.
        Clamp,
        /// The integral is corrected by the part of the command that the limits cut off. With `k_i`
        /// = 0 there is no correction.
        ///
        /// At the next sample, the integral moves by `dt/(T_t + dt)` times this part, so that the
        /// sum of the terms approaches the limit. While the other terms are constant, the part that
        /// is cut off decays by the factor `T_t/(T_t + dt)` per sample, without overshoot.
        BackCalculation {
            /// T_t \[s\], positive; `k_p/k_i` is a usual choice.
            tracking_time: T,
        },
        /// The integral stops at the value for which the command equals the limit of its range.
        ///
        /// A change away from this limit is not restricted, so the integral unwinds. The part that
        /// the slew-rate limit cuts off is treated as in back-calculation, with T_t = `k_p/k_i`.
        Conditional,
    }

    /// Settings of a [`Pid`](super::Pid), with public fields; [`Pid::try_new`] checks them.
    ///
    /// Deserialising fails if `limits`, `longest_dt` or `fallback` is missing, because an omitted
    /// field must not remove a safeguard. For a simulation, write the values of
    /// [`unlimited`](Self::unlimited) explicitly.
    ///
    /// ```
    /// use bowden::control::{DerivativeSource, Fallback, Limits, Pid, PidSettings};
    /// let pid = Pid::try_new(PidSettings {
    ///     k_d: 2.0,
    ///     derivative_time: 0.1, // [s]
    ///     damping: DerivativeSource::on_measurement(),
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
    pub struct PidSettings<T: Real> {
        /// Proportional gain \[command unit/output unit\]; finite.
        pub k_p: T,
        /// Integral gain \[command unit/(output unit·s)\]; finite. It must have the sign of `k_p`.
        ///
        /// **With 0, there is no integral action.** An existing integral (from other settings, or
        /// from a start at a given command) returns to zero with a time constant of 1 s.
        pub k_i: T,
        /// Damping gain; finite. With [`DerivativeSource::Rate`], it must have the sign of `k_p`
        /// (and of `k_i`).
        ///
        /// The unit is \[command unit·s/output unit\]; for PIV, it is \[command unit·s/rad\].
        #[cfg_attr(feature = "serde", serde(default = "T::zero"))]
        pub k_d: T,
        /// The signal that `k_d` multiplies.
        #[cfg_attr(feature = "serde", serde(default = "DerivativeSource::on_measurement"))]
        pub damping: DerivativeSource<T>,
        /// Time constant of the derivative filter \[s\], not negative; zero means no filter.
        #[cfg_attr(feature = "serde", serde(default = "T::zero"))]
        pub derivative_time: T,
        /// Set-point weight b of the proportional term, from 0 to 1.
        #[cfg_attr(feature = "serde", serde(default = "T::one"))]
        pub setpoint_weight: T,
        /// Anti-windup method.
        #[cfg_attr(feature = "serde", serde(default = "conditional"))]
        pub anti_windup: AntiWindup<T>,
        /// Largest magnitude of the integral term \[command unit\], positive.
        #[cfg_attr(feature = "serde", serde(default = "none"))]
        pub integral_limit: Option<T>,
        /// Deadband \[output unit\], not negative: the integral is frozen while `|e|` is at most
        /// this value.
        ///
        /// With static friction, the integral winds up until the output jumps past the reference
        /// (hunting). A deadband wider than this jump prevents hunting.
        #[cfg_attr(feature = "serde", serde(default = "T::zero"))]
        pub deadband: T,
        /// Period of an output that wraps \[output unit\], positive, such as 360°.
        ///
        /// The error and the changes in the output are then measured in the shorter direction, so
        /// they are at most half a period. A period requires b = 1, and c = 0 or 1.
        #[cfg_attr(feature = "serde", serde(default = "none"))]
        pub period: Option<T>,
        /// Range and slew-rate limit of the command.
        pub limits: Limits<T>,
        /// Longest `dt` of a good sample \[s\], positive; for example, five sampling periods.
        ///
        /// A longer `dt`, for example from a timer that wraps, is a bad sample.
        pub longest_dt: T,
        /// Fallback after repeated bad samples; its safe command must lie within `limits`.
        pub fallback: Fallback<T>,
    }
}

#[cfg(feature = "serde")]
fn conditional<T>() -> AntiWindup<T> {
    AntiWindup::Conditional
}

#[cfg(feature = "serde")]
fn none<T>() -> Option<T> {
    None
}

/// Checks that a number is from 0 to 1; otherwise returns the error with its name.
macro_rules! share {
    ($value:expr, $name:expr) => {
        not_below_zero!($value, $name);
        if $value > T::ONE {
            return Err(Error::OutOfRange($name));
        }
    };
}

impl<T: Real> PidSettings<T> {
    /// Settings of a PI for hardware, equation (15), with command limits and a fallback.
    ///
    /// The set-point weight b is 1, and the anti-windup is conditional. If you set `k_d`, the
    /// derivative acts on the measurement. `longest_dt` is in \[s\].
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

    /// Settings for a simulation: no command limits, no `longest_dt`, and no safe command.
    pub const fn unlimited(k_p: T, k_i: T) -> Self {
        Self {
            k_p,
            k_i,
            k_d: T::ZERO,
            damping: DerivativeSource::on_measurement(),
            derivative_time: T::ZERO,
            setpoint_weight: T::ONE,
            anti_windup: AntiWindup::Conditional,
            integral_limit: None,
            deadband: T::ZERO,
            period: None,
            limits: Limits::unlimited(),
            longest_dt: T::HIGHEST,
            fallback: Fallback::hold_indefinitely(),
        }
    }
}

crate::checked! {
    Pid<T>;

    fn is_plain[](s: &PidSettings<T>) -> bool {
        s.limits.slew().is_none()
            && matches!(s.anti_windup, AntiWindup::None | AntiWindup::Conditional)
            && s.k_i != T::ZERO
            && s.integral_limit.is_none()
            && s.deadband == T::ZERO
            && s.period.is_none()
    }

    fn check[](s: &PidSettings<T>) -> Result<(), Error> {
        must_be_finite!(s.k_p, "k_p");
        must_be_finite!(s.k_i, "k_i");
        must_be_finite!(s.k_d, "k_d");
        if (s.k_p > T::ZERO && s.k_i < T::ZERO) || (s.k_p < T::ZERO && s.k_i > T::ZERO) {
            return Err(Error::Inadmissible("k_p and k_i must have the same sign"));
        }
        if let DerivativeSource::Rate { weight } = s.damping {
            share!(weight, "derivative weight");
            let above = s.k_p > T::ZERO || s.k_i > T::ZERO;
            let below = s.k_p < T::ZERO || s.k_i < T::ZERO;
            if (above && s.k_d < T::ZERO) || (below && s.k_d > T::ZERO) {
                return Err(Error::Inadmissible("k_d must have the sign of k_p and k_i"));
            }
        }
        share!(s.setpoint_weight, "setpoint_weight");
        not_below_zero!(s.derivative_time, "derivative_time");
        if let AntiWindup::BackCalculation { tracking_time } = s.anti_windup {
            above_zero!(tracking_time, "tracking_time");
        }
        if let Some(limit) = s.integral_limit {
            above_zero!(limit, "integral_limit");
        }
        not_below_zero!(s.deadband, "deadband");
        if let Some(period) = s.period {
            above_zero!(period, "period");
            let whole = match s.damping {
                DerivativeSource::Rate { weight } => weight == T::ZERO || weight == T::ONE,
                DerivativeSource::Velocity => true,
            };
            if s.setpoint_weight != T::ONE || !whole {
                return Err(Error::Inadmissible(
                    "with a period: setpoint_weight 1, derivative weight 0 or 1",
                ));
            }
        }
        above_zero!(s.longest_dt, "longest_dt");
        if let Some(safe) = s.fallback.command() {
            if safe < s.limits.low() || safe > s.limits.high() {
                return Err(Error::Inadmissible(OUTSIDE));
            }
        }
        Ok(())
    }

    /// Checks the settings.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with the name of the setting, or
    /// [`Error::Inadmissible`] with the violated condition. The fields of [`PidSettings`] document
    /// the ranges and conditions.
    pub fn try_new(settings: PidSettings<T>) {
        if let Err(error) = check(&settings) {
            return Err(error);
        }
        Ok(Pid { plain: is_plain(&settings), settings })
    }
}
