//! The sampled loop of a static gain with a delay: margins, overshoot, settling time.
//!
//! With the plant's gain and the sample time as units, `y(k) = u(k - D)` and
//! `C(z) = k_p + k_i/(1 - 1/z) + k_d·(1 - 1/z)/(tau + 1 - tau/z)`, which is what
//! [`Pid::step`](bowden::control::Pid::step) computes. The hold is part of the sampled plant, so
//! the margins are exact. Source: K. J. Åström, B. Wittenmark, *Computer-Controlled Systems*, 3rd
//! ed., 1997, 3.3 and 4.

use std::f64::consts::PI;

/// Gains in units of the plant's gain and of the sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Gains {
    /// `k_p` times the plant's gain.
    pub(super) k_p: f64,
    /// `k_i` times the plant's gain and the sample time.
    pub(super) k_i: f64,
    /// `k_d` times the plant's gain over the sample time.
    pub(super) k_d: f64,
    /// Time constant of the derivative's filter \[samples\].
    pub(super) tau: f64,
}

impl Gains {
    /// All three gains times `factor`.
    pub(super) fn times(self, factor: f64) -> Self {
        Self {
            k_p: self.k_p * factor,
            k_i: self.k_i * factor,
            k_d: self.k_d * factor,
            tau: self.tau,
        }
    }

    /// The same controller at a step that is `ratio` times as long.
    pub(super) fn at_step(self, ratio: f64) -> Self {
        Self {
            k_p: self.k_p,
            k_i: self.k_i * ratio,
            k_d: self.k_d / ratio,
            tau: self.tau / ratio,
        }
    }

    /// Real and imaginary part of the open loop with `delay` samples of delay at `w`
    /// \[rad/sample\].
    fn at(&self, delay: f64, w: f64) -> (f64, f64) {
        // 1 - 1/z = 2·sin²(w/2) + i·sin(w).
        let (re, im) = (2.0 * (0.5 * w).sin().powi(2), w.sin());
        let square = re * re + im * im;
        let (mut a, mut b) = (self.k_p + self.k_i * re / square, -self.k_i * im / square);
        if self.k_d != 0.0 {
            let (c, d) = (1.0 + self.tau * re, self.tau * im);
            let below = self.k_d / (c * c + d * d);
            a += below * (re * c + im * d);
            b += below * (im * c - re * d);
        }
        let (sin, cos) = (-w * delay).sin_cos();
        (a * cos - b * sin, a * sin + b * cos)
    }
}

/// The distance of a loop from instability.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Margins {
    /// Gain margin: the factor by which the loop gain may increase.
    pub gain: f64,
    /// Phase margin \[deg\].
    pub phase: f64,
    /// Smallest real part of the open loop. If it exceeds -1, no sequence of slopes between zero
    /// and the largest slope makes the loop unstable (circle criterion).
    pub least_real: f64,
}

/// The margins with `delay` samples of delay.
pub(super) fn margins(gains: Gains, delay: usize) -> Margins {
    let delay = delay as f64;
    // Points of the sweep: 24 in a half turn of the delay's phase.
    let count = (24.0 * (delay + 1.0)).ceil();
    let point = |k: f64| {
        let w = PI * k / count;
        (w, gains.at(delay, w))
    };
    let mut found = Margins {
        gain: f64::INFINITY,
        phase: 180.0,
        least_real: f64::INFINITY,
    };
    let mut before = (1e-6 / (delay + 1.0), gains.at(delay, 1e-6 / (delay + 1.0)));
    found.least_real = found.least_real.min(before.1 .0);
    for k in 1..=count as usize {
        let here = point(k as f64);
        found.least_real = found.least_real.min(here.1 .0);
        let last = k == count as usize;
        if (before.1 .1 < 0.0) != (here.1 .1 < 0.0) || last {
            let w = if last && (before.1 .1 < 0.0) == (here.1 .1 < 0.0) {
                here.0
            } else {
                crossing(before.0, here.0, |w| gains.at(delay, w).1)
            };
            let (re, im) = gains.at(delay, w);
            if re < 0.0 && im.abs() < 1e-3 * re.abs().max(1e-9) {
                found.gain = found.gain.min(-1.0 / re);
            }
        }
        let size = |(re, im): (f64, f64)| re.hypot(im) - 1.0;
        if (size(before.1) < 0.0) != (size(here.1) < 0.0) {
            let w = crossing(before.0, here.0, |w| size(gains.at(delay, w)));
            let (re, im) = gains.at(delay, w);
            found.phase = found.phase.min((-im).atan2(-re).abs().to_degrees());
        }
        before = here;
    }
    found
}

