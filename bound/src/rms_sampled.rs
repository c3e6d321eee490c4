//! The RMS certificate of the first-order form in sampled time.

use super::per_step::second_order;
use super::truth::{adapting, bounded, range, sum, Adapting};
use super::{Certificate, Interval, Kind, PeakSampled, Plant};
use bowden::control::{Adaptive, Form, Leakage};
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
pub struct RmsSampled<T> {
    /// The bound on rms(e) over a long time \[N·m\].
    pub bound: T,
    /// The best reference value of delta_hat \[N·m\].
    pub target: T,
    /// The box of the errors in which the bound holds.
    pub within: PeakSampled<T>,
    /// phi without the part of delta_hat.
    phi: T,
    /// V(0) without the parts of delta_hat and of the error.
    at_start: T,
    smoothing: T,
    delta: T,
    gain: T,
    lambda: T,
    step: T,
    /// Largest weight of an estimate in V, `1 + h·sigma`; at least 2, which covers s and z.
    weight: T,
    /// Adaptation of delta_hat, without its true value, which is the target. `None` if delta_hat is
    /// constant.
    adapting: Option<Adapting<T>>,
}

/// Rounds of the search for the target.
const NARROWINGS: u32 = 90;

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
        let settings = law.settings();
        let Form::FirstOrder { step, .. } = settings.form else {
            return Err(Error::Inadmissible("the gains must be in first-order form"));
        };
        if step * settings.lambda >= T::one() {
            return Err(Error::Inadmissible("h*lambda < 1"));
        }
        let two = T::from_f64(2.0);
        let mut weight = two;
        let leaking = [settings.beta, settings.delta];
        for estimator in leaking.iter().chain(&settings.theta) {
            if let Leakage::Switching { .. } = estimator.leakage {
                return Err(Error::Inadmissible(
                    "the leakage of every estimate must be constant",
                ));
            }
            let own = T::one() + step * estimator.leakage.rate();
            if own > weight {
                weight = own;
            }
        }
        let deltas = range(&settings.delta, settings.frozen);
        let stays = deltas.low == deltas.high;
        let highest = if deltas.high < plant.delta || stays {
            deltas.high
        } else {
            plant.delta
        };
        let lowest = if deltas.low < highest {
            deltas.low
        } else {
            highest
        };
        let adapting = adapting(&settings.delta, settings.frozen, Interval::exactly(highest))?;
        let mut second = second_order(law, plant, &within);
        if let Some(delta) = &adapting {
            let v = settings.lambda * within.s;
            second += delta.gain * v * v;
        }
        let residues = sum(law, plant, |estimate| Ok(estimate.residue()))?;
        let mut found = Self {
            bound: T::zero(),
            target: highest,
            within,
            phi: two * residues + step * second / two,
            at_start: sum(law, plant, |estimate| Ok(estimate.at_start()))?,
            smoothing: settings.smooth_sign.residue::<T>() * settings.epsilon * settings.lambda,
            delta: plant.delta,
            gain: settings.gain,
            lambda: settings.lambda,
            step,
            weight,
            adapting,
        };
        if found.adapting.is_some() {
            found.target = found.best(lowest, highest);
        }
        found.bound = bounded(found.aimed_at(found.target, T::zero()))?;
        Ok(found)
    }

    /// Bound on rms(e) \[N·m\] over the first `duration` \[s\], from an initial error
    /// `start` \[N·m\].
    #[must_use]
    pub fn over(&self, duration: T, start: T) -> T {
        let mut v = self.at_start + start * start * T::from_f64(0.5);
        if let Some(delta) = self.aim(self.target) {
            v += delta.at_start();
        }
        self.aimed_at(self.target, self.weight * v / duration)
    }

    /// The bound over a long time as a certificate.
    #[must_use]
    pub fn certificate(&self) -> Certificate<T> {
        Certificate {
            kind: Kind::RmsSampled,
            value: self.bound,
        }
    }

    fn aim(&self, target: T) -> Option<Adapting<T>> {
        let truth = Interval::exactly(target);
        self.adapting.map(|delta| Adapting { truth, ..delta })
    }

    /// The bound with delta_hat measured against `target`, and `extra` in addition to phi.
    fn aimed_at(&self, target: T, extra: T) -> T {
        let two = T::from_f64(2.0);
        let residue = self.aim(target).map_or(T::zero(), |d| two * d.residue());
        let phi = self.phi + residue + self.smoothing * target + extra;
        // A target above Delta has no difference; a lower target has one.
        let left = if target < self.delta {
            self.lambda * (self.delta - target)
        } else {
            T::zero()
        };
        let linear = left + self.within.xi;
        let stiffness = self.gain * self.lambda;
        let root = (linear * linear + T::from_f64(4.0) * stiffness * phi).sqrt();
        let s = (linear + root) / (two * stiffness);
        s / (T::one() - self.step * self.lambda).sqrt()
    }

    /// Ternary search: the targets with a bound below a level form an interval.
    fn best(&self, mut low: T, mut high: T) -> T {
        let third = T::one() / T::from_f64(3.0);
        for _ in 0..NARROWINGS {
            let (a, b) = (low + (high - low) * third, high - (high - low) * third);
            if self.aimed_at(a, T::zero()) < self.aimed_at(b, T::zero()) {
                high = b;
            } else {
                low = a;
            }
        }
        high
    }
}
