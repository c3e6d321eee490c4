//! Settings of PI, PID and PIV.

use crate::result::Refused;
use crate::settings::{marked, Marked};
use crate::{bowden_fallback_f32, bowden_fallback_f64, bowden_limits_f32, bowden_limits_f64};
use core_bowden::control::{AntiWindup, DerivativeSource, Pid, PidSettings};

/// The signal that the gain `k_d` multiplies.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_derivative_source {
    /// The filtered derivative of y - c*y_r, PID (14).
    Rate = 0,
    /// The measured distal velocity, unfiltered, PIV (16).
    Velocity = 1,
}

/// Anti-windup: limits the integral while the command is limited.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_anti_windup {
    /// A change of the integral that would take the command beyond its range is cut to the value
    /// that fills the range; a change away from the limit acts in full.
    Conditional = 0,
    /// No anti-windup: the integral winds up.
    None = 1,
    /// The integral term stays within the range of the command, widened to include zero.
    Clamp = 2,
    /// The part that the limits cut off returns to the integral with the time constant
    /// `tracking_time`.
    BackCalculation = 3,
}

macro_rules! settings {
    ($f:ident) => {
        pastey::paste! {
            /// Settings of a PI (15), PID (14) or PIV (16):
            ///
            ///     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*d/dt(y - c*y_r) + u_ff
            ///     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*v_d             + u_ff    (PIV)
            ///     command = u within the range and the slew-rate limit;  e = y - y_r
            ///
            /// Start from NAME_INIT. By default: full set-point weight, derivative on the
            /// measurement, conditional anti-windup, no slew-rate limit, 4 good samples to cancel a
            /// bad one, and gains and a safe command of 0. Limits, longest_dt and `after` must be
            /// set.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_pid_settings_ $f>] {
                /// The mark that the macro NAME_INIT sets; settings without it are refused.
                pub init_mark: u32,
                /// Proportional gain [command unit/output unit].
                pub k_p: $f,
                /// Integral gain [command unit/(output unit*s)], with the sign of k_p.
                pub k_i: $f,
                /// Derivative gain [command unit*s/output unit], with the sign of k_p; for PIV
                /// [command unit*s/rad]. 0 for a PI.
                pub k_d: $f,
                /// One of bowden_derivative_source: the signal that k_d multiplies.
                pub damping: u32,
                /// Set-point weight c of the derivative, 0 to 1: with 0, the default, it acts on
                /// the measurement; with 1 it acts on the error, and a step of the reference causes
                /// a derivative kick.
                pub derivative_weight: $f,
                /// Time constant of the derivative filter, zero (no filter) or above [s].
                pub derivative_time: $f,
                /// Set-point weight b of the proportional term, 0 to 1; 1 by default.
                pub setpoint_weight: $f,
                /// One of bowden_anti_windup.
                pub anti_windup: u32,
                /// Tracking time, for BOWDEN_ANTI_WINDUP_BACK_CALCULATION only; above zero [s].
                pub tracking_time: $f,
                /// Largest magnitude of the integral term, above zero [command unit]; 0 for none.
                pub integral_limit: $f,
                /// The integral is frozen while |e| is at most this value, zero (no deadband) or
                /// above [output unit]. To prevent the limit cycle of static friction, make it
                /// wider than the jump.
                pub deadband: $f,
                /// Period of an output that wraps, above zero [output unit], such as 360 degrees; 0
                /// for none. Errors and changes are then measured along the shorter way round.
                pub period: $f,
                /// Range and slew-rate limit of the command.
                pub limits: [<bowden_limits_ $f>],
                /// Longest dt of a good sample, above zero [s]: for example five nominal steps.
                pub longest_dt: $f,
                /// Fallback after repeated bad samples.
                pub fallback: [<bowden_fallback_ $f>],
            }

            marked!([<bowden_pid_settings_ $f>]);

            impl [<bowden_pid_settings_ $f>] {
                /// The defaults; a field without a default has an invalid value.
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
