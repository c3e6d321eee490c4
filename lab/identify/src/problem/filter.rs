//! The zero-phase smoother: a Butterworth low-pass run forwards and backwards.
//!
//! The same filter acts on every column and on the output, so it can neither create a false viscous
//! term nor hide a real one: both sides of the regression change equally. Run in both directions it
//! has no phase, and the square of the magnitude of the fourth-order filter, −6 dB at the cut-off.
//!
//! Source: bilinear transform of the Butterworth prototype with pre-warped cut-off
//! (Oppenheim and Schafer, *Discrete-Time Signal Processing*, chapter 7);
//! forward-backward filtering after Gustafsson (1996).

use std::f64::consts::PI;

/// Number of signals that are filtered at once.
pub(crate) const ABREAST: usize = 8;

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

    /// The state for which a constant input of one gives a constant output of one.
    fn settled(&self) -> [f64; 2] {
        let z1 = self.b[2] - self.a[1];
        [self.b[1] - self.a[0] + z1, z1]
    }
}

/// Rows that pass one section before the next, or columns that are multiplied at a time: few enough to
/// stay in the nearest cache.
pub(crate) const BLOCK: usize = 64;
/// The memory of a recursion is set to zero below this value.
///
/// If a signal is zero for a long time, the memory would otherwise decay to denormal floats, which
/// make each operation many times slower. From this value no section reaches them within a block.
const SILENT: f64 = 1e-200;

/// Whether a recursion sets this value of its memory to zero.
pub(crate) fn is_silent(value: f64) -> bool {
    value.abs() < SILENT
}

/// One section that processes `W` signals in parallel.
struct Running<const W: usize> {
    section: Section,
    memory: [[f64; W]; 2],
}

impl<const W: usize> Running<W> {
    /// Settled on constant signals.
    #[inline(always)]
    fn settled(section: Section, constant: [f64; W]) -> Self {
        let memory = section.settled().map(|z| constant.map(|x| z * x));
        Self { section, memory }
    }

    /// Filters the rows in place, in their order.
    #[inline(always)]
    fn through<'a>(&mut self, rows: impl Iterator<Item = &'a mut [f64; W]>) {
        let Section { b, a } = self.section;
        let [mut u0, mut u1] = self.memory;
        for row in rows {
            for lane in 0..W {
                let x = row[lane];
                let y = b[0] * x + u0[lane];
                u0[lane] = b[1] * x - a[0] * y + u1[lane];
                u1[lane] = b[2] * x - a[1] * y;
                row[lane] = y;
            }
        }
        for z in u0.iter_mut().chain(&mut u1) {
            if is_silent(*z) {
                *z = 0.0;
            }
        }
        self.memory = [u0, u1];
    }
}

/// Both sections, one after the other, over rows in place.
#[inline(always)]
fn forwards<const W: usize>(running: &mut [Running<W>; 2], rows: &mut [[f64; W]]) {
    for section in running {
        section.through(rows.iter_mut());
    }
}

/// The same, from the last row to the first.
#[inline(always)]
fn backwards<const W: usize>(running: &mut [Running<W>; 2], rows: &mut [[f64; W]]) {
    for section in running {
        section.through(rows.iter_mut().rev());
    }
}

/// Forwards and backwards over `W` signals, in the widest registers that the processor has.
///
/// The result has the same bits in registers of any width: no sum is reordered, and no product is
/// fused with a sum.
struct BothWays<'a, const W: usize> {
    filter: &'a ZeroPhase,
    signals: [&'a [f64]; W],
    stride: usize,
}

