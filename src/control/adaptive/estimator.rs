//! Adaptation of one estimate: gain, leakage, bounds.

use crate::control::law;
use crate::signal::Compensated;
use crate::Real;

crate::data! {
    /// Leakage of an estimate towards its prior, to prevent drift.
    pub enum Leakage<T> {
        /// No leakage: only the bounds limit the estimate.
        None,
        /// Constant leakage at `rate` \[1/s\], the sigma in (24) to (26).
        Constant {
            /// Leakage rate \[1/s\], not negative.
            rate: T,
        },
        /// Leakage only while the estimate differs from its prior by more than `bound` (Remark 1).
        ///
        /// The leakage rate rises from zero at `bound` to `rate` at twice this distance. This is
        /// the switching sigma-modification of P. Ioannou, J. Sun, *Robust Adaptive Control*,
        /// 8.4.1. It causes no bias if the true value lies within `bound` of the prior.
        Switching {
            /// Leakage rate beyond twice the distance `bound` \[1/s\], not negative.
            rate: T,
            /// Distance from the prior up to which there is no leakage \[unit of the estimate\],
            /// positive.
            bound: T,
        },
    }
}

impl<T: Real> Leakage<T> {
    /// The leakage rate \[1/s\] at a distance from the prior \[unit of the estimate\].
    ///
    /// ```
    /// use bowden::control::Leakage;
    /// let leakage = Leakage::Switching { rate: 0.1, bound: 2.0 };
    /// assert_eq!(leakage.rate_at(-2.0), 0.0);
    /// assert_eq!(leakage.rate_at(3.0), 0.05);
    /// assert_eq!(leakage.rate_at(9.0), 0.1);
    /// ```
    #[inline]
    #[must_use]
    pub fn rate_at(&self, distance: T) -> T {
        match *self {
            Self::None => T::zero(),
            Self::Constant { rate } => rate,
            Self::Switching { rate, bound } => {
                let excess = distance.abs() / bound - T::one();
                if excess <= T::zero() {
                    T::zero()
                } else if excess < T::one() {
                    rate * excess
                } else {
                    rate
                }
            }
        }
    }

    /// The largest leakage rate \[1/s\].
    #[must_use]
    pub const fn rate(&self) -> T {
        match *self {
            Self::None => T::ZERO,
            Self::Constant { rate } | Self::Switching { rate, .. } => rate,
        }
    }
}

crate::data! {
    /// Adaptation of one estimate `p`: equations (24) to (26) in discrete time, with bounds.
    ///
    /// The update is `p⁺ = (p + h·(gain·v + sigma·prior))/(1 + h·sigma)`, clamped to `[low, high]`.
    /// Here v is the driving term (`-lambda·s·x` for a regressor x). The leakage is implicit, so it
    /// cannot overshoot at any rate. The steady state of the estimate, `prior + gain·v/sigma`, does
    /// not depend on h. Compensated summation prevents slow leakage from being lost to rounding in
    /// `f32`.
    ///
    /// ```
    /// use bowden::control::{Estimator, Leakage};
    /// // Viscous friction [N·m·s/rad]: 2.7 from the bench, bounds 0 and 6.
    /// let velocity = Estimator {
    ///     gain: 5e-4,
    ///     leakage: Leakage::Constant { rate: 0.01 },
    ///     prior: 2.7,
    ///     ..Estimator::fixed(2.7).within(0.0, 6.0)
    /// };
    /// assert_eq!((velocity.initial, velocity.low, velocity.high), (2.7, 0.0, 6.0));
    /// ```
    #[cfg_attr(feature = "serde", serde(default))]
    pub struct Estimator<T: Real> {
        /// Initial value of the estimate \[unit of the estimate\], within the bounds.
        pub initial: T,
        /// Lower bound \[unit of the estimate\].
        pub low: T,
        /// Upper bound \[unit of the estimate\].
        pub high: T,
        /// Adaptation gain: gamma, mu or mu_i in (24) to (26), not negative.
        pub gain: T,
        /// Leakage to the prior.
        pub leakage: Leakage<T>,
        /// Prior: the value towards which the estimate leaks \[unit of the estimate\]; zero in
        /// Nguyen et al. (2018).
        pub prior: T,
    }
}

impl<T: Real> Estimator<T> {
    /// A constant estimate: both bounds equal this value.
    pub const fn fixed(value: T) -> Self {
        Self {
            initial: value,
            low: value,
            high: value,
            gain: T::ZERO,
            leakage: Leakage::None,
            prior: T::ZERO,
        }
    }

    /// An estimate without bounds, as in the paper: only the leakage limits it.
    pub const fn free(initial: T) -> Self {
        Self::fixed(initial).within(T::LOWEST, T::HIGHEST)
    }

    /// Sets the bounds \[unit of the estimate\].
    #[must_use]
    pub const fn within(self, low: T, high: T) -> Self {
        Self { low, high, ..self }
    }

    /// Sets the adaptation gain and a constant leakage rate \[1/s\].
    ///
    /// An estimate with a gain requires `low < high`. Set the bounds with [`within`](Self::within),
    /// or start from [`free`](Self::free).
    #[must_use]
    pub const fn adapting(self, gain: T, leakage: T) -> Self {
        let leakage = Leakage::Constant { rate: leakage };
        Self {
            gain,
            leakage,
            ..self
        }
    }

    /// Whether a value \[unit of the estimate\] lies within the bounds; false for NaN.
    #[must_use]
    pub fn contains(&self, value: T) -> bool {
        self.low <= value && value <= self.high
    }

    /// The estimate after `dt` \[s\] with the driving term `v`, within its bounds. If the estimate
    /// overflows, its carry is not finite.
    #[inline]
    pub(crate) fn update(&self, p: Compensated<T>, dt: T, v: T) -> Compensated<T> {
        let increment = self.increment(p.value - self.prior, dt, v);
        p.plus(increment).within(self.low, self.high)
    }

    /// The increment of an estimate at a `distance` from its prior.
    ///
    /// `(p + h·(m·v + sigma·prior))/(1 + h·sigma) - p`, without the cancellation.
    #[inline]
    pub(super) fn increment(&self, distance: T, dt: T, v: T) -> T {
        let sigma = self.leakage.rate_at(distance);
        law::estimate_increment(dt, self.gain, v, sigma, distance)
    }

    /// Whether updates can produce this estimate.
    pub(super) fn holds(&self, estimate: &Compensated<T>) -> bool {
        self.contains(estimate.value) && estimate.carry.is_finite()
    }
}

impl<T: Real> Default for Estimator<T> {
    /// Fixed at zero.
    fn default() -> Self {
        Self::fixed(T::zero())
    }
}

/// Names of an estimator's fields in an error: initial, low, high, gain, leakage, its bound, prior,
/// and the condition on an estimate that adapts.
pub(super) type Names = [&'static str; 8];

macro_rules! names {
    ($of:literal) => {
        [
            concat!($of, ".initial"),
            concat!($of, ".low"),
            concat!($of, ".high"),
            concat!($of, ".gain"),
            concat!($of, ".leakage"),
            concat!($of, ".leakage.bound"),
            concat!($of, ".prior"),
            concat!($of, ": an adaptive estimate needs low < high"),
        ]
    };
}

pub(super) const BETA: Names = names!("beta");
pub(super) const DELTA: Names = names!("delta");
pub(super) const THETA: Names = names!("theta");
