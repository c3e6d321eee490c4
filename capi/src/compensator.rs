//! Inverse of the identified model as a feed-forward.

use crate::limit_of_drive;
use crate::model::{channels_f32, channels_f64, counted_f32, counted_f64, BOWDEN_TERMS};
use crate::object::{kept, read, read_all, seen, start, writable, write, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_status, told, Refused};
use crate::{bowden_model_f32, bowden_model_f64, bowden_motion_f32, bowden_motion_f64};
use core_bowden::control::{Applied, BenchRange, Compensator, CompensatorInput, CompensatorState};
use core_bowden::model::Source;

/// Maximum number of ranges in a compensator.
pub const BOWDEN_RANGES: usize = 17;
/// Value of `source` in a range: the input of the transmission.
pub const BOWDEN_SOURCE_INPUT: u32 = 0xffff_ffff;
/// Size of bowden_compensator_f32 in 64-bit words.
pub const BOWDEN_COMPENSATOR_F32_WORDS: usize = 184;
/// Size of bowden_compensator_f64 in 64-bit words.
pub const BOWDEN_COMPENSATOR_F64_WORDS: usize = 360;

/// Converts the source of a range. The compensator later rejects a channel that no term reads.
fn source(number: u32) -> Result<Source, Refused> {
    if number == BOWDEN_SOURCE_INPUT {
        return Ok(Source::Input);
    }
    let channel = u8::try_from(number).map_err(|_| Refused::capacity("channels"))?;
    Ok(Source::Channel(channel))
}

