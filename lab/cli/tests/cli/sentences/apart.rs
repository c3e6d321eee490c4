//! Several files of which one has another sign, unit or zero: the sentence names it.

use crate::sentences::changed::{spring, spring_moved_by};
use crate::sentences::files::{noise, Closed, Rows};
use crate::shell::Folder;

/// Records of one spring with a hysteresis behind each other, as many as there are names, the
/// output of each as `changed` says of its place.
fn files(names: &[&str], changed: impl Fn(usize, usize, f64) -> f64) -> (Vec<String>, Folder) {
    let whole = spring((99.0, 0.0), 0);
    let folder = Folder::new();
    let length = whole.rows.len() / names.len();
    let written = names.iter().enumerate().map(|(place, name)| {
        let mut part = Rows {
            header: whole.header.clone(),
            rows: whole.rows[place * length..(place + 1) * length].to_vec(),
        };
        let begin = part.rows[0][0];
        part.rows.iter_mut().for_each(|row| row[0] -= begin);
        part.set(2, |i, row| changed(place, i, row[2]));
        part.write(&folder, name)
    });
    (written.collect(), folder)
}

fn two_files(changed: impl Fn(f64) -> f64) -> (Closed, Folder) {
    let of = |place, _, force| match place {
        0 => force,
        _ => changed(force),
    };
    let (paths, folder) = files(&["morning.csv", "evening.csv"], of);
    (Closed::of(&[&paths[0], &paths[1]]), folder)
}

/// Gain and offset of the only file that is apart, which is the second one.
fn line(closed: &Closed) -> (f64, f64) {
    let all = closed.finding("files-scaled").unwrap()["files"]
        .as_array()
        .unwrap();
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
    assert_eq!(closed.verdict(), "no-input-dependence");
    let (gain, _) = line(&closed);
    assert!((gain + 1.0).abs() < 0.02, "{gain}");
}

#[test]
fn another_unit_in_one_file_is_told_with_its_factor() {
    let (closed, _folder) = two_files(|force| 4.448 * force + 3.0);
    assert_eq!(closed.verdict(), "no-input-dependence");
    let (gain, offset) = line(&closed);
    // The baseline model errs by the noise alone, 0.4 % of the output.
    assert!((gain / 4.448 - 1.0).abs() < 0.02, "{gain}");
    assert!((offset - 3.0).abs() < 0.3, "{offset}");
}

#[test]
fn another_zero_in_one_file_is_a_pretension_that_steps_there() {
    let (closed, _folder) = two_files(|force| force + 5.0);
    assert_eq!(closed.finding("files-scaled"), None);
    assert_eq!(closed.names().first(), Some(&"pretension"));
    let path = &closed.finding("zero-differs").unwrap()["path"];
    assert!(path.as_str().unwrap().ends_with("evening.csv"));
    assert_eq!(closed.finding("files-of-several-rigs"), None);
}

/// A cable that is always pulled, with a viscous friction of its proximal pulley; the output times a
/// factor.
fn pulled(begin: f64, factor: f64) -> Rows {
    let tones = [0.17, 0.31, 0.53, 0.79, 1.1];
    let sine = |f: f64, t: f64| (std::f64::consts::TAU * f * t).sin();
    let input = |t: f64| -> f64 { 8.0 + tones.map(|f| 1.9 * sine(f, t)).iter().sum::<f64>() };
    let angle = |t: f64| input(t) / 30.0 + 0.05 * sine(0.9, t) + 0.02 * sine(0.41, t + 1.0);
    let (mut eta, mut before, mut rows) = (0.0_f64, input(begin), Vec::new());
    for i in 0..7_500 {
        let t = begin + 0.004 * i as f64;
        for _ in 0..10 {
            let dx = (input(t) - before) / 10.0;
            let held = eta.abs().powf(1.2);
            eta += 0.5 * (dx - 0.6 * dx.abs() * held * eta.signum() - 0.4 * dx * held);
        }
        before = input(t);
        let speed = (angle(t + 1e-4) - angle(t - 1e-4)) / 2e-4;
        let torque = 0.85 * input(t) - 1.2 * eta - 0.3 - 0.45 * speed + 0.02 * noise(i);
        rows.push(vec![t - begin, input(t), factor * torque, angle(t)]);
    }
    Rows {
        header: "t [s],tau_i [N·m],tau_o [N·m],phi_p [rad]".to_owned(),
        rows,
    }
}

