//! The adaptive law, equations (17)-(26).

use crate::adaptive_settings::{bowden_adaptive_settings_f32, bowden_adaptive_settings_f64};
use crate::object::{kept, read, read_settings, seen, start, writable, write, Object};
use crate::result::{bowden_about, bowden_result, code, told, Refused};
use crate::{bowden_output_f32, bowden_output_f64, limit_of_drive};
use core_bowden::control::{Adaptive, AdaptiveInput, AdaptiveState, Applied, Output};

/// Maximum number of regressors in an adaptive law.
pub const BOWDEN_REGRESSORS: usize = 4;
/// Size of bowden_adaptive_f32 in 64-bit words.
pub const BOWDEN_ADAPTIVE_F32_WORDS: usize = 56;
/// Size of bowden_adaptive_f64 in 64-bit words.
pub const BOWDEN_ADAPTIVE_F64_WORDS: usize = 104;

/// The adaptive law and the number of regressors in its settings. All further regressors are zero.
#[derive(Clone, Copy)]
pub struct Own<T> {
    pub(crate) law: Adaptive<T, BOWDEN_REGRESSORS>,
    pub(crate) count: usize,
}

macro_rules! adaptive {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// One sample for the adaptive law.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_adaptive_sample_ $f>] {
                /// Time since the previous call [s], even if the sample of that call was bad.
                pub dt: $f,
                /// Reference y_r [N*m].
                pub reference: $f,
                /// Reference at the next sample [N*m]. Only the first-order form uses its value,
                /// but it must be finite in both forms.
                pub next_reference: $f,
                /// Measured output torque y [N*m].
                pub measured: $f,
                /// Regressors x_i [own units], such as velocity and acceleration. Entries beyond
                /// the number of regressors in the settings are ignored.
                pub regressors: [$f; BOWDEN_REGRESSORS],
                /// Feed-forward [command unit], added to the command of the adaptive law.
                pub feed_forward: $f,
            }

            impl [<bowden_adaptive_sample_ $f>] {
                fn input(&self, count: usize) -> AdaptiveInput<$f, BOWDEN_REGRESSORS> {
                    let mut regressors = [0.0; BOWDEN_REGRESSORS];
                    let given = self.regressors.iter().take(count);
                    for (own, given) in regressors.iter_mut().zip(given) {
                        *own = *given;
                    }
                    AdaptiveInput {
                        dt: self.dt,
                        reference: self.reference,
                        next_reference: self.next_reference,
                        measured: self.measured,
                        regressors,
                        feed_forward: self.feed_forward,
                    }
                }
            }

            /// Estimates of the adaptive law.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_estimates_ $f>] {
                /// Accumulated error z of (17) [N*m*s].
                pub z: $f,
                /// beta_hat [command unit/(N*m)].
                pub beta: $f,
                /// delta_hat [N*m].
                pub delta: $f,
                /// theta_hat_i [N*m/unit of the regressor].
                pub theta: [$f; BOWDEN_REGRESSORS],
            }

            /// Adaptive law with its state.
            #[repr(C)]
            pub struct [<bowden_adaptive_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_ADAPTIVE_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_adaptive_ $f>] {
                type Inner = (Own<$f>, AdaptiveState<$f, BOWDEN_REGRESSORS>);
                const MAGIC: u64 = $magic;
            }

            /// Checks the settings and initialises the law with the initial estimates.
            ///
            /// If `about` is not null, it receives the name of a rejected setting.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_init_ $f>](
                law: *mut [<bowden_adaptive_ $f>],
                settings: *const [<bowden_adaptive_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let tried = read_settings(settings)
                        .and_then(|settings| settings.law())
                        .and_then(|own| {
                            let state = AdaptiveState::new(&own.law);
                            Ok(start(law, (own, state))?)
                        });
                    told(tried, about)
                }
            }

            /// Processes one sample. `out` receives the command and its status. Bad samples have
            /// the same effect as in bowden_pid_step.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_step_ $f>](
                law: *mut [<bowden_adaptive_ $f>],
                sample: *const [<bowden_adaptive_sample_ $f>],
                out: *mut [<bowden_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let sample = read(sample)?;
                    writable(out)?;
                    let (own, state) = kept(law)?;
                    let output = own.law.step(state, &sample.input(own.count));
                    let output = [<bowden_output_ $f>]::of(output);
                    write(out, output)?;
                    Ok(output.result)
                })())
            }

            /// Writes the present estimates to `out`.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_get_estimates_ $f>](
                law: *const [<bowden_adaptive_ $f>],
                out: *mut [<bowden_estimates_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (_, state) = seen(law)?;
                    let estimates = [<bowden_estimates_ $f>] {
                        z: state.accumulated_error(),
                        beta: state.beta_hat(),
                        delta: state.delta_hat(),
                        theta: state.theta_hat(),
                    };
                    write(out, estimates)?;
                    Ok(bowden_result::Ok)
                })())
            }

            /// Reports the command [command unit] that the drive applied after the last step; see
            /// bowden_pid_applied. At the next good sample, z moves no further towards the limit of
            /// the drive. The estimates do not change while s requires a command beyond this limit.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_applied_ $f>](
                law: *mut [<bowden_adaptive_ $f>],
                command: $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    kept(law)?.1.applied(Applied::Command(command));
                    Ok(if command.is_finite() { bowden_result::Ok } else { bowden_result::Held })
                })())
            }

            /// Reports the limit that the drive reached after the last step; see
            /// bowden_pid_at_limit.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_at_limit_ $f>](
                law: *mut [<bowden_adaptive_ $f>],
                saturation: u32,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let applied = limit_of_drive(saturation)?;
                    kept(law)?.1.applied(applied);
                    Ok(bowden_result::Ok)
                })())
            }

            /// Acknowledges the fault; see bowden_pid_acknowledge.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_acknowledge_ $f>](
                law: *mut [<bowden_adaptive_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    kept(law)?.1.acknowledge();
                    Ok(bowden_result::Ok)
                })())
            }

            /// Resets the accumulated error and the estimates. The applied command is kept, and a
            /// latched safe command stays latched.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_reset_ $f>](
                law: *mut [<bowden_adaptive_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (own, state) = kept(law)?;
                    state.reset(&own.law);
                    Ok(bowden_result::Ok)
                })())
            }

            /// Prepares a stored object for a restart; see bowden_pid_restore. The estimates are
            /// kept.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_restore_ $f>](
                law: *mut [<bowden_adaptive_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (own, state) = kept(law)?;
                    state.restore(&own.law);
                    Ok(bowden_result::Ok)
                })())
            }

            /// Changes the settings of a running loop. The command for `sample` does not jump; see
            /// bowden_pid_change. The estimates are kept and clamped to their new bounds. A latched
            /// safe command stays latched.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_change_ $f>](
                law: *mut [<bowden_adaptive_ $f>],
                settings: *const [<bowden_adaptive_settings_ $f>],
                sample: *const [<bowden_adaptive_sample_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                let tried = || -> Result<(), Refused> { unsafe {
                    let new = read_settings(settings)?.law()?;
                    let sample = read(sample)?;
                    let (own, state) = kept(law)?;
                    new.law.bumpless_transfer(state, &sample.input(new.count));
                    *own = new;
                    Ok(())
                } };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(tried(), about) }
            }

            /// Restarts the law with the initial estimates, so that the next step with this sample
            /// gives `command` [command unit]. See bowden_pid_resume. In the first-order form, the
            /// dt of this sample must be the sampling period.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_resume_ $f>](
                law: *mut [<bowden_adaptive_ $f>],
                command: $f,
                sample: *const [<bowden_adaptive_sample_ $f>],
                out: *mut [<bowden_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let sample = read(sample)?;
                    if !out.is_null() {
                        writable(out)?;
                    }
                    let (own, state) = kept(law)?;
                    let status = own.law.resume(state, command, &sample.input(own.count));
                    let command = own.law.settings().limits.clamp(state.command());
                    let output = [<bowden_output_ $f>]::of(Output { command, status });
                    if !out.is_null() {
                        write(out, output)?;
                    }
                    Ok(output.result)
                })())
            }

            /// Sets `latched` to 1 if the safe command is latched, otherwise to 0.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_is_latched_ $f>](
                law: *const [<bowden_adaptive_ $f>],
                latched: *mut u32,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (_, state) = seen(law)?;
                    write(latched, u32::from(state.is_latched()))?;
                    Ok(bowden_result::Ok)
                })())
            }
        }
    };
}
adaptive!(f32, 0x6164_6170_6633_3230);
adaptive!(f64, 0x6164_6170_6636_3430);
