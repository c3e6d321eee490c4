//! Settings of the adaptive law.

use crate::adaptive::{Own, BOWDEN_REGRESSORS};
use crate::choices::{bowden_form, bowden_leakage, bowden_on_missing, bowden_smooth_sign};
use crate::result::Refused;
use crate::settings::{marked, Marked, UNSET};
use crate::{bowden_fallback_f32, bowden_fallback_f64, bowden_limits_f32, bowden_limits_f64};
use core_bowden::control::{
    Adaptive, AdaptiveSettings, Estimator, Form, Leakage, OnMissing, SmoothSign,
};

macro_rules! settings {
    ($f:ident) => {
        pastey::paste! {
            /// Settings of one estimate of the adaptive law, (24)-(26).
            ///
            /// The macro of the adaptive law also initialises its estimates. The macro of this
            /// struct fixes the estimate at 0, with zero gain and no leakage.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_estimator_ $f>] {
                /// Initialisation mark, set by NAME_INIT.
                pub init_mark: u32,
                /// Initial value of the estimate [unit of the estimate], within its bounds.
                pub initial: $f,
                /// Lower bound [unit of the estimate].
                pub low: $f,
                /// Upper bound [unit of the estimate].
                pub high: $f,
                /// Adaptation gain gamma, mu or mu_i of (24)-(26), not negative.
                pub gain: $f,
                /// Prior [unit of the estimate]: the value towards which the estimate leaks; 0 in
                /// the paper.
                pub prior: $f,
                /// Leakage method, one of bowden_leakage.
                pub leakage: u32,
                /// Largest leakage rate [1/s], not negative.
                pub leakage_rate: $f,
                /// Distance from the prior within which the estimate does not leak [unit of the
                /// estimate], positive. Only BOWDEN_LEAKAGE_SWITCHING uses this field.
                pub leakage_bound: $f,
            }

            marked!([<bowden_estimator_ $f>]);

            impl [<bowden_estimator_ $f>] {
                /// Returns the defaults: an estimate fixed at 0.
                pub const fn defaults() -> Self {
                    Self::fixed(0.0)
                }

                const fn fixed(value: $f) -> Self {
                    Self {
                        init_mark: Self::MARK,
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
                    Self::is_marked(self.init_mark)?;
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

            /// Settings of the adaptive law, equations (17)-(26).
            ///
            /// Defaults:
            ///
            /// - k, lambda and epsilon of the paper, the tanh function, and a time constant of 5
            ///   ms;
            /// - beta_hat fixed at 1, delta_hat fixed at 0, and no regressors;
            /// - no limit on z, no slew-rate limit, a fallback weight of 4 and a safe command of 0.
            ///
            /// You must set `form`, `limits`, `longest_dt` and `fallback.after`. The first-order
            /// form also requires `step` and `plant_gain`.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_adaptive_settings_ $f>] {
                /// Initialisation mark, set by NAME_INIT.
                pub init_mark: u32,
                /// Form of the adaptive law, one of bowden_form.
                pub form: u32,
                /// Form as published: filter time constant of the error rate [s], at least 0,
                /// usually 2 to 20 ms.
                pub time_constant: $f,
                /// First-order form: longest intended sampling period [s], positive.
                pub step: $f,
                /// First-order form: upper bound on the plant gain alpha [N*m/command unit],
                /// positive.
                pub plant_gain: $f,
                /// Control gain k, positive.
                pub gain: $f,
                /// lambda [1/s], positive: weight of the accumulated error in (18).
                pub lambda: $f,
                /// epsilon [N*m], positive: width of the smoothed sign function.
                pub epsilon: $f,
                /// Smoothed sign function, one of bowden_smooth_sign.
                pub smooth_sign: u32,
                /// Estimate of 1/alpha [command unit/(N*m)], adapted by (24).
                pub beta: [<bowden_estimator_ $f>],
                /// Estimate of the bound on the disturbance [N*m], adapted by (25).
                pub delta: [<bowden_estimator_ $f>],
                /// Number of regressors, at most BOWDEN_REGRESSORS.
                pub regressors: u32,
                /// Estimates of theta_i [N*m/unit of the regressor], adapted by (26). Entries from
                /// index `regressors` onward are ignored.
                pub theta: [[<bowden_estimator_ $f>]; BOWDEN_REGRESSORS],
                /// Response to a non-finite value of each regressor, one of bowden_on_missing.
                pub missing: [u32; BOWDEN_REGRESSORS],
                /// Largest magnitude of the accumulated error z [N*m*s], positive.
                pub z_limit: $f,
                /// 0 lets the estimates adapt; any other value freezes them.
                pub frozen: u32,
                /// Range and slew-rate limit of the command.
                pub limits: [<bowden_limits_ $f>],
                /// Longest dt of a good sample [s], positive. The first-order form also rejects a
                /// dt longer than 1/(lambda*max(1, g*(k + delta.high/epsilon))), with g =
                /// plant_gain*beta.high.
                pub longest_dt: $f,
                /// Fallback after repeated bad samples.
                pub fallback: [<bowden_fallback_ $f>],
            }

            marked!([<bowden_adaptive_settings_ $f>]);

            impl [<bowden_adaptive_settings_ $f>] {
                /// Returns the defaults.
                pub const fn defaults() -> Self {
                    Self {
                        init_mark: Self::MARK,
                        form: UNSET,
                        time_constant: 0.005,
                        step: 0.0,
                        plant_gain: 0.0,
                        gain: 24.0,
                        lambda: 8.0,
                        epsilon: 0.05,
                        smooth_sign: bowden_smooth_sign::Tanh as u32,
                        beta: [<bowden_estimator_ $f>]::fixed(1.0),
                        delta: [<bowden_estimator_ $f>]::fixed(0.0),
                        regressors: 0,
                        theta: [[<bowden_estimator_ $f>]::fixed(0.0); BOWDEN_REGRESSORS],
                        missing: [bowden_on_missing::Hold as u32; BOWDEN_REGRESSORS],
                        z_limit: $f::MAX,
                        frozen: 0,
                        limits: [<bowden_limits_ $f>]::UNSET,
                        longest_dt: 0.0,
                        fallback: [<bowden_fallback_ $f>] { after: 0, weight: 4, command: 0.0 },
                    }
                }
            }

            impl [<bowden_adaptive_settings_ $f>] {
                fn form(&self) -> Result<Form<$f>, Refused> {
                    let (step, plant_gain) = (self.step, self.plant_gain);
                    match self.form {
                        f if f == bowden_form::AsPublished as u32 => {
                            Ok(Form::AsPublished { time_constant: self.time_constant })
                        }
                        f if f == bowden_form::FirstOrder as u32 => Ok(Form::FirstOrder { step, plant_gain }),
                        _ => Err(Refused::choice("form")),
                    }
                }

                pub(crate) fn law(&self) -> Result<Own<$f>, Refused> {
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
                            m if m == bowden_on_missing::Hold as u32 => OnMissing::Hold,
                            m if m == bowden_on_missing::DropRegressor as u32 => OnMissing::DropRegressor,
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
