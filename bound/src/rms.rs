//! The RMS certificate: a bound on the mean square error from the algebra of Theorem 1.

use super::truth::{adapting, bounded, literal, range, sum, Adapting};
use super::{Certificate, Interval, Kind, Plant};
use bowden::control::Adaptive;
use bowden::{Error, Real};

/// Number of bisections in the search for the target: more than an `f64` can distinguish.
const NARROWINGS: u32 = 90;

/// Root mean square of the error over a long time.
///
/// Unlike Theorem 1, this bound does not depend on weights of the estimates. From (30), with
/// `p_hat·p~ <= p*²/4` instead of (31)-(33), `V' <= -k·lambda·s² + phi_a`, where
/// `phi_a = sum sigma_p·p*²/(4·m_p) + W·epsilon·lambda·Delta`. If z is initially zero,
/// `s = e + lambda·z` gives ∫s² >= ∫e² and therefore rms(e) <= rms(s). Hence
/// `rms(e) <= sqrt((phi_a + V(0)/T)/(k·lambda))`.
///
/// delta_hat may have a target below Delta. The difference is `c = Delta - target`, and
/// `rms(s) <= (c + sqrt(c² + 4·k·(phi_a + V(0)/T)/lambda))/(2·k)`. Any target gives a valid bound,
/// and the smallest bound is used. With leakage to a prior p0, `p* - p0` replaces p*. A switching
/// leakage whose bound contains the true value adds nothing.
///
/// Assumptions:
/// - the adaptive law is as published, in continuous time, and e' is known;
/// - the plant is (11), alpha and theta are constant and in the given intervals, and `|D| <= Delta`
///   at every time;
/// - z(0) = 0;
/// - the bounds on the estimates, if any, contain the true values;
/// - no command limit and no slew-rate limit is active.
///
/// ```
/// use bowden_bound::{Plant, Rms};
/// use bowden::control::Adaptive;
/// let rms = Rms::try_new(&Adaptive::paper(), &Plant::new(0.6, 7.056_f64))?;
/// assert!((rms.at_full_target - 0.441).abs() < 0.0005); // [N·m]
/// assert!((rms.bound - 0.419).abs() < 0.0005); // [N·m]
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rms<T> {
    /// The bound on rms(e) over a long time \[N·m\].
    pub bound: T,
    /// The same bound with the target Delta, or the nearest value within the bounds of
    /// delta_hat \[N·m\].
    pub at_full_target: T,
    /// The best target of delta_hat \[N·m\].
    pub target: T,
    gain: T,
    lambda: T,
    /// phi_a without the part of delta_hat.
    phi: T,
    /// V(0) without the part of delta_hat and of the error.
    at_start: T,
    /// W·epsilon.
    smoothing: T,
    delta: T,
    /// Adaptation of delta_hat, without its true value, which is the target. `None` if delta_hat is
    /// constant.
    adapting: Option<Adapting<T>>,
}

impl<T: Real> Rms<T> {
    /// The certificate of an adaptive law with a plant.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with the invalid part of the plant.
    /// [`Error::Inadmissible`] with the violated assumption.
    pub fn try_new<const N: usize>(
        law: &Adaptive<T, N>,
        plant: &Plant<T, N>,
    ) -> Result<Self, Error> {
        plant.check()?;
        literal(law)?;
        let settings = law.settings();
        let within = range(&settings.delta, settings.frozen);
        if within.high < T::zero() {
            return Err(Error::Inadmissible("delta.high >= 0"));
        }
        let lowest = if within.low > T::zero() {
            within.low
        } else {
            T::zero()
        };
        let highest = if within.high < plant.delta {
            within.high
        } else {
            plant.delta
        };
        // An estimate that is always above Delta has its least value as target.
        let highest = if highest < lowest { lowest } else { highest };
        let adapting = adapting(&settings.delta, settings.frozen, Interval::exactly(highest))?;
        let mut certificate = Self {
            bound: T::zero(),
            at_full_target: T::zero(),
            target: highest,
            gain: settings.gain,
            lambda: settings.lambda,
            phi: sum(law, plant, |estimate| Ok(estimate.residue()))?,
            at_start: sum(law, plant, |estimate| Ok(estimate.at_start()))?,
            smoothing: settings.smooth_sign.residue::<T>() * settings.epsilon,
            delta: plant.delta,
            adapting,
        };
        certificate.at_full_target = bounded(certificate.aimed_at(highest, T::zero()))?;
        if certificate.adapting.is_some() {
            certificate.target = certificate.best(lowest, highest);
        }
        certificate.bound = certificate.aimed_at(certificate.target, T::zero());
        Ok(certificate)
    }

    /// Bound on rms(e) \[N·m\] over the first `duration` \[s\], from an initial error
    /// `start` \[N·m\].
    ///
    /// This bound includes V(0), which dominates for minutes if beta_hat is initially zero.
    #[must_use]
    pub fn over(&self, duration: T, start: T) -> T {
        let mut v = self.at_start + start * start * T::from_f64(0.5);
        if let Some(delta) = self.aim(self.target) {
            v += delta.at_start();
        }
        self.aimed_at(self.target, v / duration)
    }

    /// The bound over a long time as a certificate.
    #[must_use]
    pub fn certificate(&self) -> Certificate<T> {
        Certificate {
            kind: Kind::Rms,
            value: self.bound,
        }
    }

    fn aim(&self, target: T) -> Option<Adapting<T>> {
        let truth = Interval::exactly(target);
        self.adapting.map(|delta| Adapting { truth, ..delta })
    }

    /// The bound with the target `target` of delta_hat, and `extra` in addition to phi_a.
    fn aimed_at(&self, target: T, extra: T) -> T {
        let residue = self.aim(target).map_or(T::zero(), |delta| delta.residue());
        let smoothing = self.smoothing * self.lambda * target;
        let phi = self.phi + residue + smoothing + extra;
        // A target above Delta has no difference; a lower target has one.
        let left = if target < self.delta {
            self.delta - target
        } else {
            T::zero()
        };
        let root = (left * left + T::from_f64(4.0) * self.gain * phi / self.lambda).sqrt();
        (left + root) / (T::from_f64(2.0) * self.gain)
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
