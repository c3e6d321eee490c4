//! What was fitted on the bench is what runs in firmware.
//!
//! The file of a solution is read into a [`Model`] of the core, as a user would do in firmware,
//! and stepped sample by sample over the record. Behind the fit's own
//! filter its output has to be the fit's own prediction: in `f64` to rounding, in `f32` to
//! rounding and to what the hysteresis' step in bounded time leaves.

use crate::rig::Made;
use bowden::effect::Motion;
use bowden::model::{Model, ModelState, Sample, Source};
use bowden::Real;
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::export::{ModelFile, MOST_TERMS};
use bowden_lab::fit::{fit, Solution};
use bowden_lab::model::structure::Role;
use bowden_lab::model::{Table, Variable};
use bowden_lab::problem::Prepared;
use bowden_lab::record;
use bowden_synth::{Mode, Planted, Recipe};
use serde::de::DeserializeOwned;

/// The model as its file gives it to firmware, and the state that it starts in.
fn firmware<T: Real + DeserializeOwned>(
    data: &Prepared,
    solution: &Solution,
) -> (Model<T, MOST_TERMS>, ModelState<T, MOST_TERMS>) {
    let model = ModelFile::new(data, solution).model_in().unwrap();
    let state = match solution.value(Role::Eta0 { record: 0 }) {
        Some(eta) => ModelState::with_eta(T::from_f64(eta)).unwrap(),
        None => ModelState::new(),
    };
    (model, state)
}

/// Sample by sample over the record, then through the filter.
fn played<T: Real + DeserializeOwned>(data: &Prepared, solution: &Solution) -> Vec<f64> {
    let (model, mut state) = firmware::<T>(data, solution);
    let narrow = |m: &Motion<f64>| Motion {
        position: T::from_f64(m.position),
        velocity: T::from_f64(m.velocity),
        acceleration: T::from_f64(m.acceleration),
    };
    let output: Vec<f64> = (0..data.work_len())
        .map(|i| {
            let input = narrow(&data.input.motion[i]);
            let channels: Vec<Motion<T>> =
                data.channels.iter().map(|c| narrow(&c.motion[i])).collect();
            let load = match (data.mode, data.load) {
                (_, Some(load)) => channels[load].position,
                (record::Mode::Torque, None) => input.position,
                (record::Mode::Displacement, None) => T::zero(),
            };
            let sample = Sample {
                dt: T::from_f64(data.dt),
                input,
                load,
                channels: &channels,
            };
            assert!(model.accepts(&sample));
            model.step(&mut state, &sample).to_f64().unwrap()
        })
        .collect();
    data.filtered(&output)
}

/// Largest difference to the fit's prediction from `share` of the record on, over the
/// largest prediction.
fn difference(solution: &Solution, played: &[f64], share: f64) -> f64 {
    let from = (share * played.len() as f64) as usize;
    let largest = solution
        .prediction
        .iter()
        .fold(0.0_f64, |m, p| m.max(p.abs()));
    let worst = played
        .iter()
        .zip(&solution.prediction)
        .skip(from)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    worst / largest
}

/// Rounding: the fit adds columns, the model adds terms.
const F64: f64 = 1e-9;
/// Sixteen roundings to `f32` of the largest output; inputs are rounded as well.
const F32: f64 = 16.0 * f32::EPSILON as f64;
/// What the hysteresis adds in `f32`, whose step takes bounded time: at most 1.3e-4 of eta on
/// paths of a sampled motion (table of `bowden::hysteresis`), which is less than the largest
/// output in each of these records. That its rounding is that of any other step is a test of
/// the core: `model`, `single_precision_is_double_precision_but_for_rounding`.
const BOUNDED_STEP: f64 = 1.3e-4;

