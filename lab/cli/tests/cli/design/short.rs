//! Models that promise nothing of a reference, and gains beside a model that they are not of.

use super::{compared, design, designed, LIGHT};
use crate::compare::row;
use crate::shell::{bowden, has, refuses, said, straight, text, Folder};
use serde_json::Value;

/// Up and down the output would have to pass by more than the stroke moves it: the straight cable's
/// model as if its record had covered these torques alone.
#[test]
fn a_stroke_shorter_than_the_hysteresis_has_no_reference_and_no_certificate() {
    let place = Folder::new();
    straight(&place);
    let mut table: toml::Table = place.read("model.toml").parse().unwrap();
    let input = table["about"]["ranges"]["input"].as_table_mut().unwrap();
    input.insert("position".to_owned(), vec![-0.5, 0.5].into());
    let model = place.file("short.toml", toml::to_string(&table).unwrap());
    let gains = place.path("gains.toml");
    let report = design(&model, "500", "0.006", &format!("--out {gains}"));
    for words in [
        "no output torque occurs in both directions of motion, so there is no reference",
        "record a larger stroke",
        "no certificate",
        // Neither of the two that refuse it is recommended.
        "`bowden compare` cannot use this model",
        "`bowden certify` rejects these gains: the file has no [plant] table",
    ] {
        has(&report, &[words]);
    }
    refuses(&format!("certify {gains}"), &["has no [plant]"]);
    let report = design(&model, "500", "0.006", "--json");
    let report: Value = serde_json::from_str(&report).unwrap();
    assert!(report["bounds"]["output"].is_null());
    assert!(report["adaptive"]["certificate"].is_null() && report["adaptive"]["plant"].is_null());
    // No reference of the paper's stands in for it.
    let compare = format!("compare --model {model} --inertia 0.002");
    refuses(&compare, &["short.toml", "record a larger stroke"]);
}

/// A cable of which a certificate can be given, with a record between two torques.
fn stiff(place: &Folder, kappa_eta: &str, ends: [&str; 2]) -> String {
    let numbers = "gain = 0.95\noffset = 0.05\nrho = 0.2\nsigma = 0.6\nn = 1.5\n";
    let ranges = "velocity = [-40.0, 40.0]\nacceleration = [-170.0, 170.0]\n";
    let model = format!(
        "schema = \"bowden.model/1\"\nmode = \"torque\"\nchannels = []\n\
         [transmission]\nkappa_eta = {kappa_eta}\n{numbers}\
         [about.ranges.input]\nposition = [{}]\n{ranges}",
        ends.join(", ")
    );
    place.file("model.toml", model)
}

/// A cable that can only be pulled: what `certify` will say is said before.
#[test]
fn limits_on_one_side_of_zero_are_told_before_certify_refuses_them() {
    let place = Folder::new();
    let gains = place.path("gains.toml");
    let report = |low: &str| {
        let model = stiff(&place, "1.0", [low, "40.0"]);
        design(&model, "1000", "0.0004", &format!("--out {gains}"))
    };
    let both = report("-40.0");
    assert!(!both.contains("one side of zero"));
    let proves = "\n        `bowden certify GAINS.toml` proves the bound";
    has(&both, &["certificate (peak-rounded)", proves]);
    has(&said(&format!("certify {gains}")), &["\n  PROVED"]);
    let one = report("2.0");
    let rejects = "\n        `bowden certify` rejects these gains: [adaptive]: limits 2 to 40";
    has(
        &one,
        &[
            "limits are on one side of zero",
            "certificate (peak-sampled)",
            rejects,
        ],
    );
    refuses(&format!("certify {gains}"), &["on both sides of zero"]);
}

