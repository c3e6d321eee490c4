//! Models that promise nothing of a reference, and gains beside a model that they are not of.

use super::{straight, text};
use crate::shell::{args, bowden, refused, said, Folder};
use serde_json::Value;

/// The straight cable's model as if its record had covered these torques alone.
fn of_a_stroke(place: &Folder, stroke: [f64; 2]) -> String {
    let mut table: toml::Table = toml::from_str(&text(&straight(place))).unwrap();
    let input = table["about"]["ranges"]["input"].as_table_mut().unwrap();
    input.insert("position".to_owned(), stroke.to_vec().into());
    place.file("short.toml", toml::to_string(&table).unwrap())
}

/// Up and down the output would have to pass by more than the stroke moves it.
#[test]
fn a_stroke_shorter_than_the_hysteresis_has_no_reference_and_no_certificate() {
    let place = Folder::new();
    let model = of_a_stroke(&place, [-0.5, 0.5]);
    let asked = ["--rate", "500", "--delay", "0.006"];
    let report = said(&[["design", &model].as_slice(), &asked].concat());
    assert!(
        report.contains(
            "no output torque occurs in both directions of motion, so there is no reference"
        ) && report.contains("record a larger stroke")
            && report.contains("no certificate"),
        "{report}"
    );
    // Neither of the two that refuse it is recommended.
    assert!(
        report.contains("`bowden compare` cannot use this model")
            && report
                .contains("`bowden certify` rejects these gains: the file has no [plant] table"),
        "{report}"
    );
    let gains = place.path("gains.toml");
    said(&[["design", &model, "--out", &gains].as_slice(), &asked].concat());
    assert!(refused(&["certify", &gains]).contains("has no [plant]"));
    let report = said(&[["design", &model, "--json"].as_slice(), &asked].concat());
    let report: Value = serde_json::from_str(&report).unwrap();
    assert!(report["bounds"]["output"].is_null());
    assert!(report["adaptive"]["certificate"].is_null() && report["adaptive"]["plant"].is_null());
    // No reference of the paper's stands in for it.
    let line = refused(&["compare", "--model", &model, "--inertia", "0.002"]);
    assert!(
        line.contains("short.toml") && line.contains("record a larger stroke"),
        "{line}"
    );
}

/// A cable of which a certificate can be given.
const STIFF: &str = r#"
schema = "bowden.model/1"
mode = "torque"
channels = []
[transmission]
gain = 0.95
kappa_eta = 1.0
offset = 0.05
rho = 0.2
sigma = 0.6
n = 1.5
[about.ranges.input]
position = [LOW, 40.0]
velocity = [-40.0, 40.0]
acceleration = [-170.0, 170.0]
"#;

/// A cable that can only be pulled: what `certify` will say is said before.
#[test]
fn limits_on_one_side_of_zero_are_told_before_certify_refuses_them() {
    let place = Folder::new();
    let gains = place.path("gains.toml");
    let report = |low: f64| {
        let model = place.file("model.toml", STIFF.replace("LOW", &format!("{low:?}")));
        let asked = ["--rate", "1000", "--delay", "0.0004", "--out", &gains];
        let report = said(&[["design", &model].as_slice(), &asked].concat());
        assert!(report.contains("certificate (peak-"), "{report}");
        report
    };
    let both = report(-40.0);
    assert!(!both.contains("one side of zero"));
    assert!(both.contains("certificate (peak-rounded)"), "{both}");
    assert!(said(&["certify", &gains]).contains("\n  PROVED"));
    assert!(
        both.contains("\n        `bowden certify GAINS.toml` proves the bound"),
        "{both}"
    );
    let one = report(2.0);
    assert!(one.contains("limits are on one side of zero"));
    assert!(one.contains("certificate (peak-sampled)"), "{one}");
    let line = refused(&["certify", &gains]);
    assert!(line.contains("on both sides of zero"), "{line}");
    assert!(
        one.contains("\n        `bowden certify` rejects these gains: [adaptive]: limits 2 to 40"),
        "{one}"
    );
}

/// Small limits and a slow loop: `certify` reads the file, and says what is missing.
#[test]
fn gains_that_are_not_proved_are_said_to_be_that_and_certify_names_what_fails() {
    let place = Folder::new();
    let gains = place.path("gains.toml");
    let model = STIFF.replace("kappa_eta = 1.0", "kappa_eta = 0.1");
    for (stroke, above) in [("3.0", "no certificate: "), ("6.0", "certificate (peak-")] {
        let model = model.replace("LOW", &format!("-{stroke}"));
        let model = model.replace("40.0]\nvelocity", &format!("{stroke}]\nvelocity"));
        let model = place.file("model.toml", &model);
        let asked = ["--rate", "50", "--delay", "0.01", "--out", &gains];
        let report = said(&[["design", &model].as_slice(), &asked].concat());
        assert!(report.contains(above), "{report}");
        let last = report.lines().last().unwrap().trim_start();
        assert!(
            last.starts_with("`bowden certify GAINS.toml` names the gain or limit that"),
            "{last}"
        );
        let output = bowden(&["certify", &gains]);
        assert_eq!(output.status.code(), Some(1));
        let named = String::from_utf8(output.stdout).unwrap();
        assert!(named.contains("Remedy: "), "{named}");
    }
}

