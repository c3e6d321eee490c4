//! The zero-phase smoother: a Butterworth low-pass run forwards and backwards.
//!
//! One filter serves every column and the output, so that it can neither make a
//! fake viscous term nor hide a real one: what it takes from the one side of the
//! regression it takes from the other. Run in both directions it has no phase, and
//! the square of the magnitude of the fourth-order filter, −6 dB at the cut-off.
//!
//! Source: bilinear transform of the Butterworth prototype with pre-warped cut-off
//! (Oppenheim and Schafer, *Discrete-Time Signal Processing*, chapter 7);
//! forward-backward filtering after Gustafsson (1996).

use std::f64::consts::PI;

/// One second-order section in transposed direct form II.
#[derive(Debug, Clone, Copy)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

impl Section {
    /// Low-pass with unit gain at zero frequency and quality factor `q`.
    fn low_pass(warped: f64, q: f64) -> Self {
        let k2 = warped * warped;
        let norm = 1.0 / (1.0 + warped / q + k2);
        let b0 = k2 * norm;
        Self {
            b: [b0, 2.0 * b0, b0],
            a: [2.0 * (k2 - 1.0) * norm, (1.0 - warped / q + k2) * norm],
        }
    }

    /// The state in which a constant input of one stays a constant output of one.
    fn settled(&self) -> [f64; 2] {
        let z1 = self.b[2] - self.a[1];
        [self.b[1] - self.a[0] + z1, z1]
    }
}

/// A fourth-order Butterworth low-pass without phase.
#[derive(Debug, Clone)]
pub struct ZeroPhase {
    sections: [Section; 2],
    padding: usize,
}

impl ZeroPhase {
    /// A smoother with `cutoff` \[Hz\] for signals sampled at `rate` \[Hz\].
    ///
    /// A cut-off at or above 0.45 of the rate is lowered to that.
    #[must_use]
    pub fn new(cutoff: f64, rate: f64) -> Self {
        let cutoff = if cutoff < 0.45 * rate {
            cutoff
        } else {
            0.45 * rate
        };
        let warped = (PI * cutoff / rate).tan();
        // The pole angles of the fourth-order prototype: pi/8 and 3 pi/8.
        let section = |angle: f64| Section::low_pass(warped, 0.5 / angle.cos());
        Self {
            sections: [section(PI / 8.0), section(3.0 * PI / 8.0)],
            padding: (1.5 * rate / cutoff).ceil() as usize,
        }
    }

    fn pass<'a>(&self, signal: impl Iterator<Item = &'a mut f64>, first: f64) {
        let [s, t] = self.sections;
        let (mut u, mut w) = (
            s.settled().map(|z| z * first),
            t.settled().map(|z| z * first),
        );
        for value in signal {
            let x = *value;
            let m = s.b[0] * x + u[0];
            u[0] = s.b[1] * x - s.a[0] * m + u[1];
            u[1] = s.b[2] * x - s.a[1] * m;
            let y = t.b[0] * m + w[0];
            w[0] = t.b[1] * m - t.a[0] * y + w[1];
            w[1] = t.b[2] * m - t.a[1] * y;
            *value = y;
        }
    }

    /// The smoothed signal, as long as the given one.
    ///
    /// The ends are continued by point reflection, as is usual.
    #[must_use]
    pub fn apply(&self, signal: &[f64]) -> Vec<f64> {
        let n = signal.len();
        if n < 2 {
            return signal.to_vec();
        }
        let pad = self.padding.min(n - 1);
        let mut work = Vec::with_capacity(n + 2 * pad);
        work.extend((1..=pad).rev().map(|i| 2.0 * signal[0] - signal[i]));
        work.extend_from_slice(signal);
        work.extend((1..=pad).map(|i| 2.0 * signal[n - 1] - signal[n - 1 - i]));
        let first = work[0];
        self.pass(work.iter_mut(), first);
        let last = work[work.len() - 1];
        self.pass(work.iter_mut().rev(), last);
        work.drain(..pad);
        work.truncate(n);
        work
    }

    /// The gain on white noise: rms out over rms in.
    #[must_use]
    pub fn noise_gain(&self) -> f64 {
        let reach = 8 * self.padding + 64;
        let mut impulse = vec![0.0; 2 * reach + 1];
        impulse[reach] = 1.0;
        let response = self.apply(&impulse);
        response.iter().map(|h| h * h).sum::<f64>().sqrt()
    }
}

