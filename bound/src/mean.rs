//! The root mean square of s from the change of the Lyapunov function, without the leakage.

use super::truth::{Adapting, Case};
use bowden::{Error, Real};

/// Number of bisections in the search for the target: more than an `f64` can distinguish.
const NARROWINGS: u32 = 90;

/// The coefficients of
/// `stiffness·rms(s)² <= (share·c + xi)·rms(s) + (phi + weight·V(0)/T)/per`,
/// where `c = Delta - target`, and of `rms(e) <= rms(s)/kept`. In continuous time, the stiffness is k
/// and `per` is lambda; the share, the weight and `kept` are one, and xi is zero.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Mean<T: Real> {
    /// phi without the parts of delta_hat and of the smoothed sign.
    pub(super) phi: T,
    /// The part of delta_hat in phi, as a multiple of its residue.
    pub(super) residues: T,
    pub(super) stiffness: T,
    pub(super) share: T,
    pub(super) xi: T,
    pub(super) per: T,
    pub(super) weight: T,
    pub(super) kept: T,
    /// Adaptation of delta_hat, without its true value, which is the target. `None` if delta_hat is
    /// constant.
    pub(super) adapting: Option<Adapting<T>>,
    /// V(0) without the parts of delta_hat and of the error.
    pub(super) at_start: T,
    /// W·epsilon·lambda.
    pub(super) smoothing: T,
    /// Delta \[N·m\].
    pub(super) delta: T,
}

impl<T: Real> Mean<T> {
    /// The coefficients in continuous time, if the highest target of delta_hat is `highest`.
    pub(super) fn try_new<const N: usize>(
        case: &Case<'_, T, N>,
        highest: T,
    ) -> Result<Self, Error> {
        let settings = case.settings;
        Ok(Self {
            adapting: case.delta(highest)?,
            phi: case.sum(Adapting::residue)?,
            residues: T::one(),
            stiffness: settings.gain,
            share: T::one(),
            xi: T::zero(),
            per: settings.lambda,
            weight: T::one(),
            kept: T::one(),
            at_start: case.sum(Adapting::at_start)?,
            smoothing: case.smoothing(),
            delta: case.plant.delta,
        })
    }

    /// Bound on rms(e) \[N·m\] over the first `duration` \[s\], from an initial error
    /// `start` \[N·m\].
    pub(super) fn over(&self, target: T, duration: T, start: T) -> T {
        let own = self.part(target, Adapting::at_start);
        let v = self.at_start + start * start * T::from_f64(0.5) + own;
        self.bound(target, self.weight * v / duration)
    }

    /// The part of delta_hat with the target `target`.
    fn part(&self, target: T, of: impl Fn(&Adapting<T>) -> T) -> T {
        let aimed = self.adapting.map(|delta| delta.aimed_at(target));
        aimed.as_ref().map_or(T::zero(), of)
    }

    /// The bound with the target `target` of delta_hat, and `extra` in addition to phi.
    pub(super) fn bound(&self, target: T, extra: T) -> T {
        let residue = self.residues * self.part(target, Adapting::residue);
        let phi = self.phi + residue + self.smoothing * target + extra;
        // A target above Delta has no difference; a lower target has one.
        let linear = self.share * (self.delta - target).max(T::zero()) + self.xi;
        let root = (linear * linear + T::from_f64(4.0) * self.stiffness * phi / self.per).sqrt();
        (linear + root) / (T::from_f64(2.0) * self.stiffness) / self.kept
    }

    /// The best target. Ternary search: the targets with a bound below a level form an interval.
    pub(super) fn best(&self, mut low: T, mut high: T) -> T {
        if self.adapting.is_none() {
            return high;
        }
        let third = T::one() / T::from_f64(3.0);
        for _ in 0..NARROWINGS {
            let (a, b) = (low + (high - low) * third, high - (high - low) * third);
            if self.bound(a, T::zero()) < self.bound(b, T::zero()) {
                high = b;
            } else {
                low = a;
            }
        }
        high
    }
}
