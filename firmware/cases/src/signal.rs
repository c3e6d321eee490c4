//! What the cases are fed with: four tables of samples at 1 kHz.
//!
//! The compiler computes them, in `f64` and without a library, so that they have the same
//! bits on every host and cost an image no code.

/// Samples of a signal: one period of the sine.
pub const LENGTH: usize = 2000;

/// One sample, with all that any of the cases reads.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// Since the last sample \[s\].
    pub dt: f32,
    /// Torque that is wanted \[N·m\].
    pub reference: f32,
    /// The same at the next sample \[N·m\].
    pub next_reference: f32,
    /// Torque that is measured \[N·m\].
    pub measured: f32,
    /// Input of the cable \[N·m\].
    pub input: f32,
    /// Pulley \[rad\].
    pub position: f32,
    /// Pulley \[rad/s\].
    pub velocity: f32,
    /// Pulley \[rad/s²\].
    pub acceleration: f32,
}

/// Which samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Signal {
    /// An input of `16·sin(pi·t)` N·m, without noise.
    Sine,
    /// The same with white noise: 0.29 N·m rms on the output, 0.03 on the input, and `dt`
    /// up to a tenth shorter.
    Noise,
    /// Every sample anywhere: the input within ±16 N·m, the output within 0 to 38 N·m.
    Jumps,
    /// The noise with one bad sample in eight, and with forty of them in a row.
    Faults,
}

impl Signal {
    /// All signals, in the order of [`SIGNALS`].
    pub const ALL: [Self; 4] = [Self::Sine, Self::Noise, Self::Jumps, Self::Faults];

    /// As it is called in the table of budgets.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sine => "sine",
            Self::Noise => "noise",
            Self::Jumps => "jumps",
            Self::Faults => "faults",
        }
    }

    /// Its samples.
    #[must_use]
    pub fn samples(self) -> &'static [Sample; LENGTH] {
        let [sine, noise, jumps, faults] = &SIGNALS;
        match self {
            Self::Sine => sine,
            Self::Noise => noise,
            Self::Jumps => jumps,
            Self::Faults => faults,
        }
    }
}

/// The samples of each signal of [`Signal::ALL`].
pub static SIGNALS: [[Sample; LENGTH]; 4] = [
    table(Signal::Sine),
    table(Signal::Noise),
    table(Signal::Jumps),
    table(Signal::Faults),
];

const NOMINAL_DT: f64 = 1e-3;
/// 0.5 Hz, as the benchmark of the step has it \[rad/s\].
const FREQUENCY: f64 = core::f64::consts::PI;
/// Sine and cosine of the angle of one sample, by their series: exact to rounding.
const STEP: (f64, f64) = {
    let x = FREQUENCY * NOMINAL_DT;
    let x2 = x * x;
    (
        x * (1.0 - x2 / 6.0 * (1.0 - x2 / 20.0)),
        1.0 - x2 / 2.0 * (1.0 - x2 / 12.0 * (1.0 - x2 / 30.0)),
    )
};

/// A linear congruential generator; its upper bits are good enough to feed a step.
struct Random(u64);

impl Random {
    /// The next number within ±1.
    const fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        2.0 * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64) - 1.0
    }
}

#[allow(long_running_const_eval)] // 8000 samples, less than a second
const fn table(signal: Signal) -> [Sample; LENGTH] {
    let mut samples = [rounded(0.0, 1.0); LENGTH];
    let mut random = Random(signal as u64 + 1);
    let (mut sine, mut cosine) = (0.0, 1.0);
    let mut k = 0;
    while k < LENGTH {
        samples[k] = match signal {
            Signal::Sine => rounded(sine, cosine),
            Signal::Noise => noisy(rounded(sine, cosine), &mut random),
            Signal::Jumps => anywhere(&mut random),
            Signal::Faults => bad(k, noisy(rounded(sine, cosine), &mut random)),
        };
        if k > 0 {
            samples[k - 1].next_reference = samples[k].reference;
        }
        (sine, cosine) = (
            sine * STEP.1 + cosine * STEP.0,
            cosine * STEP.1 - sine * STEP.0,
        );
        k += 1;
    }
    samples
}

