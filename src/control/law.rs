//! The adaptive law of Nguyen et al. (2018), one function for each term.
//!
//! The names follow the paper: `u_bar` is the virtual command, and `h` is the time since the last
//! sample \[s\]. A step evaluates (13) and (18), then (23) and (19) with the estimates of the last
//! sample, and finally (17) and (24) to (26). These functions neither check nor limit any value.
//! The step rejects bad samples, clamps z, the estimates and the command, and adds the increments
//! by compensated summation.

use crate::signal::clamp;
use crate::Real;

/// Equation (13): tracking error `e = y - y_r`.
#[inline]
pub fn error<T: Real>(y: T, y_r: T) -> T {
    y - y_r
}

/// Equation (17): increment of the accumulated error, `z = ∫ e dt`, over one sample: `h·e`.
#[inline]
pub fn z_increment<T: Real>(h: T, e: T) -> T {
    h * e
}

/// Equation (18): filtered error `s = e + lambda·z`.
#[inline]
pub fn filtered_error<T: Real>(e: T, lambda: T, z: T) -> T {
    e + lambda * z
}

/// Equation (19): command `u = beta_hat·u_bar`.
#[inline]
pub fn command<T: Real>(beta_hat: T, u_bar: T) -> T {
    beta_hat * u_bar
}

/// Increment of u in the first-order form of (19): `u' = lambda·way` with
/// `way = beta_hat·u_bar - u`.
#[inline]
pub fn first_order_increment<T: Real>(h: T, lambda: T, way: T) -> T {
    h * lambda * way
}

/// Equation (20): `alpha·u = u_bar - alpha·beta_error·u_bar`. `beta_error` is `1/alpha - beta_hat`.
#[inline]
pub fn plant_command<T: Real>(alpha: T, beta_error: T, u_bar: T) -> T {
    u_bar - alpha * beta_error * u_bar
}

/// Equation (21): rate of the accumulated error, `z' = e = s - lambda·z`.
#[inline]
pub fn z_rate<T: Real>(s: T, lambda: T, z: T) -> T {
    s - lambda * z
}

/// Equation (22): rate of the filtered error, `s' = e' + lambda·e`.
#[inline]
pub fn s_rate<T: Real>(e_rate: T, lambda: T, e: T) -> T {
    e_rate + lambda * e
}

/// First term of (23): `-k·s + y_r`.
#[inline]
pub fn proportional<T: Real>(k: T, s: T, y_r: T) -> T {
    -k * s + y_r
}

/// The first and second terms of (23): `proportional - (z + e')/lambda`.
#[inline]
pub fn damped<T: Real>(proportional: T, z: T, e_rate: T, lambda: T) -> T {
    proportional - (e_rate + z) / lambda
}

/// The first and second terms of (23) in the first-order form, where `-y_r'` replaces e'.
#[inline]
pub fn first_order_damped<T: Real>(proportional: T, z: T, y_r_rate: T, lambda: T) -> T {
    proportional + (y_r_rate - z) / lambda
}

/// Equation (23): virtual command `u_bar = damped + theta_hat'x - delta_hat·T(s/epsilon)`.
#[inline]
pub fn virtual_command<T: Real>(damped: T, theta_x: T, delta_hat: T, smooth_sign: T) -> T {
    damped + theta_x - delta_hat * smooth_sign
}

/// Driving term of beta_hat in (24): `v = -lambda·s·u_bar`. `lambda_s` is `lambda·s`.
#[inline]
pub fn beta_excitation<T: Real>(lambda_s: T, u_bar: T) -> T {
    -lambda_s * u_bar
}

/// Driving term of delta_hat in (25): `v = lambda·s·T(s/epsilon)`.
#[inline]
pub fn delta_excitation<T: Real>(lambda_s: T, smooth_sign: T) -> T {
    lambda_s * smooth_sign
}

/// Driving term of theta_hat_i in (26): `v = -lambda·s·x_i`.
#[inline]
pub fn theta_excitation<T: Real>(lambda_s: T, x: T) -> T {
    -lambda_s * x
}

/// Increment of an estimate in (24) to (26), with leakage:
/// `h·(gamma·v - sigma·distance)/(1 + h·sigma)`, where `distance` is the estimate minus its prior.
///
/// The leakage is implicit, so it cannot overshoot. The prior is zero in the paper.
#[inline]
pub fn estimate_increment<T: Real>(h: T, gamma: T, v: T, sigma: T, distance: T) -> T {
    h * (gamma * v - sigma * distance) / (T::one() + h * sigma)
}

/// Smoothed sign function `T(x)` in (23) and (25), with `x = s/epsilon`: `tanh(x)`, clamped to
/// `[-1, 1]`.
#[inline(always)]
pub fn smooth_sign<T: Real>(x: T) -> T {
    x.confined_tanh()
}

/// Smoothed sign function without `tanh`: `x`, clamped to `[-1, 1]`.
#[inline(always)]
pub fn clamped_sign<T: Real>(x: T) -> T {
    clamp(x, -T::one(), T::one())
}