/// The point between `low` and `high` at which a function changes its sign.
fn crossing(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
    let below = of(low) < 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (of(middle) < 0.0) == below {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// The response to a reference step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Response {
    /// Largest output above the reference, as a fraction of the step.
    pub(super) overshoot: f64,
    /// Number of samples after which the output stays within 2 % of the step.
    pub(super) settled: Option<usize>,
}

/// The step response with `delay` samples of delay, for a plant whose gain is the fraction `gain`
/// of the largest gain.
pub(super) fn response(gains: Gains, delay: usize, gain: f64) -> Response {
    let length = 60 * (delay + 1);
    let mut commands = Vec::with_capacity(length);
    // The derivative is of the output alone: a step of the reference does not kick it.
    let (mut integral, mut rate, mut last) = (0.0, 0.0, 0.0);
    let mut found = Response {
        overshoot: 0.0,
        settled: None,
    };
    for k in 0..length {
        let y = k
            .checked_sub(delay)
            .map_or(0.0, |then| gain * commands[then]);
        let error: f64 = 1.0 - y;
        found.overshoot = found.overshoot.max(-error);
        if error.abs() > 0.02 {
            found.settled = None;
        } else if found.settled.is_none() {
            found.settled = Some(k);
        }
        integral += gains.k_i * error;
        rate += (last - y - rate) / (gains.tau + 1.0);
        last = y;
        commands.push(gains.k_p * error + integral + gains.k_d * rate);
        if !error.is_finite() {
            break;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_margins_of_an_integrator_behind_a_delay_are_those_of_the_closed_form() {
        // 1 - 1/z = 2i·sin(w/2)·e^(-iw/2): the phase is -90° - w·(D - 1/2), so that it is -180°
        // at w = pi/(2D - 1), where the loop has the gain k/(2·sin(w/2)).
        for delay in [1_usize, 2, 5, 30] {
            let k = 0.3 / delay as f64;
            let own = margins(
                Gains {
                    k_i: k,
                    ..Gains::default()
                },
                delay,
            );
            let w = PI / (2.0 * delay as f64 - 1.0);
            let gain = 2.0 * (0.5 * w).sin() / k;
            assert!(
                (own.gain / gain - 1.0).abs() < 1e-6,
                "{delay}: {own:?} {gain}"
            );
            let w = 2.0 * (0.5 * k).asin();
            let phase = 90.0 - (w * (delay as f64 - 0.5)).to_degrees();
            assert!((own.phase - phase).abs() < 1e-6, "{delay}: {own:?} {phase}");
        }
    }

    #[test]
    fn beyond_the_gain_margin_the_response_grows_and_within_it_it_settles() {
        let gains = Gains {
            k_p: 0.2,
            k_i: 0.1,
            k_d: 0.1,
            tau: 2.0,
        };
        for delay in [1, 3, 8] {
            let own = margins(gains, delay);
            let within = response(gains.times(0.9 * own.gain), delay, 1.0);
            assert!(within.overshoot < 2.0, "{delay}: {within:?}");
            let beyond = response(gains.times(1.3 * own.gain), delay, 1.0);
            assert!(
                beyond.overshoot > 10.0 && beyond.settled.is_none(),
                "{delay}: {beyond:?}"
            );
        }
    }
}
