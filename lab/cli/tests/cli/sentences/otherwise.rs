//! A record that was logged otherwise than the one that the model came from: `validate` asks about
//! that, and does not blame the rig.

use crate::sentences::files::{evidence, Rows, PHI_P, T, TAU_I, TAU_O};
use crate::shell::{said, Folder};
use serde_json::Value;

/// Two records of one cable with friction of the proximal pulley, and the model of the first.
struct Bench {
    folder: Folder,
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
        let folder = Folder::new();
        let first = first.write(&folder, "first.csv");
        let model = folder.path("model.toml");
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
        println!("{}", report["summary"]);
        report
    }
}

/// The suspicion that explains why the model does not hold; the rig is not blamed besides.
fn suspicion(report: &Value) -> &Value {
    assert_eq!(report["verdict"], "does-not-hold");
    assert_eq!(evidence(report, "residual-depends-on"), None);
    evidence(report, "logged-differently").unwrap()
}

fn asks(report: &Value, what: &str, column: &str) {
    let suspicion = suspicion(report);
    assert_eq!(
        (&suspicion["what"], &suspicion["column"]),
        (&what.into(), &column.into())
    );
}

#[test]
fn a_record_logged_otherwise_is_asked_about() {
    let bench = Bench::new();
    let report = bench.check(|_| ());
    assert_eq!(report["verdict"], "holds");
    assert_eq!(evidence(&report, "logged-differently"), None);

    for (column, name) in [(PHI_P, "phi_p"), (TAU_I, "tau_i"), (TAU_O, "tau_o")] {
        let report = bench.check(|rows| rows.set(column, |_, row| -row[column]));
        asks(&report, "reversed", name);
    }

    let report = bench.check(|rows| {
        rows.set(PHI_P, |_, row| row[PHI_P].to_degrees());
    });
    asks(&report, "scaled", "phi_p");
    let factor = suspicion(&report)["factor"].as_f64().unwrap();
    assert_eq!(factor, 180.0 / std::f64::consts::PI);

    let report = bench.check(|rows| {
        for row in &mut rows.rows {
            row.swap(TAU_I, TAU_O);
        }
    });
    asks(&report, "swapped", "tau_i");
    assert_eq!(suspicion(&report)["other"], "tau_o");

    // Fifteen samples of two milliseconds.
    let report = bench.check(|rows| {
        let own: Vec<f64> = rows.rows.iter().map(|row| row[TAU_O]).collect();
        rows.set(TAU_O, |i, _| own[i.saturating_sub(15)]);
    });
    assert_eq!(suspicion(&report)["what"], "late");
    let late = suspicion(&report)["seconds"].as_f64().unwrap();
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
    assert!(evidence(&report, "output-unit-differs").is_some());
    // A tenth is no unit.
    let report = bench.check(|rows| rows.set(TAU_O, |_, row| 1.1 * row[TAU_O]));
    assert_eq!(report["verdict"], "gain-or-offset-moved");
    assert_eq!(evidence(&report, "output-unit-differs"), None);
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
    assert_eq!(evidence(&report, "logged-differently"), None);
    assert!(evidence(&report, "residual-depends-on").is_some());
}