fn assert_the_same(data: &Prepared, solution: &Solution, share: f64) {
    let wide = difference(solution, &played::<f64>(data, solution), share);
    assert!(wide < F64, "f64: {wide:e}");
    let narrow = difference(solution, &played::<f32>(data, solution), share);
    let hysteresis = match solution.structure.hysteresis {
        true => BOUNDED_STEP,
        false => 0.0,
    };
    assert!(narrow < F32 + hysteresis, "f32: {narrow:e}");
    // Nothing is shown if the two are the same by being the same type.
    assert!(narrow > 100.0 * f64::EPSILON, "f32: {narrow:e}");
}

fn made(mode: Mode, effects: &[&str]) -> Made {
    Made::new(&Recipe {
        seed: 61,
        effects: effects.iter().map(|e| Planted::new(e)).collect(),
        load: mode == Mode::Displacement,
        ..Recipe::new(mode)
    })
}

fn told(made: &Made, list: &[&str]) -> Solution {
    fit(&made.data, &made.declare(list), None, 0.0).unwrap()
}

/// Whether a gain of the solution counts: at least 1e-3 of the output is the term's.
fn contributes(solution: &Solution, name: &str) -> bool {
    let terms = &solution.structure.terms;
    let index = terms.iter().position(|t| t.effect.name() == name).unwrap();
    solution.gain(index).abs() > 1e-6
}

#[test]
fn a_model_that_the_loop_found_runs_the_same_in_firmware() {
    let made = made(
        Mode::Displacement,
        &["inertia", "lag", "stiffness-quadratic"],
    );
    let ledger = made.closed();
    // What is delivered, and what `--model-out` writes.
    let done = FinalFit::new(&made.data, &ledger);
    let last = &done.solution;
    assert!(done.refitted && last.structure.hysteresis && !last.structure.terms.is_empty());
    let terms = &last.structure.terms;
    assert!(
        terms.iter().any(|t| t.effect.is_output_stage()),
        "{terms:?}"
    );
    assert!(terms.iter().all(|t| !t.has_past()), "{terms:?}");
    assert_the_same(&made.data, last, 0.0);
}

/// Mode, what is planted, what is declared, and which gains count.
type Case = (
    Mode,
    &'static [&'static str],
    &'static [&'static str],
    &'static [&'static str],
);

const CASES: [Case; 5] = [
    // A channel and a delay.
    (
        Mode::Torque,
        &["viscous", "delay"],
        &["bouc-wen", "viscous@phi_p", "delay"],
        &["viscous", "delay"],
    ),
    // In torque mode the load is the input, else the record's own column.
    (
        Mode::Torque,
        &["load-friction"],
        &["bouc-wen", "load-friction@phi_p"],
        &["load-friction"],
    ),
    (
        Mode::Displacement,
        &["load-friction"],
        &["bouc-wen", "load-friction"],
        &["load-friction"],
    ),
    // Effects of the hysteresis, and a fitted origin.
    (
        Mode::Torque,
        &["rate", "stiffness-quadratic", "degradation"],
        &[
            "bouc-wen",
            "rate@tau_i",
            "stiffness-quadratic@phi_p",
            "degradation",
            "asymmetry-eta",
        ],
        &["rate", "degradation"],
    ),
    (
        Mode::Displacement,
        &["viscous"],
        &["viscous", "stiffness", "offset", "coulomb", "lag"],
        &[],
    ),
];

#[test]
fn what_was_declared_runs_the_same_in_firmware() {
    for (mode, planted, list, counting) in CASES {
        let made = made(mode, planted);
        let solution = told(&made, list);
        assert!(counting.iter().all(|name| contributes(&solution, name)));
        let structure = &solution.structure;
        assert_eq!(structure.hysteresis, list.contains(&"bouc-wen"));
        if planted.contains(&"delay") {
            let source = structure.terms[0].source;
            assert!(matches!(source, Source::Channel(_)));
        }
        if planted.contains(&"degradation") {
            assert!(structure.terms.iter().any(|t| t.origin != 0.0));
        }
        assert_the_same(&made.data, &solution, 0.0);
    }
}

