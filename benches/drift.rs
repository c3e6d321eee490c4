//! How far `f32` drifts from `f64` in a loop that runs for hours: 1e8 steps at 10 kHz.
//!
//! `cargo bench --bench drift` prints the greatest difference within the last period of the
//! input, after each power of ten; `-- 1e6` stops earlier. Both run on the same samples,
//! rounded to `f32`, and nothing of one enters the other: what is printed is what rounding
//! adds up to, and for the hysteresis what its step leaves, too.

use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Fallback, Form, Limits,
    Pid, PidInput, PidSettings, PidState,
};
use bowden::hysteresis::BoucWen;
use bowden::model::{Model, ModelState, Sample};
use bowden::signal::{Rates, RatesState};
use bowden::{effect::Motion, Error, Real};
use std::f64::consts::TAU;

/// Steps a second, and those of one period of the input.
const RATE: f64 = 1e4;
const PERIOD: usize = 20_000;

const NAMES: [&str; 6] = [
    "eta, compared with the same step in f64",
    "eta, compared with the splitting step in f64",
    "clock of a model, relative",
    "integral of a PI, relative",
    "velocity from Rates at 6.3 rad/s [rad/s]",
    "estimates of the adaptive law, within bounds of 12",
];

/// The samples of one period: torque \[N·m\], angle \[rad\], error \[N·m\].
fn samples() -> Vec<[f64; 3]> {
    let one = |k: usize| {
        let phase = TAU * k as f64 / PERIOD as f64;
        // 1e-4 N·m on average: what an integral sums up in an hour.
        let error = 1e-4 + 0.3 * (3.0 * phase).sin();
        [16.0 * phase.sin(), 2.0 * phase.sin(), error].map(|x| f64::from(x as f32))
    };
    (0..PERIOD).map(one).collect()
}

/// Everything that keeps a state, in one precision.
struct Loop<T> {
    shape: BoucWen<T>,
    eta: [T; 2],
    last: T,
    model: Model<T, 0>,
    clock: ModelState<T, 0>,
    pi: Pid<T>,
    integral: PidState<T>,
    rates: Rates<T>,
    past: RatesState<T>,
    law: Adaptive<T, 2>,
    estimates: AdaptiveState<T, 2>,
}

/// What is compared.
struct Seen {
    eta: [f64; 2],
    time: f64,
    integral: f64,
    velocity: f64,
    estimates: [f64; 4],
}

impl<T: Real> Loop<T> {
    fn try_new() -> Result<Self, Error> {
        let of = T::from_f64;
        let shape = BoucWen::try_new(of(0.095_82), of(98.36), of(3.871))?;
        let (range, longest) = (Limits::try_new(of(-1e3), of(1e3))?, of(0.005));
        let safe = Fallback::try_new(20, of(0.0))?;
        let boxed = |low, gain| {
            Estimator::free(of(0.0))
                .within(of(low), of(6.0))
                .adapting(of(gain), of(0.01))
        };
        let (step, plant_gain) = (of(1.0 / RATE), of(1.0));
        let law = Adaptive::try_new(AdaptiveSettings {
            beta: Estimator::fixed(of(1.0))
                .within(of(0.8), of(1.2))
                .adapting(of(2.5e-4), of(0.01)),
            delta: boxed(0.0, 6e-3),
            theta: [boxed(-6.0, 5e-4); 2],
            ..AdaptiveSettings::new(
                Form::FirstOrder { step, plant_gain },
                of(24.0),
                of(8.0),
                of(0.1),
                range,
                longest,
                safe,
            )
        })?;
        Ok(Self {
            shape,
            eta: [of(0.0); 2],
            last: of(0.0),
            model: Model::try_new(None, &[])?,
            clock: ModelState::new(),
            pi: Pid::try_new(PidSettings::new(of(30.0), of(18.0), range, longest, safe))?,
            integral: PidState::new(),
            rates: Rates::try_new(of(0.005))?,
            past: RatesState::new(),
            law,
            estimates: AdaptiveState::new(&law),
        })
    }

    #[inline]
    fn step(&mut self, [torque, angle, error]: [f64; 3]) -> Seen {
        let [torque, angle, error] = [torque, angle, error].map(T::from_f64);
        let (dt, zero) = (T::from_f64(f64::from(1e-4_f32)), T::zero());
        let change = torque - self.last;
        self.last = torque;
        let [eta, split] = self.eta;
        self.eta = [
            self.shape.advance_bounded(eta, change),
            self.shape.advance_split(split, change),
        ];
        let input = Motion::default();
        let channels = &[];
        let load = zero;
        let at = Sample {
            dt,
            input,
            load,
            channels,
        };
        self.model.step(&mut self.clock, &at);
        self.pi
            .step(&mut self.integral, &PidInput::new(dt, error, zero));
        let motion = self.rates.step(&mut self.past, angle, dt).motion;
        let regressors = [motion.velocity, angle];
        let at = AdaptiveInput::new(dt, error, zero, regressors);
        self.law.step(&mut self.estimates, &at);
        let [first, second] = self.estimates.theta_hat();
        let (beta, delta) = (self.estimates.beta_hat(), self.estimates.delta_hat());
        Seen {
            eta: self.eta.map(T::as_f64),
            time: self.clock.time().as_f64(),
            integral: self.integral.integral().as_f64(),
            velocity: motion.velocity.as_f64(),
            estimates: [first, second, beta, delta].map(T::as_f64),
        }
    }
}

/// The differences in the order of [`NAMES`].
fn differences(single: &Seen, double: &Seen) -> [f64; 6] {
    let share = |a: f64, b: f64| {
        if b == 0.0 {
            0.0
        } else {
            (a - b).abs() / b.abs()
        }
    };
    let pairs = single.estimates.iter().zip(double.estimates);
    [
        (single.eta[0] - double.eta[0]).abs(),
        (single.eta[0] - double.eta[1]).abs(),
        share(single.time, double.time),
        share(single.integral, double.integral),
        (single.velocity - double.velocity).abs(),
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max),
    ]
}

fn main() -> Result<(), Error> {
    let asked = std::env::args().skip(1).find_map(|word| word.parse().ok());
    let steps = asked.unwrap_or(1e8_f64) as u64;
    let samples = samples();
    let (mut single, mut double) = (Loop::<f32>::try_new()?, Loop::<f64>::try_new()?);
    let (mut done, mut end) = (0_u64, 10 * PERIOD as u64 / 2);
    println!("f32 against f64 at 10 kHz, greatest in the last period");
    while done < steps {
        end = end.min(steps);
        let from = end.saturating_sub(PERIOD as u64);
        let mut most = [0.0_f64; 6];
        for k in done..end {
            let sample = samples[(k % PERIOD as u64) as usize];
            let (a, b) = (single.step(sample), double.step(sample));
            if k >= from {
                let now = differences(&a, &b);
                most = std::array::from_fn(|i| most[i].max(now[i]));
            }
        }
        done = end;
        end *= 10;
        println!(
            "\n{done:.0e} steps, {:.1} minutes",
            done as f64 / RATE / 60.0
        );
        for (name, value) in NAMES.iter().zip(most) {
            println!("  {name:48} {value:9.1e}");
        }
    }
    Ok(())
}
