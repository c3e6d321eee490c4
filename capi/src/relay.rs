//! The relay experiment: ultimate gain and period of a loop, and the gains of a PI.

use crate::object::{kept, read, read_settings, seen, start, writable, write, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_status, told, Refused};
use crate::settings::{marked, Marked};
use crate::{bowden_fallback_f32, bowden_fallback_f64, bowden_limits_f32, bowden_limits_f64};
use core_bowden::control::{
    Fault, Output, PiRule, Relay, RelaySettings, RelayState, Status, Ultimate,
};

/// Size of a bowden_relay_f32 in 64-bit words.
pub const BOWDEN_RELAY_F32_WORDS: usize = 26;
/// Size of a bowden_relay_f64 in 64-bit words.
pub const BOWDEN_RELAY_F64_WORDS: usize = 44;

/// Phase of a relay experiment.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_relay_phase {
    /// The relay switches; after a bad sample the command is held.
    Running = 0,
    /// The experiment has succeeded: the relay applies the centre.
    Done = 1,
    /// The experiment has failed: the safe command is applied until bowden_relay_acknowledge.
    Failed = 2,
}

/// Why a relay experiment failed.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_relay_failure {
    /// The experiment has not failed.
    None = 0,
    /// Too many bad samples; the fault is that of the last one.
    BadSamples = 1,
    /// The output was further from the reference than `most_deviation`: choose a smaller
    /// amplitude, a centre that holds the reference, or the other sign of the amplitude.
    OutputOutOfRange = 2,
    /// `longest_time` has passed without a complete cycle: the amplitude does not move the output
    /// through the reference, its sign is wrong, or the time is too short for two periods.
    NoOscillation = 3,
    /// `longest_time` has passed and the cycles did not agree: the time is too short, the noise
    /// exceeds the hysteresis, or a cycle has fewer than 2/agreement samples.
    TimeOut = 4,
    /// A reason from a later version.
    Other = 5,
}

/// Tuning rule: PI gains from ultimate gain and period.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_pi_rule {
    /// k_p = gain/3.2, k_i = k_p/(2.2*period): the conservative rule.
    TyreusLuyben = 0,
    /// k_p = 0.45*gain, k_i = k_p/(period/1.2): fast, with an overshoot.
    ZieglerNichols = 1,
}

/// Why an experiment with this status failed.
fn failure(status: Status) -> bowden_relay_failure {
    match status {
        Status::Safe(Fault::OutputOutOfRange) => bowden_relay_failure::OutputOutOfRange,
        Status::Safe(Fault::NoOscillation) => bowden_relay_failure::NoOscillation,
        Status::Safe(Fault::TimeOut) => bowden_relay_failure::TimeOut,
        Status::Safe(_) => bowden_relay_failure::BadSamples,
        _ => bowden_relay_failure::None,
    }
}

