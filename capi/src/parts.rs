//! Types that several parts of the interface share: limits, fallback, motion and output.

use crate::result::{bowden_fault, bowden_result, of_status, Refused};
use core_bowden::control::{Applied, Fallback, Limits, Output};
use core_bowden::effect::Motion;

/// Value of `after` in a fallback that holds the last good command indefinitely. Use this value in
/// a simulation, not on a machine.
pub const BOWDEN_HOLD_FOR_EVER: u32 = 0xffff_ffff;

/// Active limit of a command or of a drive.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_saturation {
    /// No active limit: the command was applied.
    None = 0,
    /// The applied command is below the command of the controller.
    Upper = 1,
    /// The applied command is above the command of the controller.
    Lower = 2,
}

/// The response of a drive at this limit, which changed the command by an unknown amount.
pub(crate) fn limit_of_drive<T>(saturation: u32) -> Result<Applied<T>, Refused> {
    match saturation {
        s if s == bowden_saturation::None as u32 => Ok(Applied::AsCommanded),
        s if s == bowden_saturation::Upper as u32 => Ok(Applied::AtUpperLimit),
        s if s == bowden_saturation::Lower as u32 => Ok(Applied::AtLowerLimit),
        _ => Err(Refused::choice("saturation")),
    }
}

macro_rules! parts {
    ($f:ident) => {
        pastey::paste! {
            /// Range and slew-rate limit of a command.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_limits_ $f>] {
                /// Lower limit of the command [command unit].
                pub low: $f,
                /// Upper limit of the command [command unit], above `low`.
                pub high: $f,
                /// Slew-rate limit [command unit/s], at least 0; 0 disables this limit.
                pub slew: $f,
            }

            impl [<bowden_limits_ $f>] {
                /// An empty range, which is rejected until both ends are set.
                pub(crate) const UNSET: Self = Self { low: $f::MAX, high: $f::MIN, slew: 0.0 };

                pub(crate) fn limits(&self) -> Result<Limits<$f>, Refused> {
                    let range = Limits::try_new(self.low, self.high)?;
                    Ok(if self.slew == 0.0 { range } else { range.with_slew(self.slew)? })
                }
            }

            /// Safe command after repeated bad samples.
            ///
            /// A bad sample adds `weight` to a fault counter, and a good sample subtracts 1. When
            /// the counter reaches after*weight, the safe command is applied until the fault is
            /// acknowledged.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_fallback_ $f>] {
                /// Number of consecutive bad samples at which the safe command is applied, at least
                /// 1, or BOWDEN_HOLD_FOR_EVER.
                pub after: u32,
                /// Number of good samples that cancel a bad one, at least 1, usually 4.
                pub weight: u32,
                /// Safe command [command unit], within the limits.
                pub command: $f,
            }

            impl [<bowden_fallback_ $f>] {
                pub(crate) fn fallback(&self) -> Result<Fallback<$f>, Refused> {
                    if self.after == BOWDEN_HOLD_FOR_EVER {
                        return Ok(Fallback::hold_indefinitely());
                    }
                    Ok(Fallback::try_new(self.after, self.command)?.with_weight(self.weight)?)
                }
            }

            /// Position, velocity and acceleration of one channel.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq, Default)]
            pub struct [<bowden_motion_ $f>] {
                /// Position [channel unit].
                pub position: $f,
                /// Velocity [channel unit/s].
                pub velocity: $f,
                /// Acceleration [channel unit/s^2].
                pub acceleration: $f,
            }

            impl [<bowden_motion_ $f>] {
                pub(crate) fn motion(self) -> Motion<$f> {
                    Motion {
                        position: self.position,
                        velocity: self.velocity,
                        acceleration: self.acceleration,
                    }
                }

                pub(crate) fn of(motion: Motion<$f>) -> Self {
                    Self {
                        position: motion.position,
                        velocity: motion.velocity,
                        acceleration: motion.acceleration,
                    }
                }
            }

            /// Output of a controller step.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_output_ $f>] {
                /// Command for the drive [command unit], finite and within the limits.
                pub command: $f,
                /// Return value of the step.
                pub result: bowden_result,
                /// Bad input, or BOWDEN_FAULT_NONE.
                pub fault: bowden_fault,
                /// Index of the bad regressor, from 0, if `fault` is BOWDEN_FAULT_REGRESSOR.
                pub regressor: u32,
            }

            impl [<bowden_output_ $f>] {
                pub(crate) fn of(output: Output<$f>) -> Self {
                    let (result, fault, regressor) = of_status(output.status);
                    Self { command: output.command, result, fault, regressor }
                }
            }
        }
    };
}
parts!(f32);
parts!(f64);
