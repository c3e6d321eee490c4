//! `examples/torque_loop.c` once more, on the crate itself.

use core_bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, AntiWindup, BenchRange, Compensator,
    CompensatorInput, CompensatorState, Estimator, Fallback, Fault, Form, Limits, OnMissing,
    Output, Pid, PidInput, PidSettings, PidState, SmoothSign, Status,
};
use core_bowden::effect::Motion;
use core_bowden::model::{Model, ModelState, Sample, Source};
use core_bowden::signal::{Rates, RatesState};

const DT: f32 = 0.001;
const LONGEST_DT: f32 = 0.005;
const COUNTS: f32 = 16384.0;
const TURN: f32 = 6.283_185_5;
const COUNT: f32 = TURN / COUNTS;
const CHECKSUM: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

struct Loop {
    pid: (Pid<f32>, PidState<f32>),
    law: (Adaptive<f32, 1>, AdaptiveState<f32, 1>),
    model: (Model<f32, 8>, ModelState<f32, 8>),
    bench: (Compensator<f32, 8>, CompensatorState<f32, 8>),
    rates: (Rates<f32>, RatesState<f32>),
}

struct Told {
    pid: Output<f32>,
    law: f32,
    velocity: f32,
    predicted: f32,
    bench: f32,
}

fn motion(position: f32, velocity: f32, acceleration: f32) -> Motion<f32> {
    Motion {
        position,
        velocity,
        acceleration,
    }
}

impl Loop {
    fn new() -> Self {
        let limits = Limits::try_new(-10.0, 40.0).unwrap();
        let fallback = Fallback::try_new(20, 0.0).unwrap();
        let pid = Pid::try_new(PidSettings {
            k_d: 0.002,
            derivative_time: 0.01,
            anti_windup: AntiWindup::BackCalculation { tracking_time: 0.1 },
            limits: limits.with_slew(2000.0).unwrap(),
            ..PidSettings::new(0.5, 25.0, limits, LONGEST_DT, fallback)
        })
        .unwrap();
        let lag = Form::FirstOrder {
            step: DT,
            plant_gain: 1.0,
        };
        let law = Adaptive::try_new(AdaptiveSettings {
            smooth_sign: SmoothSign::Clamp,
            delta: Estimator::fixed(1.0).within(0.0, 3.0).adapting(0.006, 0.01),
            theta: [Estimator {
                gain: 0.02,
                ..Estimator::fixed(0.0).within(-3.0, 3.0)
            }],
            missing: [OnMissing::DropRegressor],
            ..AdaptiveSettings::new(lag, 24.0, 8.0, 0.1, limits, LONGEST_DT, fallback)
        })
        .unwrap();
        let bytes = include_bytes!("../../../examples/data/demo.postcard");
        let model: Model<f32, 8> = postcard::from_bytes_crc32(bytes, CHECKSUM.digest()).unwrap();
        // As examples/data/demo.rs has them.
        let ranges = [
            BenchRange {
                source: Source::Input,
                low: motion(-12.495_871, -38.818_592, -170.3947),
                high: motion(16.003_07, 35.032_35, 142.7363),
            },
            BenchRange {
                source: Source::Channel(0),
                low: motion(-0.451_851_34, -1.579_440_1, -5.874_228_5),
                high: motion(0.599_456_3, 1.608_444, 4.656_939),
            },
        ];
        let bench = Compensator::try_new(&model)
            .and_then(|bench| bench.with_longest_dt(LONGEST_DT))
            .and_then(|bench| bench.with_ranges(&ranges))
            .unwrap();
        let rates = Rates::try_new(0.008_376_576)
            .and_then(|rates| rates.with_period(COUNTS * COUNT))
            .unwrap();
        Self {
            pid: (pid, PidState::new()),
            law: (law, AdaptiveState::new(&law)),
            model: (model, ModelState::new()),
            bench: (bench, CompensatorState::new()),
            rates: (rates, RatesState::new()),
        }
    }

    fn step(&mut self, dt: f32, wanted: f32, torque: f32, counts: u16) -> Told {
        let pulley = self
            .rates
            .0
            .step(&mut self.rates.1, f32::from(counts) * COUNT, dt);
        let channels = [pulley.motion, Motion::default()];
        let wish = CompensatorInput {
            channels: &channels,
            ..CompensatorInput::new(dt, wanted)
        };
        let bench = self.bench.0.step(&mut self.bench.1, &wish).command;
        let sample = PidInput {
            feed_forward: bench,
            ..PidInput::new(dt, wanted, torque)
        };
        let pid = self.pid.0.step(&mut self.pid.1, &sample);
        let velocity = pulley.motion.velocity;
        let sample = AdaptiveInput {
            feed_forward: bench,
            ..AdaptiveInput::new(dt, wanted, torque, [velocity])
        };
        let law = self.law.0.step(&mut self.law.1, &sample).command;
        let seen = Sample {
            dt,
            input: motion(pid.command, 0.0, 0.0),
            load: pid.command,
            channels: &channels,
        };
        let predicted = self.model.0.step(&mut self.model.1, &seen);
        Told {
            pid,
            law,
            velocity,
            predicted,
            bench,
        }
    }
}

fn triangle(k: i32, period: i32) -> f32 {
    let (x, half) = (k % period, period / 2);
    4.0 * (if x < half { x } else { period - x }) as f32 / period as f32 - 1.0
}

fn words(status: Status) -> &'static str {
    match status {
        Status::Good => "success",
        Status::Held(Fault::Measured) => {
            "a bad sample: the last good command or value is held: the measured output is NaN or infinite"
        }
        Status::Held(Fault::DtTooLong) => {
            "a bad sample: the last good command or value is held: dt is too long"
        }
        Status::Safe(Fault::Measured) => {
            "too many bad samples: the safe command is applied until it is acknowledged: the measured output is NaN or infinite"
        }
        other => unreachable!("{other:?}"),
    }
}

/// The lines that the C program prints.
pub fn lines() -> Vec<String> {
    let mut own = Loop::new();
    let (mut drive, mut torque) = (0.0_f32, 0.0_f32);
    let mut last = 0;
    let mut lines = Vec::new();
    for k in 0..2000 {
        let angle = 0.5 * triangle(k, 800);
        let dt = if k == 1500 { 4295.0 } else { DT };
        let wanted = 8.0 + 4.0 * triangle(k, 500);
        let lost = (300..305).contains(&k) || (1000..1100).contains(&k);
        let measured = if lost { f32::NAN } else { torque };
        let counts = (if angle < 0.0 { angle + TURN } else { angle } / COUNT) as u16;
        if k == 1200 {
            own.pid.1.acknowledge();
            own.law.1.acknowledge();
        }
        let told = own.step(dt, wanted, measured, counts);
        drive += 0.5 * (told.pid.command - drive);
        torque = 0.93 * drive - 0.6 * told.velocity;
        let kind = match told.pid.status {
            Status::Good => 0,
            Status::Held(_) => 1,
            _ => 2,
        };
        if k % 100 == 0 || kind != last {
            let bits = [
                told.pid.command,
                told.law,
                told.velocity,
                told.predicted,
                told.bench,
            ];
            let bits = bits
                .map(|number| format!("{:08x}", number.to_bits()))
                .join(" ");
            lines.push(format!(
                "{k} ms: command {} mN*m [{bits}] {}",
                (1000.0 * told.pid.command) as i32,
                words(told.pid.status)
            ));
        }
        last = kind;
    }
    lines
}