/// A curve with five points between the quarters of its variable, in front of a lag.
#[test]
fn a_curve_over_a_position_a_velocity_or_a_load_runs_the_same_in_firmware() {
    let made = made(Mode::Displacement, &["stribeck", "lag"]);
    let load = Source::Channel(made.data.load.unwrap() as u8);
    for (variable, effect) in [
        (Variable::Position(Source::Input), "curve-position"),
        (Variable::Velocity(Source::Input), "curve-velocity"),
        (Variable::Position(load), "curve-position"),
    ] {
        let mut values = variable.values(&made.data, &[]).unwrap();
        values.sort_by(f64::total_cmp);
        let hat = |k: usize| (0..5).map(|j| f64::from(u8::from(j == k))).collect();
        let mut structure = made.declare(&["bouc-wen", "lag"]);
        structure.table = Some(Table {
            variable,
            knots: (0..5).map(|k| values[(values.len() - 1) * k / 4]).collect(),
            shapes: (1..5).map(hat).collect(),
        });
        let solution = fit(&made.data, &structure, None, 0.0).unwrap();
        let file = ModelFile::new(&made.data, &solution);
        let curve = file.terms.iter().filter(|term| term.effect == effect);
        assert_eq!(curve.filter(|term| term.gain.abs() > 1e-6).count(), 4);
        assert_the_same(&made.data, &solution, 0.0);
    }
}

/// A stop forgets: once it has slipped it does not know where it began. The fit knows of
/// motion before the record (`start`), the firmware starts with the record, so the
/// first part may differ. Both have slipped within the first quarter, and what the filter
/// spreads of the difference has decayed below rounding by the middle.
#[test]
fn a_stop_runs_the_same_in_firmware_once_it_has_slipped() {
    let made = made(Mode::Torque, &["presliding"]);
    let solution = told(&made, &["bouc-wen", "presliding@phi_p"]);
    assert!(contributes(&solution, "presliding"));
    let term = &solution.structure.terms[0];
    let early = solution.prediction.len() / 4 * made.data.stride;
    let channel = made.data.channel(term.source).unwrap();
    let positions = channel.motion[..early].iter().map(|m| m.position);
    let moved = positions.clone().fold(f64::NEG_INFINITY, f64::max)
        - positions.fold(f64::INFINITY, f64::min);
    assert!(term.start[0] != 0.0);
    // Two half-widths from the lowest to the highest place, in whichever order, and it
    // lies at its end wherever it began.
    assert!(moved >= 2.0 * term.effect.shape(0).unwrap(), "{moved}");
    assert_the_same(&made.data, &solution, 0.5);
}

/// Creep forgets exponentially, never quite. What it remembers from before the record is
/// `-gain·start·exp(−t/tau)` of the prediction; the rest must be the firmware's.
#[test]
fn creep_runs_the_same_in_firmware_but_for_what_it_remembers_from_before() {
    let made = made(Mode::Torque, &["creep"]);
    let mut solution = told(&made, &["bouc-wen", "creep@tau_i"]);
    let term = solution.structure.terms[0];
    let (tau, gain) = (term.effect.shape(0).unwrap(), solution.gain(0));
    assert!(contributes(&solution, "creep") && term.start[0] != 0.0);
    let before: Vec<f64> = (0..made.data.work_len())
        .map(|i| -gain * term.start[0] * (-(i as f64 + 1.0) * made.data.dt / tau).exp())
        .collect();
    let before = made.data.filtered(&before);
    let played = played::<f64>(&made.data, &solution);
    assert!(
        difference(&solution, &played, 0.0) > 1e-3,
        "nothing is remembered"
    );
    for (prediction, remembered) in solution.prediction.iter_mut().zip(before) {
        *prediction -= remembered;
    }
    assert_the_same(&made.data, &solution, 0.0);
}
