//! The peak certificate in continuous time.

use super::truth::{bounded, Case};
use super::{Certificate, Kind, Plant};
use bowden::control::Adaptive;
use bowden::{Error, Real};

/// Peak of the error in continuous time, with bounds on the estimates.
///
/// Let `g = alpha·beta_hat` and `w = (g-1)·y_r + (g·theta_hat - theta)'x - D`. The adaptive law as
/// published is
///
/// ```text
/// s' = (lambda/g)·(w - g·delta_hat·T(s/eps)) - lambda·(k - 1 + 1/g)·s - (1 + lambda²·(1 - 1/g))·z
/// z' = s - lambda·z
/// ```
///
/// In the box `|s| <= S`, `|z| <= S/lambda`, the worst case is the corner at which z drives s
/// outwards. The box is therefore invariant and attractive for `S = sup |w|/(g·kappa)`. Here kappa
/// is `k + 1/lambda²` if `g <= lambda²/(1 + lambda²)`, otherwise `k - 1/lambda² + 2·(1/g - 1)`.
/// Then `|e| <= |s| + lambda·|z| <= 2·S`.
///
/// Assumptions:
/// - the adaptive law is as published, in continuous time, and e' is known;
/// - the plant is (11), alpha and theta are in the given intervals, and `|D| <= Delta`;
/// - `|y_r|` and `|x_i|` are within the given limits;
/// - the bounds on beta_hat are positive, and the bounds on delta_hat are not negative;
/// - no command limit and no slew-rate limit is active.
///
/// The true values need not lie within the bounds on the estimates, and the estimates may move
/// freely within their bounds.
///
/// ```
/// use bowden_bound::{PeakContinuous, Plant};
/// use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Form};
/// let literal = Form::AsPublished { time_constant: 0.005 };
/// let law = Adaptive::try_new(AdaptiveSettings {
///     beta: Estimator::fixed(1.0), // alpha is known: g = 1
///     delta: Estimator::fixed(7.0).within(0.0, 8.0).adapting(0.00625, 0.01),
///     ..AdaptiveSettings::<f64, 0>::unlimited(literal, 24.0, 8.0, 0.05)
/// })?;
/// let peak = PeakContinuous::try_new(&law, &Plant::new(1.0, 7.056))?;
/// assert!((peak.bound - 0.588).abs() < 0.0005); // 2·7.056/(24 - 1/64) [N·m]
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PeakContinuous<T> {
    /// S \[N·m\]: bound on limsup `|s|`, and on limsup `lambda·|z|`.
    pub s: T,
    /// 2·S \[N·m\]: bound on limsup `|e|`.
    pub bound: T,
}

impl<T: Real> PeakContinuous<T> {
    /// The certificate of an adaptive law with a plant.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with the invalid part of the plant.
    /// [`Error::Inadmissible`] with the violated assumption, or if no bound exists because the
    /// bounds on the estimates are too wide or k is too small.
    pub fn try_new<const N: usize>(
        law: &Adaptive<T, N>,
        plant: &Plant<T, N>,
    ) -> Result<Self, Error> {
        let case = Case::try_new(law, plant)?.published()?;
        let settings = law.settings();
        let g = case.loop_gain()?;
        let squared = settings.lambda * settings.lambda;
        // g·kappa is linear in g on either side of the kink, so least at one of three.
        let kink = squared / (T::one() + squared);
        let ends = [g.low, kink.max(g.low).min(g.high), g.high];
        let each = ends.map(|g| g_kappa(settings.gain, squared, g));
        let stiffness = each.into_iter().fold(T::infinity(), T::min);
        if stiffness <= T::zero() {
            return Err(Error::Inadmissible("k > 1/lambda² - 2*(1/g - 1)"));
        }
        let s = bounded(case.push(g, plant.reference) / stiffness)?;
        Ok(Self {
            s,
            bound: bounded(T::from_f64(2.0) * s)?,
        })
    }

    /// The bound 2·S as a certificate.
    #[must_use]
    pub fn certificate(&self) -> Certificate<T> {
        Certificate::new(Kind::PeakContinuous, self.bound)
    }
}

/// g·kappa(g).
fn g_kappa<T: Real>(gain: T, squared: T, g: T) -> T {
    let inverse = T::one() / squared;
    if g * (T::one() + squared) <= squared {
        g * (gain + inverse)
    } else {
        g * (gain - inverse) + T::from_f64(2.0) * (T::one() - g)
    }
}
