//! A record that was logged otherwise than the one that the model came from: `validate` asks about
//! that, and does not blame the rig.

use crate::files::{Rows, PHI_P, T, TAU_I, TAU_O};
use crate::shell::said;
use serde_json::Value;
use tempfile::TempDir;

/// Two records of one cable with friction of the proximal pulley, and the model of the first.
struct Bench {
    folder: TempDir,
    model: String,
    next: Rows,
}

impl Bench {
    fn new() -> Self {
        let fixed = ["--mode", "torque", "--seconds", "40", "--rate", "500"];
        let planted = ["--effect", "viscous@phi_p:3", "--seed", "1"];
        let mut first = Rows::generated(&[fixed.as_slice(), &planted].concat());
        let mut next = Rows {
            header: first.header.clone(),
            rows: first.rows.split_off(first.rows.len() / 2),
        };
        let begin = next.rows[0][T];
        next.set(T, |_, row| row[T] - begin);
        let folder = tempfile::tempdir().unwrap();
        let first = first.write(&folder, "first.csv");
        let model = folder.path().join("model.toml").display().to_string();
        said(&["identify", &first, "--model-out", &model]);
        Self {
            model,
            next,
            folder,
        }
    }

    /// The check of the next record as it was changed.
    fn check(&self, change: impl Fn(&mut Rows)) -> Value {
        let mut rows = Rows {
            header: self.next.header.clone(),
            rows: self.next.rows.clone(),
        };
        change(&mut rows);
        let record = rows.write(&self.folder, "next.csv");
        let report = said(&["validate", &self.model, &record, "--json"]);
        let report: Value = serde_json::from_str(&report).unwrap();
        println!(
            "{} {}",
            report["summary"], report["suspected_logging_error"]
        );
        report
    }
}

fn asks(report: &Value, texts: &[&str]) {
    let sentence = report["summary"].as_str().unwrap();
    assert!(sentence.contains("does not hold"), "{sentence}");
    for text in texts {
        assert!(sentence.contains(text), "{text:?} is not in: {sentence}");
    }
    // The rig is not blamed besides.
    assert!(!sentence.contains("depends on"), "{sentence}");
}

#[test]
fn a_record_logged_otherwise_is_asked_about() {
    let bench = Bench::new();
    let report = bench.check(|_| ());
    assert_eq!(report["verdict"], "holds");
    assert!(report["suspected_logging_error"].is_null());

    let report = bench.check(|rows| rows.set(PHI_P, |_, row| -row[PHI_P]));
    asks(
        &report,
        &[
            "With the sign of `phi_p` reversed",
            "have the opposite sign here?",
        ],
    );
    let report = bench.check(|rows| rows.set(TAU_I, |_, row| -row[TAU_I]));
    asks(&report, &["With the sign of `tau_i` reversed"]);

    let report = bench.check(|rows| {
        rows.set(PHI_P, |_, row| row[PHI_P].to_degrees());
    });
    asks(
        &report,
        &[
            "With `phi_p` divided by 57.296",
            "degrees instead of radians",
        ],
    );

    let report = bench.check(|rows| {
        for row in &mut rows.rows {
            row.swap(TAU_I, TAU_O);
        }
    });
    asks(&report, &["With `tau_i` and `tau_o` swapped"]);

    // Fifteen samples of two milliseconds.
    let report = bench.check(|rows| {
        let own: Vec<f64> = rows.rows.iter().map(|row| row[TAU_O]).collect();
        rows.set(TAU_O, |i, _| own[i.saturating_sub(15)]);
    });
    asks(&report, &["ms earlier", "logged with another clock?"]);
    let late = report["suspected_logging_error"]["seconds"]
        .as_f64()
        .unwrap();
    // The last of the steps in which it is sought is a sixteenth of a row, some milliseconds.
    assert!((late - 0.030).abs() < 0.001, "{late}");
}

#[test]
fn a_gain_of_a_thousand_is_asked_about_as_a_unit() {
    let bench = Bench::new();
    let report = bench.check(|rows| {
        rows.set(TAU_O, |_, row| 1e3 * row[TAU_O]);
    });
    assert_eq!(report["verdict"], "gain-or-offset-moved");
    let sentence = report["summary"].as_str().unwrap();
    assert!(sentence.contains("in another unit here"), "{sentence}");
    // A tenth is no unit.
    let report = bench.check(|rows| rows.set(TAU_O, |_, row| 1.1 * row[TAU_O]));
    let sentence = report["summary"].as_str().unwrap();
    assert!(!sentence.contains("unit"), "{sentence}");
}

/// A rig with another friction is no record that was logged otherwise.
#[test]
fn a_rig_that_has_changed_is_still_blamed() {
    let bench = Bench::new();
    let report = bench.check(|rows| {
        let speed = |i: usize, rows: &[Vec<f64>]| {
            let (before, after) = (
                &rows[i.saturating_sub(1)],
                &rows[(i + 1).min(rows.len() - 1)],
            );
            (after[PHI_P] - before[PHI_P]) / (after[T] - before[T])
        };
        let own = rows.rows.clone();
        rows.set(TAU_O, |i, row| row[TAU_O] - 2.0 * speed(i, &own).signum());
    });
    assert_eq!(report["verdict"], "does-not-hold");
    assert!(report["suspected_logging_error"].is_null(), "{report}");
    assert!(report["summary"].as_str().unwrap().contains("depends on"));
}
