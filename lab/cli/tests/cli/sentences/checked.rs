//! What `validate` says of a rig whose gain has moved, of one that moves less, and of a model that hardly
//! reads its input.

use crate::sentences::changed::{spring, spring_moved_by};
use crate::sentences::files::{evidence, noise, Rows};
use crate::shell::{said, Folder};
use serde_json::Value;

/// A model of the spring, and records of that spring to check it on.
struct Bench {
    folder: Folder,
    model: String,
}

/// Columns of the spring.
const T: usize = 0;
const X: usize = 1;
const F: usize = 2;

impl Bench {
    fn of(first: &Rows) -> Self {
        let folder = Folder::new();
        let first = first.write(&folder, "first.csv");
        let model = folder.path("model.toml");
        said(&["identify", &first, "--model-out", &model]);
        Self { folder, model }
    }

    fn check(&self, rows: &Rows) -> Value {
        let record = rows.write(&self.folder, "next.csv");
        let report = said(&["validate", &self.model, &record, "--json"]);
        let report: Value = serde_json::from_str(&report).unwrap();
        println!("{}", report["summary"]);
        report
    }
}

fn has(report: &Value, code: &str) -> bool {
    evidence(report, code).is_some()
}

/// The gain that has changed.
fn gain(report: &Value) -> f64 {
    let line = evidence(report, "line-changed").unwrap();
    line["gain"]["value"].as_f64().unwrap()
}

/// The rms error up to which the model holds, in the output's unit.
fn limit(report: &Value) -> f64 {
    report["threshold_nrmse"].as_f64().unwrap() * report["record"]["output_std"].as_f64().unwrap()
}

/// Another draw of the sensor's noise.
fn another(mut rows: Rows) -> Rows {
    rows.set(F, |i, row| row[F] + 0.002 * noise(i + 50_000));
    rows
}

/// Rows that are scaled to that rms about their mean.
fn of_rms(rms: f64, mut values: Vec<f64>) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    let scale = rms / (squares / values.len() as f64).sqrt();
    values.iter_mut().for_each(|v| *v = (*v - mean) * scale);
    values
}

#[test]
fn a_gain_that_has_moved_is_no_output_that_comes_late() {
    let bench = Bench::of(&spring((99.0, 0.0), 0));
    let same = bench.check(&another(spring((99.0, 0.0), 0)));
    assert_eq!(same["verdict"], "holds");
    let limit = limit(&same);
    // Behind the gain a curve of the position stays, and a little friction, which a shift of the
    // output takes.
    let rows = another(spring((99.0, 0.0), 0));
    let rate = 500.0;
    let x = |i: usize| rows.rows[i.min(rows.rows.len() - 1)][X];
    let all = 0..rows.rows.len();
    let curve = of_rms(0.93 * limit, all.clone().map(|i| x(i).powi(2)).collect());
    let speed = all.map(|i| rate * (x(i + 1) - x(i.saturating_sub(1))) / 2.0);
    let drag = of_rms(0.6 * limit, speed.collect());
    let mut stiffer = another(spring((99.0, 0.0), 0));
    stiffer.set(F, |i, row| 1.12 * row[F] + curve[i] + drag[i]);
    let report = bench.check(&stiffer);
    assert_eq!(report["verdict"], "does-not-hold");
    assert!(!has(&report, "logged-differently"));
    // The gain of the record, to what a shift of the output takes of the curve.
    assert!((gain(&report) - 1.12).abs() < 0.005, "{}", gain(&report));
}

#[test]
fn an_output_that_is_late_by_less_than_half_a_row_is_not_said_to_be() {
    let bench = Bench::of(&spring((99.0, 0.0), 0));
    let late = |rows: f64| {
        let mut record = another(spring((99.0, 0.0), 0));
        let own: Vec<f64> = record.rows.iter().map(|row| row[F]).collect();
        record.set(F, |i, _| {
            let at = (i as f64 - rows).max(0.0);
            let (low, part) = (at.floor() as usize, at.fract());
            let next = own[(low + 1).min(own.len() - 1)];
            1.3 * (own[low] + part * (next - own[low]))
        });
        bench.check(&record)
    };
    let report = late(0.4);
    assert_eq!(report["verdict"], "does-not-hold");
    assert!(!has(&report, "logged-differently"));
    // The gain alone does not explain a record that is late by more, and both are told.
    let report = late(4.0);
    assert!((gain(&report) - 1.3).abs() < 0.02, "{}", gain(&report));
    assert_eq!(
        evidence(&report, "logged-differently").unwrap()["what"],
        "late"
    );
}

