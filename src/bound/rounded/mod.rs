//! The box theorem for the shipped step: every rounding included.

mod estimates;
mod gains;
mod inequalities;
mod roundings;

pub use inequalities::{Inequality, Named};
pub use roundings::Roundings;

use super::dyadic::Enclosure;
use super::{Certificate, Kind, Plant};
use crate::control::{Adaptive, AdaptiveSettings};
use crate::{Error, Real};
use gains::Gains;

/// The box theorem of the lag form, for the step as it is shipped, with every rounding.
///
/// [`PeakSampled`](super::PeakSampled) is about exact numbers. This is about the floats of
/// the controller: let `|s| <= S`, `|z| <= Z`, and let the sums of z and of the command owe
/// no more than their last addition lost. If the nine [`inequalities`](Self::inequalities)
/// hold, all of that holds after every step too, and `|e| <= S + lambda·Z` at every sample,
/// for `f32` and `f64`. Each inequality is computed in integers, rounded outwards: what is
/// proved here needs no trust in a float. It needs no heap, so that a controller can check
/// its own gains at start-up; its time on a microcontroller is not measured.
///
/// *Proof.* The exact step keeps the box with room to spare, as in
/// [`PeakSampled`](super::PeakSampled); the [`Roundings`] are less than the room. The theorem
/// over the reals is `theorems/Box.v`.
///
/// **A limit that may be met.** The eighth inequality says that the box needs no command beyond
/// the limit. Where it fails, the three of [`at_the_limit`](Self::at_the_limit) will do: a limit
/// that holds the reference against the load cuts a command, z waits, and the box is the same
/// (`theorems/Limit.v`).
///
/// **A slew rate must not be met.** Where the law has one, [`slew`](Self::slew) says that no step
/// from the box moves the command by as much as it allows (`theorems/Slew.v`).
///
/// Assumed beside: the plant `y = alpha·u - theta'x - D` without dynamics, where y is as the
/// controller reads it: what the sensor rounds is part of D and counts in its rate; `dt` is
/// the form's step at every sample; the next reference is the one that comes; no feed-forward;
/// no sample is bad; the errors start in the box. The truth need not lie in the boxes, and the
/// estimates may move in theirs as they like.
///
/// ```
/// use bowden::bound::{PeakRounded, Plant};
/// use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Form, Limits};
/// let lag = Form::Lag { step: 0.001, plant_gain: 1.0 };
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
    /// S \[N·m\]: the box of s. The least that is proved, to 2^-14 of itself.
    pub s: Enclosure,
    /// Z \[N·m·s\]: the box of z.
    pub z: Enclosure,
    /// W \[N·m\]: greatest `|(g-1)·(r + r'/lambda) + (g·theta_hat - theta)'x - D|`.
    pub w: Enclosure,
    /// Xi \[N·m/s\]: greatest rate of `D + theta'x`.
    pub xi: Enclosure,
    /// Least and greatest g = alpha·beta_hat.
    pub g: [Enclosure; 2],
    /// S + lambda·Z \[N·m\].
    pub error: Enclosure,
    /// What one step rounds.
    pub roundings: Roundings,
    /// The nine inequalities, in the order of [`Named`].
    pub inequalities: [Inequality; 9],
    /// What stands for [`Named::Command`] where that one fails.
    pub at_the_limit: [Inequality; 3],
    /// That the slew rate is not met; `None` where the law has none.
    pub slew: Option<Inequality>,
}

/// Doublings and halvings of the search for S.
const DOUBLINGS: u32 = 20;
const HALVINGS: u32 = 80;

impl PeakRounded {
    /// The certificate of a law on a plant.
    ///
    /// # Errors
    /// Those of [`examine`](Self::examine), and [`Error::Inadmissible`] with the first
    /// inequality that does not hold.
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

    /// The inequalities at the least S that they allow, whether all of them hold or not.
    ///
    /// Of settings, since [`Adaptive::try_new`] refuses some that fail. Where no S will do,
    /// they stand at the S that exact numbers would need.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::OutOfRange`] or [`Error::Inadmissible`] where settings
    /// or plant are such that no inequality can be stated; [`Error::Capacity`] for more than
    /// 16 regressors.
    pub fn examine<T: Real, const N: usize>(
        settings: &AdaptiveSettings<T, N>,
        plant: &Plant<f64, N>,
    ) -> Result<Self, Error> {
        let gains = Gains::try_new(settings, plant)?;
        let mut high = Enclosure::ONE;
        let mut doublings = 0;
        while !Self::at(&gains, high).grows_into() {
            high = high + high;
            doublings += 1;
            if doublings > DOUBLINGS {
                return Ok(Self::at(&gains, gains.exact_box()));
            }
        }
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

    /// Whether all inequalities hold, that of a slew rate too, or of [`Named::Command`] what
    /// stands for it.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        self.refused().is_none()
    }

    /// Whether the limit of the command may be met in the box: [`Named::Command`] fails.
    #[must_use]
    pub fn may_meet_the_limit(&self) -> bool {
        let mut fails = self.inequalities.iter().filter(|it| !it.holds());
        fails.any(|it| it.name == Named::Command)
    }

    /// The first inequality that does not hold; of a limit that may be met
    /// [`Named::Reserve`], where it is that which fails.
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

    /// S + lambda·Z \[N·m\]: `|e|` at every sample; not below it as a real number.
    #[must_use]
    pub fn bound(&self) -> f64 {
        let nearest = self.error.high().as_f64();
        nearest + libm::fabs(nearest) * f64::EPSILON
    }

    /// The bound as a certificate.
    #[must_use]
    pub fn certificate(&self) -> Certificate<f64> {
        Certificate {
            kind: Kind::PeakRounded,
            value: self.bound(),
        }
    }

    /// Whether the inequalities hold that a greater S can mend.
    fn grows_into(&self) -> bool {
        // The step's own two are the same at every S, the last three are lost with a greater one.
        let [_, _, z, stiff, s, owed, ..] = &self.inequalities;
        [z, stiff, s, owed]
            .iter()
            .all(|inequality| inequality.holds())
    }
}
