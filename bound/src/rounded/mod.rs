//! The box theorem for the shipped step, with all rounding errors.

mod gains;
mod inequalities;
mod roundings;

pub use inequalities::{Inequality, Named};
pub use roundings::Roundings;

use super::dyadic::Enclosure;
use super::{Certificate, Kind, Plant};
use bowden::control::{Adaptive, AdaptiveSettings};
use bowden::{Error, Real};
use gains::Gains;

/// The box theorem of the first-order form for the shipped step, with all rounding errors.
///
/// [`PeakSampled`](super::PeakSampled) applies to exact numbers. This theorem applies to the floats
/// of the controller. Let `|s| <= S` and `|z| <= Z`, and let the carries of the sums of z and of
/// the command be at most the rounding error of their last addition. If the nine
/// [`inequalities`](Self::inequalities) hold, these conditions also hold after every step. Then
/// `|e| <= S + lambda·Z` at every sample, for `f32` and `f64`.
///
/// Each inequality is computed in integers, rounded outwards, so the proof does not rely on
/// floating-point arithmetic. The computation needs no heap, so a controller can check its own
/// gains at start-up. The computing time on a microcontroller has not been measured.
///
/// *Proof.* The exact step stays in the box with a margin, as in
/// [`PeakSampled`](super::PeakSampled). The rounding errors ([`Roundings`]) are smaller than the
/// margin. The theorem over the reals is `theorems/Box.v`.
///
/// **Command limits that may be active.** By the eighth inequality, no command in the box exceeds
/// the limits. If this inequality fails, the three inequalities of
/// [`at_the_limit`](Self::at_the_limit) are sufficient instead. While the command saturates, z does
/// not move further towards the limit. If the limits allow a command that holds the reference
/// against the load, the box is the same (`theorems/Limit.v`).
///
/// **A slew-rate limit must not be active.** By the inequality [`slew`](Self::slew), every step
/// from the box changes the command by less than the slew-rate limit allows (`theorems/Slew.v`).
///
/// Further assumptions:
/// - the plant is `y = alpha·u - theta'x - D` without dynamics, where y is the value that the
///   controller reads (the quantisation of the sensor is part of D and of its rate);
/// - `dt` is the step of the form at every sample;
/// - the next reference that the controller receives is correct;
/// - there is no feed-forward;
/// - no sample is bad;
/// - the initial errors are in the box.
///
/// The true values need not lie within the bounds on the estimates, and the estimates may move
/// freely within their bounds.
///
/// ```
/// use bowden_bound::{PeakRounded, Plant};
/// use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Form, Limits};
/// let lag = Form::FirstOrder { step: 0.001, plant_gain: 1.0 };
/// let law = Adaptive::try_new(AdaptiveSettings {
///     beta: Estimator::free(1.0).within(0.8, 1.2).adapting(2.5e-4, 0.01),
///     delta: Estimator::free(1.0).within(0.0, 4.0).adapting(0.00625, 0.01),
///     limits: Limits::try_new(-60.0, 60.0)?,
///     ..AdaptiveSettings::<f32, 0>::unlimited(lag, 24.0, 8.0, 0.05)
/// })?;
/// let plant = Plant { reference: 10.0, ..Plant::new(1.0, 6.0) }; // [N·m], always f64
/// let proved = PeakRounded::try_new(&law, &plant)?;
/// assert!((proved.bound() - 0.8347).abs() < 1e-3); // [N·m]
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PeakRounded {
    /// S \[N·m\]: the bound on `|s|`. This is the smallest value for which the proof succeeds, to a
    /// relative accuracy of 2^-14.
    pub s: Enclosure,
    /// Z \[N·m·s\]: the bound on `|z|`.
    pub z: Enclosure,
    /// W \[N·m\]: largest `|(g-1)·(r + r'/lambda) + (g·theta_hat - theta)'x - D|`.
    pub w: Enclosure,
    /// Xi \[N·m/s\]: largest rate of `D + theta'x`.
    pub xi: Enclosure,
    /// Minimum and maximum of g = alpha·beta_hat.
    pub g: [Enclosure; 2],
    /// S + lambda·Z \[N·m\].
    pub error: Enclosure,
    /// The rounding errors of one step.
    pub roundings: Roundings,
    /// The nine inequalities, in the order of [`Named`].
    pub inequalities: [Inequality; 9],
    /// The inequalities that replace [`Named::Command`] if it fails.
    pub at_the_limit: [Inequality; 3],
    /// The slew-rate inequality; `None` if the law has no slew-rate limit.
    pub slew: Option<Inequality>,
}

