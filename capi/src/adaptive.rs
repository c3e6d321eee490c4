//! The robust adaptive law, (17)-(26).

use crate::choices::{bowden_form, bowden_leakage, bowden_missing, bowden_smooth_sign};
use crate::object::{kept, read, seen, start, writable, write, Object};
use crate::result::{bowden_about, bowden_result, code, told, Refused};
use crate::{bowden_fallback_f32, bowden_fallback_f64, bowden_limits_f32, bowden_limits_f64};
use crate::{bowden_output_f32, bowden_output_f64};
use core_bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Form, Leakage, Missing,
    Output, SmoothSign,
};

/// Most regressors of an adaptive law.
pub const BOWDEN_REGRESSORS: usize = 4;
/// Room of a bowden_adaptive_f32, in words of 64 bits.
pub const BOWDEN_ADAPTIVE_F32_WORDS: usize = 56;
/// Room of a bowden_adaptive_f64, in words of 64 bits.
pub const BOWDEN_ADAPTIVE_F64_WORDS: usize = 104;

macro_rules! settings {
    ($f:ident) => {
        pastey::paste! {
            /// How one estimate adapts, (24)-(26), with a box.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_estimator_ $f>] {
                /// Where the estimate starts [unit of the estimate], within the box.
                pub initial: $f,
                /// Least value [unit of the estimate].
                pub low: $f,
                /// Greatest value [unit of the estimate].
                pub high: $f,
                /// Adaptation gain: gamma, mu or mu_i of (24)-(26), not negative.
                pub gain: $f,
                /// What the leakage pulls to [unit of the estimate]; 0 in the paper.
                pub prior: $f,
                /// One of bowden_leakage.
                pub leakage: u32,
                /// Greatest leakage, not negative [1/s].
                pub leakage_rate: $f,
                /// Of BOWDEN_LEAKAGE_SWITCHING alone, above zero [unit of the estimate].
                pub leakage_bound: $f,
            }

            impl [<bowden_estimator_ $f>] {
                fn fixed(value: $f) -> Self {
                    Self {
                        initial: value,
                        low: value,
                        high: value,
                        gain: 0.0,
                        prior: 0.0,
                        leakage: bowden_leakage::None as u32,
                        leakage_rate: 0.0,
                        leakage_bound: 0.0,
                    }
                }

                fn estimator(&self) -> Result<Estimator<$f>, Refused> {
                    let rate = self.leakage_rate;
                    let leakage = match self.leakage {
                        l if l == bowden_leakage::None as u32 => Leakage::None,
                        l if l == bowden_leakage::Constant as u32 => Leakage::Constant { rate },
                        l if l == bowden_leakage::Switching as u32 => {
                            Leakage::Switching { rate, bound: self.leakage_bound }
                        }
                        _ => return Err(Refused::choice("leakage")),
                    };
                    Ok(Estimator {
                        initial: self.initial,
                        low: self.low,
                        high: self.high,
                        gain: self.gain,
                        leakage,
                        prior: self.prior,
                    })
                }
            }

            /// Settings of the adaptive law, (17)-(26).
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_adaptive_settings_ $f>] {
                /// One of bowden_form.
                pub form: u32,
                /// Of the literal form: filter of the error's rate, 2 to 20 ms [s].
                pub time_constant: $f,
                /// Of the lag form: longest sample time that is intended [s].
                pub step: $f,
                /// Of the lag form: upper bound of the plant's gain alpha [N*m/command unit].
                pub plant_gain: $f,
                /// Control gain k, above zero.
                pub gain: $f,
                /// lambda, above zero [1/s]: weight of the accumulated error, (18).
                pub lambda: $f,
                /// epsilon, above zero [N*m]: width of the smooth sign.
                pub epsilon: $f,
                /// One of bowden_smooth_sign.
                pub smooth_sign: u32,
                /// Estimate of 1/alpha [command unit/(N*m)], (24).
                pub beta: [<bowden_estimator_ $f>],
                /// Estimate of the bound of the disturbance [N*m], (25).
                pub delta: [<bowden_estimator_ $f>],
                /// How many regressors there are, at most BOWDEN_REGRESSORS.
                pub regressors: u32,
                /// Estimates of theta_i [N*m/unit of the regressor], (26); those from
                /// `regressors` on are not read.
                pub theta: [[<bowden_estimator_ $f>]; BOWDEN_REGRESSORS],
                /// One of bowden_missing for each regressor.
                pub missing: [u32; BOWDEN_REGRESSORS],
                /// Most that the accumulated error z may be, above zero [N*m*s].
                pub z_limit: $f,
                /// 0, or anything else where the estimates stay as they are.
                pub frozen: u32,
                /// Range and slew rate of the command.
                pub limits: [<bowden_limits_ $f>],
                /// Longest dt that is a sample, above zero [s]; the lag form accepts none longer
                /// than 1/(lambda*max(1, g*(k + delta.high/epsilon))) either.
                pub longest_dt: $f,
                /// What goes out when samples stay bad.
                pub fallback: [<bowden_fallback_ $f>],
            }

            impl [<bowden_adaptive_settings_ $f>] {
                fn form(&self) -> Result<Form<$f>, Refused> {
                    let (step, plant_gain) = (self.step, self.plant_gain);
                    match self.form {
                        f if f == bowden_form::Literal as u32 => {
                            Ok(Form::Literal { time_constant: self.time_constant })
                        }
                        f if f == bowden_form::Lag as u32 => Ok(Form::Lag { step, plant_gain }),
                        _ => Err(Refused::choice("form")),
                    }
                }

                fn law(&self) -> Result<Own<$f>, Refused> {
                    let count = self.regressors as usize;
                    if count > BOWDEN_REGRESSORS {
                        return Err(Refused::capacity("regressors"));
                    }
                    let mut settings = AdaptiveSettings::<$f, BOWDEN_REGRESSORS>::new(
                        self.form()?,
                        self.gain,
                        self.lambda,
                        self.epsilon,
                        self.limits.limits()?,
                        self.longest_dt,
                        self.fallback.fallback()?,
                    );
                    settings.smooth_sign = match self.smooth_sign {
                        s if s == bowden_smooth_sign::Tanh as u32 => SmoothSign::Tanh,
                        s if s == bowden_smooth_sign::Clamp as u32 => SmoothSign::Clamp,
                        _ => return Err(Refused::choice("smooth_sign")),
                    };
                    settings.beta = self.beta.estimator()?;
                    settings.delta = self.delta.estimator()?;
                    settings.z_limit = self.z_limit;
                    settings.frozen = self.frozen != 0;
                    let own = settings.theta.iter_mut().zip(&mut settings.missing);
                    let given = self.theta.iter().zip(&self.missing).take(count);
                    for ((theta, missing), (estimator, choice)) in own.zip(given) {
                        *theta = estimator.estimator()?;
                        *missing = match *choice {
                            m if m == bowden_missing::Hold as u32 => Missing::Hold,
                            m if m == bowden_missing::Drop as u32 => Missing::Drop,
                            _ => return Err(Refused::choice("missing")),
                        };
                    }
                    Ok(Own { law: Adaptive::try_new(settings)?, count })
                }
            }
        }
    };
}
settings!(f32);
settings!(f64);

