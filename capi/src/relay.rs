//! Relay experiment: measures the ultimate gain and period of a loop and computes PI gains.

use crate::object::{kept, read, read_settings, seen, start, writable, write, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_status, told, Refused};
use crate::settings::{marked, Marked};
use crate::{bowden_fallback_f32, bowden_fallback_f64, bowden_limits_f32, bowden_limits_f64};
use core_bowden::control::{
    Fault, Output, PiRule, Relay, RelaySettings, RelayState, Status, Ultimate,
};

/// Size of bowden_relay_f32 in 64-bit words.
pub const BOWDEN_RELAY_F32_WORDS: usize = 26;
/// Size of bowden_relay_f64 in 64-bit words.
pub const BOWDEN_RELAY_F64_WORDS: usize = 44;

/// Phase of a relay experiment.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_relay_phase {
    /// The relay switches. A bad sample holds the command.
    Running = 0,
    /// The experiment has succeeded. The command is the centre.
    Done = 1,
    /// The experiment has failed. The safe command is applied until bowden_relay_acknowledge.
    Failed = 2,
}

/// Reason why a relay experiment failed.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_relay_failure {
    /// The experiment has not failed.
    None = 0,
    /// There were too many bad samples. `fault` describes the last one.
    BadSamples = 1,
    /// The distance of the output from the reference exceeded `most_deviation`. Choose a smaller
    /// amplitude, a centre that holds the reference, or the other sign of the amplitude.
    OutputOutOfRange = 2,
    /// There was no complete cycle within `longest_time`. Possible causes: the amplitude is too
    /// small to move the output through the reference, its sign is wrong, or the time is too short
    /// for two periods.
    NoOscillation = 3,
    /// The cycles did not agree within `longest_time`. Possible causes: the time is too short, the
    /// noise exceeds the hysteresis, or a cycle has fewer than 2/agreement samples.
    TimeOut = 4,
    /// Reserved for reasons that a later version adds.
    Other = 5,
}

/// Tuning rule that computes PI gains from the ultimate gain and the ultimate period.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_pi_rule {
    /// Conservative: k_p = gain/3.2, k_i = k_p/(2.2*period).
    TyreusLuyben = 0,
    /// Fast, with overshoot: k_p = 0.45*gain, k_i = k_p/(period/1.2).
    ZieglerNichols = 1,
}

/// The reason why an experiment with this status failed.
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
            /// Settings of a relay experiment, in which the output oscillates about the reference.
            /// The relay switches the command:
            ///
            ///     to centre + amplitude   when y < reference - hysteresis
            ///     to centre - amplitude   when y > reference + hysteresis
            ///
            /// By default the fallback weight is 4 and the safe command is 0. You must set all
            /// other fields.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_relay_settings_ $f>] {
                /// Initialisation mark, set by NAME_INIT.
                pub init_mark: u32,
                /// Reference y_r about which the output oscillates [output unit].
                pub reference: $f,
                /// Mean of the two command levels [command unit]. The half-periods are equal if
                /// this command holds the output at the reference.
                pub centre: $f,
                /// Distance from the centre to each level [command unit], nonzero, with the sign of
                /// the plant gain.
                pub amplitude: $f,
                /// Hysteresis of the relay [output unit], at least 0. Choose at least the peak
                /// value of the measurement noise.
                pub hysteresis: $f,
                /// Largest distance of the output from the reference [output unit], above
                /// `hysteresis`. A single sample beyond this distance ends the experiment.
                pub most_deviation: $f,
                /// Number of consecutive cycles that are averaged, at least 2.
                pub cycles: u32,
                /// Largest relative deviation of a cycle from the mean of earlier cycles, above 0
                /// and below 1.
                pub agreement: $f,
                /// Maximum duration of the experiment [s], at least `longest_dt`.
                pub longest_time: $f,
                /// Longest dt of a good sample [s], positive.
                pub longest_dt: $f,
                /// Range of the command. A slew-rate limit is an error.
                pub limits: [<bowden_limits_ $f>],
                /// Fallback after a failure. BOWDEN_HOLD_FOR_EVER is an error.
                pub fallback: [<bowden_fallback_ $f>],
            }

            marked!([<bowden_relay_settings_ $f>]);

            impl [<bowden_relay_settings_ $f>] {
                /// Returns the defaults.
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
                /// Ultimate gain [command unit/output unit], with the sign of the relay amplitude.
                pub gain: $f,
                /// Ultimate period [s].
                pub period: $f,
                /// Half the peak-to-peak value of the output [output unit].
                pub amplitude: $f,
                /// Fraction of the period in which the command is centre + amplitude.
                pub duty: $f,
            }

            /// PI gains for bowden_pid_settings.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_pi_gains_ $f>] {
                /// Proportional gain [command unit/output unit].
                pub k_p: $f,
                /// Integral gain [command unit/(output unit*s)].
                pub k_i: $f,
            }

            /// Output of bowden_relay_step.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_relay_output_ $f>] {
                /// Command for the drive [command unit], finite and within the limits.
                pub command: $f,
                /// Return value of the step.
                pub result: bowden_result,
                /// Bad input of the sample, or BOWDEN_FAULT_NONE.
                pub fault: bowden_fault,
                /// Phase of the experiment.
                pub phase: bowden_relay_phase,
                /// Reason why the experiment failed, or BOWDEN_RELAY_FAILURE_NONE.
                pub failure: bowden_relay_failure,
                /// Number of complete cycles.
                pub cycles: u32,
                /// Result of the experiment. All fields are zero until the experiment is done.
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

            /// Relay experiment with its state.
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
            /// At the start, the output must be near the reference. Start from rest, or from the
            /// mean command of the previous loop.
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

            /// Processes one sample. `dt` [s] is the time since the previous call, even if the
            /// sample of that call was bad. `measured` is in [output unit]. Call this function
            /// while the phase is BOWDEN_RELAY_PHASE_RUNNING.
            ///
            /// A bad sample holds the command (BOWDEN_RESULT_HELD). After a failure the safe
            /// command is applied until bowden_relay_acknowledge (BOWDEN_RESULT_SAFE). Every
            /// sample, including a bad one, counts towards `longest_time`, so the experiment always
            /// ends.
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

            /// Acknowledges the failure. The next good sample restarts the experiment with its full
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

            /// Sets `latched` to 1 if the safe command is latched, otherwise to 0.
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

            /// Computes PI gains from the result of an experiment. `rule` must be one of
            /// bowden_pi_rule (otherwise BOWDEN_RESULT_ERROR_CHOICE).
            ///
            /// A result that is zero or not finite is an error (BOWDEN_RESULT_ERROR_OUT_OF_RANGE).
            /// The result is zero until the experiment is done. To continue with these gains, call
            /// bowden_pid_resume with the applied command.
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
