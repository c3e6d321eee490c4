//! The parameters of the loop, and the step along the path.

use super::bounded::{self, Constants, Series};
use super::number::Dual;
use super::state::{BoucWenState, Sensitivity};
use super::{closed, law, path};
use crate::error::{above_zero, must_be_finite};
use crate::real::of;
use crate::{Error, Real};
use core::fmt;

/// Parameters of a Bouc-Wen loop, equations (2) and (7).
///
/// - rho: initial slope of eta [1/input unit].
/// - sigma ≥ 1/2: the slope after a reversal is 2·sigma·rho.
/// - n ≥ 1: sharpness of the knee, larger is sharper.
///
/// The condition `sigma >= 1/2` makes the model dissipative. Together with `n >= 1`, it ensures
/// `|eta| <= 1`.
///
/// ```
/// use bowden::hysteresis::{BoucWenState, BoucWen};
/// # fn main() -> Result<(), bowden::Error> {
/// let shape = BoucWen::try_new(0.09582, 98.36, 3.871)?; // first set of the paper
/// let mut state = BoucWenState::new();
/// shape.step(&mut state, 0.0); // the first sample only sets the input
/// assert!(shape.step(&mut state, 16.0) > 0.9);
/// assert!(shape.step(&mut state, -1e30) >= -1.0);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, PartialEq)]
pub struct BoucWen<T> {
    rho: T,
    sigma: T,
    /// Constants that include n.
    constants: Constants<T>,
}

impl<T: fmt::Debug> fmt::Debug for BoucWen<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parameters = f.debug_struct("BoucWen");
        parameters.field("rho", &self.rho);
        parameters.field("sigma", &self.sigma);
        parameters.field("n", &self.constants.n);
        parameters.finish()
    }
}

#[cfg(feature = "defmt")]
impl<T: defmt::Format> defmt::Format for BoucWen<T> {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (rho, sigma, n) = (&self.rho, &self.sigma, &self.constants.n);
        defmt::write!(f, "BoucWen {{ rho: {}, sigma: {}, n: {} }}", rho, sigma, n);
    }
}

crate::checked! {
    BoucWen<T>;

    fn constants[](c: T, n: T) -> Constants<T> {
        let n1 = n + T::ONE;
        let first = T::ONE / n1;
        let second = (n1 - n * n) / (n * of(2.0) + T::ONE) * first * first;
        let (root, size, below) = (-T::ONE / n, n * n1 * of(0.6), first + second);
        let after_1 = if below > T::ZERO { T::ONE / (below + T::ONE) } else { T::ONE };
        let series = Series { first, second };
        Constants { c, n, root, size, series, after_1 }
    }

    /// Parameters with `rho > 0` [1/input unit], `sigma >= 1/2` and `n >= 1`.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with the name of the invalid parameter. A
    /// `sigma` or `n` above 1e9 is out of range, because such a value cannot be identified.
    pub fn try_new(rho: T, sigma: T, n: T) {
        above_zero!(rho, "rho");
        must_be_finite!(sigma, "sigma");
        if sigma < of(0.5) || sigma > of(1e9) {
            return Err(Error::OutOfRange("sigma"));
        }
        must_be_finite!(n, "n");
        if n < T::ONE || n > of(1e9) {
            return Err(Error::OutOfRange("n"));
        }
        let two: T = of(2.0);
        let constants = constants(two * sigma - T::ONE, n);
        Ok(BoucWen { rho, sigma, constants })
    }
}

impl<T: Real> BoucWen<T> {
    /// Initial slope of eta [1/input unit].
    pub fn rho(&self) -> T {
        self.rho
    }

    /// Parameter sigma: the slope after a reversal is 2·sigma·rho.
    pub fn sigma(&self) -> T {
        self.sigma
    }

    /// Sharpness of the knee, larger is sharper.
    pub fn n(&self) -> T {
        self.constants.n
    }

