//! A planned motion, run on a rig of its own making, settles what was confounded.

use super::{closed, noise};
use bowden_lab::foresight::plan::{separate, strengthen, trajectory, Kind, Way};
use bowden_lab::record::{parse, Options, Record};
use bowden_synth::{generate, Base, Mode, Planted, Recipe, Synthetic};

const NOISE: f64 = 0.05;

/// On this motion a faint cubic stiffness cannot be told from a dead zone.
fn confounded() -> (Synthetic, Record) {
    let recipe = Recipe {
        seed: 6,
        noise: NOISE,
        effects: vec![Planted {
            strength: 1.2,
            ..Planted::new("stiffness-cubic")
        }],
        ..Recipe::new(Mode::Displacement)
    };
    let made = generate(&recipe).unwrap();
    let record = parse(made.to_csv().as_bytes(), "made.csv", &Options::default()).unwrap();
    (made, record)
}

/// A cubic through four neighbours in Lagrange's form.
fn between(points: &[f64], at: f64) -> f64 {
    let i = (at as usize).clamp(1, points.len() - 3);
    let u = at - i as f64;
    let nodes = [-1.0, 0.0, 1.0, 2.0];
    (0..4)
        .map(|k| {
            let others = (0..4).filter(|&m| m != k);
            let weight: f64 = others
                .map(|m| (u - nodes[m]) / (nodes[k] - nodes[m]))
                .product();
            weight * points[i + k - 1]
        })
        .sum()
}

/// (1) and (2) of the paper by Euler steps of a fiftieth of a millisecond, and a cubic
/// stiffness: the motion of a CSV file at 1 kHz, with noise on the force.
fn rig(csv: &str, base: &Base, cubic: f64, seed: u64) -> Record {
    let rows = csv.lines().skip(1).map(|line| {
        let mut cells = line.split(',').map(|cell| cell.parse::<f64>().unwrap());
        (cells.next().unwrap(), cells.next().unwrap())
    });
    let (times, points): (Vec<f64>, Vec<f64>) = rows.unzip();
    let step = times[1] - times[0];
    let (rate, substeps) = (1000.0, 50);
    let samples = ((points.len() - 4) as f64 * step * rate) as usize;
    let noise = noise(NOISE, seed, samples);
    let h = 1.0 / (rate * f64::from(substeps));
    let place = |t: f64| between(&points, 1.0 + t / step);
    let (mut eta, mut now) = (0.0_f64, place(0.0));
    let mut text = "t [s],x [mm],f [N]\n".to_owned();
    for (k, error) in noise.iter().enumerate() {
        let t = k as f64 / rate;
        let force = base.gain * now + base.kappa_eta * eta + base.offset + cubic * now.powi(3);
        text += &format!("{t},{now},{}\n", force + error);
        for m in 1..=substeps {
            let next = place(t + f64::from(m) * h);
            let dx = next - now;
            let power = eta.abs().powf(base.n);
            let signed = power.copysign(eta);
            eta +=
                base.rho * (dx - base.sigma * dx.abs() * signed + (base.sigma - 1.0) * dx * power);
            now = next;
        }
    }
    parse(text.as_bytes(), "rig.csv", &Options::default()).unwrap()
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_planned_motion_tells_the_cubic_stiffness_from_the_dead_zone() {
    let (made, record) = confounded();
    let (data, ledger) = closed(&record);
    let round = &ledger.rounds[0];
    let rivals: Vec<&str> = round.rivals.iter().map(|r| r.family).collect();
    assert!(rivals.contains(&"backlash"), "{rivals:?}");
    let experiment = separate(&data, round).unwrap();
    // A rival that this motion does not separate is no aim of it.
    assert!(experiment.aims.len() <= rivals.len());
    let aimed = |name: &str| {
        experiment
            .aims
            .iter()
            .any(|a| a.rival.as_deref() == Some(name))
    };
    assert!(aimed("dead-zone"), "{:?}", experiment.aims);
    for aim in &experiment.aims {
        println!("{}", aim.words());
        assert!(aim.left_then > aim.left_now, "{aim:?}");
        assert!(aim.left_then > 1.0, "{aim:?}");
        assert!((0.0..=1.0).contains(&aim.correlation_then), "{aim:?}");
    }
    let csv = trajectory(&data, experiment.way).csv();
    let truth = &made.truth;
    for seed in [11, 12] {
        let measured = rig(&csv, &truth.base, truth.effects[0].gain, seed);
        let (_, told) = closed(&measured);
        let first = &told.rounds[0];
        assert_eq!(first.candidate.family, "stiffness");
        let rivals: Vec<&str> = first.rivals.iter().map(|r| r.family).collect();
        assert!(rivals.is_empty(), "still confounded with {rivals:?}");
    }
}

/// On a record whose error is a hundred times as large no motion lets the two be told apart.
#[test]
fn an_experiment_that_separates_nothing_is_not_proposed() {
    let (_, record) = confounded();
    let (data, ledger) = closed(&record);
    let mut round = ledger.rounds[0].clone();
    assert!(separate(&data, &round).is_some());
    round.after.fit *= 100.0;
    assert!(separate(&data, &round).is_none());
}

#[test]
fn every_motion_can_be_prepared_like_the_record_and_keeps_to_what_it_says() {
    let (_, record) = confounded();
    let (data, _) = closed(&record);
    for way in Way::all(&data) {
        let kind = way.kind;
        let planned = trajectory(&data, way);
        let motion = planned.prepared(&data).unwrap();
        let times = |a: f64, b: f64| a / b;
        let stroke = times(motion.input.reach, data.input.reach);
        let speed = times(motion.input.speed, data.input.speed);
        // The fit segments hold different parts of the motion, so neither is exact.
        match kind {
            Kind::Slower => assert!((0.4..0.6).contains(&speed), "{speed}"),
            Kind::Faster => assert!((1.6..2.4).contains(&speed), "{speed}"),
            Kind::LargerStroke => assert!((stroke - 1.5).abs() < 1e-3, "{stroke}"),
            Kind::SmallerStroke => assert!((stroke - 0.4).abs() < 1e-3, "{stroke}"),
            Kind::Multisine => assert!(stroke <= 1.001, "{stroke}"),
            Kind::OffsetCentre => {
                let moved = (motion.input.middle - data.input.middle) / data.input.reach;
                assert!((moved - 0.5).abs() < 1e-3, "{moved}");
            }
            Kind::HoldAndWait => {
                let still = motion.input.motion.iter();
                let still = still.filter(|m| m.velocity.abs() < 0.01 * data.input.speed);
                let share = times(still.count() as f64, motion.work_len() as f64);
                // One third is rest, but for the filter's edges.
                assert!((0.2..0.5).contains(&share), "{share}");
            }
            Kind::SweptStroke | Kind::MixedPace => assert!(speed > 0.3, "{speed}"),
        }
    }
}

#[test]
fn where_all_is_identified_nothing_is_planned() {
    let recipe = Recipe {
        seed: 3,
        ..Recipe::new(Mode::Displacement)
    };
    let csv = generate(&recipe).unwrap().to_csv();
    let record = parse(csv.as_bytes(), "made.csv", &Options::default()).unwrap();
    let (data, ledger) = closed(&record);
    assert!(strengthen(&data, ledger.last()).is_none());
}
