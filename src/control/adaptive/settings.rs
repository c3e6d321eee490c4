//! Settings of the adaptive law, and the conditions on them.

use super::estimator::{Names, BETA, DELTA, THETA};
use super::{Adaptive, Estimator, Leakage, SmoothSign};
use crate::control::status::OUTSIDE;
use crate::control::{Fallback, Limits};
use crate::error::{above_zero, must_be_finite, not_below_zero};
use crate::{Error, Real};

crate::data! {
    /// Treatment of the error rate e' in (23). Each form suits one kind of plant.
    pub enum Form<T> {
        /// Equation (23) as published, with e' as a filtered difference of the error.
        ///
        /// Use this form for a plant with inertia, whose output cannot follow the command
        /// immediately. On a static plant with one sample of delay, this form diverges unless
        /// `g·k < 1` with g = alpha·beta_hat. Without the filter, the condition is
        /// `g·(k + 2/(lambda·h)) < 1`.
        AsPublished {
            /// Time constant of the filter of e' \[s\], not negative; usually 2 to 20 ms.
            time_constant: T,
        },
        /// Equation (23) solved for e': the command follows through a lag of 1/lambda.
        ///
        /// `u⁺ = u + h·lambda·(beta_hat·ubar - u)`. Use this form for a plant that responds within
        /// one sample, such as a stiff drive or a blocked joint. On such a plant, the form is
        /// equivalent to (22). On a plant with inertia, this form diverges.
        FirstOrder {
            /// Longest intended sampling period \[s\], positive.
            step: T,
            /// Upper bound on the plant's gain alpha \[N·m/command unit\], positive.
            plant_gain: T,
        },
    }

    /// Response to a regressor that is not finite.
    #[derive(Eq, Default)]
    pub enum OnMissing {
        /// The sample is bad, and the command is held.
        #[default]
        Hold,
        /// The command of this sample omits the term of the regressor, and the estimates do not
        /// change. The torque loop stays closed, with the status
        /// [`Degraded`](crate::control::Status::Degraded).
        DropRegressor,
    }

    /// Settings of an [`Adaptive`](super::Adaptive) law with `N` regressors.
    ///
    /// Deserialising fails if `limits`, `longest_dt` or `fallback` is missing, because an omitted
    /// field must not remove a safeguard. For a simulation, write the values of
    /// [`unlimited`](Self::unlimited) explicitly.
    ///
    /// ```
    /// use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Form};
    /// let settings = AdaptiveSettings {
    ///     beta: Estimator::fixed(1.0).within(0.8, 1.2).adapting(2.5e-4, 0.01),
    ///     delta: Estimator::fixed(1.0).within(0.0, 7.0).adapting(6e-3, 0.01),
    ///     ..AdaptiveSettings::<f64, 2>::unlimited(
    ///         Form::FirstOrder { step: 0.001, plant_gain: 1.0 }, // [s], [N·m/command unit]
    ///         24.0, 8.0, 0.05,
    ///     )
    /// };
    /// // 1 ms is too long with this epsilon: the constructor rejects it.
    /// assert!(Adaptive::try_new(settings).is_err());
    /// assert!((settings.largest_step().unwrap() - 635e-6).abs() < 1e-6);
    /// let wider = AdaptiveSettings { epsilon: 0.1, ..settings };
    /// assert!(Adaptive::try_new(wider).is_ok());
    /// ```
    pub struct AdaptiveSettings<T: Real, const N: usize> {
        /// Form as published, or first-order form.
        pub form: Form<T>,
        /// Control gain k, positive.
        pub gain: T,
        /// lambda \[1/s\], positive: weight of the accumulated error in (18).
        pub lambda: T,
        /// epsilon \[N·m\], positive: width of the smoothed sign function.
        ///
        /// With one sample of delay, epsilon should be at least 1/40 of the largest delta_hat.
        /// Otherwise, the command may chatter.
        pub epsilon: T,
        /// The smoothed sign function in (23) and (25).
        #[cfg_attr(feature = "serde", serde(default))]
        pub smooth_sign: SmoothSign,
        /// Estimate of 1/alpha in (24) \[command unit/(N·m)\].
        pub beta: Estimator<T>,
        /// Estimate of the bound on the disturbance in (25) \[N·m\].
        pub delta: Estimator<T>,
        /// Estimates of theta_i in (26) \[N·m/unit of the regressor\].
        #[cfg_attr(feature = "serde", serde(with = "crate::list"))]
        pub theta: [Estimator<T>; N],
        /// Largest magnitude of the accumulated error z \[N·m·s\].
        #[cfg_attr(feature = "serde", serde(default = "T::max_value"))]
        pub z_limit: T,
        /// Whether the estimates are frozen.
        #[cfg_attr(feature = "serde", serde(default))]
        pub frozen: bool,
        /// For each regressor, the response to a value that is not finite.
        #[cfg_attr(
            feature = "serde",
            serde(with = "crate::list", default = "all_hold::<N>")
        )]
        pub missing: [OnMissing; N],
        /// Range and slew-rate limit of the command.
        pub limits: Limits<T>,
        /// Longest `dt` of a good sample \[s\], positive; for example, five sampling periods.
        ///
        /// The first-order form also rejects a `dt` longer than
        /// [`largest_step`](Self::largest_step).
        pub longest_dt: T,
        /// Fallback after repeated bad samples.
        pub fallback: Fallback<T>,
    }
}

