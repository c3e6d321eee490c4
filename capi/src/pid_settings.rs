//! Settings of PI, PID and PIV controllers.

use crate::result::Refused;
use crate::settings::{marked, Marked};
use crate::{bowden_fallback_f32, bowden_fallback_f64, bowden_limits_f32, bowden_limits_f64};
use core_bowden::control::{AntiWindup, DerivativeSource, Pid, PidSettings};

/// Signal that the gain `k_d` multiplies.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_derivative_source {
    /// PID: the filtered derivative of y - c*y_r, as in (14).
    Rate = 0,
    /// PIV: the measured distal velocity, unfiltered, as in (16).
    Velocity = 1,
}

/// Anti-windup method: how the integral behaves while the command saturates.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_anti_windup {
    /// The integral changes only until the command reaches the end of its range. A change away from
    /// this limit is not restricted.
    Conditional = 0,
    /// No anti-windup: the integral winds up.
    None = 1,
    /// The integral term stays within the command range. For this purpose, the range is widened to
    /// include zero and the integral term at which the command reaches its limit.
    Clamp = 2,
    /// The part of the command that the limits cut off is fed back to the integral with the time
    /// constant `tracking_time`.
    BackCalculation = 3,
}

macro_rules! settings {
    ($f:ident) => {
        pastey::paste! {
            /// Settings of a PI, PID or PIV controller, equations (15), (14) and (16):
            ///
            ///     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*d/dt(y - c*y_r) + u_ff
            ///     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*v_d             + u_ff    (PIV)
            ///     command = u within the range and the slew-rate limit;  e = y - y_r
            ///
            /// Defaults: b = 1, c = 0, conditional anti-windup, no slew-rate limit, a fallback
            /// weight of 4, and 0 for the gains and the safe command. You must set `limits`,
            /// `longest_dt` and `fallback.after`.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_pid_settings_ $f>] {
                /// Initialisation mark, set by NAME_INIT.
                pub init_mark: u32,
                /// Proportional gain [command unit/output unit].
                pub k_p: $f,
                /// Integral gain [command unit/(output unit*s)], with the sign of k_p.
                pub k_i: $f,
                /// Derivative gain [command unit*s/output unit], with the sign of k_p. PIV:
                /// velocity gain [command unit*s/rad]. PI: 0.
                pub k_d: $f,
                /// Signal that k_d multiplies, one of bowden_derivative_source.
                pub damping: u32,
                /// Set-point weight c of the derivative, 0 to 1. With 0, the default, the
                /// derivative acts on the measurement. With 1 it acts on the error, so a reference
                /// step causes a derivative kick.
                pub derivative_weight: $f,
                /// Time constant of the derivative filter [s], at least 0; 0 disables the filter.
                pub derivative_time: $f,
                /// Set-point weight b of the proportional term, 0 to 1; default 1.
                pub setpoint_weight: $f,
                /// Anti-windup method, one of bowden_anti_windup.
                pub anti_windup: u32,
                /// Tracking time [s], positive. Only BOWDEN_ANTI_WINDUP_BACK_CALCULATION uses it.
                pub tracking_time: $f,
                /// Largest magnitude of the integral term [command unit], at least 0; 0 disables
                /// this limit.
                pub integral_limit: $f,
                /// Deadband [output unit], at least 0: the integral is frozen while |e| is at most
                /// this value. Static friction can make the output jump past the reference again
                /// and again (hunting). A deadband wider than this jump prevents hunting.
                pub deadband: $f,
                /// Period of an output that wraps [output unit], such as 360 degrees; 0 if the
                /// output does not wrap. Errors and changes are taken in the shorter direction. A
                /// period requires b = 1, and c = 0 or c = 1.
                pub period: $f,
                /// Range and slew-rate limit of the command.
                pub limits: [<bowden_limits_ $f>],
                /// Longest dt of a good sample [s], positive, for example five sampling periods.
                pub longest_dt: $f,
                /// Fallback after repeated bad samples.
                pub fallback: [<bowden_fallback_ $f>],
            }

            marked!([<bowden_pid_settings_ $f>]);

            impl [<bowden_pid_settings_ $f>] {
                /// Returns the defaults.
                pub const fn defaults() -> Self {
                    Self {
                        init_mark: Self::MARK,
                        k_p: 0.0,
                        k_i: 0.0,
                        k_d: 0.0,
                        damping: bowden_derivative_source::Rate as u32,
                        derivative_weight: 0.0,
                        derivative_time: 0.0,
                        setpoint_weight: 1.0,
                        anti_windup: bowden_anti_windup::Conditional as u32,
                        tracking_time: 0.0,
                        integral_limit: 0.0,
                        deadband: 0.0,
                        period: 0.0,
                        limits: [<bowden_limits_ $f>]::UNSET,
                        longest_dt: 0.0,
                        fallback: [<bowden_fallback_ $f>] { after: 0, weight: 4, command: 0.0 },
                    }
                }

                pub(crate) fn pid(&self) -> Result<Pid<$f>, Refused> {
                    let damping = match self.damping {
                        d if d == bowden_derivative_source::Rate as u32 => {
                            DerivativeSource::Rate { weight: self.derivative_weight }
                        }
                        d if d == bowden_derivative_source::Velocity as u32 => DerivativeSource::Velocity,
                        _ => return Err(Refused::choice("damping")),
                    };
                    let anti_windup = match self.anti_windup {
                        w if w == bowden_anti_windup::Conditional as u32 => AntiWindup::Conditional,
                        w if w == bowden_anti_windup::None as u32 => AntiWindup::None,
                        w if w == bowden_anti_windup::Clamp as u32 => AntiWindup::Clamp,
                        w if w == bowden_anti_windup::BackCalculation as u32 => {
                            AntiWindup::BackCalculation { tracking_time: self.tracking_time }
                        }
                        _ => return Err(Refused::choice("anti_windup")),
                    };
                    Ok(Pid::try_new(PidSettings {
                        k_d: self.k_d,
                        damping,
                        derivative_time: self.derivative_time,
                        setpoint_weight: self.setpoint_weight,
                        anti_windup,
                        integral_limit: (self.integral_limit != 0.0).then_some(self.integral_limit),
                        deadband: self.deadband,
                        period: (self.period != 0.0).then_some(self.period),
                        ..PidSettings::new(
                            self.k_p,
                            self.k_i,
                            self.limits.limits()?,
                            self.longest_dt,
                            self.fallback.fallback()?,
                        )
                    })?)
                }
            }
        }
    };
}
settings!(f32);
settings!(f64);
