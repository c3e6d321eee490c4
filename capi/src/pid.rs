//! PI, PID and PIV controllers.

use crate::object::{kept, read, read_settings, seen, start, writable, write, Object};
use crate::result::{bowden_about, bowden_result, code, told, Refused};
use crate::{bowden_fallback_f32, bowden_fallback_f64, bowden_limits_f32, bowden_limits_f64};
use crate::{
    bowden_output_f32, bowden_output_f64, bowden_pid_settings_f32, bowden_pid_settings_f64,
};
use crate::{bowden_saturation, limit_of_drive};
use core_bowden::control::{Applied, Output, Pid, PidInput, PidState, PidTerms};

/// Size of bowden_pid_f32 in 64-bit words.
pub const BOWDEN_PID_F32_WORDS: usize = 24;
/// Size of bowden_pid_f64 in 64-bit words.
pub const BOWDEN_PID_F64_WORDS: usize = 40;

macro_rules! pid {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// One sample for a PI, PID or PIV controller.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_pid_sample_ $f>] {
                /// Time since the previous call [s], even if the sample of that call was bad.
                pub dt: $f,
                /// Reference y_r [output unit], such as [N*m].
                pub reference: $f,
                /// Measured output y [output unit], such as [N*m].
                pub measured: $f,
                /// Measured distal velocity [rad/s]. Only a PIV controller uses this field.
                pub velocity: $f,
                /// Feed-forward [command unit], added to the command before the limits.
                pub feed_forward: $f,
            }

            impl [<bowden_pid_sample_ $f>] {
                fn input(&self) -> PidInput<$f> {
                    PidInput {
                        dt: self.dt,
                        reference: self.reference,
                        measured: self.measured,
                        velocity: self.velocity,
                        feed_forward: self.feed_forward,
                    }
                }
            }

            /// Terms of the command at the last good sample. The terms from `proportional` to
            /// `feed_forward` add up to `unlimited`.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_pid_terms_ $f>] {
                /// e = y - y_r [output unit].
                pub error: $f,
                /// -k_p*(y - b*y_r) [command unit].
                pub proportional: $f,
                /// -k_i*integral(e) after anti-windup [command unit].
                pub integral: $f,
                /// -k_d*d/dt(y - c*y_r), filtered [command unit]; 0 for a PIV controller.
                pub derivative: $f,
                /// -k_d*v_d [command unit]; 0 for a PI or PID controller.
                pub velocity: $f,
                /// Feed-forward [command unit].
                pub feed_forward: $f,
                /// Command before limiting [command unit].
                pub unlimited: $f,
                /// 1 if the applied command differs from `unlimited`, otherwise 0. Possible causes
                /// are the range, the slew-rate limit, the safe command and bowden_pid_applied.
                pub saturated: u32,
            }

            impl [<bowden_pid_terms_ $f>] {
                fn of(terms: PidTerms<$f>) -> Self {
                    Self {
                        error: terms.error,
                        proportional: terms.proportional,
                        integral: terms.integral,
                        derivative: terms.derivative,
                        velocity: terms.velocity,
                        feed_forward: terms.feed_forward,
                        unlimited: terms.unlimited,
                        saturated: u32::from(terms.saturated),
                    }
                }
            }

            /// PI, PID or PIV controller with its state.
            #[repr(C)]
            pub struct [<bowden_pid_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_PID_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_pid_ $f>] {
                type Inner = (Pid<$f>, PidState<$f>);
                const MAGIC: u64 = $magic;
            }

            /// Writes the settings of a PI controller, equation (15). All fields without an
            /// argument receive their defaults.
            ///
            /// `low` and `high` [command unit] are the command limits, and `longest_dt` [s] is the
            /// longest dt of a good sample. `safe` [command unit] is applied from the `after`-th
            /// consecutive bad sample onward. bowden_pid_init checks the values.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_settings_pi_ $f>](
                settings: *mut [<bowden_pid_settings_ $f>],
                k_p: $f,
                k_i: $f,
                low: $f,
                high: $f,
                longest_dt: $f,
                after: u32,
                safe: $f,
            ) -> bowden_result {
                let value = [<bowden_pid_settings_ $f>] {
                    k_p,
                    k_i,
                    limits: [<bowden_limits_ $f>] { low, high, slew: 0.0 },
                    longest_dt,
                    fallback: [<bowden_fallback_ $f>] { after, weight: 4, command: safe },
                    ..[<bowden_pid_settings_ $f>]::defaults()
                };
                // SAFETY: the caller's rule of pointers.
                code(unsafe { write(settings, value) }.map(|()| bowden_result::Ok).map_err(Refused::from))
            }

            /// Checks the settings and initialises the controller.
            ///
            /// If `about` is not null, it receives the name of a rejected setting.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_init_ $f>](
                pid: *mut [<bowden_pid_ $f>],
                settings: *const [<bowden_pid_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let tried = read_settings(settings)
                        .and_then(|settings| settings.pid())
                        .and_then(|law| Ok(start(pid, (law, PidState::new()))?));
                    told(tried, about)
                }
            }

            /// Processes one sample. `out` receives the command and its status.
            ///
            /// A bad sample leaves the state unchanged and holds the last good command
            /// (BOWDEN_RESULT_HELD). After too many bad samples the safe command is applied until
            /// bowden_pid_acknowledge, even if later samples are good (BOWDEN_RESULT_SAFE).
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_step_ $f>](
                pid: *mut [<bowden_pid_ $f>],
                sample: *const [<bowden_pid_sample_ $f>],
                out: *mut [<bowden_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let input = read(sample)?.input();
                    writable(out)?;
                    let (law, state) = kept(pid)?;
                    let output = [<bowden_output_ $f>]::of(law.step(state, &input));
                    write(out, output)?;
                    Ok(output.result)
                })())
            }

            /// Writes the terms of the last good sample to `out`, for telemetry. All terms are zero
            /// before the first good sample.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_get_terms_ $f>](
                pid: *const [<bowden_pid_ $f>],
                out: *mut [<bowden_pid_terms_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (law, state) = seen(pid)?;
                    write(out, [<bowden_pid_terms_ $f>]::of(law.terms(state)))?;
                    Ok(bowden_result::Ok)
                })())
            }

            /// Reports the command [command unit] that the drive applied after the last step, if it
            /// differs from the command of the step. A drive that is off applies 0.
            ///
            /// Call this function between two steps. The slew-rate limit, anti-windup and a
            /// bumpless start then continue from this command. A command that is not finite changes
            /// nothing (BOWDEN_RESULT_HELD).
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_applied_ $f>](
                pid: *mut [<bowden_pid_ $f>],
                command: $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (law, state) = kept(pid)?;
                    law.applied(state, Applied::Command(command));
                    Ok(if command.is_finite() { bowden_result::Ok } else { bowden_result::Held })
                })())
            }

            /// Reports the limit that the drive reached after the last step, one of
            /// bowden_saturation. Use this function for a drive that does not report its command,
            /// such as the inner loop of a cascade. Otherwise use bowden_pid_applied.
            ///
            /// Call this function between two steps. The last change of the integral towards the
            /// limit is then reversed, except with BOWDEN_ANTI_WINDUP_NONE. If `saturation` is not
            /// in bowden_saturation, the result is BOWDEN_RESULT_ERROR_CHOICE.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_at_limit_ $f>](
                pid: *mut [<bowden_pid_ $f>],
                saturation: u32,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let applied = limit_of_drive(saturation)?;
                    let (law, state) = kept(pid)?;
                    law.applied(state, applied);
                    Ok(bowden_result::Ok)
                })())
            }

            /// Sets `saturation` to the limit that was active at the last good sample, one of
            /// bowden_saturation.
            ///
            /// In a cascade, pass this value to bowden_pid_at_limit of the outer loop if the gains
            /// of the inner loop are positive.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_get_saturation_ $f>](
                pid: *const [<bowden_pid_ $f>],
                saturation: *mut u32,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (law, state) = seen(pid)?;
                    let side = match law.saturation(state) {
                        Applied::AtUpperLimit => bowden_saturation::Upper,
                        Applied::AtLowerLimit => bowden_saturation::Lower,
                        Applied::AsCommanded | Applied::Command(_) => bowden_saturation::None,
                    };
                    write(saturation, side as u32)?;
                    Ok(bowden_result::Ok)
                })())
            }

            /// Acknowledges the fault. At the next good sample, the controller closes the loop
            /// again, starting from the safe command. The call has no effect unless the safe
            /// command is latched.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_acknowledge_ $f>](
                pid: *mut [<bowden_pid_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    kept(pid)?.1.acknowledge();
                    Ok(bowden_result::Ok)
                })())
            }

            /// Clears the integral, the filtered derivative and the stored samples. The applied
            /// command is kept, and a latched safe command stays latched.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_reset_ $f>](
                pid: *mut [<bowden_pid_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    kept(pid)?.1.reset();
                    Ok(bowden_result::Ok)
                })())
            }

            /// Prepares a stored object for a restart after a power-off. Call this function before
            /// the first step. Otherwise the step continues from the stored command.
            ///
            /// The command becomes the value nearest to zero within the limits. At the first good
            /// sample, the controller starts from this command without a jump. The integral, the
            /// filtered derivative and the stored samples are cleared. A latched safe command stays
            /// latched.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_restore_ $f>](
                pid: *mut [<bowden_pid_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (law, state) = kept(pid)?;
                    state.restore(law);
                    Ok(bowden_result::Ok)
                })())
            }

            /// Restarts the controller so that the command continues from `command` [command unit]
            /// without a jump. A `command` or a sample that is not finite is treated as a bad
            /// sample. A latched safe command stays latched. `out` receives the applied command and
            /// may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_resume_ $f>](
                pid: *mut [<bowden_pid_ $f>],
                command: $f,
                sample: *const [<bowden_pid_sample_ $f>],
                out: *mut [<bowden_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let input = read(sample)?.input();
                    if !out.is_null() {
                        writable(out)?;
                    }
                    let (law, state) = kept(pid)?;
                    let status = state.resume_from(law, command, &input);
                    let command = law.settings().limits.clamp(state.command());
                    let output = [<bowden_output_ $f>]::of(Output { command, status });
                    if !out.is_null() {
                        write(out, output)?;
                    }
                    Ok(output.result)
                })())
            }

            /// Changes the settings of a running loop without a jump in the command. After an
            /// error, the loop continues with the old settings. `about` may be null.
            ///
            /// If the new range excludes the applied command, the next command is the nearest
            /// command in the range, regardless of the slew-rate limit. Therefore, narrow a range
            /// in small steps.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_change_ $f>](
                pid: *mut [<bowden_pid_ $f>],
                settings: *const [<bowden_pid_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let tried = read_settings(settings)
                        .and_then(|settings| settings.pid())
                        .and_then(|new| {
                            let (law, state) = kept(pid)?;
                            new.bumpless_transfer(state);
                            *law = new;
                            Ok(())
                        });
                    told(tried, about)
                }
            }

            /// Sets `latched` to 1 if the safe command is latched, otherwise to 0.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_is_latched_ $f>](
                pid: *const [<bowden_pid_ $f>],
                latched: *mut u32,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (_, state) = seen(pid)?;
                    write(latched, u32::from(state.is_latched()))?;
                    Ok(bowden_result::Ok)
                })())
            }
        }
    };
}
pid!(f32, 0x7069_645f_6633_3201);
pid!(f64, 0x7069_645f_6636_3401);
