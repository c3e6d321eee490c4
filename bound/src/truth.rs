//! Ranges of the estimates, and the distance of the true values from their priors.

use super::{Interval, Plant};
use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Form, Leakage};
use bowden::{Error, Real};

/// One estimate in the Lyapunov function, and its true value.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Adapting<T: Real> {
    pub(super) estimator: Estimator<T>,
    pub(super) truth: Interval<T>,
}

impl<T: Real> Adapting<T> {
    /// The same estimate with this true value.
    pub(super) fn aimed_at(self, truth: T) -> Self {
        let truth = Interval::exactly(truth);
        Self { truth, ..self }
    }

    /// Largest `(p* - prior)²`.
    pub(super) fn distance_squared(&self) -> T {
        let distance = self.truth.max_distance_from(self.estimator.prior);
        distance * distance
    }

    /// Largest `(sigma/m)·(p_hat - prior)·(p* - p_hat)` over every p_hat.
    pub(super) fn residue(&self) -> T {
        let Estimator { gain, leakage, .. } = self.estimator;
        if let Leakage::Switching { bound, .. } = leakage {
            // It leaks only from beyond the true value, and towards the true value.
            if self.truth.max_distance_from(self.estimator.prior) <= bound {
                return T::zero();
            }
        }
        leakage.rate() * self.distance_squared() / (T::from_f64(4.0) * gain)
    }

    /// Largest initial `(p* - p_hat)²/(2·m)`.
    pub(super) fn at_start(&self) -> T {
        let distance = self.truth.max_distance_from(self.estimator.initial);
        distance * distance / (T::from_f64(2.0) * self.estimator.gain)
    }
}

/// The estimates beta_hat, delta_hat and theta_hat.
pub(super) fn estimators<T: Real, const N: usize>(
    settings: &AdaptiveSettings<T, N>,
) -> impl Iterator<Item = &Estimator<T>> {
    let two = [&settings.beta, &settings.delta];
    two.into_iter().chain(&settings.theta)
}

/// The error if the leakage of an estimate is not constant.
pub(super) const VARYING: Error =
    Error::Inadmissible("the leakage of every estimate must be constant");

/// Whether an estimate is constant at its initial value.
fn stays<T: Real>(estimator: &Estimator<T>, frozen: bool) -> bool {
    let idle = estimator.gain == T::zero() && estimator.leakage.rate() == T::zero();
    frozen || idle
}

/// Range of an estimate.
pub(super) fn range<T: Real>(estimator: &Estimator<T>, frozen: bool) -> Interval<T> {
    if stays(estimator, frozen) {
        Interval::exactly(estimator.initial)
    } else {
        Interval {
            low: estimator.low,
            high: estimator.high,
        }
    }
}

/// An adaptive law with a plant.
pub(super) struct Case<'a, T: Real, const N: usize> {
    pub(super) settings: &'a AdaptiveSettings<T, N>,
    pub(super) plant: &'a Plant<T, N>,
}

impl<'a, T: Real, const N: usize> Case<'a, T, N> {
    pub(super) fn try_new(law: &'a Adaptive<T, N>, plant: &'a Plant<T, N>) -> Result<Self, Error> {
        plant.check()?;
        let settings = law.settings();
        Ok(Self { settings, plant })
    }

    /// A law of the form as published, which the continuous certificates require.
    pub(super) fn published(self) -> Result<Self, Error> {
        match self.settings.form {
            Form::AsPublished { .. } => Ok(self),
            Form::FirstOrder { .. } => Err(Error::Inadmissible(
                "the gains must have the form as published",
            )),
        }
    }

    /// The least of `rate` and the leakages of the estimates that adapt \[1/s\].
    ///
    /// An estimate at the true value is no part of V, and a lower one is refused elsewhere.
    ///
    /// # Errors
    /// [`VARYING`] for a leakage that is not constant and positive.
    pub(super) fn slowest(&self, mut rate: T) -> Result<T, Error> {
        let frozen = self.settings.frozen;
        for estimator in estimators(self.settings).filter(|own| !stays(own, frozen)) {
            match estimator.leakage {
                Leakage::Constant { rate: own } if own > T::zero() => rate = rate.min(own),
                _ => return Err(VARYING),
            }
        }
        Ok(rate)
    }

    /// Range of an estimate.
    pub(super) fn range(&self, estimator: &Estimator<T>) -> Interval<T> {
        range(estimator, self.settings.frozen)
    }

