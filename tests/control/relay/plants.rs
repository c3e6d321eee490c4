//! Lags in series behind a delay: simulated by Runge-Kutta, and as a frequency response.

use super::*;
use std::collections::VecDeque;

#[derive(Debug, Clone)]
pub struct Plant {
    gain: f64,
    lags: Vec<f64>,
    delay: f64,
    states: Vec<f64>,
    /// Added to the command at the input of the lags.
    load: f64,
    /// Commands that have not reached the lags, with the time until they do.
    late: VecDeque<(f64, f64)>,
    acts: f64,
}

impl Plant {
    pub fn new(gain: f64, lags: &[f64], delay: f64) -> Self {
        Self {
            gain,
            lags: lags.to_vec(),
            delay,
            states: vec![0.0; lags.len()],
            load: 0.0,
            late: VecDeque::new(),
            acts: 0.0,
        }
    }

    /// 1/(s + 1)³: k_u = 8, w_u = sqrt(3).
    pub fn third_order() -> Self {
        Self::new(1.0, &[1.0; 3], 0.0)
    }

    pub fn with_load(mut self, load: f64) -> Self {
        self.load = load;
        self
    }

    pub fn output(&self) -> f64 {
        self.states[self.states.len() - 1]
    }

    /// The command from here on, for `dt`.
    pub fn run(&mut self, command: f64, dt: f64) {
        self.late.push_back((self.delay, command));
        let mut left = dt;
        while left > 0.0 {
            while self.late.front().is_some_and(|(due, _)| *due <= 0.0) {
                self.acts = self.late.pop_front().unwrap().1;
            }
            let shortest = self.lags.iter().fold(f64::INFINITY, |a, b| a.min(*b));
            let due = self.late.front().map_or(f64::INFINITY, |(due, _)| *due);
            let h = left.min(due).min(0.02 * shortest);
            self.advance(h);
            left -= h;
            for (due, _) in &mut self.late {
                *due -= h;
            }
        }
    }

    fn advance(&mut self, h: f64) {
        let input = self.gain * (self.acts + self.load);
        let rates = |states: &[f64]| -> Vec<f64> {
            let from = std::iter::once(&input).chain(states);
            let each = from.zip(states).zip(&self.lags);
            each.map(|((from, to), tau)| (from - to) / tau).collect()
        };
        let moved = |by: f64, rates: &[f64]| -> Vec<f64> {
            let each = self.states.iter().zip(rates);
            each.map(|(x, rate)| x + by * rate).collect()
        };
        let a = rates(&self.states);
        let b = rates(&moved(0.5 * h, &a));
        let c = rates(&moved(0.5 * h, &b));
        let d = rates(&moved(h, &c));
        for (i, x) in self.states.iter_mut().enumerate() {
            *x += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
        }
    }

    /// Magnitude and phase \[rad\] at a frequency \[rad/s\], the phase unwrapped.
    pub fn response(&self, w: f64) -> (f64, f64) {
        let lags = self.lags.iter();
        let (size, phase) = lags.fold((self.gain.abs(), -w * self.delay), |(size, phase), tau| {
            (size / (w * tau).hypot(1.0), phase - (w * tau).atan())
        });
        let sign = if self.gain < 0.0 { -1.0 } else { 1.0 };
        (sign * size, phase)
    }

    /// k_u and w_u \[rad/s\]: where the phase is -pi.
    pub fn ultimate(&self) -> (f64, f64) {
        let w = super::exact::root(1e-3, 1e3, |w| self.response(w).1 + std::f64::consts::PI);
        (1.0 / self.response(w).0, w)
    }
}

/// Sample times that jitter, and noise: both uniform.
pub struct Sampled {
    pub dt: f64,
    nominal: f64,
    jitter: f64,
    noise: f64,
    random: Random,
}

impl Sampled {
    pub fn every(dt: f64) -> Self {
        Self {
            dt,
            nominal: dt,
            jitter: 0.0,
            noise: 0.0,
            random: Random(1),
        }
    }

    /// With `dt` from `1 − jitter` to `1 + jitter` of the nominal one.
    pub fn jittering(self, jitter: f64) -> Self {
        Self { jitter, ..self }
    }

    /// With noise within ±`noise`.
    pub fn noisy(self, noise: f64) -> Self {
        Self { noise, ..self }
    }

    /// The time since the sample before, and the noise of this one.
    pub fn next(&mut self) -> (f64, f64) {
        (self.dt, self.noise * self.random.within(-1.0, 1.0))
    }

    pub fn drawn(&mut self) -> f64 {
        self.nominal * (1.0 + self.jitter * self.random.within(-1.0, 1.0))
    }
}