/// What a record at three times the speed leaves of the ranges that a model of the spring, with so
/// much drag, has seen.
fn left_by_a_faster_one(drag: f64) -> Vec<String> {
    let at = |times: f64, seed: usize| {
        let mut rows = spring((99.0, 0.0), 0);
        let x: Vec<f64> = rows.rows.iter().map(|row| row[X]).collect();
        let last = x.len() - 1;
        let speed = |i: usize| times * 250.0 * (x[(i + 1).min(last)] - x[i.saturating_sub(1)]);
        rows.set(T, |_, row| row[T] / times);
        rows.set(F, |i, row| {
            row[F] + drag * speed(i) + 0.002 * noise(i + seed)
        });
        rows
    };
    let bench = Bench::of(&at(1.0, 0));
    let report = bench.check(&at(3.0, 50_000));
    let outside = report["outside"].as_array().unwrap();
    let named = outside.iter().map(|one| one["quantity"].as_str().unwrap());
    named.map(str::to_owned).collect()
}

#[test]
fn a_speed_that_no_part_of_the_model_reads_is_not_called_a_guess() {
    // A spring that slips gives the same force at any speed.
    assert!(left_by_a_faster_one(0.0).is_empty());
    assert_eq!(left_by_a_faster_one(0.05), ["velocity"]);
}

/// The spring with forces that nothing measured explains, so much of them, and another gain.
fn disturbed(gain: f64, times: f64, seed: usize) -> Rows {
    disturbed_at(1.0, gain, times, seed)
}

/// The same moved by so many times the tones.
fn disturbed_at(moved: f64, gain: f64, times: f64, seed: usize) -> Rows {
    let mut rows = another(spring_moved_by(moved, (99.0, 0.0), 0));
    let mut slow = 0.0;
    let forces = (0..rows.rows.len()).map(|i| {
        slow += 0.02 * (noise(i + seed) - slow);
        slow
    });
    let forces = of_rms(0.5 * times, forces.collect());
    rows.set(F, |i, row| gain * row[F] + forces[i]);
    rows
}

#[test]
fn a_gain_that_has_moved_within_a_wide_limit_is_told() {
    let bench = Bench::of(&disturbed(1.0, 1.0, 100_000));
    let same = bench.check(&disturbed(1.0, 1.0, 200_000));
    assert_eq!(same["verdict"], "holds");
    assert!(!has(&same, "line-changed"));
    let stiffer = bench.check(&disturbed(1.07, 1.4, 200_000));
    assert_eq!(stiffer["verdict"], "holds");
    // The disturbance has a share in the fitted gain.
    assert!((gain(&stiffer) - 1.1).abs() < 0.005, "{}", gain(&stiffer));
}

/// A joint on a spring, whose angle is recorded. The drive's sensor has so much of the torque of a
/// gear that nothing explains.
fn sprung_joint(of_gear: f64, seed: usize) -> Rows {
    let mut gear = 0.0;
    let row = |i: usize| {
        let t = i as f64 / 500.0;
        gear += 0.02 * (noise(i + seed + 9) - gear);
        let angle = 0.6 * (1.9 * t).sin() + 0.3 * (4.7 * t + 0.5 + seed as f64).sin();
        let torque = 8.0 * angle + 0.02 * noise(i + seed);
        let drive = torque + of_gear * gear;
        vec![t, drive, torque, angle + 1e-4 * noise(i + seed + 7)]
    };
    Rows {
        header: "t,tau_i [N·m],tau_o [N·m],phi_p [rad]".to_owned(),
        rows: (0..12_000).map(row).collect(),
    }
}

