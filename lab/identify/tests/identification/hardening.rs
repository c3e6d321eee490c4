//! The hysteretic benchmark of Noël and Schoukens (2016): an oscillator with a Bouc-Wen element
//! beyond what a saturating state can be.
//!
//! `m·y'' + c·y' + k·y + z = u`, `z' = A·y' − b·(g·|y'|·|z|^(ν−1)·z + d·y'·|z|^ν)`. It is
//! integrated here by Runge-Kutta in time, and shares nothing with the effect.

use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::intervals::parameters;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{parse, Options};
use bowden_lab::search::close;
use std::f64::consts::TAU;
use std::fmt::Write;

const MASS: f64 = 2.0;
const DAMPING: f64 = 10.0;
const STIFFNESS: f64 = 5e4;
const ALPHA: f64 = 5e4;
const BETA: f64 = 1e3;
const GAMMA: f64 = 0.8;
const DELTA: f64 = -1.1;

/// A random-phase multisine of 5 to 150 Hz, 50 N rms, as its authors suggest.
fn force(t: f64) -> f64 {
    let tones = 145;
    let amplitude = 50.0 * (2.0 / f64::from(tones)).sqrt();
    let tone = |k: i32| {
        // Phases that repeat no pattern: the golden angle times k².
        let phase = 2.399_963_229_728_653 * f64::from(k * k);
        (TAU * f64::from(5 + k) * t + phase).sin()
    };
    amplitude * (0..tones).map(tone).sum::<f64>()
}

/// Rates of position, velocity and z.
fn rates([y, v, z]: [f64; 3], u: f64) -> [f64; 3] {
    let a = (u - DAMPING * v - STIFFNESS * y - z) / MASS;
    let z_rate = ALPHA * v - BETA * (GAMMA * v.abs() * z + DELTA * v * z.abs());
    [v, a, z_rate]
}

/// The record as CSV: 4 s at 12 kHz after 2 s that are not recorded; white noise of 0.5 N on the
/// force, 1 % of it.
///
/// The motion that turns between two samples is not seen: at 3 kHz, with a cut-off of 120 Hz, the
/// stiffness comes out 0.3 % low, which is more than its interval.
fn record() -> String {
    let h = 1.0 / 12_000.0;
    let (mut state, mut t) = ([0.0; 3], -2.0);
    let mut noise: u64 = 1;
    let mut text = "t [s],x [m],f [N]\n".to_owned();
    for _ in 0..6 * 12_000 {
        if t > -0.5 * h {
            // A linear congruential generator: uniform, of unit variance.
            noise = noise
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let error = ((noise >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * 12.0_f64.sqrt();
            let measured = force(t) + 0.5 * error;
            writeln!(text, "{t:.9},{:.12e},{measured:.9}", state[0]).unwrap();
        }
        let [u, v, w] = [0.0, 0.5, 1.0].map(|share| force(t + share * h));
        let moved = |k: [f64; 3], by: f64| std::array::from_fn(|i| state[i] + by * k[i]);
        let a = rates(state, u);
        let b = rates(moved(a, 0.5 * h), v);
        let c = rates(moved(b, 0.5 * h), v);
        let d = rates(moved(c, h), w);
        state = std::array::from_fn(|i| state[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
        t += h;
    }
    text
}

#[test]
fn the_benchmark_beyond_a_saturating_state_comes_back_and_nothing_is_added() {
    let record = parse(record().as_bytes(), "benchmark.csv", &Options::default()).unwrap();
    let cutoff = Some(480.0);
    let data = Prepared::new(&record, Preparation { cutoff }).unwrap();
    let list = [
        "inertia",
        "viscous",
        "stiffness-linear",
        "hardening",
        "offset",
    ];
    let list = list.map(str::to_owned);
    let ledger = close(&data, &structure(&list, &data).unwrap(), |_| ()).unwrap();
    assert!(ledger.rounds.is_empty() && ledger.unknown.is_none());
    let done = FinalFit::new(&data, &ledger);
    let all = parameters(&data, &done.solution);
    for (name, truth) in [
        ("inertia", MASS),
        ("viscous", DAMPING),
        ("stiffness-linear", STIFFNESS),
        ("hardening", ALPHA),
        ("hardening.g", -BETA * (GAMMA + DELTA)),
        ("hardening.beta", BETA * GAMMA),
    ] {
        let own = all.iter().find(|p| p.name == name).unwrap();
        println!("{name}: {truth} in {:?}, {}", own.ci95, own.value);
        let [low, high] = own.ci95.unwrap();
        assert!(
            low < truth && truth < high,
            "{name}: {truth} in {low} to {high}"
        );
        // An interval that holds everything would say nothing.
        assert!(high - low < 0.2 * truth, "{name}: {low} to {high}");
    }
}
