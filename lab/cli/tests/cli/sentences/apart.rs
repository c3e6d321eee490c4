//! Several files of which one has another sign, unit, zero or channel: the sentence names it.

use crate::sentences::files::{noise, spring, spring_of, Closed, Rows, PHI_P};
use serde_json::Value;

const PHI_D: usize = PHI_P + 1;

/// Records of one spring with a hysteresis behind each other, as many as there are names, the
/// output of each as `changed` says of its place and row.
fn files(names: &[&str], changed: impl Fn(usize, usize, f64) -> f64, options: &str) -> Closed {
    let mut parts = spring().parts(names.len());
    for (place, part) in parts.iter_mut().enumerate() {
        part.set(2, |i, row| changed(place, i, row[2]));
    }
    Closed::files(names.iter().copied().zip(parts), options)
}

const TWO: [&str; 2] = ["morning.csv", "evening.csv"];

fn two_files(changed: impl Fn(usize, f64) -> f64, options: &str) -> Closed {
    let of = |place, i, force| match place {
        0 => force,
        _ => changed(i, force),
    };
    files(&TWO, of, options)
}

/// The only file that is apart.
fn apart<'a>(closed: &'a Closed, name: &str) -> &'a Value {
    let all = &closed.finding("files-scaled").unwrap()["files"];
    assert_eq!(all.as_array().unwrap().len(), 1, "{all}");
    assert!(all[0]["path"].as_str().unwrap().ends_with(name), "{all}");
    &all[0]
}

#[test]
fn another_sign_or_unit_in_one_file_is_told_with_its_factor_and_nothing_is_called_a_model() {
    for (gain, offset) in [(-1.0, 0.0), (4.448, 3.0)] {
        let closed = two_files(|_, force| gain * force + offset, "");
        assert_eq!(closed.verdict(), "no-input-dependence");
        let file = apart(&closed, "evening.csv");
        assert!(file["than"].as_str().unwrap().ends_with("morning.csv"));
        assert!(file["after"].as_f64() < file["before"].as_f64());
        let of = |what: &str| file[what].as_f64().unwrap();
        // The baseline model errs by the noise alone, 0.4 % of the output.
        assert!((of("gain") / gain - 1.0).abs() < 0.02, "{file}");
        assert!((of("offset") - offset).abs() < 0.3, "{file}");
    }
}

#[test]
fn another_zero_in_one_file_is_a_pretension_that_steps_there() {
    let closed = two_files(|_, force| force + 5.0, "");
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
    let (mut eta, mut before) = (0.0_f64, input(begin));
    let row = |i: usize| {
        let t = begin + 0.004 * i as f64;
        let dx = (input(t) - before) / 10.0;
        for _ in 0..10 {
            let held = eta.abs().powf(1.2);
            eta += 0.5 * (dx - 0.6 * dx.abs() * held * eta.signum() - 0.4 * dx * held);
        }
        before = input(t);
        let speed = (angle(t + 1e-4) - angle(t - 1e-4)) / 2e-4;
        let torque = 0.85 * input(t) - 1.2 * eta - 0.3 - 0.45 * speed + 0.02 * noise(i);
        vec![t - begin, input(t), factor * torque, angle(t)]
    };
    let header = "t [s],tau_i [N·m],tau_o [N·m],phi_p [rad]";
    Rows::new(header, (0..7_500).map(row))
}

/// In the squared error of both files the louder one is everything: what describes it may miss the
/// other one fifty times over, and still leave little of the sum.
#[test]
fn a_unit_of_a_thousandth_is_told_where_an_effect_is_missing_too() {
    let files = [
        ("newton.csv", pulled(0.0, 1.0)),
        ("milli.csv", pulled(100.0, 1e3)),
    ];
    let closed = Closed::files(files, "");
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
    let first_reversed = |place, _, force: f64| if place == 0 { -force } else { force };
    let closed = files(&names, first_reversed, "");
    assert_eq!(closed.verdict(), "no-input-dependence");
    apart(&closed, "one.csv");
}