/// The law, and how many of the regressors it reads; the others are zero.
#[derive(Clone, Copy)]
pub struct Own<T> {
    law: Adaptive<T, BOWDEN_REGRESSORS>,
    count: usize,
}

macro_rules! adaptive {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// One sample for the adaptive law.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_adaptive_sample_ $f>] {
                /// Since the last call, also where that was a bad sample [s].
                pub dt: $f,
                /// Reference y_r [N*m].
                pub reference: $f,
                /// Reference at the next sample [N*m]; only the lag form reads it.
                pub next_reference: $f,
                /// Measured output torque y [N*m].
                pub measured: $f,
                /// Regressors x_i [their own units]: velocity and acceleration in the paper.
                /// Those beyond the law's number are not read.
                pub regressors: [$f; BOWDEN_REGRESSORS],
                /// Added to the law's command [command unit]; 0 for none.
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

            /// What the law has estimated.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_estimates_ $f>] {
                /// Accumulated error z [N*m*s], (17).
                pub z: $f,
                /// beta_hat [command unit/(N*m)].
                pub beta: $f,
                /// delta_hat [N*m].
                pub delta: $f,
                /// theta_hat_i [N*m/unit of the regressor].
                pub theta: [$f; BOWDEN_REGRESSORS],
            }

            /// An adaptive law with its state; the caller's memory, made by
            /// bowden_adaptive_init.
            #[repr(C)]
            pub struct [<bowden_adaptive_ $f>] {
                /// Not for use.
                pub opaque: [u64; [<BOWDEN_ADAPTIVE_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_adaptive_ $f>] {
                type Inner = (Own<$f>, AdaptiveState<$f, BOWDEN_REGRESSORS>);
                const MAGIC: u64 = $magic;
            }

            /// Settings to start from: no regressors, beta_hat fixed at 1, delta_hat and
            /// theta_hat at 0, tanh, no limit of z, no slew rate, 4 good samples for a bad one.
            ///
            /// The form is the literal one with 5 ms, and `step` is `longest_dt`. `low` and
            /// `high` [command unit] are what the drive may get, `safe` [command unit] goes out
            /// from the `after`-th bad sample in a row on. k, lambda [1/s] and epsilon [N*m] are
            /// the paper's 24, 8 and 0.05. Numbers are checked by bowden_adaptive_init.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_settings_start_ $f>](
                settings: *mut [<bowden_adaptive_settings_ $f>],
                low: $f,
                high: $f,
                longest_dt: $f,
                after: u32,
                safe: $f,
            ) -> bowden_result {
                let zero = [<bowden_estimator_ $f>]::fixed(0.0);
                let value = [<bowden_adaptive_settings_ $f>] {
                    form: bowden_form::Literal as u32,
                    time_constant: 0.005,
                    step: longest_dt,
                    plant_gain: 1.0,
                    gain: 24.0,
                    lambda: 8.0,
                    epsilon: 0.05,
                    smooth_sign: bowden_smooth_sign::Tanh as u32,
                    beta: [<bowden_estimator_ $f>]::fixed(1.0),
                    delta: zero,
                    regressors: 0,
                    theta: [zero; BOWDEN_REGRESSORS],
                    missing: [bowden_missing::Hold as u32; BOWDEN_REGRESSORS],
                    z_limit: $f::MAX,
                    frozen: 0,
                    limits: [<bowden_limits_ $f>] { low, high, slew: 0.0 },
                    longest_dt,
                    fallback: [<bowden_fallback_ $f>] { after, weight: 4, command: safe },
                };
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    write(settings, value)?;
                    Ok(bowden_result::Ok)
                })())
            }

            /// Checks the settings and starts with the initial estimates.
            ///
            /// `about` may be null; else it gets the name of what is refused. On an error the
            /// object is as it was.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_init_ $f>](
                law: *mut [<bowden_adaptive_ $f>],
                settings: *const [<bowden_adaptive_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let tried = read(settings)
                        .map_err(Refused::from)
                        .and_then(|settings| settings.law())
                        .and_then(|own| {
                            let state = AdaptiveState::new(&own.law);
                            Ok(start(law, (own, state))?)
                        });
                    told(tried, about)
                }
            }

            /// One sample: the command, and what happened; as bowden_pid_step.
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

            /// What the law has estimated so far.
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

            /// Takes note that somebody has seen the fault, as bowden_pid_acknowledge.
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

            /// Forgets the accumulated error and what was estimated; the command that is out
            /// stays known, and a safe command that is latched stays so.
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

            /// Makes an object that was stored fit for a start, as bowden_pid_power_up; what was
            /// estimated stays.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_power_up_ $f>](
                law: *mut [<bowden_adaptive_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (own, state) = kept(law)?;
                    state.power_up(&own.law);
                    Ok(bowden_result::Ok)
                })())
            }

            /// Other settings for a loop that runs, without a jump of the command on this sample, as
            /// bowden_pid_change. What was estimated stays, each in its new box, and so does a safe
            /// command that is latched.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_adaptive_change_ $f>](
                law: *mut [<bowden_adaptive_ $f>],
                settings: *const [<bowden_adaptive_settings_ $f>],
                sample: *const [<bowden_adaptive_sample_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                let tried = || -> Result<(), Refused> { unsafe {
                    let new = read(settings)?.law()?;
                    let sample = read(sample)?;
                    let (own, state) = kept(law)?;
                    new.law.take_over(state, &sample.input(new.count));
                    *own = new;
                    Ok(())
                } };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(tried(), about) }
            }

            /// Starts with the initial estimates, so that the next step on this sample commands
            /// `command` [command unit], as bowden_pid_resume.
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
                    let command = own.law.settings().limits.confine(state.command());
                    let output = [<bowden_output_ $f>]::of(Output { command, status });
                    if !out.is_null() {
                        write(out, output)?;
                    }
                    Ok(output.result)
                })())
            }

            /// 1 into `latched` while the safe command is out until it is acknowledged, else 0.
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
