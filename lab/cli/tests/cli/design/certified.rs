//! `bowden certify` on the file of `bowden design`.

use super::text;
use crate::shell::{bowden, refused, said, text as of_bytes, Folder};
use serde_json::Value;

/// A cable whose output never turns back: 0.95 - 2·0.2·1.2 = 0.47 is its least slope.
const SOFT: &str = include_str!("../shell/soft.toml");

/// Gains of the soft cable, and what the design says of them.
fn designed(place: &Folder) -> (String, Value) {
    let (model, gains) = (place.file("soft.toml", SOFT), place.path("gains.toml"));
    let asked = ["design", &model, "--rate", "1000", "--delay", "0.0001"];
    let report = said(&[&asked, ["--out", &gains, "--json"].as_slice()].concat());
    (gains, serde_json::from_str(&report).unwrap())
}

/// The file with some lines of a table replaced.
fn with(gains: &str, table: &str, lines: &[(&str, &str)]) -> String {
    let all = text(gains);
    let (before, own) = all.split_once(&format!("[{table}]\n")).unwrap();
    let (own, after) = own.split_once("\n\n").unwrap_or((own, ""));
    let mut own = own.to_owned();
    for (key, value) in lines {
        let old = own.lines().find(|l| l.starts_with(&format!("{key} = ")));
        own = own.replace(old.unwrap(), &format!("{key} = {value}"));
    }
    format!("{before}[{table}]\n{own}\n\n{after}")
}

#[test]
fn designed_gains_are_proved_as_they_stand_and_refused_beyond_what_their_limits_hold() {
    let place = Folder::new();
    let (gains, report) = designed(&place);
    // The record has reached -12 N·m, which does not hold its greatest output and the friction:
    // less is promised, and `certify` proves that.
    let stated = said(&["certify", &gains, "--json"]);
    let stated: Value = serde_json::from_str(&stated).unwrap();
    assert_eq!(stated["proved"], true);
    assert_eq!(stated["may_meet_the_limit"], false);
    let promised = report["adaptive"]["certificate"].as_f64().unwrap();
    let error = stated["error"]["value"].as_f64().unwrap();
    assert!((promised / error - 1.0).abs() < 1e-12, "{promised} {error}");
    let reference = report["adaptive"]["plant"]["reference"].as_f64().unwrap();
    // (reference + friction and offset + 2·S)/alpha within 12.
    assert!(reference > 4.0 && reference < 12.0 * 0.95, "{reference}");
    let beyond = with(&gains, "plant", &[("reference", "13.15")]);
    let output = bowden(&["certify", &place.file("beyond.toml", &beyond)]);
    assert_eq!(output.status.code(), Some(1));
    let refusal = of_bytes(&output.stdout);
    assert!(refusal.contains("NOT PROVED in f32"), "{refusal}");
    assert!(refusal.contains("a command limit of at least"), "{refusal}");

    // The fastest input of the record is slower than the law from the corner of its box.
    let slow = with(&gains, "adaptive.limits", &[("slew", "40.0")]);
    let output = bowden(&["certify", &place.file("slow.toml", &slow)]);
    assert_eq!(output.status.code(), Some(1));
    let refusal = of_bytes(&output.stdout);
    let (_, enough) = refusal
        .split_once("Remedy: a slew-rate limit of at least ")
        .unwrap();
    let enough = enough.split(' ').next().unwrap();
    let mended = with(&gains, "adaptive.limits", &[("slew", enough)]);
    said(&["certify", &place.file("mended.toml", &mended)]);

    // A limit that holds both, the same on both sides, may be met.
    let gains = place.file("beyond.toml", &beyond);
    let wide = with(
        &gains,
        "adaptive.limits",
        &[("low", "-19.0"), ("high", "19.0"), ("slew", "900.0")],
    );
    let wide = place.file("wide.toml", &wide);
    let proved = said(&["certify", &wide]);
    assert!(proved.contains("PROVED in f32"), "{proved}");
    let json: Value = serde_json::from_str(&said(&["certify", &wide, "--json"])).unwrap();
    // A greater reference has a greater box.
    let (own, peak) = (
        json["error"]["value"].as_f64().unwrap(),
        report["adaptive"]["certificate"].as_f64().unwrap(),
    );
    assert!(own > peak && own < 1.5 * peak, "{own} {peak}");
    assert_eq!(json["may_meet_the_limit"], true);
    for (key, field) in [("disturbance", "disturbance"), ("reference", "reference")] {
        assert!(report["adaptive"]["plant"][key].is_number(), "{report}");
        assert!(json["plant"][field].is_string(), "{json}");
    }

    // Other limits on either side may be met too, and no theorem is of them.
    let uneven = with(
        &gains,
        "adaptive.limits",
        &[("low", "-19.0"), ("high", "24.0"), ("slew", "900.0")],
    );
    let output = bowden(&["certify", &place.file("uneven.toml", &uneven)]);
    assert_eq!(output.status.code(), Some(1));
    let refusal = of_bytes(&output.stdout);
    assert!(refusal.contains("symmetric command limits"), "{refusal}");

    // Limits that are never met may differ.
    let far = with(
        &gains,
        "adaptive.limits",
        &[("low", "-900.0"), ("high", "950.0"), ("slew", "900.0")],
    );
    said(&["certify", &place.file("far.toml", &far)]);
}

#[test]
fn what_a_design_lacks_or_states_wrongly_is_one_line() {
    let place = Folder::new();
    let (gains, _) = designed(&place);
    let all = text(&gains);
    let (without, _) = all.split_once("[plant]").unwrap();
    let line = refused(&["certify", &place.file("bare.toml", without)]);
    assert!(line.contains("bare.toml: has no [plant]"), "{line}");
    let (head, _) = all.split_once("[adaptive]").unwrap();
    let line = refused(&["certify", &place.file("pi.toml", head)]);
    assert!(line.contains("pi.toml: has no [adaptive]"), "{line}");
    for (key, value, what) in [
        ("alpha", "[0.9, 0.8]", "the lower one first"),
        ("alpha", "[0.0, 0.8]", "positive"),
        ("disturbance", "-1.0", "zero or positive"),
        ("disturbance_rate", "nan", "a finite number"),
        ("reference_rate", "inf", "a finite number"),
    ] {
        let wrong = with(&gains, "plant", &[(key, value)]);
        let row = wrong
            .lines()
            .position(|l| l.starts_with(&format!("{key} = ")));
        let line = refused(&["certify", &place.file("wrong.toml", &wrong)]);
        let place = format!("wrong.toml:{}:1: [plant]: {key}", row.unwrap() + 1);
        assert!(line.contains(&place) && line.contains(what), "{line}");
    }
    let limits = with(&gains, "adaptive.limits", &[("low", "0.0")]);
    let line = refused(&["certify", &place.file("one_sided.toml", &limits)]);
    assert!(line.contains("on both sides of zero"), "{line}");
}
