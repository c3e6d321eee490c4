//! What the law is made from, and the conditions it must meet.

use super::estimator::{BETA, DELTA, THETA};
use super::{Estimator, SmoothSign};
use crate::control::{Fallback, Limits};
use crate::error::finite;
use crate::signal::Derivative;
use crate::{Error, Real};

/// How the error's rate enters the law: each form is for one kind of plant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Form<T> {
    /// (23) as it stands, with a filtered difference of the error.
    ///
    /// For a plant with inertia, whose output cannot follow the command at once. On a
    /// static plant with one sample of delay it diverges unless
    /// `g·(k + 2/(lambda·h)) < 1`: at 1 kHz g would have to be 0.004.
    Literal {
        /// Of the filter of the error's rate \[s\]: 2 to 20 ms.
        time_constant: T,
    },
    /// The error's rate solved for: the command follows through a lag of 1/lambda.
    ///
    /// `u⁺ = u + h·lambda·(beta_hat·ubar - u)`. For a plant that answers within a
    /// sample (a stiff drive, a blocked joint): there it is (22) exactly. On a plant with
    /// inertia it diverges.
    Lag {
        /// Longest sample time that is intended \[s\].
        step: T,
        /// Upper bound of the plant's gain alpha \[N·m/command unit\].
        plant_gain: T,
    },
}

/// Settings of an [`Adaptive`](super::Adaptive) law over `N` regressors, (19)-(26).
///
/// ```
/// use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Form};
/// let settings = AdaptiveSettings {
///     beta: Estimator::fixed(1.0).within(0.8, 1.2).adapting(2.5e-4, 0.01),
///     delta: Estimator::fixed(1.0).within(0.0, 7.0).adapting(6e-3, 0.01),
///     ..AdaptiveSettings::<f64, 2>::new(
///         Form::Lag { step: 0.001, plant_gain: 1.0 }, // \[s\], [N·m/command unit]
///         24.0, 8.0, 0.05,
///     )
/// };
/// // 1 ms is too long with this epsilon: the constructor says so, and what would do.
/// assert!(Adaptive::try_new(settings).is_err());
/// assert!((settings.largest_step().unwrap() - 635e-6).abs() < 1e-6);
/// let wider = AdaptiveSettings { epsilon: 0.1, ..settings };
/// assert!(Adaptive::try_new(wider).is_ok());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        deny_unknown_fields,
        bound(
            serialize = "T: Real + serde::Serialize",
            deserialize = "T: Real + serde::Deserialize<'de>"
        )
    )
)]
pub struct AdaptiveSettings<T, const N: usize> {
    /// Literal or lag form.
    pub form: Form<T>,
    /// Control gain k, above zero.
    pub gain: T,
    /// lambda \[1/s\], above zero: weight of the accumulated error, (18).
    pub lambda: T,
    /// epsilon \[N·m\], above zero: width of the smooth sign.
    ///
    /// With one sample of delay at least a fortieth of the greatest delta_hat, or the
    /// command chatters.
    pub epsilon: T,
    /// Which smooth sign.
    #[cfg_attr(feature = "serde", serde(default))]
    pub smooth_sign: SmoothSign,
    /// Estimate of 1/alpha \[command unit/(N·m)\], (24).
    pub beta: Estimator<T>,
    /// Estimate of the bound of the disturbance \[N·m\], (25).
    pub delta: Estimator<T>,
    /// Estimates of theta_i \[N·m/unit of the regressor\], (26).
    #[cfg_attr(feature = "serde", serde(with = "super::list"))]
    pub theta: [Estimator<T>; N],
    /// Most that the accumulated error z may be \[N·m·s\].
    #[cfg_attr(feature = "serde", serde(default = "T::max_value"))]
    pub z_limit: T,
    /// The estimates stay as they are.
    #[cfg_attr(feature = "serde", serde(default))]
    pub frozen: bool,
    /// Range and slew rate of the command.
    #[cfg_attr(feature = "serde", serde(default = "Limits::none"))]
    pub limits: Limits<T>,
    /// What to command when samples stay bad.
    #[cfg_attr(feature = "serde", serde(default = "Fallback::hold"))]
    pub fallback: Fallback<T>,
}

impl<T: Real, const N: usize> AdaptiveSettings<T, N> {
    /// k, lambda \[1/s\] and epsilon \[N·m\] with fixed estimates: start of a struct update.
    ///
    /// beta_hat is one, delta_hat and theta_hat are zero; no limits.
    #[must_use]
    pub fn new(form: Form<T>, gain: T, lambda: T, epsilon: T) -> Self {
        Self {
            form,
            gain,
            lambda,
            epsilon,
            smooth_sign: SmoothSign::Tanh,
            beta: Estimator::fixed(T::one()),
            delta: Estimator::fixed(T::zero()),
            theta: [Estimator::fixed(T::zero()); N],
            z_limit: T::max_value(),
            frozen: false,
            limits: Limits::none(),
            fallback: Fallback::hold(),
        }
    }

