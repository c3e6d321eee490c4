//! `bowden.gains/1`: read back as it was, and refused where it is wrong.

use super::{design, designed, model, Question, ASKED, QUICK};
use bowden::control::PidSettings;
use bowden_trials::gains::GainsFile;

const NUMBERS: [f64; 6] = [0.9, 2.0, 0.05, 0.2, 0.6, 2.0];

#[test]
fn the_file_reads_back_as_it_was_and_a_table_of_it_is_the_settings_of_the_core() {
    let noisy = Question {
        noise: 0.02,
        ..QUICK
    };
    let own = designed(NUMBERS, &noisy);
    assert!(own.gains.adaptive.is_some());
    let text = own.gains.toml().unwrap();
    assert_eq!(GainsFile::parse(&text, "gains.toml").unwrap(), own.gains);
    let table: toml::Table = toml::from_str(&text).unwrap();
    let pi: PidSettings<f32> = table["pi"].clone().try_into().unwrap();
    assert_eq!(pi.k_i, own.pi.k_i as f32);
}

/// What stands in the file, what is written in its place, and two parts of the refusal.
const WRONG: [[&str; 4]; 9] = [
    ["k_p = ", "kp = ", "gains.toml:13:1: `kp`", "unknown field"],
    ["k_p = ", "k_p = nan # ", "gains.toml:13:1: [pi]: ", "k_p"],
    [
        "k_i = ",
        "k_i = -",
        "gains.toml:13:1: [pi]: ",
        "k_p and k_i",
    ],
    [
        "rate = 1000.0",
        "rate = -1.0",
        "gains.toml:7:1: [design]: rate -1",
        "",
    ],
    [
        "delay = 0.0",
        "delay = nan",
        "gains.toml:8:1: [design]: delay NaN",
        "",
    ],
    [
        "drive_gain = 1.0\n",
        "",
        "gains.toml:4:1: ",
        "missing field `drive_gain`",
    ],
    [
        "bowden.gains/1",
        "bowden.gains/9",
        "gains.toml:2:1: schema",
        "",
    ],
    ["[pi]", "[pee]", "gains.toml:", "pee"],
    ["lambda = ", "lambda = -", "[adaptive]: ", "lambda"],
];

#[test]
fn what_is_wrong_in_the_file_is_told_with_line_and_column() {
    let text = designed(NUMBERS, &QUICK).gains.toml().unwrap();
    for [from, to, place, what] in WRONG {
        assert!(text.contains(from), "{from} is not in\n{text}");
        let line = GainsFile::parse(&text.replacen(from, to, 1), "gains.toml").unwrap_err();
        assert_eq!(line.lines().count(), 1, "{line}");
        assert!(
            line.contains(place) && line.contains(what),
            "{place}{what}: {line}"
        );
    }
}

/// What stands in the model, what is written in its place, and a part of the refusal.
const NO_TORQUE_LOOP: [[&str; 3]; 9] = [
    [
        "\"torque\"",
        "\"displacement\"",
        "must be torque, because the loop commands a torque",
    ],
    ["n = 2.0", "n = 2.0\nm = 1", "m.toml:11:1: `m`"],
    ["sigma = 0.6\n", "", "missing field `sigma`"],
    ["rho = 0.2", "rho = nan", "rho"],
    ["model/1", "model/7", "bowden.model/7"],
    ["-20.0, 20.0", "20.0, -20.0", "about.ranges.input.position"],
    [
        "about.ranges.input",
        "about.ranges.other",
        "about.ranges.input",
    ],
    [
        "gain = 0.9\nkappa_eta = 2.0",
        "gain = -0.9\nkappa_eta = 0.1",
        "falls while the input rises (gain -0.9000)",
    ],
    // The output rises after a reversal, and falls beyond: of a rig with its sensor turned.
    [
        "gain = 0.9\nkappa_eta = 2.0",
        "gain = -0.9\nkappa_eta = -20.0",
        "falls while the input rises (gain -0.9000)",
    ],
];

#[test]
fn a_model_that_is_none_of_a_torque_loop_is_one_line() {
    let text = model(NUMBERS, "");
    let expect = |text: &str, part: &str| {
        let line = design(text, "m.toml", &ASKED).unwrap_err();
        let is_one = line.starts_with("m.toml") && line.lines().count() == 1;
        assert!(is_one && line.contains(part), "{part}: {line}");
    };
    expect("", "is empty");
    expect(" \n", "is empty");
    for [from, to, part] in NO_TORQUE_LOOP {
        assert!(text.contains(from), "{from} is not in\n{text}");
        expect(&text.replace(from, to), part);
    }
}

#[test]
fn options_that_make_no_sense_are_one_line() {
    let text = model(NUMBERS, "");
    let expect = |set: &dyn Fn(&mut Question), part: &str| {
        let mut asked = ASKED;
        set(&mut asked);
        let line = design(&text, "m.toml", &asked).unwrap_err();
        let is_one = line.lines().count() == 1;
        assert!(is_one && line.starts_with(part), "{line}");
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        expect(&|q| q.rate = bad, "--rate");
        expect(&|q| q.drive_gain = bad, "--drive-gain");
    }
    for bad in [-1e-9, f64::NAN, f64::INFINITY] {
        expect(&|q| q.delay = bad, "--delay");
        expect(&|q| q.noise = bad, "--noise");
    }
    let says = "--rate 1000: the delay of 2 s is longer than 1000";
    expect(&|q| q.delay = 2.0, says);
}
