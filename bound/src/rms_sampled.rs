//! The RMS certificate of the first-order form in sampled time.

use super::mean::Mean;
use super::per_step::{highest_target, second_order};
use super::truth::{bounded, estimators, first_order, Case, VARYING};
use super::{Certificate, Kind, PeakSampled, Plant};
use bowden::control::{Adaptive, Estimator, Leakage};
use bowden::{Error, Real};

/// Root mean square of the error of the first-order form over a long time, in sampled time.
///
/// The derivation is the same as for [`Rms`](super::Rms), but uses the step of V that
/// [`PerStep`](super::PerStep) bounds. Without the leakage,
/// `V⁺ <= V - h·k·lambda·s² + h·(lambda·c + Xi)·|s| + h·phi`, where
///
/// - `phi = sum c_p·sigma_p·(p* - p0)²/(2·m_p) + W_T·eps·lambda·target + (h/2)·R`, where R bounds
///   the second-order terms in the box of [`PeakSampled`];
/// - `c = Delta - target`, where any target is valid and the smallest bound is used.
///
/// The mean of `|s|` is at most `rms(s)`, so
/// `k·lambda·rms(s)² <= (lambda·c + Xi)·rms(s) + phi + V(0)/T`. From z = 0,
/// `(1 - h·lambda)·sum(e²) <= sum(s²)` (`theorems/Decrease.v`), so
/// `rms(e) <= rms(s)/sqrt(1 - h·lambda)`.
///
/// Assumptions: the same as for [`PerStep`](super::PerStep), z(0) = 0 and `h·lambda < 1`. In
/// contrast to [`PerStep`](super::PerStep), the leakage may be zero.
///
/// ```
/// use bowden_bound::{Plant, RmsSampled};
/// use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Form};
/// let lag = Form::FirstOrder { step: 0.001, plant_gain: 1.0 };
/// let law = Adaptive::try_new(AdaptiveSettings {
///     beta: Estimator::fixed(1.0).within(0.95, 1.05).adapting(2.5e-4, 0.01),
///     delta: Estimator::fixed(7.0).within(0.0, 7.056).adapting(0.00625, 0.01),
///     ..AdaptiveSettings::<f64, 0>::unlimited(lag, 24.0, 8.0, 0.2)
/// })?;
/// let rms = RmsSampled::try_new(&law, &Plant::new(1.0, 7.056))?;
/// assert!(rms.bound > 0.0 && rms.bound < rms.within.bound); // below the peak
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RmsSampled<T: Real> {
    /// The bound on rms(e) over a long time \[N·m\].
    pub bound: T,
    /// The best reference value of delta_hat \[N·m\].
    pub target: T,
    /// The box of the errors in which the bound holds.
    pub within: PeakSampled<T>,
    mean: Mean<T>,
}

impl<T: Real> RmsSampled<T> {
    /// The certificate of an adaptive law with a plant.
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
        let (lambda, two) = (settings.lambda, T::from_f64(2.0));
        if step * lambda >= T::one() {
            return Err(Error::Inadmissible("h*lambda < 1"));
        }
        // Largest weight of an estimate in V, `1 + h·sigma`; at least 2, which covers s and z.
        let mut weight = two;
        for Estimator { leakage, .. } in estimators(settings) {
            if let Leakage::Switching { .. } = leakage {
                return Err(VARYING);
            }
            weight = weight.max(T::one() + step * leakage.rate());
        }
        let deltas = case.range(&settings.delta);
        let highest = highest_target(deltas, plant.delta);
        let mean = Mean::try_new(&case, highest)?;
        let second = second_order(&case, &within, mean.adapting);
        let mean = Mean {
            phi: two * mean.phi + step * second / two,
            residues: two,
            stiffness: settings.gain * lambda,
            share: lambda,
            xi: within.xi,
            per: T::one(),
            weight,
            kept: (T::one() - step * lambda).sqrt(),
            ..mean
        };
        let target = mean.best(deltas.low.min(highest), highest);
        Ok(Self {
            bound: bounded(mean.bound(target, T::zero()))?,
            target,
            within,
            mean,
        })
    }

    /// Bound on rms(e) \[N·m\] over the first `duration` \[s\], from an initial error
    /// `start` \[N·m\].
    #[must_use]
    pub fn over(&self, duration: T, start: T) -> T {
        self.mean.over(self.target, duration, start)
    }

    /// The bound over a long time as a certificate.
    #[must_use]
    pub fn certificate(&self) -> Certificate<T> {
        Certificate::new(Kind::RmsSampled, self.bound)
    }
}