    /// Eta after an increment of the input [input unit] of any size.
    ///
    /// An `eta` outside [-1, 1] is clamped first, so `|eta| <= 1` after any finite, nonzero
    /// increment. An increment that is not finite returns `eta` unchanged. This function calls
    /// [`advance_bounded`](Self::advance_bounded) for `f32` and
    /// [`advance_split`](Self::advance_split) for `f64`.
    #[inline]
    #[must_use]
    pub fn advance(&self, eta: T, input_change: T) -> T {
        if T::SHORT {
            self.advance_bounded(eta, input_change)
        } else {
            self.advance_split(eta, input_change)
        }
    }

    /// Eta after an increment of the input [input unit], in bounded time.
    ///
    /// The step evaluates one power and at most two coarse approximations of a power. In `f32` it
    /// does not call libm.
    #[inline]
    #[must_use]
    pub fn advance_bounded(&self, eta: T, input_change: T) -> T {
        if !input_change.is_finite() || eta.is_nan() {
            return eta;
        }
        self.bounded(crate::signal::clamp(eta, -T::one(), T::one()), input_change)
    }

    /// The same as [`advance_bounded`](Self::advance_bounded), for an eta in \[-1, 1\] and a change
    /// that may be infinite.
    #[inline]
    fn bounded(&self, eta: T, input_change: T) -> T {
        let one = T::one();
        let direction = if input_change < T::zero() { -one } else { one };
        let path = self.rho * input_change.abs();
        direction * bounded::follow(direction * eta, path, &self.constants)
    }

    /// Eta after an increment of the input [input unit]. A long increment is split, so the result
    /// is accurate for an increment of any size.
    ///
    /// The method is exact for `n = 1` and `n = 2`, and of third order for any other n.
    #[inline]
    #[must_use]
    pub fn advance_split(&self, eta: T, input_change: T) -> T {
        self.along(eta, input_change, |zeta, p, c| {
            if self.constants.n == T::one() {
                closed::linear(zeta, p, c)
            } else if self.constants.n == T::from_f64(2.0) {
                closed::quadratic(zeta, p, c)
            } else {
                path::follow(zeta, p, c, self.constants.n)
            }
        })
    }

    /// Applies a step in zeta and p to eta and a change of the input.
    #[inline]
    fn along(&self, eta: T, input_change: T, step: impl Fn(T, T, T) -> T) -> T {
        if !input_change.is_finite() || input_change == T::zero() || eta.is_nan() {
            return eta;
        }
        let one = T::one();
        let direction = if input_change < T::zero() { -one } else { one };
        let zeta = crate::signal::clamp(direction * eta, -one, one);
        let next = step(zeta, self.rho * input_change.abs(), self.c());
        direction * crate::signal::clamp(next, zeta, one)
    }

    /// The state after an increment of the input [input unit], with the exact derivatives of this
    /// discrete step.
    ///
    /// This function does not use the closed forms for `n = 1` and `n = 2`. For these n, the
    /// resulting eta differs from the result of [`advance`](Self::advance) by the error of the
    /// general step. In saturation, all derivatives are zero.
    #[inline]
    #[must_use]
    pub fn advance_with_sensitivity(
        &self,
        state: Sensitivity<T>,
        input_change: T,
    ) -> Sensitivity<T> {
        if !input_change.is_finite() || input_change == T::zero() || state.eta.is_nan() {
            return state;
        }
        let (zero, one) = (T::zero(), T::one());
        let direction = if input_change < zero { -one } else { one };
        let length = input_change.abs();
        let zeta = Dual {
            value: crate::signal::clamp(direction * state.eta, -one, one),
            by: [
                direction * state.d_rho,
                direction * state.d_sigma,
                direction * state.d_n,
                direction * state.d_eta0,
            ],
        };
        let p = Dual {
            value: self.rho * length,
            by: [length, zero, zero, zero],
        };
        let c = Dual {
            value: self.c(),
            by: [zero, T::from_f64(2.0), zero, zero],
        };
        let n = Dual {
            value: self.constants.n,
            by: [zero, zero, one, zero],
        };
        let next = if T::SHORT {
            bounded::follow(zeta, p, &Constants::of(c, n))
        } else {
            path::follow(zeta, p, c, n)
        };
        let [d_rho, d_sigma, d_n, d_eta0] = next.by;
        Sensitivity {
            eta: direction * crate::signal::clamp(next.value, zeta.value, one),
            d_rho: direction * d_rho,
            d_sigma: direction * d_sigma,
            d_n: direction * d_n,
            d_eta0: direction * d_eta0,
        }
    }

