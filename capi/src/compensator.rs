//! The identified model turned round, as a feed-forward.

use crate::model::{channels_f32, channels_f64, counted_f32, counted_f64, BOWDEN_TERMS};
use crate::object::{kept, read, read_all, seen, start, writable, write, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_status, told, Refused};
use crate::{bowden_model_f32, bowden_model_f64, bowden_motion_f32, bowden_motion_f64};
use core_bowden::control::{BenchRange, Compensator, CompensatorInput, CompensatorState};
use core_bowden::model::Source;

/// Most ranges of a compensator.
pub const BOWDEN_RANGES: usize = 17;
/// As the source of a range: the transmission's input.
pub const BOWDEN_SOURCE_INPUT: u32 = 0xffff_ffff;
/// Room of a bowden_compensator_f32, in words of 64 bits.
pub const BOWDEN_COMPENSATOR_F32_WORDS: usize = 184;
/// Room of a bowden_compensator_f64, in words of 64 bits.
pub const BOWDEN_COMPENSATOR_F64_WORDS: usize = 360;

/// The source of a range; a channel that no term can read is refused later.
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
            /// What the bench has seen of one source: the effects are not asked beyond it.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_range_ $f>] {
                /// The channel, from 0, or BOWDEN_SOURCE_INPUT.
                pub source: u32,
                /// Least position, velocity and acceleration.
                pub low: [<bowden_motion_ $f>],
                /// Greatest position, velocity and acceleration.
                pub high: [<bowden_motion_ $f>],
            }

            /// One sample for a compensator.
            #[repr(C)]
            #[derive(Debug, Clone, Copy)]
            pub struct [<bowden_compensator_sample_ $f>] {
                /// Since the previous sample, above zero [s].
                pub dt: $f,
                /// The output that is wanted [output unit], such as tau_o [N*m]: the reference,
                /// not the measured output.
                pub desired: $f,
                /// The transmission's input with its rates, as it is now, for effects that read
                /// it.
                pub input: [<bowden_motion_ $f>],
                /// The transmitted load: tau_i in torque mode, else a load channel.
                pub load: $f,
                /// All other channels, in the order of the model's file; may be null where
                /// there are none.
                pub channels: *const [<bowden_motion_ $f>],
                /// How many there are, at most BOWDEN_CHANNELS.
                pub channel_count: usize,
            }

            /// What a step of a compensator gives.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_compensator_output_ $f>] {
                /// The transmission's input [input unit], such as tau_i [N*m]; finite.
                pub command: $f,
                /// Share of the effects in the output [output unit], zero on a bad sample.
                pub effects: $f,
                /// The model's hysteresis state, within -1 and 1.
                pub eta: $f,
                /// What the step did: the same as it returns.
                pub result: bowden_result,
                /// What was wrong.
                pub fault: bowden_fault,
                /// Which term, from 0, where the fault is BOWDEN_FAULT_REGRESSOR.
                pub regressor: u32,
            }

            /// A model turned round, with its state; the caller's memory, made by
            /// bowden_compensator_init.
            #[repr(C)]
            pub struct [<bowden_compensator_ $f>] {
                /// Not for use.
                pub opaque: [u64; [<BOWDEN_COMPENSATOR_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_compensator_ $f>] {
                type Inner = (Compensator<$f, BOWDEN_TERMS>, CompensatorState<$f, BOWDEN_TERMS>);
                const MAGIC: u64 = $magic;
            }

            /// Turns a loaded model round, (5)-(7), and starts at zero:
            ///
            ///     tau_i = inverse transmission(desired - sum of gain*regressor, eta)
            ///
            /// `longest_dt` [s]: a longer dt is a bad sample. `ranges`: motions are clamped to
            /// them, each read by a term of the model; null where `range_count` is 0.
            /// BOWDEN_RESULT_ERROR_INADMISSIBLE where the model has no inverse. The model is not
            /// needed afterwards. On an error the object is as it was. `about` may be null.
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

            /// Lets what the cable has to transmit pass through a play of this half-width, zero or
            /// more [output unit]; zero, as init has it, is none.
            ///
            /// A term that reads a velocity from an encoder's counts makes a reversal of each count,
            /// after which the inverse is steep, and the command chatters. A little more than half of
            /// what one count makes of torque takes that out: |gain|*count/(2*time constant). On an
            /// error the object is as it was.
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

            /// One sample: the input that makes the model's output `desired`.
            ///
            /// A bad sample leaves the state and holds the last good command, zero before the
            /// first one: BOWDEN_RESULT_HELD. `out` is written with every result that is not
            /// negative.
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
                        eta: output.eta,
                        result,
                        fault,
                        regressor,
                    };
                    write(out, output)?;
                    Ok(result)
                })())
            }

            /// The state of the start again, with this hysteresis state, within -1 and 1.
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
