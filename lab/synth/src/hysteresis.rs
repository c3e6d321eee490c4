//! The paper's (2) and (7), as printed, by fourth-order Runge-Kutta.

use super::recipe::Base;

/// Rate of eta for an input that moves at `rate`.
fn derivative(base: &Base, eta: f64, rate: f64) -> f64 {
    let power = eta.abs().powf(base.n);
    // |eta|^(n-1) eta, written so that it is 0 and not 0/0 at eta = 0.
    let signed = power.copysign(eta);
    base.rho * (rate - base.sigma * rate.abs() * signed + (base.sigma - 1.0) * rate * power)
}

/// eta after a step of `dt` with the input's rate at its start, middle and end.
pub(super) fn step(base: &Base, eta: f64, dt: f64, rates: [f64; 3]) -> f64 {
    let k1 = derivative(base, eta, rates[0]);
    let k2 = derivative(base, eta + 0.5 * dt * k1, rates[1]);
    let k3 = derivative(base, eta + 0.5 * dt * k2, rates[1]);
    let k4 = derivative(base, eta + dt * k3, rates[2]);
    eta + dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
}

/// The output of a play of half-width `half` that was at `last`: it moves only while it is
/// pushed.
pub(super) fn follow(last: f64, input: f64, half: f64) -> f64 {
    if input - last > half {
        input - half
    } else if last - input > half {
        input + half
    } else {
        last
    }
}