/// In the squared error of both files the louder one is everything: what describes it may miss the
/// other one fifty times over, and still leave little of the sum.
#[test]
fn a_unit_of_a_thousandth_is_told_where_an_effect_is_missing_too() {
    let folder = Folder::new();
    let paths = [
        pulled(0.0, 1.0).write(&folder, "newton.csv"),
        pulled(100.0, 1e3).write(&folder, "milli.csv"),
    ];
    let closed = Closed::of(&[&paths[0], &paths[1]]);
    assert_eq!(closed.verdict(), "no-input-dependence");
    let file = &closed.finding("files-scaled").unwrap()["files"][0];
    let gain = file["gain"].as_f64().unwrap();
    // In either direction, and as exactly as the missing effect lets the gains be known.
    assert!((gain.ln().abs() - 1e3_f64.ln()).abs() < 0.1, "{gain}");
}

/// Most files count: the first one is the odd one here. The last of four is held out whole.
#[test]
fn of_several_files_the_one_that_differs_from_most_is_named() {
    let names = ["one.csv", "two.csv", "three.csv", "four.csv"];
    let (paths, _folder) = files(&names, |place, _, force| match place {
        0 => -force,
        _ => force,
    });
    let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
    let closed = Closed::of(&paths);
    assert_eq!(closed.verdict(), "no-input-dependence");
    let all = closed.finding("files-scaled").unwrap()["files"]
        .as_array()
        .unwrap();
    assert_eq!(all.len(), 1, "{all:?}");
    assert!(all[0]["path"].as_str().unwrap().ends_with("one.csv"));
}

/// Noise has no gain.
#[test]
fn a_sensor_that_is_dead_in_one_file_is_not_called_another_unit() {
    let (paths, _folder) = files(
        &["morning.csv", "evening.csv"],
        |place, i, force| match place {
            0 => force,
            _ => noise(i),
        },
    );
    let closed = Closed::of(&[&paths[0], &paths[1]]);
    assert_eq!(closed.finding("files-scaled"), None);
}

/// What the search has not tried may describe all files.
#[test]
fn a_search_that_was_not_made_says_nothing_of_files_that_are_apart() {
    let (paths, _folder) = files(
        &["morning.csv", "evening.csv"],
        |place, _, force| match place {
            0 => force,
            _ => -force,
        },
    );
    let closed = Closed::of(&[&paths[0], &paths[1], "--max-terms", "0"]);
    assert_eq!(closed.finding("files-scaled"), None);
}

#[test]
fn files_of_one_rig_are_not_apart() {
    let (closed, _folder) = two_files(|force| force);
    assert_eq!(closed.finding("files-scaled"), None);
    assert!(closed.names().is_empty());
    assert_eq!(closed.finding("files-of-several-rigs"), None);
}

/// Seen alone, a spring that hardens has another gain where it is moved further.
#[test]
fn files_of_two_strokes_on_a_spring_that_hardens_are_not_apart() {
    let small = spring_moved_by(0.3, (99.0, 0.0), 0);
    let large = spring((99.0, 0.0), 0);
    let folder = Folder::new();
    let hardens = |mut rows: Rows, name: &str| {
        rows.set(2, |_, row| row[2] + 0.8 * row[1].powi(3));
        rows.write(&folder, name)
    };
    let paths = [hardens(small, "small.csv"), hardens(large, "large.csv")];
    let closed = Closed::of(&[&paths[0], &paths[1]]);
    assert_eq!(closed.finding("files-scaled"), None);
    assert_eq!(closed.names().first(), Some(&"stiffness-cubic"));
    assert_eq!(closed.finding("files-of-several-rigs"), None);
}

/// The same spring with a third of the friction, and another zero: no gain makes one of the other.
#[test]
fn files_of_two_rigs_are_said_to_be_that_and_no_zero_is_blamed() {
    let whole = spring((99.0, 0.0), 0);
    let folder = Folder::new();
    let middle = whole.rows.len() / 2;
    let half = |rows: &[Vec<f64>]| Rows {
        header: whole.header.clone(),
        rows: rows.to_vec(),
    };
    let (first, mut second) = (half(&whole.rows[..middle]), half(&whole.rows[middle..]));
    let friction = |row: &[f64]| row[2] - 1.5 * row[1];
    second.set(2, |_, row| 1.5 * row[1] + friction(row) / 3.0 + 0.5);
    let paths = [
        first.write(&folder, "one.csv"),
        second.write(&folder, "other.csv"),
    ];
    let closed = Closed::of(&[&paths[0], &paths[1]]);
    assert!(closed.finding("files-of-several-rigs").is_some());
    assert_eq!(closed.finding("zero-differs"), None);
    let apart = Closed::of(&[&paths[0], &paths[1], "--per-file", "gains"]);
    assert_eq!(apart.verdict(), "explained");
    assert_eq!(apart.finding("files-of-several-rigs"), None);
}
