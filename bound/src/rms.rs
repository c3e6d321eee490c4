//! The RMS certificate: a bound on the mean square error from the algebra of Theorem 1.

use super::mean::Mean;
use super::truth::{bounded, Case};
use super::{Certificate, Kind, Plant};
use bowden::control::Adaptive;
use bowden::{Error, Real};

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
pub struct Rms<T: Real> {
    /// The bound on rms(e) over a long time \[N·m\].
    pub bound: T,
    /// The same bound with the target Delta, or the nearest value within the bounds of
    /// delta_hat \[N·m\].
    pub at_full_target: T,
    /// The best target of delta_hat \[N·m\].
    pub target: T,
    mean: Mean<T>,
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
        let case = Case::try_new(law, plant)?.published()?;
        let within = case.range(&law.settings().delta);
        if within.high < T::zero() {
            return Err(Error::Inadmissible("delta.high >= 0"));
        }
        let lowest = within.low.max(T::zero());
        // An estimate that is always above Delta has its least value as target.
        let highest = within.high.min(plant.delta).max(lowest);
        let mean = Mean::try_new(&case, highest)?;
        let target = mean.best(lowest, highest);
        Ok(Self {
            bound: mean.bound(target, T::zero()),
            at_full_target: bounded(mean.bound(highest, T::zero()))?,
            target,
            mean,
        })
    }

    /// Bound on rms(e) \[N·m\] over the first `duration` \[s\], from an initial error
    /// `start` \[N·m\].
    ///
    /// This bound includes V(0), which dominates for minutes if beta_hat is initially zero.
    #[must_use]
    pub fn over(&self, duration: T, start: T) -> T {
        self.mean.over(self.target, duration, start)
    }

    /// The bound over a long time as a certificate.
    #[must_use]
    pub fn certificate(&self) -> Certificate<T> {
        Certificate::new(Kind::Rms, self.bound)
    }
}
