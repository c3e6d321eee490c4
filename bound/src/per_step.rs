//! Theorem 1 in sampled time: the change of the Lyapunov function in one step.

use super::truth::{bounded, estimators, first_order, Adapting, Case, VARYING};
use super::{Certificate, Interval, Kind, PeakSampled, Plant};
use bowden::control::{Adaptive, Leakage};
use bowden::{Error, Real};

/// `V⁺ <= (1 - h·rate)·V + h·input` for the first-order form: Theorem 1 in sampled time.
///
/// Here `V = s²/2 + z²/2 + sum c_p·(1 + h·sigma_p)·(p* - p_hat)²/(2·m_p)` over beta (c = alpha),
/// delta and the thetas (c = 1). Because of the implicit leakage, the factor `1 + h·sigma` is
/// necessary for the cross terms to cancel exactly, as in (28). A clamp to bounds that contain the
/// true value cannot increase V. The remaining terms are:
///
/// - `rate = min(2·lambda, k·lambda, sigma_p/(1 + h·sigma_p))`: half of `k·lambda·s²` compensates
///   xi;
/// - `input = sum c_p·sigma_p·(p* - p0)²/(2·m_p) + W_T·eps·lambda·target + lambda·S·(Delta -
///   target) + Xi²/(2·k·lambda) + (h/2)·R`, where `target` is Delta, the upper bound of delta_hat
///   if this is below Delta, or the value of a constant delta_hat. In the box of [`PeakSampled`], R
///   bounds the second-order terms `((s⁺-s)/h)² + ((z⁺-z)/h)² + sum c_p·m_p·v_p²`.
///
/// Further assumptions, in addition to those of [`PeakSampled`]:
/// - the errors are in the box of [`PeakSampled`];
/// - `dt` is the step h of the form at every sample;
/// - the leakage of each estimate that adapts is constant and positive;
/// - the bounds on the estimates contain the true values;
/// - `h·rate <= 1`.
///
/// As in Theorem 1, the inequality bounds all errors together, so the bound on the tracking error
/// is loose.
///
/// ```
/// use bowden_bound::{PerStep, Plant};
/// use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Form};
/// let lag = Form::FirstOrder { step: 0.001, plant_gain: 1.0 };
/// let law = Adaptive::try_new(AdaptiveSettings {
///     beta: Estimator::fixed(1.0).within(0.95, 1.05).adapting(2.5e-4, 0.01),
///     delta: Estimator::fixed(7.0).within(0.0, 7.056).adapting(0.00625, 0.01),
///     ..AdaptiveSettings::<f64, 0>::unlimited(lag, 24.0, 8.0, 0.2)
/// })?;
/// let step = PerStep::try_new(&law, &Plant::new(1.0, 7.056))?;
/// assert!((step.rate - 0.01 / 1.00001).abs() < 1e-12); // the leakage [1/s]
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PerStep<T> {
    /// The box of the errors in which the inequality holds.
    pub within: PeakSampled<T>,
    /// The step h \[s\].
    pub step: T,
    /// Decay rate of V \[1/s\].
    pub rate: T,
    /// Input rate of V \[(N·m)²/s\].
    pub input: T,
    /// Reference value of delta_hat in V \[N·m\].
    pub target: T,
    lambda: T,
}

impl<T: Real> PerStep<T> {
    /// The inequality of an adaptive law with a plant.
    ///
    /// # Errors
    /// The same as [`PeakSampled::try_new`], and [`Error::Inadmissible`] with the violated
    /// assumption.
    pub fn try_new<const N: usize>(
        law: &Adaptive<T, N>,
        plant: &Plant<T, N>,
    ) -> Result<Self, Error> {
        let within = PeakSampled::try_new(law, plant)?;
        let (case, settings) = (Case::try_new(law, plant)?, law.settings());
        let [step, _] = first_order(settings)?;
        let (gain, lambda, two) = (settings.gain, settings.lambda, T::from_f64(2.0));
        let mut rate = gain.min(two) * lambda;
        for estimator in estimators(settings) {
            let range = case.range(estimator);
            match estimator.leakage {
                _ if range.low == range.high => {}
                Leakage::Constant { rate: sigma } => {
                    rate = rate.min(sigma / (T::one() + step * sigma));
                }
                _ => return Err(VARYING),
            }
        }
        if rate <= T::zero() || step * rate > T::one() {
            return Err(Error::Inadmissible("leakage > 0 and h*rate <= 1"));
        }
        let target = highest_target(case.range(&settings.delta), plant.delta);
        // (p* - p0)²·sigma/(2·m) is twice the residue.
        let mut input = two * case.sum(Adapting::residue)?;
        let delta = case.delta(target)?;
        input += delta.map_or(T::zero(), |delta| two * delta.residue());
        input += case.smoothing() * target;
        if target < plant.delta {
            input += lambda * within.s * (plant.delta - target);
        }
        input += within.xi * within.xi / (two * gain * lambda);
        input += step * second_order(&case, &within, delta) / two;
        Ok(Self {
            within,
            step,
            rate,
            input: bounded(input)?,
            target,
            lambda,
        })
    }

    /// The resulting bound on limsup `|e|`: `(1 + lambda)·sqrt(2·input/rate)` \[N·m\].
    #[must_use]
    pub fn certificate(&self) -> Certificate<T> {
        let size = (T::from_f64(2.0) * (self.input / self.rate)).sqrt();
        Certificate::new(Kind::PerStep, (T::one() + self.lambda) * size)
    }
}

/// The highest useful target of delta_hat: Delta, or the highest estimate if this is lower. A
/// constant estimate is measured against itself, also above Delta.
pub(super) fn highest_target<T: Real>(estimates: Interval<T>, delta: T) -> T {
    if estimates.low == estimates.high {
        estimates.high
    } else {
        estimates.high.min(delta)
    }
}

/// R, at worst in the box, with `delta` for delta_hat.
pub(super) fn second_order<T: Real, const N: usize>(
    case: &Case<'_, T, N>,
    within: &PeakSampled<T>,
    delta: Option<Adapting<T>>,
) -> T {
    let Case { settings, plant } = case;
    let (lambda, s, g) = (settings.lambda, within.s, within.g.high);
    let most = case.range(&settings.delta).high;
    let ds =
        lambda * g * (settings.gain * s + most) + g * s / lambda + lambda * within.w + within.xi;
    let dz = T::from_f64(2.0) * s;
    let mut rest = ds * ds + dz * dz;
    let mut virtual_command = settings.gain * s
        + s / (lambda * lambda)
        + plant.reference
        + plant.reference_rate / lambda
        + most;
    for (theta, known) in settings.theta.iter().zip(&plant.regressors) {
        let estimate = case.range(theta).magnitude();
        let v = lambda * s * known.magnitude;
        if known.magnitude > T::zero() {
            virtual_command += estimate * known.magnitude;
            rest += theta.gain * v * v;
        }
    }
    let v = lambda * s * virtual_command;
    rest += plant.alpha.high * settings.beta.gain * v * v;
    let v = lambda * s;
    rest + delta.map_or(T::zero(), |delta| delta.estimator.gain * v * v)
}
