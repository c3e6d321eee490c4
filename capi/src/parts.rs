//! What several parts of the interface share: limits, fallback, motions, the output.

use crate::result::{bowden_fault, bowden_result, of_status, Refused};
use core_bowden::control::{Fallback, Limits, Output};
use core_bowden::signal::Motion;

/// For `after` of a fallback: the last good command is held for ever; for a simulation, not for
/// a machine.
pub const BOWDEN_HOLD_FOR_EVER: u32 = 0xffff_ffff;

macro_rules! parts {
    ($f:ident) => {
        pastey::paste! {
            /// Range and slew rate of a command.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_limits_ $f>] {
                /// Least command [command unit].
                pub low: $f,
                /// Greatest command [command unit]; above `low`.
                pub high: $f,
                /// Slew rate above zero [command unit/s]; 0 for none.
                pub slew: $f,
            }

            impl [<bowden_limits_ $f>] {
                pub(crate) fn limits(&self) -> Result<Limits<$f>, Refused> {
                    let range = Limits::try_new(self.low, self.high)?;
                    Ok(if self.slew == 0.0 { range } else { range.with_slew(self.slew)? })
                }

                pub(crate) fn of(limits: &Limits<$f>) -> Self {
                    Self {
                        low: limits.low(),
                        high: limits.high(),
                        slew: limits.slew().unwrap_or(0.0),
                    }
                }
            }

            /// What to command when samples stay bad.
            ///
            /// A score counts: a bad sample adds the weight, a good one takes 1 away. At
            /// after*weight the safe command goes out and stays out until it is acknowledged.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_fallback_ $f>] {
                /// From which bad sample in a row on, at least 1; BOWDEN_HOLD_FOR_EVER for never.
                pub after: u32,
                /// How many good samples make up for a bad one, at least 1; 4 is usual.
                pub weight: u32,
                /// The safe command [command unit], within the limits.
                pub command: $f,
            }

            impl [<bowden_fallback_ $f>] {
                pub(crate) fn fallback(&self) -> Result<Fallback<$f>, Refused> {
                    if self.after == BOWDEN_HOLD_FOR_EVER {
                        return Ok(Fallback::hold_for_ever());
                    }
                    Ok(Fallback::try_new(self.after, self.command)?.with_weight(self.weight)?)
                }

                pub(crate) fn of(fallback: &Fallback<$f>) -> Self {
                    Self {
                        after: fallback.after(),
                        weight: fallback.weight(),
                        command: fallback.command().unwrap_or(0.0),
                    }
                }
            }

            /// Position, velocity and acceleration of one channel, in its own units and seconds.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq, Default)]
            pub struct [<bowden_motion_ $f>] {
                /// [channel unit]
                pub position: $f,
                /// [channel unit/s]
                pub velocity: $f,
                /// [channel unit/s^2]
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

            /// What a step of a controller gives.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_output_ $f>] {
                /// What goes to the drive [command unit]: finite and within the limits.
                pub command: $f,
                /// What the step did: the same as it returns.
                pub result: bowden_result,
                /// What was wrong.
                pub fault: bowden_fault,
                /// Which regressor or term, from 0, where the fault is BOWDEN_FAULT_REGRESSOR.
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