#[cfg(feature = "serde")]
fn all_hold<const N: usize>() -> [OnMissing; N] {
    [OnMissing::Hold; N]
}

crate::checked! {
    Adaptive<T, N>;

    fn largest_step[, const N: usize](s: &AdaptiveSettings<T, N>, plant_gain: T) -> T {
        let loop_gain = plant_gain * s.beta.high * (s.gain + s.delta.high / s.epsilon);
        // Written so that an overflow gives a largest step of zero.
        if loop_gain > T::ONE {
            T::ONE / (s.lambda * loop_gain)
        } else {
            T::ONE / s.lambda
        }
    }

    fn check_estimator[](it: &Estimator<T>, names: &Names) -> Result<(), Error> {
        let [initial, low, high, gain, leakage, bound_name, prior, fixed] = *names;
        must_be_finite!(it.low, low);
        must_be_finite!(it.high, high);
        must_be_finite!(it.prior, prior);
        if it.low > it.high {
            return Err(Error::OutOfRange(low));
        }
        must_be_finite!(it.initial, initial);
        if it.initial < it.low || it.initial > it.high {
            return Err(Error::OutOfRange(initial));
        }
        not_below_zero!(it.gain, gain);
        if it.gain > T::ZERO && it.low == it.high {
            return Err(Error::Inadmissible(fixed));
        }
        not_below_zero!(it.leakage.rate(), leakage);
        if let Leakage::Switching { bound, .. } = it.leakage {
            above_zero!(bound, bound_name);
        }
        Ok(())
    }

    /// Checks the settings.
    ///
    /// # Errors
    /// - [`Error::NonFinite`] or [`Error::OutOfRange`] with the field's name (`"theta.gain"`).
    /// - [`Error::Inadmissible`] if the safe command lies outside the limits, or if an estimate
    ///   with a gain has equal bounds.
    /// - [`Error::Inadmissible`] with the violated condition of the first-order form:
    ///   `beta.low > 0`, `delta.low >= 0`, `h·lambda <= 1` or
    ///   `h·lambda·g·(k + delta.high/epsilon) <= 1`, where g is `plant_gain·beta.high`.
    ///   For the last two conditions, [`AdaptiveSettings::largest_step`] returns the largest
    ///   admissible `dt`.
    pub fn try_new(settings: AdaptiveSettings<T, N>) {
        let s = &settings;
        above_zero!(s.gain, "gain");
        above_zero!(s.lambda, "lambda");
        above_zero!(s.epsilon, "epsilon");
        above_zero!(s.z_limit, "z_limit");
        if let Err(error) = check_estimator(&s.beta, &BETA) {
            return Err(error);
        }
        if let Err(error) = check_estimator(&s.delta, &DELTA) {
            return Err(error);
        }
        // A `for` is not constant.
        let mut i = 0;
        while i < N {
            if let Err(error) = check_estimator(&s.theta[i], &THETA) {
                return Err(error);
            }
            i += 1;
        }
        above_zero!(s.longest_dt, "longest_dt");
        let longest = match s.form {
            Form::AsPublished { time_constant } => {
                not_below_zero!(time_constant, "time_constant");
                s.longest_dt
            }
            Form::FirstOrder { step, plant_gain } => {
                above_zero!(step, "step");
                above_zero!(plant_gain, "plant_gain");
                if s.beta.low <= T::ZERO {
                    return Err(Error::Inadmissible("first-order form: beta.low > 0"));
                }
                if s.delta.low < T::ZERO {
                    return Err(Error::Inadmissible("first-order form: delta.low >= 0"));
                }
                if step * s.lambda > T::ONE {
                    return Err(Error::Inadmissible("first-order form: h*lambda <= 1"));
                }
                let largest = largest_step(s, plant_gain);
                if step > largest || largest.is_nan() {
                    return Err(Error::Inadmissible(
                        "first-order form: h*lambda*g*(k + delta.high/epsilon) <= 1",
                    ));
                }
                if largest < s.longest_dt {
                    largest
                } else {
                    s.longest_dt
                }
            }
        };
        if let Some(safe) = s.fallback.command() {
            if safe < s.limits.low() || safe > s.limits.high() {
                return Err(Error::Inadmissible(OUTSIDE));
            }
        }
        Ok(Adaptive { settings, longest })
    }
}

