//! The exact error recursion of the first-order form on a static plant.

use super::SmoothSign;
use crate::control::law;
use crate::Real;

crate::data! {
    /// The errors s \[N·m\] and z \[N·m·s\] of the closed loop.
    #[derive(Default)]
    pub struct ErrorState<T> {
        /// Filtered error of (18), `s = e + lambda·z` \[N·m\].
        pub s: T,
        /// Accumulated error z of (17) \[N·m·s\].
        pub z: T,
    }
}

/// The disturbances that act on the errors in one step of the [`LagRecursion`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Disturbance<T> {
    /// g = alpha·beta_hat; 1 if beta_hat is exact.
    pub g: T,
    /// delta_hat \[N·m\].
    pub delta_hat: T,
    /// `w = (g-1)·(r + (r⁺-r)/(h·lambda)) + (g·theta_hat - theta)'x - D` \[N·m\].
    pub w: T,
    /// `xi = (D⁺ - D) + theta'(x⁺ - x)` \[N·m\]: the decrease in the plant's output at a constant
    /// command.
    pub xi: T,
}

/// One step of the errors in the closed loop of the first-order form on a static plant.
///
/// On the plant `y = alpha·u - theta'x - D` with u from the previous sample, these equations are
/// exact:
///
/// - `s⁺ = s - h·lambda·g·k·s - h·g·z + h·lambda·(w - g·delta_hat·T(s/eps)) - xi`
/// - `z⁺ = z + h·(s - lambda·z)`
///
/// The equations hold for any sequence of time steps `h`, as long as neither the command nor z is
/// at a limit. The box theorem (`PeakSampled` in the crate `bowden-bound`) applies to this
/// recursion. From bounds on g, delta_hat, `|w|` and `|xi|`, the theorem computes bounds on s and z
/// (the box). Errors that start inside the box stay inside the box.
///
/// ```
/// use bowden::control::{Disturbance, ErrorState, LagRecursion, SmoothSign};
/// let gains = LagRecursion { gain: 24.0, lambda: 8.0, epsilon: 0.2, smooth_sign: SmoothSign::Tanh };
/// let known = Disturbance { g: 1.0, delta_hat: 0.0, w: 0.0, xi: 0.0 };
/// let next = gains.step(ErrorState { s: 1.0, z: 0.0 }, 0.001, &known);
/// assert_eq!((next.s, next.z), (1.0 - 0.001 * 8.0 * 24.0, 0.001));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LagRecursion<T> {
    /// Control gain k.
    pub gain: T,
    /// lambda \[1/s\].
    pub lambda: T,
    /// epsilon \[N·m\].
    pub epsilon: T,
    /// The smoothed sign function.
    pub smooth_sign: SmoothSign,
}

impl<T: Real> LagRecursion<T> {
    /// The errors after one sample of `dt` \[s\].
    #[inline]
    #[must_use]
    pub fn step(&self, at: ErrorState<T>, dt: T, by: &Disturbance<T>) -> ErrorState<T> {
        let sign = self.smooth_sign.of(at.s / self.epsilon);
        let pull = self.gain * at.s + by.delta_hat * sign;
        let ds = self.lambda * (by.w - by.g * pull) - by.g * at.z;
        ErrorState {
            s: at.s + dt * ds - by.xi,
            z: at.z + dt * law::z_rate(at.s, self.lambda, at.z),
        }
    }
}