/// What the smoother leaves of the amplitude at `frequency` \[Hz\].
#[must_use]
pub fn gain(cutoff: f64, rate: f64, frequency: f64) -> f64 {
    let warped = |f: f64| (PI * f / rate).tan();
    1.0 / (1.0 + (warped(frequency) / warped(cutoff)).powi(8))
}

/// The derivative by fourth-order central differences; lower order at the ends.
#[must_use]
pub fn derivative(signal: &[f64], dt: f64) -> Vec<f64> {
    let n = signal.len();
    let at = |i: usize| -> f64 {
        if n < 2 {
            0.0
        } else if i == 0 {
            signal[1] - signal[0]
        } else if i == n - 1 {
            signal[n - 1] - signal[n - 2]
        } else if i == 1 || i == n - 2 {
            0.5 * (signal[i + 1] - signal[i - 1])
        } else {
            (8.0 * (signal[i + 1] - signal[i - 1]) - (signal[i + 2] - signal[i - 2])) / 12.0
        }
    };
    (0..n).map(|i| at(i) / dt).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(frequency: f64, rate: f64, n: usize) -> Vec<f64> {
        (0..n)
            .map(|i| (2.0 * PI * frequency * i as f64 / rate).sin())
            .collect()
    }

    #[test]
    fn the_gain_is_that_of_an_eighth_order_butterworth_and_there_is_no_phase() {
        let (rate, cutoff) = (1000.0, 20.0);
        let filter = ZeroPhase::new(cutoff, rate);
        for frequency in [2.0, 10.0, 20.0, 40.0] {
            let input = sine(frequency, rate, 4000);
            let output = filter.apply(&input);
            // |H|^2 of the fourth-order low-pass at the pre-warped frequency.
            let gain = gain(cutoff, rate, frequency);
            for i in 1000..3000 {
                // The transient of the ends has decayed to 1e-9 after a second.
                assert!(
                    (output[i] - gain * input[i]).abs() < 1e-8,
                    "{frequency} Hz at {i}"
                );
            }
        }
    }

    #[test]
    fn a_constant_and_a_ramp_pass_unchanged() {
        let filter = ZeroPhase::new(5.0, 100.0);
        let ramp: Vec<f64> = (0..300).map(|i| 3.0 + 0.25 * f64::from(i)).collect();
        for (a, b) in ramp.iter().zip(filter.apply(&ramp)) {
            // A ramp is a fixed point up to the start-up of each pass in the padding.
            assert!((a - b).abs() < 2e-2, "{a} {b}");
        }
        for v in filter.apply(&[7.5; 50]) {
            assert!((v - 7.5).abs() < 1e-12);
        }
    }

    #[test]
    fn the_noise_gain_matches_the_integral_of_the_magnitude() {
        let (rate, cutoff) = (200.0, 10.0);
        let steps = 200_000;
        let mut integral = 0.0;
        for i in 0..steps {
            let f = (f64::from(i) + 0.5) / f64::from(steps) * rate / 2.0;
            let ratio = (PI * f / rate).tan() / (PI * cutoff / rate).tan();
            integral += (1.0 / (1.0 + ratio.powi(8))).powi(2) / f64::from(steps);
        }
        let gain = ZeroPhase::new(cutoff, rate).noise_gain();
        assert!((gain - integral.sqrt()).abs() < 1e-6 * gain);
    }

    #[test]
    fn the_derivative_of_a_cubic_is_exact_inside() {
        let dt = 0.1;
        let cubic: Vec<f64> = (0..50).map(|i| (f64::from(i) * dt).powi(3)).collect();
        let slope = derivative(&cubic, dt);
        for (i, s) in slope.iter().enumerate().take(48).skip(2) {
            let t = i as f64 * dt;
            assert!((s - 3.0 * t * t).abs() < 1e-9);
        }
    }
}