impl<const W: usize> pulp::WithSimd for BothWays<'_, W> {
    type Output = [Vec<f64>; W];

    // What is not inlined here is compiled for the narrow registers of any processor.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        self.filter.both_ways(self.signals, self.stride)
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

    /// The smoothed signal, as long as the given one.
    ///
    /// The ends are continued by point reflection, as is usual.
    #[must_use]
    pub fn apply(&self, signal: &[f64]) -> Vec<f64> {
        self.abreast([signal], 1).into_iter().flatten().collect()
    }

    /// Every `stride`-th sample of each smoothed signal. The signals have one length.
    ///
    /// Eight signals go through the recursion in parallel: one signal waits for its own last value
    /// at every step, but eight do not wait for each other. Each result equals that of
    /// [`apply`](Self::apply) bit for bit.
    #[must_use]
    pub fn apply_all(&self, signals: &[&[f64]], stride: usize) -> Vec<Vec<f64>> {
        let mut all = Vec::with_capacity(signals.len());
        for group in signals.chunks(ABREAST) {
            match *group {
                [a] => all.extend(self.abreast([a], stride)),
                [a, b] => all.extend(self.abreast([a, b], stride)),
                _ if group.len() <= 4 => all.extend(self.some_of::<4>(group, stride)),
                _ => all.extend(self.some_of::<ABREAST>(group, stride)),
            }
        }
        all
    }

    /// At most `W` signals; unused lanes repeat the first.
    fn some_of<const W: usize>(
        &self,
        group: &[&[f64]],
        stride: usize,
    ) -> impl Iterator<Item = Vec<f64>> {
        let lanes = std::array::from_fn(|lane| *group.get(lane).unwrap_or(&group[0]));
        let smoothed = self.abreast::<W>(lanes, stride);
        smoothed.into_iter().take(group.len())
    }

    fn abreast<const W: usize>(&self, signals: [&[f64]; W], stride: usize) -> [Vec<f64>; W] {
        pulp::Arch::new().dispatch(BothWays {
            filter: self,
            signals,
            stride,
        })
    }

    #[inline(always)]
    fn both_ways<const W: usize>(&self, signals: [&[f64]; W], stride: usize) -> [Vec<f64>; W] {
        let n = signals.iter().map(|s| s.len()).min().unwrap_or(0);
        if n < 2 {
            return signals.map(<[f64]>::to_vec);
        }
        let signals = signals.map(|s| &s[..n]);
        let pad = self.padding.min(n - 1);
        let beyond = |end: usize, inside: usize| signals.map(|s| 2.0 * s[end] - s[inside]);
        let mut work = vec![[0.0; W]; n + 2 * pad];
        let (before, rest) = work.split_at_mut(pad);
        let (rows, after) = rest.split_at_mut(n);
        for (i, row) in before.iter_mut().rev().enumerate() {
            *row = beyond(0, i + 1);
        }
        for (i, row) in after.iter_mut().enumerate() {
            *row = beyond(n - 1, n - 2 - i);
        }
        let settled = |on: [f64; W]| self.sections.map(|s| Running::settled(s, on));

        let mut running = settled(beyond(0, pad));
        forwards(&mut running, before);
        for (k, rows) in rows.chunks_mut(BLOCK).enumerate() {
            for (lane, signal) in signals.iter().enumerate() {
                for (row, value) in rows.iter_mut().zip(&signal[k * BLOCK..]) {
                    row[lane] = *value;
                }
            }
            forwards(&mut running, rows);
        }
        forwards(&mut running, after);

        let mut running = settled(after[pad - 1]);
        backwards(&mut running, after);
        let mut smoothed = signals.map(|_| vec![0.0; n.div_ceil(stride)]);
        for (k, rows) in rows.chunks_mut(BLOCK).enumerate().rev() {
            backwards(&mut running, rows);
            let first = (k * BLOCK).div_ceil(stride);
            let kept = rows.iter().skip(first * stride - k * BLOCK).step_by(stride);
            for (i, row) in kept.enumerate() {
                for (signal, value) in smoothed.iter_mut().zip(row) {
                    signal[first + i] = *value;
                }
            }
        }
        smoothed
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

/// Amplitude gain of the smoother at `frequency` \[Hz\].
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

    /// As the formula is written: padded, forwards, backwards, cut.
    fn one_by_one(filter: &ZeroPhase, signal: &[f64]) -> Vec<f64> {
        let n = signal.len();
        let pad = filter.padding.min(n - 1);
        let before = (1..=pad).rev().map(|i| 2.0 * signal[0] - signal[i]);
        let after = (1..=pad).map(|i| 2.0 * signal[n - 1] - signal[n - 1 - i]);
        let mut work: Vec<f64> = before.chain(signal.iter().copied()).chain(after).collect();
        for _ in 0..2 {
            let first = work[0];
            for section in filter.sections {
                let [mut z0, mut z1] = section.settled().map(|z| z * first);
                for value in &mut work {
                    let x = *value;
                    let y = section.b[0] * x + z0;
                    z0 = section.b[1] * x - section.a[0] * y + z1;
                    z1 = section.b[2] * x - section.a[1] * y;
                    *value = y;
                }
            }
            work.reverse();
        }
        work[pad..pad + n].to_vec()
    }

    #[test]
    fn signals_abreast_come_out_bit_for_bit_as_one_by_one_at_every_stride() {
        let filter = ZeroPhase::new(7.0, 200.0);
        for n in [2, 3, 40, 400] {
            let signals: Vec<Vec<f64>> = (0..11)
                .map(|k| sine(1.0 + 3.1 * f64::from(k), 200.0, n))
                .collect();
            for (count, stride) in [(1, 1), (2, 3), (3, 1), (5, 6), (8, 7), (11, 4)] {
                let some: Vec<&[f64]> = signals[..count].iter().map(Vec::as_slice).collect();
                let abreast = filter.apply_all(&some, stride);
                assert_eq!(abreast.len(), count);
                for (signal, smoothed) in some.iter().zip(&abreast) {
                    let expected: Vec<f64> = one_by_one(&filter, signal)
                        .into_iter()
                        .step_by(stride)
                        .collect();
                    assert_eq!(
                        smoothed, &expected,
                        "{count} of {n} samples, every {stride}"
                    );
                }
            }
        }
    }

    /// With denormal floats each operation takes many times as long.
    #[test]
    fn where_a_signal_is_silent_nothing_denormal_is_left() {
        let mut signal = sine(3.0, 200.0, 400);
        signal.resize(20_000, 0.0);
        signal.extend(sine(3.0, 200.0, 400));
        for cutoff in [20.0, 90.0, 5.0] {
            let smoothed = ZeroPhase::new(cutoff, 200.0).apply(&signal);
            let is_usual = |v: &f64| *v == 0.0 || v.is_normal();
            assert!(smoothed.iter().all(is_usual), "{cutoff} Hz");
            assert_eq!(smoothed[10_000], 0.0, "{cutoff} Hz");
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