#[test]
fn a_rate_that_is_too_low_for_the_law_is_named() {
    let place = Folder::new();
    let model = straight(&place);
    for asked in [
        ["--rate", "2", "--delay", "0.001"],
        ["--rate", "10", "--delay", "0.3"],
    ] {
        let report = said(&[["design", &model].as_slice(), &asked].concat());
        assert!(
            report.contains("these gains: the file has no [adaptive] table"),
            "{report}"
        );
        let line = report.lines().find(|l| l.contains("cannot both hold"));
        let line = line.unwrap_or_else(|| panic!("{report}"));
        let (step, most) = line
            .split_once("at a step of ")
            .unwrap()
            .1
            .split_once(" s, ")
            .unwrap();
        let most = most
            .split_once("at most ")
            .unwrap()
            .1
            .split(' ')
            .next()
            .unwrap();
        let (step, most): (f64, f64) = (step.parse().unwrap(), most.parse().unwrap());
        assert!(step > most, "{line}");
        // What is said to do does.
        let rate = format!("{}", 1.05 / most);
        let report = said(&["design", &model, "--rate", &rate, "--delay", "0"]);
        assert!(!report.contains("cannot both hold"), "{report}");
    }
}

#[test]
fn gains_of_another_model_are_told() {
    let place = Folder::new();
    let (model, gains) = super::designed(&place);
    let told = |model: &str| {
        let fixed = args("--seeds 1 --seconds 8 --inertia 0.002 --damping 0.5");
        said(
            &[
                ["compare", "--model", model, "--gains", &gains].as_slice(),
                &fixed,
            ]
            .concat(),
        )
    };
    assert!(!told(&model).contains("designed for model.toml and not"));
    let other = place.file("other.toml", text(&model));
    let report = told(&other);
    assert!(
        report.contains("gains.toml, designed for model.toml and not for this model"),
        "{report}"
    );
}

/// A loop that its slew-rate limit rules has an error that says nothing of its gains.
#[test]
fn a_command_that_is_at_its_limit_much_of_the_time_is_told_beside_its_errors() {
    let place = Folder::new();
    let (model, gains) = super::designed(&place);
    let fixed = ["--seeds", "1", "--seconds", "9"];
    let light = super::LIGHT.as_slice();
    let compared = |gains: &str, more: &[&str]| {
        let asked = ["compare", "--model", &model, "--gains", gains];
        said(&[asked.as_slice(), &fixed, light, more].concat())
    };
    assert!(!compared(&gains, &[]).contains("The command saturates"));
    // PI alone is slowed down.
    let mut table: toml::Table = toml::from_str(&text(&gains)).unwrap();
    let limits = &mut table["pi"].as_table_mut().unwrap()["limits"];
    let limits = limits.as_table_mut().unwrap();
    let designed = limits["slew"].as_float().unwrap();
    limits.insert("slew".to_owned(), (0.02 * designed).into());
    let slow = place.file("slow.toml", toml::to_string(&table).unwrap());
    let report = compared(&slow, &[]);
    let told = report.lines().find(|l| l.contains("The command saturates"));
    let told = told.unwrap_or_else(|| panic!("{report}"));
    assert!(
        told.contains("saturates: pi at its slew-rate limit in "),
        "{told}"
    );
    assert!(!told.contains("adaptive"), "{told}");
    let json: Value = serde_json::from_str(&compared(&slow, &["--json"])).unwrap();
    let rows = json["rows"].as_array().unwrap();
    let share = |name: &str| {
        let row = rows.iter().find(|row| row["controller"] == name).unwrap();
        row["at_limit"]["slew"].as_f64().unwrap()
    };
    assert!(share("pi") > 0.2 && share("pi") <= 1.0, "{json}");
    assert!(share("adaptive") < 0.2, "{json}");
    let percent = format!("{:.0} % of the samples", 100.0 * share("pi"));
    assert!(told.contains(&percent), "{told}");
    let page = place.path("page.html");
    compared(&slow, &["--report", &page]);
    assert!(text(&page).contains("saturates: pi at its slew-rate limit in "));
}

/// Certificates without a model's cable would be believed to be of it.
#[test]
fn certificates_of_the_reference_rig_are_not_asked_for_a_model() {
    let place = Folder::new();
    let (model, gains) = super::designed(&place);
    let line = refused(&["certify", "--gains", &model]);
    assert!(
        line.contains("model.toml: this file is a model")
            && line.contains("`bowden design MODEL.toml"),
        "{line}"
    );
    let line = refused(&["certify", "--gains", &gains]);
    assert!(
        line.contains("certify this file with `bowden certify FILE`"),
        "{line}"
    );
}
