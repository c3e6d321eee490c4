//! `bowden certify` on the file of `bowden design`.

use super::design;
use crate::shell::{bowden, has, json, refuses, said, text, Folder};
use serde_json::Value;

/// A cable whose output never turns back: 0.95 - 2·0.2·1.2 = 0.47 is its least slope.
const SOFT: &str = include_str!("../shell/soft.toml");

/// Gains of the soft cable, and what the design says of them.
fn designed(place: &Folder) -> (String, Value) {
    let (model, gains) = (place.file("soft.toml", SOFT), place.path("gains.toml"));
    let report = design(&model, "1000", "0.0001", &format!("--out {gains} --json"));
    (
        place.read("gains.toml"),
        serde_json::from_str(&report).unwrap(),
    )
}

/// Gains with some lines of a table replaced.
fn with(gains: &str, table: &str, lines: &[(&str, &str)]) -> String {
    let (before, own) = gains.split_once(&format!("[{table}]\n")).unwrap();
    let (own, after) = own.split_once("\n\n").unwrap_or((own, ""));
    let mut own = own.to_owned();
    for (key, value) in lines {
        let mut all = own.lines();
        let old = all.find(|l| l.starts_with(&format!("{key} = ")));
        own = own.replace(old.unwrap(), &format!("{key} = {value}"));
    }
    format!("{before}[{table}]\n{own}\n\n{after}")
}

/// Gains with other limits of the command.
fn limited(gains: &str, low: &str, high: &str, slew: &str) -> String {
    let limits = [("low", low), ("high", high), ("slew", slew)];
    with(gains, "adaptive.limits", &limits)
}

#[test]
fn designed_gains_are_proved_as_they_stand_and_refused_beyond_what_their_limits_hold() {
    let place = Folder::new();
    let (gains, report) = designed(&place);
    let certify = |gains: &str| format!("certify {}", place.file("own.toml", gains));
    let proved = |gains: &str| json(&format!("{} --json", certify(gains)));
    let refusal = |gains: &str| {
        let output = bowden(&certify(gains));
        assert_eq!(output.status.code(), Some(1));
        text(&output.stdout).to_owned()
    };
    // The record has reached -12 N·m, which does not hold its greatest output and the friction:
    // less is promised, and `certify` proves that.
    let stated = proved(&gains);
    assert_eq!(stated["proved"], true);
    assert_eq!(stated["may_meet_the_limit"], false);
    let promised = report["adaptive"]["certificate"].as_f64().unwrap();
    let error = |of: &Value| of["error"]["value"].as_f64().unwrap();
    let own = error(&stated);
    assert!((promised / own - 1.0).abs() < 1e-12, "{promised} {own}");
    let reference = report["adaptive"]["plant"]["reference"].as_f64().unwrap();
    // (reference + friction and offset + 2·S)/alpha within 12.
    assert!(reference > 4.0 && reference < 12.0 * 0.95, "{reference}");
    let beyond = with(&gains, "plant", &[("reference", "13.15")]);
    has(
        &refusal(&beyond),
        &["NOT PROVED in f32", "a command limit of at least"],
    );

    // The fastest input of the record is slower than the law from the corner of its box.
    let slew = |slew: &str| with(&gains, "adaptive.limits", &[("slew", slew)]);
    let slow = refusal(&slew("40.0"));
    let (_, enough) = slow
        .split_once("Remedy: a slew-rate limit of at least ")
        .unwrap();
    proved(&slew(enough.split(' ').next().unwrap()));

    // A limit that holds both, the same on both sides, may be met. A greater reference has a
    // greater box.
    let wide = limited(&beyond, "-19.0", "19.0", "900.0");
    has(&said(&certify(&wide)), &["PROVED in f32"]);
    let stated = proved(&wide);
    let own = error(&stated);
    assert!(own > promised && own < 1.5 * promised, "{own} {promised}");
    assert_eq!(stated["may_meet_the_limit"], true);
    for key in ["disturbance", "reference"] {
        assert!(report["adaptive"]["plant"][key].is_number(), "{report}");
        assert!(stated["plant"][key].is_string(), "{stated}");
    }
    // Other limits on either side may be met too, and no theorem is of them.
    let uneven = limited(&beyond, "-19.0", "24.0", "900.0");
    has(&refusal(&uneven), &["symmetric command limits"]);
    // Limits that are never met may differ.
    proved(&limited(&beyond, "-900.0", "950.0", "900.0"));
}

#[test]
fn what_a_design_lacks_or_states_wrongly_is_one_line() {
    let place = Folder::new();
    let (gains, _) = designed(&place);
    let before = |part: &str| gains.split_once(part).unwrap().0.to_owned();
    let one_sided = with(&gains, "adaptive.limits", &[("low", "0.0")]);
    for (text, part) in [
        (before("[plant]"), "own.toml: has no [plant]"),
        (before("[adaptive]"), "own.toml: has no [adaptive]"),
        (one_sided, "on both sides of zero"),
    ] {
        let path = place.file("own.toml", text);
        refuses(&format!("certify {path}"), &[part]);
    }
    for (key, value, what) in [
        ("alpha", "[0.9, 0.8]", "the lower one first"),
        ("alpha", "[0.0, 0.8]", "positive"),
        ("disturbance", "-1.0", "zero or positive"),
        ("disturbance_rate", "nan", "a finite number"),
        ("reference_rate", "inf", "a finite number"),
    ] {
        let wrong = with(&gains, "plant", &[(key, value)]);
        let is_own = |line: &str| line.starts_with(&format!("{key} = "));
        let row = wrong.lines().position(is_own).unwrap() + 1;
        let path = place.file("own.toml", &wrong);
        let line = format!("own.toml:{row}:1: [plant]: {key}");
        refuses(&format!("certify {path}"), &[&line, what]);
    }
}
