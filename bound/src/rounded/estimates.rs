//! Upper bounds on the numbers in an estimate's update, (24)-(26).

use crate::checked::finite;
use crate::dyadic::Enclosure;
use crate::truth::range;
use bowden::control::{Estimator, Leakage};
use bowden::{Error, Real};

/// Upper bounds on the adaptation of an estimate.
#[derive(Clone, Copy)]
pub(super) struct Adapts {
    gain: Enclosure,
    /// \[1/s\]
    leakage: Enclosure,
    /// Largest distance from the prior \[unit of the estimate\].
    distance: Enclosure,
    /// The distance divided by the bound of a switching leakage.
    bounds: Enclosure,
    /// Largest magnitude \[unit of the estimate\].
    most: Enclosure,
}

impl Adapts {
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `name`, if no number can be stated.
    pub(super) fn try_new<T: Real>(
        estimator: &Estimator<T>,
        frozen: bool,
        name: &'static str,
    ) -> Result<Self, Error> {
        let number = |x: T| Ok::<_, Error>(Enclosure::of(finite(x, name)?));
        let prior = number(estimator.prior)?;
        let range = range(estimator, frozen);
        let ends = [number(range.low)?, number(range.high)?];
        let farthest = |from: Enclosure| (ends[0] - from).abs().max((ends[1] - from).abs());
        let distance = farthest(prior);
        let bounds = match estimator.leakage {
            Leakage::Switching { bound, .. } if bound > T::ZERO => distance / number(bound)?,
            Leakage::Switching { .. } => return Err(Error::OutOfRange(name)),
            Leakage::None | Leakage::Constant { .. } => Enclosure::ZERO,
        };
        Ok(Self {
            gain: number(estimator.gain)?.abs(),
            leakage: number(estimator.leakage.rate())?.abs(),
            distance,
            bounds,
            most: farthest(Enclosure::ZERO),
        })
    }

    /// A sum of which every number of the update is a part, or a part less a factor below one.
    ///
    /// The lines follow `Estimator::update` with an input of at most `drive`, over `step`
    /// \[s\]. They are the distance, the rate of the leakage, the input and leakage terms,
    /// their share in a step, and the sum.
    pub(super) fn numbers(&self, drive: Enclosure, step: Enclosure) -> Enclosure {
        let one = Enclosure::ONE;
        let rate = self.gain * drive + self.leakage * self.distance;
        let leakage = self.leakage * (one + step);
        let from = self.distance + self.bounds + self.most;
        one + from + leakage + drive + rate * (one + step)
    }
}