/// The sample of the undisturbed sine.
const fn rounded(sine: f64, cosine: f64) -> Sample {
    let reference = 25.0 + 10.0 * sine;
    let (amplitude, w) = (0.25, FREQUENCY);
    Sample {
        dt: NOMINAL_DT as f32,
        reference: reference as f32,
        next_reference: reference as f32,
        // An error of either sign, as fast as the reference's second harmonic.
        measured: (reference - 0.8 * sine * cosine) as f32,
        input: (16.0 * sine) as f32,
        position: (amplitude * sine) as f32,
        velocity: (amplitude * w * cosine) as f32,
        acceleration: (-amplitude * w * w * sine) as f32,
    }
}

const fn noisy(clean: Sample, random: &mut Random) -> Sample {
    Sample {
        dt: (NOMINAL_DT * (0.95 + 0.05 * random.next())) as f32,
        measured: clean.measured + (0.5 * random.next()) as f32,
        input: clean.input + (0.05 * random.next()) as f32,
        velocity: clean.velocity + (0.02 * random.next()) as f32,
        acceleration: clean.acceleration + (0.5 * random.next()) as f32,
        ..clean
    }
}

const fn anywhere(random: &mut Random) -> Sample {
    let reference = 19.0 + 19.0 * random.next();
    Sample {
        dt: NOMINAL_DT as f32,
        reference: reference as f32,
        next_reference: reference as f32,
        measured: (19.0 + 19.0 * random.next()) as f32,
        input: (16.0 * random.next()) as f32,
        position: (0.25 * random.next()) as f32,
        velocity: (2.0 * random.next()) as f32,
        acceleration: (20.0 * random.next()) as f32,
    }
}

/// One of the ways in which a sample can be bad, in turn.
const fn bad(k: usize, good: Sample) -> Sample {
    let lost = LENGTH / 2 <= k && k < LENGTH / 2 + 40;
    if k % 8 != 7 && !lost {
        return good;
    }
    let mut sample = good;
    match (k / 8) % 8 {
        0 => sample.measured = f32::NAN,
        1 => sample.dt = 0.0,
        2 => sample.velocity = f32::INFINITY,
        3 => sample.reference = f32::NAN,
        4 => sample.dt = f32::NAN,
        5 => sample.input = f32::NAN,
        6 => sample.dt = 4295.0,
        _ => sample.measured = f32::NEG_INFINITY,
    }
    if lost {
        sample.measured = f32::NAN;
        sample.input = f32::NAN;
    }
    sample
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sine_is_a_sine() {
        for (k, sample) in Signal::Sine.samples().iter().enumerate() {
            let expected = 16.0 * (k as f64 * 1e-3 * core::f64::consts::PI).sin_by_series();
            // Half an ulp of 16 in f32, and 2000 roundings in f64.
            assert!(
                (f64::from(sample.input) - expected).abs() < 1e-6,
                "sample {k}"
            );
        }
    }

    trait Series {
        fn sin_by_series(self) -> f64;
    }

    impl Series for f64 {
        fn sin_by_series(self) -> f64 {
            bowden::Real::sin(self)
        }
    }

    #[test]
    fn good_signals_are_finite_and_faults_are_not_all() {
        let bad = |at: &&Sample| {
            let sum = at.dt + at.reference + at.measured + at.input + at.velocity;
            !(sum.is_finite() && at.dt > 0.0 && at.dt < 0.01)
        };
        for signal in [Signal::Sine, Signal::Noise, Signal::Jumps] {
            assert_eq!(signal.samples().iter().filter(bad).count(), 0, "{signal:?}");
        }
        // Every eighth, and 40 in a row of which 5 are such.
        assert_eq!(
            Signal::Faults.samples().iter().filter(bad).count(),
            LENGTH / 8 + 35
        );
    }

    #[test]
    fn the_next_reference_is_the_reference_of_the_next_sample() {
        for pair in Signal::Jumps.samples().windows(2) {
            assert_eq!(pair[0].next_reference, pair[1].reference);
        }
    }
}
