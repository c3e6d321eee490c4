//! Several files of which one has another sign, unit or zero: the sentence names it.

use crate::changed::{spring, spring_moved_by};
use crate::files::{Closed, Rows};

/// Two records of one spring with a hysteresis, the output of the second as `changed` says.
fn two_files(changed: impl Fn(f64) -> f64) -> (Closed, tempfile::TempDir) {
    let whole = spring((99.0, 0.0), 0);
    let (first, second) = whole.rows.split_at(whole.rows.len() / 2);
    let begin = second[0][0];
    let part = |rows: &[Vec<f64>]| Rows {
        header: whole.header.clone(),
        rows: rows.to_vec(),
    };
    let mut second = part(second);
    second.rows.iter_mut().for_each(|row| row[0] -= begin);
    second.set(2, |_, row| changed(row[2]));
    let folder = tempfile::tempdir().unwrap();
    let paths = [
        part(first).write(&folder, "morning.csv"),
        second.write(&folder, "evening.csv"),
    ];
    (Closed::of(&[&paths[0], &paths[1]]), folder)
}

/// Gain and offset of the only file that is apart, which is the second one.
fn line(closed: &Closed) -> (f64, f64) {
    let all = closed.json["files_apart"].as_array().unwrap();
    assert_eq!(all.len(), 1, "{all:?}");
    assert!(all[0]["path"].as_str().unwrap().ends_with("evening.csv"));
    assert!(all[0]["than"].as_str().unwrap().ends_with("morning.csv"));
    assert!(all[0]["after"].as_f64() < all[0]["before"].as_f64());
    (
        all[0]["gain"].as_f64().unwrap(),
        all[0]["offset"].as_f64().unwrap(),
    )
}

#[test]
fn another_sign_in_one_file_is_told_and_nothing_is_called_a_model() {
    let (closed, _folder) = two_files(|force| -force);
    assert_eq!(closed.verdict(), "no-model");
    let (gain, _) = line(&closed);
    assert!((gain + 1.0).abs() < 0.02, "{gain}");
    closed.says(&["evening.csv", "another sign", "--per-file gains"]);
}

#[test]
fn another_unit_in_one_file_is_told_with_its_factor() {
    let (closed, _folder) = two_files(|force| 4.448 * force + 3.0);
    assert_eq!(closed.verdict(), "no-model");
    let (gain, offset) = line(&closed);
    // The declared model errs by the noise alone, 0.4 % of the output.
    assert!((gain / 4.448 - 1.0).abs() < 0.02, "{gain}");
    assert!((offset - 3.0).abs() < 0.3, "{offset}");
    closed.says(&["evening.csv", "unit or calibration"]);
}

#[test]
fn another_zero_in_one_file_is_a_pretension_that_steps_there() {
    let (closed, _folder) = two_files(|force| force + 5.0);
    assert!(closed.json["files_apart"].as_array().unwrap().is_empty());
    assert_eq!(closed.names().first(), Some(&"pretension"));
    closed.says(&["The pretension steps where", "evening.csv", "zero"]);
}

#[test]
fn files_of_one_rig_are_not_apart() {
    let (closed, _folder) = two_files(|force| force);
    assert!(closed.json["files_apart"].as_array().unwrap().is_empty());
    assert!(!closed.sentence().contains("No one model"));
    assert!(!closed.sentence().contains("pretension"));
}

/// Seen alone, a spring that hardens has another gain where it is moved further.
#[test]
fn files_of_two_strokes_on_a_spring_that_hardens_are_not_apart() {
    let small = spring_moved_by(0.3, (99.0, 0.0), 0);
    let large = spring((99.0, 0.0), 0);
    let folder = tempfile::tempdir().unwrap();
    let hardens = |mut rows: Rows, name: &str| {
        rows.set(2, |_, row| row[2] + 0.8 * row[1].powi(3));
        rows.write(&folder, name)
    };
    let paths = [hardens(small, "small.csv"), hardens(large, "large.csv")];
    let closed = Closed::of(&[&paths[0], &paths[1]]);
    assert!(closed.json["files_apart"].as_array().unwrap().is_empty());
    assert_eq!(closed.names().first(), Some(&"stiffness-cubic"));
}