    /// Largest sample time \[s\] that the lag form admits; `None` for the literal form.
    ///
    /// `1/(lambda·max(1, g⁺·(k + delta_max/epsilon)))`, where g⁺ is the plant's gain
    /// times the greatest beta_hat: then the error's map does not fall in s, and the box
    /// theorem ([`PeakSampled`](crate::bound::PeakSampled)) holds. It can be asked of
    /// settings that [`Adaptive::try_new`](super::Adaptive::try_new) refuses; not for
    /// gains that are not positive and finite.
    #[must_use]
    pub fn largest_step(&self) -> Option<T> {
        let Form::Lag { plant_gain, .. } = self.form else {
            return None;
        };
        let steepest = self.gain + self.delta.high / self.epsilon;
        let loop_gain = plant_gain * self.beta.high * steepest;
        // Written so that an overflow gives a largest step of zero.
        Some(if loop_gain > T::one() {
            T::one() / (self.lambda * loop_gain)
        } else {
            T::one() / self.lambda
        })
    }

    /// Everything that must hold.
    pub(super) fn check(&self) -> Result<(), Error> {
        positive(self.gain, "gain")?;
        positive(self.lambda, "lambda")?;
        positive(self.epsilon, "epsilon")?;
        positive(self.z_limit, "z_limit")?;
        self.beta.check(&BETA)?;
        self.delta.check(&DELTA)?;
        for theta in &self.theta {
            theta.check(&THETA)?;
        }
        if let Some(safe) = self.fallback.command() {
            if !self.limits.contains(safe) {
                return Err(Error::Inadmissible("the safe command within the limits"));
            }
        }
        match self.form {
            Form::Literal { time_constant } => Derivative::try_new(time_constant).map(|_| ()),
            Form::Lag { step, plant_gain } => {
                positive(step, "step")?;
                positive(plant_gain, "plant_gain")?;
                self.check_lag(step)
            }
        }
    }

    fn check_lag(&self, step: T) -> Result<(), Error> {
        if self.beta.low <= T::zero() {
            return Err(Error::Inadmissible("lag form: beta.low > 0"));
        }
        if self.delta.low < T::zero() {
            return Err(Error::Inadmissible("lag form: delta.low >= 0"));
        }
        if step * self.lambda > T::one() {
            return Err(Error::Inadmissible("lag form: h*lambda <= 1"));
        }
        match self.largest_step() {
            Some(largest) if step <= largest => Ok(()),
            _ => Err(Error::Inadmissible(
                "lag form: h*lambda*g*(k + delta.high/epsilon) <= 1",
            )),
        }
    }
}

impl<T: Real> AdaptiveSettings<T, 2> {
    /// Table 2, with the paper's initial estimates and no projection.
    ///
    /// Literal form. The filter of the error's rate, 5 ms, is not in the paper. The
    /// regressors are velocity \[rad/s\] and acceleration \[rad/s²\] of the proximal
    /// pulley. beta_hat starts at zero, the singular point of the loop: the start-up
    /// overshoots (Figure 9). Boxes and `beta.initial = 0.8/alpha` avoid that.
    ///
    /// ```
    /// use bowden::control::AdaptiveSettings;
    /// let table_2 = AdaptiveSettings::<f64, 2>::paper();
    /// assert_eq!(table_2.lambda * table_2.delta.gain, 0.05); // lambda·mu
    /// assert_eq!((table_2.beta.initial, table_2.delta.initial), (0.0, 7.0));
    /// ```
    #[must_use]
    pub fn paper() -> Self {
        let leakage = T::of(0.01);
        let velocity = Estimator::fixed(T::zero()).adapting(T::of(0.004 / 8.0), leakage);
        let literal = Form::Literal {
            time_constant: T::of(0.005),
        };
        Self {
            beta: Estimator::fixed(T::zero()).adapting(T::of(0.002 / 8.0), leakage),
            delta: Estimator::fixed(T::of(7.0)).adapting(T::of(0.05 / 8.0), leakage),
            theta: [velocity; 2],
            ..Self::new(literal, T::of(24.0), T::of(8.0), T::of(0.05))
        }
    }
}

fn positive<T: Real>(value: T, name: &'static str) -> Result<T, Error> {
    if finite(value, name)? > T::zero() {
        Ok(value)
    } else {
        Err(Error::OutOfRange(name))
    }
}
