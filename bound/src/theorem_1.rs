//! Theorem 1 of Nguyen et al. (2018), with the paper's constants.

use super::truth::{bounded, Adapting, Case};
use super::{Certificate, Kind, Plant};
use bowden::control::Adaptive;
use bowden::{Error, Real};

/// The constants of Theorem 1, (34)-(38): phi, theta, delta and (1 + lambda)·delta.
///
/// With `V = s²/2 + z²/2 + alpha·beta~²/(2·gamma) + Delta~²/(2·mu) + sum theta~_i²/(2·mu_i)` (27),
/// the law gives `V' <= -theta·V + phi` (34). Therefore limsup `|s|` and limsup `|z|` are at most
/// `delta = sqrt(2·phi/theta)`, and limsup `|e| <= (1 + lambda)·delta`. With a prior p0, `p* - p0`
/// replaces p* in phi.
///
/// Assumptions:
/// - the adaptive law is as published, in continuous time, and e' is known;
/// - the plant is (11), alpha and theta are constant and in the given intervals, and `|D| <= Delta`
///   at every time;
/// - every estimate has a positive constant leakage and a positive gain;
/// - the bounds on the estimates, if any, contain the true values;
/// - no command limit and no slew-rate limit is active.
///
/// The algebra of (27)-(34) is correct, but the bound is vacuous. The leakage is by far the slowest
/// rate, so theta is very small and delta is very large.
///
/// ```
/// use bowden_bound::{Plant, Theorem1};
/// use bowden::control::Adaptive;
/// let bound = Theorem1::try_new(&Adaptive::paper(), &Plant::new(0.5, 7.0_f64))?;
/// assert!((bound.phi - 79.98).abs() < 0.005);
/// assert_eq!(bound.theta, 0.01);
/// assert!((bound.delta - 126.47).abs() < 0.01);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Theorem1<T> {
    /// phi \[(N·m)²/s\], defined after (34).
    pub phi: T,
    /// theta \[1/s\]: the slowest of 2·lambda, 2·k·lambda and the leakages.
    pub theta: T,
    /// delta = sqrt(2·phi/theta): bound on limsup `|s|` \[N·m\] and on limsup `|z|` \[N·m·s\].
    pub delta: T,
    /// (1 + lambda)·delta \[N·m\]: bound on limsup `|e|` in (38).
    pub bound: T,
}

impl<T: Real> Theorem1<T> {
    /// The constants of an adaptive law with a plant.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with the invalid part of the plant.
    /// [`Error::Inadmissible`] with the violated assumption.
    pub fn try_new<const N: usize>(
        law: &Adaptive<T, N>,
        plant: &Plant<T, N>,
    ) -> Result<Self, Error> {
        let case = Case::try_new(law, plant)?.published()?;
        let settings = law.settings();
        let two = T::from_f64(2.0);
        let lambda = settings.lambda;
        let theta = case.slowest((two * lambda).min(two * settings.gain * lambda))?;
        // Twice the residue is sigma·(p* - p0)²/(2·m).
        let mut phi = two * case.sum(Adapting::residue)?;
        if let Some(delta) = case.delta(plant.delta)? {
            phi += two * delta.residue();
        }
        phi += case.smoothing() * plant.delta;
        let delta = bounded((two * phi / theta).sqrt())?;
        Ok(Self {
            phi,
            theta,
            delta,
            bound: bounded((T::one() + lambda) * delta)?,
        })
    }

    /// The bound (1 + lambda)·delta as a certificate.
    #[must_use]
    pub fn certificate(&self) -> Certificate<T> {
        Certificate::new(Kind::Theorem1, self.bound)
    }
}