#[test]
fn a_model_that_hardly_reads_its_input_cannot_see_a_change_of_the_drive() {
    let bench = Bench::of(&sprung_joint(10.0, 0));
    let report = bench.check(&sprung_joint(10.0, 50_000));
    assert_eq!(report["verdict"], "holds");
    let input = &evidence(&report, "input-contributes-little").unwrap()["input"];
    assert_eq!(input, "tau_i");
    // A spring is read at its input.
    let bench = Bench::of(&spring((99.0, 0.0), 0));
    let report = bench.check(&another(spring((99.0, 0.0), 0)));
    assert_eq!(report["verdict"], "holds");
    assert!(!has(&report, "input-contributes-little"));
}

#[test]
fn a_rig_that_moves_less_is_not_said_to_have_changed() {
    // Forces of 0.1 N that nothing explains are a larger share of a smaller motion.
    let bench = Bench::of(&disturbed(1.0, 0.2, 100_000));
    let same = bench.check(&disturbed_at(0.3, 1.0, 0.2, 200_000));
    let of = |field: &str| same[field].as_f64().unwrap();
    let own = same["trained_on"]["nrmse"]["held_out"].as_f64().unwrap();
    assert!(of("nrmse") > 2.0 * own);
    assert_eq!(same["verdict"], "holds");
    assert!(has(&same, "error-as-expected-in-unit"));
    // What has changed shows there too.
    let stiffer = bench.check(&disturbed_at(0.3, 1.15, 0.2, 200_000));
    assert_eq!(stiffer["verdict"], "gain-or-offset-moved");
    assert!(has(&stiffer, "model-inexact"));
    let mut rubs = disturbed_at(0.3, 1.0, 0.2, 200_000);
    let x: Vec<f64> = rubs.rows.iter().map(|row| row[X]).collect();
    rubs.set(F, |i, row| {
        let ahead = x[(i + 1).min(x.len() - 1)] - x[i.saturating_sub(1)];
        row[F] + 0.3 * ahead.signum()
    });
    let rubs = bench.check(&rubs);
    assert_eq!(rubs["verdict"], "does-not-hold");
    assert!(!has(&rubs, "logged-differently"));
}

#[test]
fn a_model_that_did_not_carry_over_at_home_is_told_of_wherever_it_is_tried() {
    let rows = spring((99.0, 0.0), 0);
    let bench = Bench::of(&rows);
    let text = std::fs::read_to_string(&bench.model).unwrap();
    let own = text
        .lines()
        .find(|line| line.starts_with("verdict = "))
        .unwrap();
    let other = text.replace(own, "verdict = \"not-transferable\"");
    let code = "model-not-transferable";
    assert!(!has(&bench.check(&another(rows)), code));
    std::fs::write(&bench.model, other).unwrap();
    assert!(has(&bench.check(&another(spring((99.0, 0.0), 0))), code));
}

#[test]
fn a_motion_in_which_the_error_of_home_is_most_cannot_tell() {
    let bench = Bench::of(&disturbed(1.0, 1.0, 100_000));
    let same = bench.check(&disturbed_at(0.25, 1.0, 1.0, 200_000));
    assert_eq!(same["verdict"], "cannot-tell");
    assert_eq!(
        evidence(&same, "error-as-expected-in-unit").unwrap()["holds"],
        false
    );
}

#[test]
fn just_above_the_limit_of_a_model_that_was_not_exact_nothing_is_decided() {
    let bench = Bench::of(&disturbed(1.0, 1.0, 100_000));
    let above = bench.check(&disturbed(1.0, 2.3, 200_000));
    assert_eq!(above["verdict"], "cannot-tell");
    assert!(has(&above, "error-at-limit") && has(&above, "model-inexact"));
    let more = bench.check(&disturbed(1.0, 3.5, 200_000));
    assert_eq!(more["verdict"], "does-not-hold");
    assert!(has(&more, "model-inexact"));
    // The model of a spring that it describes to the noise.
    let bench = Bench::of(&spring((99.0, 0.0), 0));
    let disturbed = bench.check(&disturbed(1.0, 0.1, 200_000));
    assert_eq!(disturbed["verdict"], "does-not-hold");
    assert!(!has(&disturbed, "model-inexact"));
}