impl<T: Real, const N: usize> AdaptiveSettings<T, N> {
    /// Settings for hardware: with command limits, a `longest_dt` and a fallback. All estimates are
    /// fixed.
    ///
    /// `gain` is k, `lambda` is in \[1/s\], `epsilon` in \[N·m\] and `longest_dt` in \[s\].
    /// beta_hat is one; delta_hat and theta_hat are zero.
    pub const fn new(
        form: Form<T>,
        gain: T,
        lambda: T,
        epsilon: T,
        limits: Limits<T>,
        longest_dt: T,
        fallback: Fallback<T>,
    ) -> Self {
        Self {
            limits,
            longest_dt,
            fallback,
            ..Self::unlimited(form, gain, lambda, epsilon)
        }
    }

    /// Settings for a simulation: no command limits, no `longest_dt`, and no safe command.
    pub const fn unlimited(form: Form<T>, gain: T, lambda: T, epsilon: T) -> Self {
        Self {
            form,
            gain,
            lambda,
            epsilon,
            smooth_sign: SmoothSign::Tanh,
            beta: Estimator::fixed(T::ONE),
            delta: Estimator::fixed(T::ZERO),
            theta: [Estimator::fixed(T::ZERO); N],
            z_limit: T::HIGHEST,
            frozen: false,
            missing: [OnMissing::Hold; N],
            limits: Limits::unlimited(),
            longest_dt: T::HIGHEST,
            fallback: Fallback::hold_indefinitely(),
        }
    }

    /// Largest `dt` \[s\] that the first-order form admits; `None` for the form as published.
    ///
    /// The result is `1/(lambda·max(1, g⁺·(k + delta_max/epsilon)))`, where g⁺ is
    /// `plant_gain·beta.high`. Up to this `dt`, the next s is a non-decreasing function of s, and
    /// the box theorem (`PeakSampled` in the crate `bowden-bound`) holds. The method also accepts
    /// settings that [`Adaptive::try_new`](super::Adaptive::try_new) rejects, but their gains must
    /// be positive and finite.
    #[must_use]
    pub fn largest_step(&self) -> Option<T> {
        let Form::FirstOrder { plant_gain, .. } = self.form else {
            return None;
        };
        Some(largest_step(self, plant_gain))
    }
}