#[test]
fn files_that_are_not_apart_are_not_called_that() {
    // Noise has no gain; and what a search has not tried may describe all files.
    let dead = two_files(|i, _| noise(i), "");
    let not_searched = two_files(|_, force| -force, "--max-terms 0");
    let same = two_files(|_, force| force, "");
    assert!(same.names().is_empty());
    assert_eq!(same.finding("files-of-several-rigs"), None);
    // Seen alone, a spring that hardens has another gain where it is moved further.
    let strokes = [("small.csv", 0.3), ("large.csv", 1.0)].map(|(name, times)| {
        let mut rows = spring_of(times, |_| 0.0);
        rows.set(2, |_, row| row[2] + 0.8 * row[1].powi(3));
        (name, rows)
    });
    let hardens = Closed::files(strokes, "");
    assert_eq!(hardens.names().first(), Some(&"stiffness-cubic"));
    assert_eq!(hardens.finding("files-of-several-rigs"), None);
    for closed in [dead, not_searched, same, hardens] {
        assert_eq!(closed.finding("files-scaled"), None);
    }
}

/// The same spring with a third of the friction, and another zero: no gain makes one of the other.
#[test]
fn files_of_two_rigs_are_said_to_be_that_and_no_zero_is_blamed() {
    let mut parts = spring().parts(2);
    let friction = |row: &[f64]| row[2] - 1.5 * row[1];
    parts[1].set(2, |_, row| 1.5 * row[1] + friction(row) / 3.0 + 0.5);
    let closed = |options: &str| Closed::files(TWO.into_iter().zip(parts.clone()), options);
    let together = closed("");
    assert!(together.finding("files-of-several-rigs").is_some());
    assert_eq!(together.finding("zero-differs"), None);
    let apart = closed("--per-file gains");
    assert_eq!(apart.verdict(), "explained");
    assert_eq!(apart.finding("files-of-several-rigs"), None);
}

/// Two halves of one record with effects of both angles; the second half as `changed` has it.
fn halves(changed: impl Fn(&mut Rows)) -> Closed {
    let effects = "--effect=viscous@phi_p:2 --effect=gravity@phi_d:2";
    let whole = Rows::generated(&format!("{effects} --seed=41 --seconds=40"));
    let mut parts = whole.parts(2);
    changed(&mut parts[1]);
    Closed::files(TWO.into_iter().zip(parts), "--mode torque")
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn a_channel_that_counts_the_other_way_or_has_anothers_place_in_one_file_is_asked_about() {
    let reverse = |rows: &mut Rows, channel: usize| rows.set(channel, |_, row| -row[channel]);
    let swap = |rows: &mut Rows| rows.rows.iter_mut().for_each(|r| r.swap(PHI_P, PHI_D));
    for (closed, what, column) in [
        (halves(|rows| reverse(rows, PHI_P)), "reversed", "phi_p"),
        (halves(|rows| reverse(rows, PHI_D)), "reversed", "phi_d"),
        (halves(swap), "swapped", "phi_p"),
    ] {
        assert_eq!(closed.verdict(), "no-input-dependence");
        let suspicion = closed.finding("logged-differently").unwrap();
        let path = suspicion["path"].as_str().unwrap();
        assert!(path.ends_with("evening.csv"), "{path}");
        assert_eq!(suspicion["what"], what);
        assert_eq!(suspicion["column"], column);
        if what == "swapped" {
            assert_eq!(suspicion["other"], "phi_d");
        }
        let error = |name: &str| suspicion[name].as_f64().unwrap();
        assert!(error("after") <= 0.8 * error("before"), "{suspicion}");
        // What the whole record shows: viscous friction of one angle, and what gravity does over a
        // small range of the other.
        let terms = suspicion["terms"].as_array().unwrap();
        assert!(terms.iter().any(|n| n == "viscous@phi_p"), "{suspicion}");
        assert_eq!(terms.len(), 2, "{suspicion}");
        assert_eq!(closed.finding("output-leads"), None);
    }
    let equal = halves(|_| {});
    assert_eq!(equal.finding("logged-differently"), None);
    assert_eq!(equal.names().len(), 2);
}