/// Small limits and a slow loop: `certify` reads the file, and says what is missing.
#[test]
fn gains_that_are_not_proved_are_said_to_be_that_and_certify_names_what_fails() {
    let place = Folder::new();
    let gains = place.path("gains.toml");
    for (ends, above) in [
        (["-3.0", "3.0"], "no certificate: "),
        (["-6.0", "6.0"], "certificate (peak-"),
    ] {
        let model = stiff(&place, "0.1", ends);
        let report = design(&model, "50", "0.01", &format!("--out {gains}"));
        has(&report, &[above]);
        let last = report.lines().last().unwrap();
        has(
            last,
            &["`bowden certify GAINS.toml` names the gain or limit that"],
        );
        let output = bowden(&format!("certify {gains}"));
        assert_eq!(output.status.code(), Some(1));
        has(text(&output.stdout), &["Remedy: "]);
    }
}

#[test]
fn a_rate_that_is_too_low_for_the_law_is_named() {
    let place = Folder::new();
    let model = straight(&place);
    for (rate, delay) in [("2", "0.001"), ("10", "0.3")] {
        let report = design(&model, rate, delay, "");
        has(
            &report,
            &[
                "these gains: the file has no [adaptive] table",
                "cannot both hold",
            ],
        );
        let after = |words: &str| -> f64 {
            let mut lines = report.lines();
            let line = lines.find(|l| l.contains("cannot both hold")).unwrap();
            let (_, rest) = line.split_once(words).unwrap();
            rest.split(' ').next().unwrap().parse().unwrap()
        };
        let (step, most) = (after("at a step of "), after("at most "));
        assert!(step > most, "{report}");
        // What is said to do does.
        let report = design(&model, &(1.05 / most).to_string(), "0", "");
        assert!(!report.contains("cannot both hold"), "{report}");
    }
}

#[test]
fn gains_of_another_model_are_told() {
    let place = Folder::new();
    let (model, gains) = designed(&place);
    let other = place.file("other.toml", place.read("model.toml"));
    let words = "gains.toml, designed for model.toml and not for this model";
    for (model, is_other) in [(model, false), (other, true)] {
        let files = format!("--model {model} --gains {gains}");
        let report = said(&format!("compare {files} --seeds 1 --seconds 8 {LIGHT}"));
        assert_eq!(report.contains(words), is_other, "{report}");
    }
}

/// A loop that its slew-rate limit rules has an error that says nothing of its gains.
#[test]
fn a_command_that_is_at_its_limit_much_of_the_time_is_told_beside_its_errors() {
    let place = Folder::new();
    let (model, gains) = designed(&place);
    // PI alone is slowed down.
    let mut table: toml::Table = place.read("gains.toml").parse().unwrap();
    let limits = &mut table["pi"].as_table_mut().unwrap()["limits"];
    let limits = limits.as_table_mut().unwrap();
    let designed = limits["slew"].as_float().unwrap();
    limits.insert("slew".to_owned(), (0.02 * designed).into());
    let slow = place.file("slow.toml", toml::to_string(&table).unwrap());
    let page = place.path("page.html");
    let told = |gains: &str| {
        let files = format!("--model {model} --gains {gains} --report {page}");
        said(&format!("compare {files} --seeds 1 --seconds 9 {LIGHT}"))
    };
    assert!(!told(&gains).contains("The command saturates"));
    let report = told(&slow);
    let told = report.lines().find(|l| l.contains("The command saturates"));
    let told = told.unwrap_or_else(|| panic!("{report}"));
    let at_limit = "saturates: pi at its slew-rate limit in ";
    has(told, &[at_limit]);
    has(&place.read("page.html"), &[at_limit]);
    assert!(!told.contains("adaptive"), "{told}");
    let json = compared(&model, &slow, "--seconds 9");
    let share = |name: &str| row(&json, name)["at_limit"]["slew"].as_f64().unwrap();
    assert!(share("pi") > 0.2 && share("pi") <= 1.0, "{json}");
    assert!(share("adaptive") < 0.2, "{json}");
    has(
        told,
        &[&format!("{:.0} % of the samples", 100.0 * share("pi"))],
    );
}
