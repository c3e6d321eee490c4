//! Theorem 1 with the best choice of the constants that its proof leaves free.

use super::truth::{bounded, Adapting, Case};
use super::{Certificate, Kind, Plant};
use bowden::control::Adaptive;
use bowden::{Error, Real};

/// Theorem 1's bound on limsup `|e|` with the best choice of its free constants.
///
/// The proof of [`Theorem1`](super::Theorem1) leaves three constants free: the weight c in
/// `V = s²/2 + c·z²/2 + ...`, a target T of delta_hat with `T <= Delta`, and a rate theta below
/// 2·lambda and twice the slowest leakage. Then `V' <= -theta·V + phi`, where phi is the sum of
///
/// - `sum w_p·sigma_p²·(p* - p0)²/(4·m_p·(sigma_p - theta/2))` from the leakages, with T instead of
///   p* for delta;
/// - `W·epsilon·lambda·T` from the smoothed sign function;
/// - `lambda²·(Delta - T)²/(4·a)` from the disturbance beyond the target, where
///   `a = k·lambda - theta/2 - (c - 1)²/(4·c·(lambda - theta/2))` is positive.
///
/// Therefore `|e| <= sqrt((1 + lambda²/c)·2·phi/theta)`, since `e = s - lambda·z`. With c = 1, T =
/// Delta and theta equal to the slowest leakage, this bound equals (34)-(38) except for the factor
/// `(1 + lambda)`. For Table 2, the largest term is the leakage of beta_hat, which does not depend
/// on this choice.
///
/// Assumptions: the same as for [`Theorem1`](super::Theorem1).
///
/// ```
/// use bowden_bound::{Plant, Tightest};
/// use bowden::control::Adaptive;
/// let best = Tightest::try_new(&Adaptive::paper(), &Plant::new(0.5, 7.0_f64))?;
/// assert!(best.bound < 100.0); // instead of 1138 N·m
/// assert_eq!(best.dominant_term().0, "leakage of beta_hat");
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tightest<T> {
    /// Bound on limsup `|e|` \[N·m\].
    pub bound: T,
    /// theta \[1/s\].
    pub theta: T,
    /// c: weight of z² in V \[1/s²\].
    pub weight: T,
    /// T \[N·m\]: the reference value of delta_hat.
    pub target: T,
    /// The terms of phi \[(N·m)²/s\], in the order of [`NAMES`](Self::NAMES).
    pub terms: [T; 5],
}

/// Number of rounds in each search. Each round reduces the interval to two thirds.
const NARROWINGS: u32 = 36;

impl<T: Real> Tightest<T> {
    /// Names of the terms.
    pub const NAMES: [&'static str; 5] = [
        "leakage of beta_hat",
        "leakage of delta_hat",
        "leakage of theta_hat",
        "smooth sign",
        "disturbance",
    ];

    /// The best bound of an adaptive law with a plant.
    ///
    /// # Errors
    /// The same as [`Theorem1::try_new`](super::Theorem1::try_new).
    pub fn try_new<const N: usize>(
        law: &Adaptive<T, N>,
        plant: &Plant<T, N>,
    ) -> Result<Self, Error> {
        let case = Case::try_new(law, plant)?.published()?;
        let slowest = case.slowest(law.settings().lambda)?;
        // theta as a share of its maximum, c by its logarithm.
        let theta = |share: T| slowest * T::from_f64(2.0) * share;
        let best_weight = |theta: T| -> Result<Self, Error> {
            let highest = T::from_f64(16.0) * law.settings().gain * law.settings().lambda;
            let top = (highest * law.settings().lambda + T::from_f64(2.0)).ln();
            let of = |log: T| at(&case, theta, log.exp());
            of(narrowed(T::zero(), top, |log| Ok(of(log)?.bound))?)
        };
        let share = narrowed(T::from_f64(1e-6), T::one() - T::from_f64(1e-6), |share| {
            Ok(best_weight(theta(share))?.bound)
        })?;
        let best = best_weight(theta(share))?;
        bounded(best.bound)?;
        Ok(best)
    }

    /// The name of the largest term of phi, and its fraction of phi.
    #[must_use]
    pub fn dominant_term(&self) -> (&'static str, T) {
        let sum = self.terms.iter().fold(T::zero(), |sum, term| sum + *term);
        let first = (Self::NAMES[0], T::zero());
        let terms = Self::NAMES.into_iter().zip(self.terms);
        let greatest = terms.fold(first, |most, own| if own.1 > most.1 { own } else { most });
        (greatest.0, greatest.1 / sum)
    }

    /// The bound as a certificate.
    #[must_use]
    pub fn certificate(&self) -> Certificate<T> {
        Certificate::new(Kind::Tightest, self.bound)
    }
}

/// The bound at one theta and one c, with the best target.
fn at<T: Real, const N: usize>(
    case: &Case<'_, T, N>,
    theta: T,
    weight: T,
) -> Result<Tightest<T>, Error> {
    let Case { settings, plant } = case;
    let delta = case.delta(plant.delta)?;
    let lowest = delta.map_or(plant.delta, |_| {
        case.range(&settings.delta).low.max(T::zero())
    });
    let (two, four, lambda) = (T::from_f64(2.0), T::from_f64(4.0), settings.lambda);
    let half = theta / two;
    let leaked = |estimate: &Adapting<T>| {
        let sigma = estimate.estimator.leakage.rate();
        let share = sigma * sigma / (four * estimate.estimator.gain * (sigma - half));
        share * estimate.distance_squared()
    };
    let all = case.sum(leaked)?;
    let of_theta = case.add_thetas(T::zero(), leaked)?;
    let coupling = weight - T::one();
    let coupled = coupling * coupling / (four * weight * (lambda - half));
    let stiffness = settings.gain * lambda - half - coupled;
    let smooth = case.smoothing();
    let aimed = |target: T| {
        let left = lambda * (plant.delta - target);
        [
            delta.map_or(T::zero(), |delta| leaked(&delta.aimed_at(target))),
            smooth * target,
            left * left / (four * stiffness),
        ]
    };
    let total = |target: T| Ok(aimed(target).iter().fold(T::zero(), |sum, x| sum + *x));
    let target = narrowed(lowest, plant.delta, total)?;
    let [of_delta, smoothing, disturbance] = aimed(target);
    let phi = all + of_delta + smoothing + disturbance;
    let seen = T::one() + lambda * lambda / weight;
    let bound = match stiffness <= T::zero() {
        true => T::infinity(),
        false => (seen * two * phi / theta).sqrt(),
    };
    Ok(Tightest {
        bound,
        theta,
        weight,
        target,
        terms: [all - of_theta, of_delta, of_theta, smoothing, disturbance],
    })
}

/// The argument at which a function that falls and then rises is smallest. Any argument gives a
/// valid bound.
fn narrowed<T: Real>(
    mut low: T,
    mut high: T,
    of: impl Fn(T) -> Result<T, Error>,
) -> Result<T, Error> {
    let third = T::one() / T::from_f64(3.0);
    for _ in 0..NARROWINGS {
        let (a, b) = (low + (high - low) * third, high - (high - low) * third);
        // Infinite on both sides: the upper end is too far.
        if of(b)? < of(a)? {
            low = a;
        } else {
            high = b;
        }
    }
    Ok(low + (high - low) * T::from_f64(0.5))
}