macro_rules! compensator {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// Range of one source in the bench record. The effects are not extrapolated beyond
            /// this range.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_range_ $f>] {
                /// Channel index, from 0, or BOWDEN_SOURCE_INPUT.
                pub source: u32,
                /// Minima of position, velocity and acceleration.
                pub low: [<bowden_motion_ $f>],
                /// Maxima of position, velocity and acceleration.
                pub high: [<bowden_motion_ $f>],
            }

            /// One sample for a compensator.
            #[repr(C)]
            #[derive(Debug, Clone, Copy)]
            pub struct [<bowden_compensator_sample_ $f>] {
                /// Time since the previous sample [s], positive.
                pub dt: $f,
                /// Desired output [output unit], such as tau_o [N*m]. Use the reference, not the
                /// measured output.
                pub desired: $f,
                /// Current input of the transmission with its velocity and acceleration. Only
                /// effects that depend on the input use it.
                pub input: [<bowden_motion_ $f>],
                /// Transmitted load: tau_i in torque mode, otherwise a load channel.
                pub load: $f,
                /// All other channels, in the order of the model file; may be null if there are
                /// none.
                pub channels: *const [<bowden_motion_ $f>],
                /// Number of elements in `channels`, at most BOWDEN_CHANNELS.
                pub channel_count: usize,
            }

            /// Output of bowden_compensator_step.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_compensator_output_ $f>] {
                /// Input of the transmission [input unit], such as tau_i [N*m]; finite.
                pub command: $f,
                /// Contribution of the effects to the output [output unit]; zero for a bad sample.
                pub effects: $f,
                /// Hysteresis state of the model, from -1 to 1.
                pub eta: $f,
                /// Return value of the step.
                pub result: bowden_result,
                /// Bad input, or BOWDEN_FAULT_NONE.
                pub fault: bowden_fault,
                /// Index of the term, from 0, if `fault` is BOWDEN_FAULT_REGRESSOR.
                pub regressor: u32,
            }

            /// Inverse of a model with its state.
            #[repr(C)]
            pub struct [<bowden_compensator_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_COMPENSATOR_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_compensator_ $f>] {
                type Inner = (Compensator<$f, BOWDEN_TERMS>, CompensatorState<$f, BOWDEN_TERMS>);
                const MAGIC: u64 = $magic;
            }

            /// Inverts a loaded model and initialises the state to zero. Each step then computes
            ///
            ///     tau_i = inverse transmission(desired - sum of gain*regressor, eta)
            ///
            /// A dt longer than `longest_dt` [s] is a bad sample. Positions, velocities and
            /// accelerations are clamped to `ranges`. The source of each range must be
            /// BOWDEN_SOURCE_INPUT or a channel that a term of the model reads. `ranges` may be
            /// null if `range_count` is 0. `about` may be null. After the call, the compensator no
            /// longer needs the model.
            ///
            /// If the model has no inverse, the result is BOWDEN_RESULT_ERROR_INADMISSIBLE.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_compensator_init_ $f>](
                compensator: *mut [<bowden_compensator_ $f>],
                model: *const [<bowden_model_ $f>],
                longest_dt: $f,
                ranges: *const [<bowden_range_ $f>],
                range_count: usize,
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                let parts = || -> Result<(), Refused> { unsafe {
                    let (model, _) = seen(model)?;
                    let mut own = Compensator::try_new(model)?.with_longest_dt(longest_dt)?;
                    let mut given = [None; BOWDEN_RANGES];
                    read_all(ranges, range_count, &mut given, Some)?;
                    for range in given.into_iter().flatten() {
                        own = own.with_ranges(&[BenchRange {
                            source: source(range.source)?,
                            low: range.low.motion(),
                            high: range.high.motion(),
                        }])?;
                    }
                    Ok(start(compensator, (own, CompensatorState::new()))?)
                } };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(parts(), about) }
            }

            /// Applies a play to the desired torque of the cable. `half_width` [output unit] must
            /// be at least 0. The default, 0, disables the play.
            ///
            /// If a term reads a velocity that is computed from encoder counts, the desired torque
            /// of the cable reverses at each count. The inverse is steep after a reversal, so the
            /// command chatters. To remove these reversals, choose a half-width slightly above
            /// |gain|*count/(2*time constant). This value is half of one count's effect on the
            /// torque.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_compensator_set_play_ $f>](
                compensator: *mut [<bowden_compensator_ $f>],
                half_width: $f,
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                let tried = || -> Result<(), Refused> { unsafe {
                    let (own, _) = kept(compensator)?;
                    *own = own.with_play(half_width)?;
                    Ok(())
                } };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(tried(), about) }
            }

            /// Computes the input for which the output of the model is `desired`.
            ///
            /// A bad sample leaves the state unchanged and holds the last good command
            /// (BOWDEN_RESULT_HELD).
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_compensator_step_ $f>](
                compensator: *mut [<bowden_compensator_ $f>],
                sample: *const [<bowden_compensator_sample_ $f>],
                out: *mut [<bowden_compensator_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let given = read(sample)?;
                    let channels =
                        [<channels_ $f>](given.channels, given.channel_count)?;
                    writable(out)?;
                    let (own, state) = kept(compensator)?;
                    let at = CompensatorInput {
                        dt: given.dt,
                        desired: given.desired,
                        input: given.input.motion(),
                        load: given.load,
                        channels: [<counted_ $f>](&channels, given.channel_count),
                    };
                    let output = own.step(state, &at);
                    let (result, fault, regressor) = of_status(output.status);
                    let output = [<bowden_compensator_output_ $f>] {
                        command: output.command,
                        effects: output.effects,
                        eta: state.eta(),
                        result,
                        fault,
                        regressor,
                    };
                    write(out, output)?;
                    Ok(result)
                })())
            }

            /// Reports the actual input of the transmission [input unit] after the last step, if it
            /// differs from the command of the step.
            ///
            /// Call this function between two steps, for example if the drive is off or another
            /// controller adds a command. The hysteresis then follows this input. If there are
            /// several reports after a step, only the last one is used. A command that is not
            /// finite changes nothing (BOWDEN_RESULT_HELD).
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_compensator_applied_ $f>](
                compensator: *mut [<bowden_compensator_ $f>],
                command: $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (own, state) = kept(compensator)?;
                    own.applied(state, Applied::Command(command));
                    Ok(if command.is_finite() { bowden_result::Ok } else { bowden_result::Held })
                })())
            }

            /// Reports the limit that the drive reached after the last step; see
            /// bowden_pid_at_limit. The input of the model then does not rise if this limit is the
            /// upper one, and does not fall if it is the lower one.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_compensator_at_limit_ $f>](
                compensator: *mut [<bowden_compensator_ $f>],
                saturation: u32,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let applied = limit_of_drive(saturation)?;
                    let (own, state) = kept(compensator)?;
                    own.applied(state, applied);
                    Ok(bowden_result::Ok)
                })())
            }

            /// Resets the state and sets the hysteresis state to `eta`, from -1 to 1.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_compensator_reset_ $f>](
                compensator: *mut [<bowden_compensator_ $f>],
                eta: $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    kept(compensator)?.1 = CompensatorState::with_eta(eta)?;
                    Ok(bowden_result::Ok)
                })())
            }
        }
    };
}
compensator!(f32, 0x636f_6d70_6633_3250);
compensator!(f64, 0x636f_6d70_6636_3450);
