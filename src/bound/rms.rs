//! The RMS certificate: what Theorem 1's own algebra says of the mean square.

use super::truth::{adapting, bounded, literal, range, sum, Adapting};
use super::{Certificate, Interval, Kind, Plant};
use crate::control::Adaptive;
use crate::{Error, Real};

/// Halvings of the search for the target: more than an f64 can tell apart.
const NARROWINGS: u32 = 90;

/// Root mean square of the error over a long time.
///
/// Theorem 1 weighs every estimate; the mean of s² needs none. From (30), with
/// `p_hat·p~ <= p*²/4` in place of (31)-(33), `V' <= -k·lambda·s² + phi_a`, where `phi_a
/// = sum sigma_p·p*²/(4·m_p) + W·epsilon·lambda·Delta`; and rms(e) <= rms(s), since
/// `s = e + lambda·z` gives ∫s² >= ∫e² where z starts at zero. So
/// `rms(e) <= sqrt((phi_a + V(0)/T)/(k·lambda))`.
///
/// delta_hat may be aimed at a target below Delta: then `c = Delta - target` is left,
/// and `rms(s) <= (c + sqrt(c² + 4·k·(phi_a + V(0)/T)/lambda))/(2·k)`. Any target is a
/// valid bound; the least is taken. Leakage to a prior p0 puts `p* - p0` in the
/// place of p*; a switching leakage whose bound holds the truth adds nothing.
///
/// Assumed: the literal form in continuous time with e' known; the plant (11) with
/// constant alpha, theta in the stated intervals and `|D| <= Delta` at every time;
/// z(0) = 0; boxes, if any, that hold the truth; no limit met.
///
/// ```
/// use bowden::bound::{Plant, Rms};
/// use bowden::control::Adaptive;
/// let rms = Rms::try_new(&Adaptive::paper(), &Plant::new(0.6, 7.056_f64))?;
/// assert!((rms.at_full_target - 0.441).abs() < 0.0005); // [N·m]
/// assert!((rms.bound - 0.419).abs() < 0.0005); // [N·m]
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rms<T> {
    /// The bound of rms(e) over a long time \[N·m\].
    pub bound: T,
    /// The same with delta_hat aimed at Delta, or as near as its box allows \[N·m\].
    pub at_full_target: T,
    /// What delta_hat is best aimed at \[N·m\].
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
    /// Without its truth, which is the target. `None` where delta_hat stays.
    adapting: Option<Adapting<T>>,
}

impl<T: Real> Rms<T> {
    /// The certificate of a law on a plant.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::OutOfRange`] with what is wrong with the plant;
    /// [`Error::Inadmissible`] with the assumption that does not hold.
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
        // An estimate that is always above Delta is aimed at its least value.
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

    /// rms(e) over the first `duration` \[s\] \[N·m\], from an error of `start` \[N·m\].
    ///
    /// V(0) counts: with beta_hat starting at zero it dominates for minutes.
    #[must_use]
    pub fn over(&self, duration: T, start: T) -> T {
        let mut v = self.at_start + start * start * T::of(0.5);
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

    /// The bound with delta_hat aimed at `target`, and `extra` beside phi_a.
    fn aimed_at(&self, target: T, extra: T) -> T {
        let residue = self.aim(target).map_or(T::zero(), |delta| delta.residue());
        let smoothing = self.smoothing * self.lambda * target;
        let phi = self.phi + residue + smoothing + extra;
        // More than Delta leaves nothing; less leaves the difference.
        let left = if target < self.delta {
            self.delta - target
        } else {
            T::zero()
        };
        let root = (left * left + T::of(4.0) * self.gain * phi / self.lambda).sqrt();
        (left + root) / (T::of(2.0) * self.gain)
    }

    /// Ternary search: where the bound is below a level is an interval of targets.
    fn best(&self, mut low: T, mut high: T) -> T {
        let third = T::one() / T::of(3.0);
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
