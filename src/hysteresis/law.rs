//! The state equation of the hysteresis: equations (2) and (7) of Nguyen et al. (2018).
//!
//! The names follow the paper. The input `x` is a displacement in (2) and a torque in (7).
//! [`eta_rate`] is the equation as published. [`f`] is the same equation along the path (see
//! [`hysteresis`](crate::hysteresis)), so `eta' = d·rho·|x'|·f(d·eta)` with `d = sgn(x')`.

use super::number::Number;
use crate::Real;

/// Equations (2) and (7): `eta' = rho·(x' - sigma·|x'|·|eta|^(n-1)·eta + (sigma - 1)·x'·|eta|^n)`.
///
/// ```
/// use bowden::hysteresis::law::eta_rate;
/// // From eta = 0, the slope is rho; after a reversal at eta = 1, it is 2·sigma·rho.
/// assert_eq!(eta_rate(0.1, 3.0, 2.0, 1.0, 0.0), 0.1);
/// assert!((eta_rate(0.1_f64, 3.0, 2.0, -1.0, 1.0) + 0.6).abs() < 1e-12);
/// ```
#[inline]
pub fn eta_rate<T: Real>(rho: T, sigma: T, n: T, x_rate: T, eta: T) -> T {
    let power = eta.abs().pow(n - T::one()); // |eta|^(n-1)
    let damping = sigma * x_rate.abs() * power * eta;
    rho * (x_rate - damping + (sigma - T::one()) * x_rate * power * eta.abs())
}

/// Equations (2) and (7) along the path: `f(zeta)`, where `c` is `2·sigma - 1` and `power` is
/// `|zeta|^n`.
#[inline]
pub fn f<T: Real>(zeta: T, c: T, power: T) -> T {
    if zeta < T::zero() {
        unloading(c * power)
    } else {
        loading(power)
    }
}

/// Loading, `zeta >= 0`: `f = 1 - zeta^n`.
#[inline]
pub(super) fn loading<N: Number>(power: N) -> N {
    (-power).shift(N::Float::ONE)
}

/// Unloading, `zeta < 0`: `f = 1 + c·|zeta|^n`.
#[inline]
pub(super) fn unloading<N: Number>(c_power: N) -> N {
    c_power.shift(N::Float::ONE)
}
