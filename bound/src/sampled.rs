//! The box theorem: the peak certificate of the first-order form in sampled time.

use super::truth::{bounded, first_order, Case};
use super::{Certificate, Interval, Kind, Plant};
use bowden::control::Adaptive;
use bowden::{Error, Real};

/// The box theorem: peak of the error of the first-order form in sampled time.
///
/// The closed loop is exactly [`LagRecursion`](bowden::control::LagRecursion). Let `W >= |w|`,
/// `h·Xi >= |xi|` and `g⁻ <= g <= g⁺` hold at every sample, for any estimates within their bounds.
/// **If** `h·lambda <= 1`, `h·lambda·g⁺·(k + delta_max/eps) <= 1` and `k > 1/lambda²`, **then** the
/// box `|s| <= S`, `|z| <= S/lambda` with `S = (W + Xi/lambda)/(g⁻·(k - 1/lambda²))` is invariant
/// and attractive, and `|e| <= |s| + lambda·|z| <= 2·S`.
///
/// *Proof.* By the first condition, `z⁺ = (1 - h·lambda)·z + h·s` stays in the box. By the second
/// condition, `f(s) = s - h·lambda·g·(k·s + delta_hat·T(s/eps))` does not decrease (the slope of T
/// is at most one). Since f is odd, `|f(s)| <= f(S) <= S - h·lambda·g·k·S`. Then
/// `|s⁺| <= S - h·lambda·g·k·S + h·g·S/lambda + h·lambda·W + h·Xi <= S`. Outside the box, at m·S
/// with m > 1, the same calculation gives a decrease of at least
/// `h·lambda·g·(k - 1/lambda²)·(m - 1)·S`. ∎
///
/// The theorem requires that s uses z of the previous sample. If z is updated first, the recursion
/// is different. The worst corner is `s = S, z = -S/lambda`. The bound is tight, because the worst
/// disturbance reaches more than 0.99·S (test `bound`).
///
/// Further assumptions:
/// - the plant (11) has no dynamics, and y is the response to u of the previous sample;
/// - alpha and theta are constant and lie in the given intervals;
/// - D, y_r, x and their rates are within the given limits;
/// - the next reference that the controller receives is correct;
/// - no command limit and no slew-rate limit is active.
///
/// The true values need not lie within the bounds on the estimates.
///
/// ```
/// use bowden_bound::{Interval, PeakSampled, Plant};
/// use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Form};
/// let lag = Form::FirstOrder { step: 0.001, plant_gain: 1.0 };
/// let law = Adaptive::try_new(AdaptiveSettings {
///     beta: Estimator::fixed(1.0).within(0.95, 1.05).adapting(2.5e-4, 0.01),
///     delta: Estimator::fixed(7.0).within(0.0, 7.056).adapting(0.00625, 0.01),
///     ..AdaptiveSettings::<f64, 0>::unlimited(lag, 24.0, 8.0, 0.2)
/// })?;
/// let plant = Plant {
///     delta_rate: 45.7, // [N·m/s]
///     reference: 38.0, // [N·m]
///     reference_rate: 22.24, // [N·m/s]
///     ..Plant::new(1.0, 7.056)
/// };
/// assert!((PeakSampled::try_new(&law, &plant)?.bound - 1.30).abs() < 0.005); // [N·m]
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PeakSampled<T> {
    /// W \[N·m\]: largest `|(g-1)·(r + r'/lambda) + (g·theta_hat - theta)'x - D|`.
    pub w: T,
    /// Xi \[N·m/s\]: largest rate of `D + theta'x`.
    pub xi: T,
    /// Minimum and maximum of g = alpha·beta_hat.
    pub g: Interval<T>,
    /// S \[N·m\]: the box is `|s| <= S`, `|z| <= S/lambda`.
    pub s: T,
    /// 2·S \[N·m\]: bound on `|e|` at every sample.
    pub bound: T,
    /// Largest `|u|` in the box \[command unit\], which the command limits must allow.
    pub command: T,
}

impl<T: Real> PeakSampled<T> {
    /// The certificate of an adaptive law with a plant.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with the invalid part of the plant.
    /// [`Error::Inadmissible`] with the violated assumption, or if no bound exists because the
    /// bounds on the estimates are too wide.
    pub fn try_new<const N: usize>(
        law: &Adaptive<T, N>,
        plant: &Plant<T, N>,
    ) -> Result<Self, Error> {
        let case = Case::try_new(law, plant)?;
        let settings = law.settings();
        let [_, plant_gain] = first_order(settings)?;
        if plant.alpha.high > plant_gain {
            return Err(Error::Inadmissible(
                "alpha <= plant_gain of the first-order form",
            ));
        }
        let lambda = settings.lambda;
        let stiffness = settings.gain - T::one() / (lambda * lambda);
        if stiffness <= T::zero() {
            return Err(Error::Inadmissible("k > 1/lambda²"));
        }
        let g = case.loop_gain()?;
        let reference = plant.reference + plant.reference_rate / lambda;
        let w = case.push(g, reference);
        let xi = plant.delta_rate + plant.weighted(|known| known.rate);
        let s = bounded((w + xi / lambda) / (g.low * stiffness))?;
        if settings.z_limit < s / lambda {
            return Err(Error::Inadmissible("z_limit >= S/lambda"));
        }
        let two = T::from_f64(2.0);
        let torque = plant.reference + two * s + plant.delta + plant.weighted(|x| x.magnitude);
        Ok(Self {
            w,
            xi,
            g,
            s,
            bound: bounded(two * s)?,
            command: torque / plant.alpha.low,
        })
    }

    /// The bound 2·S as a certificate.
    #[must_use]
    pub fn certificate(&self) -> Certificate<T> {
        Certificate::new(Kind::PeakSampled, self.bound)
    }
}
