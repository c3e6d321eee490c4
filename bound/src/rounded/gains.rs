//! A law and a plant as exact numbers.

use super::roundings::Word;
use crate::checked::{above_zero, finite};
use crate::dyadic::Enclosure;
use crate::truth::{first_order, range};
use crate::{Interval, Plant};
use bowden::control::{AdaptiveSettings, Estimator, Leakage};
use bowden::{Error, Real};

/// Maximum number of regressors in a law that is examined.
pub(super) const MOST: usize = 16;

/// Upper bounds on the numbers in the update of an estimate, (24)-(26).
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
    fn try_new<T: Real>(
        estimator: &Estimator<T>,
        frozen: bool,
        name: &'static str,
    ) -> Result<Self, Error> {
        let number = |x: T| Ok::<_, Error>(Enclosure::of(finite(x, name)?));
        let prior = number(estimator.prior)?;
        let ends = ends(range(estimator, frozen), name)?;
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

/// One regressor.
#[derive(Clone, Copy)]
pub(super) struct Term {
    /// Largest `|theta_hat|`.
    pub(super) estimate: Enclosure,
    /// Largest `|theta|`.
    truth: Enclosure,
    /// Largest `|g·theta_hat - theta|`.
    mismatch: Enclosure,
    /// Largest `|x|`.
    pub(super) magnitude: Enclosure,
    rate: Enclosure,
    pub(super) adapts: Adapts,
}

/// All numbers of the inequalities.
pub(super) struct Gains {
    pub(super) word: Word,
    pub(super) gain: Enclosure,
    pub(super) lambda: Enclosure,
    pub(super) epsilon: Enclosure,
    pub(super) step: Enclosure,
    /// Minimum and maximum of alpha.
    pub(super) alpha: [Enclosure; 2],
    /// Largest beta_hat.
    pub(super) beta: Enclosure,
    /// Minimum and maximum of g = alpha·beta_hat.
    pub(super) g: [Enclosure; 2],
    /// Largest delta_hat.
    pub(super) delta: Enclosure,
    /// Upper bound on `T(s/epsilon)/s`.
    pub(super) slope: Enclosure,
    pub(super) z_limit: Enclosure,
    pub(super) command: Enclosure,
    /// Slew-rate limit, if there is one.
    pub(super) slew: Option<Enclosure>,
    pub(super) reference: Enclosure,
    pub(super) reference_rate: Enclosure,
    /// W \[N·m\].
    pub(super) w: Enclosure,
    /// Xi \[N·m/s\].
    pub(super) xi: Enclosure,
    /// Largest `|theta'x + D|`.
    pub(super) load: Enclosure,
    /// Adaptation of beta_hat and delta_hat.
    pub(super) adapts: [Adapts; 2],
    terms: [Option<Term>; MOST],
}

impl Gains {
    pub(super) fn regressors(&self) -> impl Iterator<Item = &Term> {
        self.terms.iter().flatten()
    }

    /// # Errors
    /// If no inequality can be stated.
    pub(super) fn try_new<T: Real, const N: usize>(
        settings: &AdaptiveSettings<T, N>,
        plant: &Plant<f64, N>,
    ) -> Result<Self, Error> {
        plant.check()?;
        let step = usable(settings)?;
        let word = word::<T>();
        let (beta, delta) = boxes(settings)?;
        let alpha = [plant.alpha.low, plant.alpha.high].map(Enclosure::of);
        let g = [alpha[0] * beta[0], alpha[1] * beta[1]];
        let terms = terms(settings, plant, g)?;
        let lambda = Enclosure::of(settings.lambda);
        let reference = Enclosure::of(plant.reference);
        let reference_rate = Enclosure::of(plant.reference_rate);
        let off = (Enclosure::ONE - g[0]).abs();
        let off = off.max((g[1] - Enclosure::ONE).abs());
        let disturbance = Enclosure::of(plant.delta);
        let mut w = off * (reference + reference_rate / lambda) + disturbance;
        let (mut xi, mut load) = (Enclosure::of(plant.delta_rate), disturbance);
        for term in terms.iter().flatten() {
            w = w + term.mismatch * term.magnitude;
            xi = xi + term.truth * term.rate;
            load = load + term.truth * term.magnitude;
        }
        let (low, high) = (settings.limits.low(), settings.limits.high());
        let command = if -low < high { -low } else { high };
        // The rounding of s/epsilon, and a smooth sign above its argument by two units.
        let above = Enclosure::ONE + word.unit * Enclosure::power(3);
        Ok(Self {
            word,
            gain: Enclosure::of(settings.gain),
            lambda,
            epsilon: Enclosure::of(settings.epsilon),
            step: Enclosure::of(step),
            alpha,
            beta: beta[1],
            g,
            delta: delta[1],
            slope: above / Enclosure::of(settings.epsilon),
            z_limit: Enclosure::of(settings.z_limit),
            command: Enclosure::of(command),
            slew: settings.limits.slew().map(Enclosure::of),
            reference,
            reference_rate,
            w,
            xi,
            load,
            adapts: [
                Adapts::try_new(&settings.beta, settings.frozen, "beta")?,
                Adapts::try_new(&settings.delta, settings.frozen, "delta")?,
            ],
            terms,
        })
    }
}

/// Both word lengths, from the constants of their floats.
fn word<T: Real>() -> Word {
    let unit = Enclosure::of(T::epsilon()) * Enclosure::power(-1);
    // Half of the least subnormal number: the least normal one has as many bits above it.
    let least = Enclosure::of(T::min_positive_value()) * unit;
    let most = Enclosure::of(T::HIGHEST);
    Word { unit, least, most }
}

/// The step \[s\] of settings whose single numbers make sense.
fn usable<T: Real, const N: usize>(settings: &AdaptiveSettings<T, N>) -> Result<T, Error> {
    let [step, _] = first_order(settings)?;
    above_zero(step, "step")?;
    above_zero(settings.gain, "gain")?;
    above_zero(settings.lambda, "lambda")?;
    above_zero(settings.epsilon, "epsilon")?;
    above_zero(settings.z_limit, "z_limit")?;
    if settings.longest_dt < step || settings.longest_dt.is_nan() {
        return Err(Error::Inadmissible("longest_dt >= step"));
    }
    Ok(step)
}

/// The bounds on beta_hat, which must be positive, and on delta_hat, which must not be negative.
fn boxes<T: Real, const N: usize>(
    settings: &AdaptiveSettings<T, N>,
) -> Result<([Enclosure; 2], [Enclosure; 2]), Error> {
    let beta = ends(range(&settings.beta, settings.frozen), "beta.low")?;
    if beta[0].is_at_most(Enclosure::ZERO) {
        return Err(Error::Inadmissible("beta.low > 0"));
    }
    let delta = ends(range(&settings.delta, settings.frozen), "delta.low")?;
    if !Enclosure::ZERO.is_at_most(delta[0]) {
        return Err(Error::Inadmissible("delta.low >= 0"));
    }
    Ok((beta, delta))
}

fn ends<T: Real>(interval: Interval<T>, name: &'static str) -> Result<[Enclosure; 2], Error> {
    let (low, high) = (finite(interval.low, name)?, finite(interval.high, name)?);
    if low > high {
        return Err(Error::OutOfRange(name));
    }
    Ok([low, high].map(Enclosure::of))
}

fn terms<T: Real, const N: usize>(
    settings: &AdaptiveSettings<T, N>,
    plant: &Plant<f64, N>,
    g: [Enclosure; 2],
) -> Result<[Option<Term>; MOST], Error> {
    let mut terms = [None; MOST];
    if N > MOST {
        return Err(Error::Capacity("regressors"));
    }
    let pairs = settings.theta.iter().zip(&plant.regressors);
    for (place, (estimator, known)) in terms.iter_mut().zip(pairs) {
        let estimates = ends(range(estimator, settings.frozen), "theta.low")?;
        let truths = ends(known.theta, "theta")?;
        let mut mismatch = Enclosure::ZERO;
        for g in g {
            for estimate in estimates {
                for truth in truths {
                    mismatch = mismatch.max((g * estimate - truth).abs());
                }
            }
        }
        *place = Some(Term {
            estimate: estimates[0].abs().max(estimates[1].abs()),
            truth: truths[0].abs().max(truths[1].abs()),
            mismatch,
            magnitude: Enclosure::of(known.magnitude),
            rate: Enclosure::of(known.rate),
            adapts: Adapts::try_new(estimator, settings.frozen, "theta")?,
        });
    }
    Ok(terms)
}
