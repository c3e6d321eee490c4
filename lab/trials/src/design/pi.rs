//! Gains of PI and PID controllers for a static plant with a delay, within stated margins.
//!
//! Among all pairs that satisfy the margins, the pair with the largest integral gain is chosen. A
//! static plant follows a ramp with the error `rate/(k_i·slope)`, and a disturbance decays with the
//! time constant `1/(k_i·slope)`. Source: K. J. Åström, T. Hägglund, *Advanced PID Control*, 2006,
//! 6.8 and 7.3 (maximise the integral gain subject to robustness).

use super::linear::{margins, response, Gains, Margins, Response};

/// The requirements on the loop at the steepest slope of the plant.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Asked {
    /// Smallest gain margin.
    pub gain_margin: f64,
    /// Smallest phase margin \[deg\].
    pub phase_margin: f64,
    /// Largest overshoot after a reference step, as a fraction of the step.
    pub overshoot: f64,
    /// Lower bound on the real part of the open loop.
    pub least_real: f64,
}

/// The requirements of [`bowden design`](super::design).
pub const ASKED: Asked = Asked {
    gain_margin: 2.0,
    phase_margin: 45.0,
    overshoot: 0.05,
    least_real: -1.0,
};

/// Longest delay in the search \[samples\]. A longer delay has the same gains in another unit of
/// time.
const LONGEST: usize = 48;

/// Gains, and the properties of the loop at the steepest slope of the plant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Found {
    pub(super) gains: Gains,
    pub(super) margins: Margins,
    pub(super) response: Response,
}

fn admissible(gains: Gains, delay: usize) -> bool {
    let own = margins(gains, delay);
    own.gain >= ASKED.gain_margin
        && own.phase >= ASKED.phase_margin
        && own.least_real > ASKED.least_real
        && response(gains, delay, 1.0).overshoot <= ASKED.overshoot
}

/// The largest admitted value up to `high`, if all smaller values are admitted too.
fn greatest(high: f64, admitted: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, high);
    for _ in 0..24 {
        let middle = 0.5 * (low + high);
        if admitted(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// The largest integral gain with the other gains.
pub(super) fn greatest_integral(rest: Gains, delay: usize) -> f64 {
    greatest(2.0, |k_i| admissible(Gains { k_i, ..rest }, delay))
}

/// The largest proportional gain without an integral, which only the gain margin limits.
pub(super) fn greatest_proportional() -> f64 {
    1.0 / ASKED.gain_margin
}

fn best(candidates: impl Iterator<Item = Gains>, delay: usize) -> Gains {
    let mut best = Gains::default();
    for rest in candidates {
        let k_i = greatest_integral(rest, delay);
        if k_i > best.k_i {
            best = Gains { k_i, ..rest };
        }
    }
    best
}

/// Scales the gains from the delay of the search to the real delay, and reduces them until the
/// margins are satisfied.
fn scaled(gains: Gains, from: usize, to: usize) -> Gains {
    let ratio = to as f64 / from as f64;
    let mut gains = Gains {
        k_p: gains.k_p,
        k_i: gains.k_i / ratio,
        k_d: gains.k_d * ratio,
        tau: gains.tau * ratio,
    };
    while !admissible(gains, to) && gains.k_i > 1e-12 {
        gains = gains.times(0.99);
    }
    gains
}

/// PI gains for `delay` samples of delay.
pub(super) fn pi(delay: usize) -> Found {
    let seen = delay.min(LONGEST);
    let grid = (1..=24).map(|k| Gains {
        k_p: greatest_proportional() * f64::from(k) / 25.0,
        ..Gains::default()
    });
    found(scaled(best(grid, seen), seen, delay), delay)
}

/// PID gains for `delay` samples of delay. The time constant of the filter is half of the delay.
pub(super) fn pid(delay: usize) -> Found {
    let seen = delay.min(LONGEST / 2);
    let tau = (0.5 * seen as f64).max(1.0);
    let grid = (1..=5).flat_map(|p| {
        (1..=5).map(move |d| Gains {
            k_p: greatest_proportional() * f64::from(p) / 6.0,
            // At high frequencies the term has the gain k_d/tau.
            k_d: 0.1 * f64::from(d) * tau,
            tau,
            ..Gains::default()
        })
    });
    found(scaled(best(grid, seen), seen, delay), delay)
}

fn found(gains: Gains, delay: usize) -> Found {
    Found {
        gains,
        margins: margins(gains, delay),
        response: response(gains, delay, 1.0),
    }
}
