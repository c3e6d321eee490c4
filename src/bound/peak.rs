//! The peak certificate in continuous time.

use super::truth::{bounded, literal, loop_gain, mismatch};
use super::{Certificate, Interval, Kind, Plant};
use crate::control::Adaptive;
use crate::{Error, Real};

/// Peak of the error in continuous time, where the estimates have boxes.
///
/// With `g = alpha·beta_hat` and `w = (g-1)·y_r + (g·theta_hat - theta)'x - D` the
/// literal law is `s' = (lambda/g)·(w - g·delta_hat·T(s/eps)) - lambda·(k - 1 + 1/g)·s -
/// (1 + lambda²·(1 - 1/g))·z`, `z' = s - lambda·z`. On the box `|s| <= S`,
/// `|z| <= S/lambda` the worst corner is that where z pushes s out, so the box is invariant
/// and attractive for `S = sup |w|/(g·kappa)`, where kappa is `k + 1/lambda²` if `g <=
/// lambda²/(1 + lambda²)`, else `k - 1/lambda² + 2·(1/g - 1)`. Then `|e| <= |s| +
/// lambda·|z| <= 2·S`.
///
/// Assumed: the literal form in continuous time with e' known; the plant (11) with
/// alpha, theta in the stated intervals, `|D| <= Delta`, `|y_r|` and `|x_i|` within what is
/// stated; beta_hat's box above zero, delta_hat's not below; no limit met. The truth
/// need not lie in the boxes; the estimates may do in them what they like.
///
/// ```
/// use bowden::bound::{PeakContinuous, Plant};
/// use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Form};
/// let literal = Form::Literal { time_constant: 0.005 };
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
    /// S \[N·m\]: limsup of `|s|`, and of lambda·`|z|`.
    pub s: T,
    /// 2·S \[N·m\]: limsup of `|e|`.
    pub bound: T,
}

impl<T: Real> PeakContinuous<T> {
    /// The certificate of a law on a plant.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::OutOfRange`] with what is wrong with the plant;
    /// [`Error::Inadmissible`] with the assumption that does not hold, or where the
    /// boxes are too wide or k is too small for a bound.
    pub fn try_new<const N: usize>(
        law: &Adaptive<T, N>,
        plant: &Plant<T, N>,
    ) -> Result<Self, Error> {
        plant.check()?;
        literal(law)?;
        let settings = law.settings();
        let g = loop_gain(law, plant)?;
        let squared = settings.lambda * settings.lambda;
        // g·kappa is linear in g on either side of the kink, so least at one of three.
        let kink = squared / (T::one() + squared);
        let mut stiffness = g_kappa(settings.gain, squared, g.low);
        for at in [kink, g.high] {
            if g.low <= at && at <= g.high {
                let here = g_kappa(settings.gain, squared, at);
                if here < stiffness {
                    stiffness = here;
                }
            }
        }
        if stiffness <= T::zero() {
            return Err(Error::Inadmissible("k > 1/lambda² - 2*(1/g - 1)"));
        }
        let s = bounded(push(law, plant, g, plant.reference) / stiffness)?;
        Ok(Self {
            s,
            bound: bounded(T::of(2.0) * s)?,
        })
    }

    /// 2·S as a certificate.
    #[must_use]
    pub fn certificate(&self) -> Certificate<T> {
        Certificate {
            kind: Kind::PeakContinuous,
            value: self.bound,
        }
    }
}

/// g·kappa(g).
fn g_kappa<T: Real>(gain: T, squared: T, g: T) -> T {
    let inverse = T::one() / squared;
    if g * (T::one() + squared) <= squared {
        g * (gain + inverse)
    } else {
        g * (gain - inverse) + T::of(2.0) * (T::one() - g)
    }
}

/// Greatest `|w| = |(g-1)·reference + (g·theta_hat - theta)'x - D|` \[N·m\].
pub(super) fn push<T: Real, const N: usize>(
    law: &Adaptive<T, N>,
    plant: &Plant<T, N>,
    g: Interval<T>,
    reference: T,
) -> T {
    let detuning = g.furthest_from(T::one());
    // With no reference, an unbounded g does no harm: 0·inf would be NaN.
    let reference = if reference == T::zero() {
        T::zero()
    } else {
        detuning * reference
    };
    reference + mismatch(law, plant, g) + plant.delta
}