/// Number of doublings and halvings in the search for S.
const DOUBLINGS: i32 = 20;
const HALVINGS: u32 = 80;

impl PeakRounded {
    /// The certificate of an adaptive law with a plant.
    ///
    /// # Errors
    /// The same as [`examine`](Self::examine), and [`Error::Inadmissible`] with the first violated
    /// inequality.
    pub fn try_new<T: Real, const N: usize>(
        law: &Adaptive<T, N>,
        plant: &Plant<f64, N>,
    ) -> Result<Self, Error> {
        let examined = Self::examine(law.settings(), plant)?;
        match examined.refused() {
            None => Ok(examined),
            Some(inequality) => Err(Error::Inadmissible(inequality.name.text())),
        }
    }

    /// The inequalities at the smallest S that they allow, even if some do not hold.
    ///
    /// The argument is a settings struct, because [`Adaptive::try_new`] rejects some settings for
    /// which an inequality fails. If no S is sufficient, the inequalities are evaluated at the S
    /// for exact numbers.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::OutOfRange`] or [`Error::Inadmissible`] if no inequality can
    /// be formed for these settings and this plant. [`Error::Capacity`] for more than 16
    /// regressors.
    pub fn examine<T: Real, const N: usize>(
        settings: &AdaptiveSettings<T, N>,
        plant: &Plant<f64, N>,
    ) -> Result<Self, Error> {
        let gains = Gains::try_new(settings, plant)?;
        let mut doubled = (0..=DOUBLINGS).map(Enclosure::power);
        let Some(mut high) = doubled.find(|s| Self::at(&gains, *s).grows_into()) else {
            return Ok(Self::at(&gains, gains.exact_box()));
        };
        let mut low = Enclosure::ZERO;
        for _ in 0..HALVINGS {
            if (high - low).is_at_most(high * Enclosure::power(-14)) {
                break;
            }
            let middle = (low + high) * Enclosure::power(-1);
            if Self::at(&gains, middle).grows_into() {
                high = middle;
            } else {
                low = middle;
            }
        }
        Ok(Self::at(&gains, high))
    }

    /// Whether all inequalities hold, including the slew-rate inequality. The three inequalities
    /// [`at_the_limit`](Self::at_the_limit) may replace [`Named::Command`].
    #[must_use]
    pub fn is_proved(&self) -> bool {
        self.refused().is_none()
    }

    /// Whether the command may saturate in the box, because [`Named::Command`] fails.
    #[must_use]
    pub fn may_meet_the_limit(&self) -> bool {
        let mut fails = self.inequalities.iter().filter(|it| !it.holds());
        fails.any(|it| it.name == Named::Command)
    }

    /// The first violated inequality. If the command may saturate, this is [`Named::Reserve`], if
    /// that inequality fails.
    #[must_use]
    pub fn refused(&self) -> Option<&Inequality> {
        let [reserve, waiting, slack] = &self.at_the_limit;
        let waits = waiting.holds() && slack.holds();
        let instead = |it: &Inequality| it.name == Named::Command && waits && reserve.holds();
        let mut all = self.inequalities.iter().chain(&self.slew);
        let first = all.find(|it| !it.holds() && !instead(it))?;
        let is_reserve = first.name == Named::Command && waits;
        Some(if is_reserve { reserve } else { first })
    }

    /// The bound S + lambda·Z \[N·m\] on `|e|` at every sample, never rounded down.
    #[must_use]
    pub fn bound(&self) -> f64 {
        let nearest = self.error.high.as_f64();
        nearest + libm::fabs(nearest) * f64::EPSILON
    }

    /// The bound as a certificate.
    #[must_use]
    pub fn certificate(&self) -> Certificate<f64> {
        Certificate::new(Kind::PeakRounded, self.bound())
    }

    /// Whether all inequalities hold that a larger S can satisfy.
    fn grows_into(&self) -> bool {
        // Two inequalities of the step are the same at every S; a greater S violates the last
        // three.
        let [_, _, z, stiff, s, owed, ..] = &self.inequalities;
        [z, stiff, s, owed]
            .iter()
            .all(|inequality| inequality.holds())
    }
}
