//! Known ranges of the plant (11), `y = alpha·u - theta'x - D`.

use super::Interval;
use crate::checked::not_negative;
use bowden::{Error, Real};

/// Known ranges of one regressor and its coefficient.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Known<T> {
    /// Interval of theta_i \[N·m/unit of the regressor\].
    pub theta: Interval<T>,
    /// Largest `|x_i|` \[unit of the regressor\], for peak and sampled certificates only.
    pub magnitude: T,
    /// Largest rate of x_i \[unit/s\], for sampled certificates only.
    pub rate: T,
}

/// Known ranges of the plant, its disturbance and its reference. They are the input of every
/// certificate.
///
/// ```
/// use bowden_bound::{Interval, Plant};
/// let plant = Plant {
///     alpha: Interval { low: 0.95, high: 1.05 },
///     reference: 38.0,      // [N·m]
///     reference_rate: 22.3, // [N·m/s]
///     delta_rate: 45.7,     // [N·m/s]
///     ..Plant::<f64, 0>::new(1.0, 7.056)
/// };
/// assert_eq!(plant.delta, 7.056);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Plant<T, const N: usize> {
    /// Gain alpha = B·N·A \[N·m/command unit\], positive.
    pub alpha: Interval<T>,
    /// Bound Delta on `|D|` \[N·m\], which is `kappa_eta + |T0| + |d|` from (12).
    pub delta: T,
    /// Bound on the rate of D \[N·m/s\], for sampled certificates only.
    ///
    /// For the hysteresis, this rate is `kappa_eta·f/(B - kappa_eta·f)·|y'|`. Here
    /// `f = 2·sigma·rho` is the largest slope of eta versus tau_i, and
    /// `tau_i' = y'/(B - kappa_eta·f)` in the worst case. For example, the rate is 45.7 N·m/s for
    /// the first set of Nguyen et al. (2018) with sigma = 1/2, if y follows the reference of the
    /// paper (`|y_r'| <= 22.24 N·m/s`).
    pub delta_rate: T,
    /// Coefficients and regressors.
    pub regressors: [Known<T>; N],
    /// Largest `|y_r|` \[N·m\], for peak and sampled certificates only.
    pub reference: T,
    /// Largest `|y_r'|` \[N·m/s\], for sampled certificates only.
    pub reference_rate: T,
}

impl<T: Real, const N: usize> Plant<T, N> {
    /// A plant with a known alpha \[N·m/command unit\] and `|D| <= delta` \[N·m\]. All other fields
    /// are zero.
    #[must_use]
    pub fn new(alpha: T, delta: T) -> Self {
        Self {
            alpha: Interval::exactly(alpha),
            delta,
            delta_rate: T::zero(),
            regressors: [Known::default(); N],
            reference: T::zero(),
            reference_rate: T::zero(),
        }
    }

    /// Rejects values that cannot describe a plant.
    pub(super) fn check(&self) -> Result<(), Error> {
        self.alpha.above_zero("alpha")?;
        not_negative(self.delta, "delta")?;
        not_negative(self.delta_rate, "delta_rate")?;
        not_negative(self.reference, "reference")?;
        not_negative(self.reference_rate, "reference_rate")?;
        for known in &self.regressors {
            known.theta.ordered("theta")?;
            not_negative(known.magnitude, "magnitude")?;
            not_negative(known.rate, "rate")?;
        }
        Ok(())
    }

    /// Sum of `|theta_i|` times what `of` takes from regressor i.
    pub(super) fn weighted(&self, of: impl Fn(&Known<T>) -> T) -> T {
        let each = self.regressors.iter();
        each.fold(T::zero(), |sum, known| {
            sum + known.theta.magnitude() * of(known)
        })
    }
}