macro_rules! relay {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// Settings of a relay experiment, which makes the loop oscillate about the reference:
            ///
            ///     command = centre + amplitude   from y < reference - hysteresis on
            ///     command = centre - amplitude   from y > reference + hysteresis on
            ///
            /// Start from NAME_INIT. By default 4 good samples cancel a bad one, and the safe
            /// command is 0; all other fields must be set.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_relay_settings_ $f>] {
                /// The mark that the macro NAME_INIT sets; settings without it are refused.
                pub init_mark: u32,
                /// Reference y_r, about which the output oscillates [output unit].
                pub reference: $f,
                /// Mean of the two levels of the command [command unit]. The command that holds the
                /// output at the reference gives equal half-periods.
                pub centre: $f,
                /// Distance from the centre to each level, not zero, with the sign of the plant's
                /// gain [command unit].
                pub amplitude: $f,
                /// Hysteresis of the relay, zero or above [output unit]: at least the peak of the
                /// noise.
                pub hysteresis: $f,
                /// Largest distance of the output from the reference, above `hysteresis`
                /// [output unit]. One sample beyond it ends the experiment.
                pub most_deviation: $f,
                /// Number of successive cycles in the average, at least 2.
                pub cycles: u32,
                /// Largest deviation of a cycle from the mean of earlier cycles, as a share of this
                /// mean, between 0 and 1.
                pub agreement: $f,
                /// Maximum duration of the experiment, at least `longest_dt` [s].
                pub longest_time: $f,
                /// Longest dt of a good sample, above zero [s].
                pub longest_dt: $f,
                /// Range of the command, without a slew-rate limit.
                pub limits: [<bowden_limits_ $f>],
                /// Fallback after a failure; BOWDEN_HOLD_FOR_EVER is refused.
                pub fallback: [<bowden_fallback_ $f>],
            }

            marked!([<bowden_relay_settings_ $f>]);

            impl [<bowden_relay_settings_ $f>] {
                /// The defaults; a field without a default has an invalid value.
                pub const fn defaults() -> Self {
                    Self {
                        init_mark: Self::MARK,
                        reference: $f::MAX,
                        centre: $f::MAX,
                        amplitude: 0.0,
                        hysteresis: -1.0,
                        most_deviation: 0.0,
                        cycles: 0,
                        agreement: 0.0,
                        longest_time: 0.0,
                        longest_dt: 0.0,
                        limits: [<bowden_limits_ $f>]::UNSET,
                        fallback: [<bowden_fallback_ $f>] { after: 0, weight: 4, command: 0.0 },
                    }
                }

                fn relay(&self) -> Result<Relay<$f>, Refused> {
                    for (value, name) in [(self.reference, "reference"), (self.centre, "centre")] {
                        if value == $f::MAX {
                            return Err(Refused::unset(name));
                        }
                    }
                    Ok(Relay::try_new(RelaySettings {
                        reference: self.reference,
                        centre: self.centre,
                        amplitude: self.amplitude,
                        hysteresis: self.hysteresis,
                        most_deviation: self.most_deviation,
                        cycles: self.cycles,
                        agreement: self.agreement,
                        longest_time: self.longest_time,
                        longest_dt: self.longest_dt,
                        limits: self.limits.limits()?,
                        fallback: self.fallback.fallback()?,
                    })?)
                }
            }

            /// Result of a relay experiment.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq, Default)]
            pub struct [<bowden_ultimate_ $f>] {
                /// Ultimate gain, with the sign of the relay's amplitude [command unit/output
                /// unit].
                pub gain: $f,
                /// Ultimate period [s].
                pub period: $f,
                /// Half the distance from the lowest to the highest output [output unit].
                pub amplitude: $f,
                /// Share of the period in which the command is centre + amplitude.
                pub duty: $f,
            }

            /// Gains of a PI, for bowden_pid_settings.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_pi_gains_ $f>] {
                /// Proportional gain [command unit/output unit].
                pub k_p: $f,
                /// Integral gain [command unit/(output unit*s)].
                pub k_i: $f,
            }

            /// Output of a step of a relay experiment.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_relay_output_ $f>] {
                /// Command for the drive [command unit]: finite and within the limits.
                pub command: $f,
                /// Status of the step, equal to its return value.
                pub result: bowden_result,
                /// The bad input of a sample.
                pub fault: bowden_fault,
                /// Phase of the experiment.
                pub phase: bowden_relay_phase,
                /// Why the experiment failed.
                pub failure: bowden_relay_failure,
                /// Number of complete cycles.
                pub cycles: u32,
                /// The result; zero until the experiment is done.
                pub ultimate: [<bowden_ultimate_ $f>],
            }

            impl [<bowden_relay_output_ $f>] {
                fn of(output: &Output<$f>, state: &RelayState<$f>) -> Self {
                    let (result, fault, _) = of_status(output.status);
                    let failure = failure(output.status);
                    let (fault, phase) = match failure {
                        bowden_relay_failure::BadSamples => (fault, bowden_relay_phase::Failed),
                        bowden_relay_failure::None if state.result().is_some() => {
                            (fault, bowden_relay_phase::Done)
                        }
                        bowden_relay_failure::None => (fault, bowden_relay_phase::Running),
                        _ => (bowden_fault::None, bowden_relay_phase::Failed),
                    };
                    let ultimate = state.result().map_or_else(Default::default, |own| {
                        [<bowden_ultimate_ $f>] {
                            gain: own.gain,
                            period: own.period,
                            amplitude: own.amplitude,
                            duty: own.duty,
                        }
                    });
                    let (command, cycles) = (output.command, state.cycles());
                    Self { command, result, fault, phase, failure, cycles, ultimate }
                }
            }

            /// A relay experiment with its state, in the caller's memory; initialised by
            /// bowden_relay_init.
            #[repr(C)]
            pub struct [<bowden_relay_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_RELAY_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_relay_ $f>] {
                type Inner = (Relay<$f>, RelayState<$f>);
                const MAGIC: u64 = $magic;
            }

            /// Checks the settings and starts an experiment. `about` may be null.
            ///
            /// Start with the output near the reference: at the mean command of the previous loop,
            /// or at rest.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_relay_init_ $f>](
                relay: *mut [<bowden_relay_ $f>],
                settings: *const [<bowden_relay_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let tried = read_settings(settings)
                        .and_then(|settings| settings.relay())
                        .and_then(|own| Ok(start(relay, (own, RelayState::new()))?));
                    told(tried, about)
                }
            }

            /// Processes one sample, with `dt` since the last call [s], also after a bad sample,
            /// and the measured output [output unit]. Call this function while the phase is
            /// BOWDEN_RELAY_PHASE_RUNNING.
            ///
            /// A bad sample holds the command: BOWDEN_RESULT_HELD. After a failure the safe command
            /// is applied until bowden_relay_acknowledge: BOWDEN_RESULT_SAFE. Every sample consumes
            /// part of `longest_time`, so the experiment ends. `out` is written if the result is
            /// not negative.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_relay_step_ $f>](
                relay: *mut [<bowden_relay_ $f>],
                dt: $f,
                measured: $f,
                out: *mut [<bowden_relay_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(out)?;
                    let (own, state) = kept(relay)?;
                    let output = own.step(state, dt, measured);
                    let output = [<bowden_relay_output_ $f>]::of(&output, state);
                    write(out, output)?;
                    Ok(output.result)
                })())
            }

            /// Acknowledges the failure: the next good sample restarts the experiment with its full
            /// duration. Without a failure the call has no effect.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_relay_acknowledge_ $f>](
                relay: *mut [<bowden_relay_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    kept(relay)?.1.acknowledge();
                    Ok(bowden_result::Ok)
                })())
            }

            /// Sets `latched` to 1 while the safe command is latched, otherwise to 0.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_relay_is_latched_ $f>](
                relay: *const [<bowden_relay_ $f>],
                latched: *mut u32,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (_, state) = seen(relay)?;
                    write(latched, u32::from(state.is_latched()))?;
                    Ok(bowden_result::Ok)
                })())
            }

            /// The gains of a PI by `rule`, one of bowden_pi_rule, from the result of an experiment.
            ///
            /// Continue with bowden_pid_resume from the applied command. An unknown rule returns
            /// BOWDEN_RESULT_ERROR_CHOICE. A result that is zero or not finite, as before the end
            /// of the experiment, returns BOWDEN_RESULT_ERROR_OUT_OF_RANGE.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_relay_gains_ $f>](
                ultimate: *const [<bowden_ultimate_ $f>],
                rule: u32,
                gains: *mut [<bowden_pi_gains_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let given = read(ultimate)?;
                    writable(gains)?;
                    let rule = match rule {
                        r if r == bowden_pi_rule::TyreusLuyben as u32 => PiRule::TyreusLuyben,
                        r if r == bowden_pi_rule::ZieglerNichols as u32 => PiRule::ZieglerNichols,
                        _ => return Err(Refused::choice("rule")),
                    };
                    let own = Ultimate {
                        gain: given.gain,
                        period: given.period,
                        amplitude: given.amplitude,
                        duty: given.duty,
                    };
                    let own = own.pi(rule);
                    let usable =
                        given.gain != 0.0 && given.period > 0.0 && given.period.is_finite();
                    if !(usable && own.k_p.is_finite() && own.k_i.is_finite()) {
                        return Err(bowden_result::ErrorOutOfRange.into());
                    }
                    write(gains, [<bowden_pi_gains_ $f>] { k_p: own.k_p, k_i: own.k_i })?;
                    Ok(bowden_result::Ok)
                })())
            }
        }
    };
}
relay!(f32, 0x7265_6c61_6633_3220);
relay!(f64, 0x7265_6c61_6636_3420);