    /// Slope d(eta)/d(input) [1/input unit] in the direction given by the sign of `direction`.
    ///
    /// The slope is the right-hand side of (2) and (7) divided by `x'`. It lies in
    /// `[0, 2·sigma·rho]`.
    #[inline]
    #[must_use]
    pub fn slope(&self, eta: T, direction: T) -> T {
        let zeta = if direction < T::zero() { -eta } else { eta };
        let a = zeta.abs();
        let power = if T::SHORT {
            (self.constants.n * a.log2()).exp2()
        } else {
            a.pow(self.constants.n)
        };
        self.rho * law::f(zeta, self.c(), power)
    }

    /// Advances the state to the input of one sample [input unit], and returns eta in [-1, 1].
    ///
    /// The first sample only sets the input. A sample that is not finite leaves the state unchanged
    /// and returns the current eta.
    #[inline]
    pub fn step(&self, state: &mut BoucWenState<T>, input: T) -> T {
        let mut change = input - state.input;
        if !change.is_finite() {
            match unusual(state, input) {
                Some(longest) => change = longest,
                None => return state.eta,
            }
        }
        state.eta = if T::SHORT {
            self.bounded(state.eta, change)
        } else {
            self.advance(state.eta, change)
        };
        state.input = input;
        state.eta
    }

    /// The paths from one state in the direction given by the sign of `direction`.
    #[inline]
    pub(crate) fn way(&self, eta: T, direction: T) -> Way<'_, T> {
        let direction = if direction < T::ZERO { -T::ONE } else { T::ONE };
        let zeta = direction * eta;
        Way {
            shape: self,
            direction,
            eta,
            zeta,
            powered: if T::SHORT {
                bounded::powered(zeta, self.constants.n)
            } else {
                T::ZERO
            },
        }
    }

    /// Ratio of the initial slopes of unloading and loading, minus one.
    #[inline]
    fn c(&self) -> T {
        self.constants.c
    }
}

/// The change that replaces an infinite change. `None` for a bad sample, and for the first sample,
/// which only sets the input.
#[cold]
fn unusual<T: Real>(state: &mut BoucWenState<T>, input: T) -> Option<T> {
    if !input.is_finite() {
        return None;
    }
    if state.input().is_none() {
        state.input = input;
        return None;
    }
    let most = T::max_value();
    Some(if input < T::ZERO { -most } else { most })
}

/// The paths from one state in one direction. The part common to all lengths is computed once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Way<'a, T> {
    shape: &'a BoucWen<T>,
    direction: T,
    eta: T,
    zeta: T,
    powered: T,
}

impl<T: Real> Way<'_, T> {
    /// The eta after [`BoucWen::step`] with this change of the input, in the direction of the
    /// path.
    #[inline]
    pub(crate) fn after(&self, input_change: T) -> T {
        let shape = self.shape;
        if !T::SHORT {
            return shape.advance(self.eta, input_change);
        }
        let path = shape.rho * input_change.abs();
        self.direction * bounded::follow_powered(self.zeta, path, self.powered, &shape.constants)
    }

    /// [`BoucWen::slope`] at the start of the path.
    #[inline]
    pub(crate) fn slope(&self) -> T {
        let shape = self.shape;
        if !T::SHORT {
            return shape.slope(self.zeta, T::ONE);
        }
        let power = self.zeta.abs() * self.powered;
        shape.rho * law::f(self.zeta, shape.c(), power)
    }
}

/// The stored form of the parameters.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Parameters<T> {
    rho: T,
    sigma: T,
    n: T,
}

crate::checked::stored_as! {
    BoucWen<T> as Parameters<T>: |shape| Parameters {
        rho: shape.rho,
        sigma: shape.sigma,
        n: shape.n(),
    }, |it: Parameters<T>| BoucWen::try_new(it.rho, it.sigma, it.n)
}