    /// The estimate's part of the Lyapunov function; `None` if it is constant at the true value.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] if it is constant at another value, leaks without a gain, or its
    /// bounds do not contain the true value.
    fn adapting(
        &self,
        estimator: &Estimator<T>,
        truth: Interval<T>,
    ) -> Result<Option<Adapting<T>>, Error> {
        let refused = |why| Err(Error::Inadmissible(why));
        if stays(estimator, self.settings.frozen) {
            // An error of rounding alone counts as the true value.
            let rounding = T::from_f64(4.0) * T::epsilon() * truth.magnitude();
            if truth.max_distance_from(estimator.initial) <= rounding {
                return Ok(None);
            }
            return refused("an estimate must adapt or be the truth");
        }
        if estimator.gain == T::zero() {
            return refused("an estimate that leaks must have a gain");
        }
        if !(estimator.contains(truth.low) && estimator.contains(truth.high)) {
            return refused("each box must contain the truth");
        }
        let estimator = *estimator;
        Ok(Some(Adapting { estimator, truth }))
    }

    /// [`adapting`](Self::adapting) for delta_hat with this target.
    pub(super) fn delta(&self, target: T) -> Result<Option<Adapting<T>>, Error> {
        self.adapting(&self.settings.delta, Interval::exactly(target))
    }

    /// Sum of `of` over beta, weighted by alpha, and the thetas.
    ///
    /// Each term is the worst case over the intervals of the plant. With beta* = 1/alpha, the term
    /// of beta is proportional to `alpha·(1/alpha - p)²`. This expression is convex in alpha, so
    /// the worst case is at an end of the interval.
    pub(super) fn sum(&self, of: impl Fn(&Adapting<T>) -> T) -> Result<T, Error> {
        let mut worst = T::zero();
        for alpha in [self.plant.alpha.low, self.plant.alpha.high] {
            let truth = Interval::exactly(T::one() / alpha);
            if let Some(beta) = self.adapting(&self.settings.beta, truth)? {
                worst = worst.max(alpha * of(&beta));
            }
        }
        self.add_thetas(worst, of)
    }

    /// `sum` plus `of` each theta.
    pub(super) fn add_thetas(
        &self,
        mut sum: T,
        of: impl Fn(&Adapting<T>) -> T,
    ) -> Result<T, Error> {
        for (theta, known) in self.settings.theta.iter().zip(&self.plant.regressors) {
            if let Some(theta) = self.adapting(theta, known.theta)? {
                sum += of(&theta);
            }
        }
        Ok(sum)
    }

    /// `W·epsilon·lambda`: what the smoothed sign function adds to phi per target.
    pub(super) fn smoothing(&self) -> T {
        let settings = self.settings;
        settings.smooth_sign.residue::<T>() * settings.epsilon * settings.lambda
    }

    /// Minimum and maximum of `g = alpha·beta_hat`.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] if g may not be positive, or if delta_hat may be negative.
    pub(super) fn loop_gain(&self) -> Result<Interval<T>, Error> {
        if self.range(&self.settings.delta).low < T::zero() {
            return Err(Error::Inadmissible("delta.low >= 0"));
        }
        let beta = self.range(&self.settings.beta);
        if beta.low <= T::zero() {
            return Err(Error::Inadmissible("beta.low > 0"));
        }
        Ok(Interval {
            low: self.plant.alpha.low * beta.low,
            high: self.plant.alpha.high * beta.high,
        })
    }

    /// Largest `|w| = |(g-1)·reference + (g·theta_hat - theta)'x - D|` for a loop gain in `g`
    /// \[N·m\].
    pub(super) fn push(&self, g: Interval<T>, reference: T) -> T {
        let mut mismatch = T::zero();
        for (theta, known) in self.settings.theta.iter().zip(&self.plant.regressors) {
            let estimate = self.range(theta);
            let mut worst = T::zero();
            for g in [g.low, g.high] {
                for estimate in [estimate.low, estimate.high] {
                    worst = worst.max(known.theta.max_distance_from(g * estimate));
                }
            }
            mismatch += scaled(worst, known.magnitude);
        }
        scaled(g.max_distance_from(T::one()), reference) + mismatch + self.plant.delta
    }
}

/// A factor that may be infinite times a signal. A signal that is always zero has any factor: 0·inf
/// would be NaN.
fn scaled<T: Real>(factor: T, signal: T) -> T {
    if signal == T::zero() {
        T::zero()
    } else {
        factor * signal
    }
}

/// The value, or an error if it is not finite.
pub(super) fn bounded<T: Real>(value: T) -> Result<T, Error> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::Inadmissible(
            "the boxes must be narrow enough for a finite bound",
        ))
    }
}

/// The step \[s\] and the plant gain of the first-order form, which the sampled certificates require.
pub(super) fn first_order<T: Real, const N: usize>(
    settings: &AdaptiveSettings<T, N>,
) -> Result<[T; 2], Error> {
    match settings.form {
        Form::FirstOrder { step, plant_gain } => Ok([step, plant_gain]),
        _ => Err(Error::Inadmissible("the gains must be in first-order form")),
    }
}
