//! `bowden.gains/1`: read back as it was, and refused where it is wrong.

use super::{design, designed, model, Question, ASKED};
use bowden::control::PidSettings;
use bowden_trials::gains::GainsFile;

const NUMBERS: [f64; 6] = [0.9, 2.0, 0.05, 0.2, 0.6, 2.0];

#[test]
fn the_file_reads_back_as_it_was_and_a_table_of_it_is_the_settings_of_the_core() {
    let own = designed(
        NUMBERS,
        &Question {
            delay: 0.0,
            noise: 0.02,
            ..ASKED
        },
    );
    assert!(own.gains.adaptive.is_some());
    let text = own.gains.toml().unwrap();
    assert_eq!(GainsFile::parse(&text, "gains.toml").unwrap(), own.gains);
    let table: toml::Table = toml::from_str(&text).unwrap();
    let pi: PidSettings<f32> = table["pi"].clone().try_into().unwrap();
    assert_eq!(pi.k_i, own.pi.k_i as f32);
}

#[track_caller]
fn refused(from: &str, to: &str, expected: &[&str]) {
    let text = designed(
        NUMBERS,
        &Question {
            delay: 0.0,
            ..ASKED
        },
    )
    .gains
    .toml()
    .unwrap();
    assert!(text.contains(from), "{from} is not in\n{text}");
    let line = GainsFile::parse(&text.replacen(from, to, 1), "gains.toml").unwrap_err();
    assert_eq!(line.lines().count(), 1, "{line}");
    for part in expected {
        assert!(line.contains(part), "{part} is not in {line}");
    }
}

#[test]
fn what_is_wrong_in_the_file_is_told_with_line_and_column() {
    refused(
        "k_p = ",
        "kp = ",
        &["gains.toml:13:1: `kp`", "unknown field"],
    );
    refused(
        "k_p = ",
        "k_p = nan # ",
        &["gains.toml:13:1: [pi]: ", "k_p"],
    );
    refused(
        "k_i = ",
        "k_i = -",
        &["gains.toml:13:1: [pi]: ", "k_p and k_i"],
    );
    refused(
        "rate = 1000.0",
        "rate = -1.0",
        &["gains.toml:7:1: [design]: rate -1"],
    );
    refused(
        "delay = 0.0",
        "delay = nan",
        &["gains.toml:8:1: [design]: delay NaN"],
    );
    refused(
        "drive_gain = 1.0\n",
        "",
        &["gains.toml:4:1: ", "missing field `drive_gain`"],
    );
    refused(
        "bowden.gains/1",
        "bowden.gains/9",
        &["gains.toml:2:1: schema"],
    );
    refused("[pi]", "[pee]", &["gains.toml:", "pee"]);
    refused(
        "lambda = ",
        "lambda = -",
        &["gains.toml:", "[adaptive]: ", "lambda"],
    );
}

#[test]
fn a_model_that_is_none_of_a_torque_loop_is_one_line() {
    let text = model(NUMBERS, "");
    let line = |text: &str| design(text, "m.toml", &ASKED).unwrap_err();
    let expect = |text: &str, part: &str| {
        let line = line(text);
        assert!(
            line.contains(part) && line.lines().count() == 1,
            "{part}: {line}"
        );
        assert!(line.starts_with("m.toml"), "{line}");
    };
    expect("", "is empty");
    expect(" \n", "is empty");
    expect(
        &text.replace("\"torque\"", "\"displacement\""),
        "must be torque, because the loop commands a torque",
    );
    expect(
        &text.replace("n = 2.0", "n = 2.0\nm = 1"),
        "m.toml:11:1: `m`",
    );
    expect(&text.replace("sigma = 0.6\n", ""), "missing field `sigma`");
    expect(&text.replace("rho = 0.2", "rho = nan"), "rho");
    expect(&text.replace("model/1", "model/7"), "bowden.model/7");
    expect(
        &text.replace("-20.0, 20.0", "20.0, -20.0"),
        "about.ranges.input.position",
    );
    expect(
        &text.replace("about.ranges.input", "about.ranges.other"),
        "about.ranges.input",
    );
    expect(
        &text
            .replace("gain = 0.9", "gain = -0.9")
            .replace("kappa_eta = 2.0", "kappa_eta = 0.1"),
        "falls while the input rises (gain -0.9000)",
    );
    // The output rises after a reversal, and falls beyond: of a rig with its sensor turned.
    expect(
        &text
            .replace("gain = 0.9", "gain = -0.9")
            .replace("kappa_eta = 2.0", "kappa_eta = -20.0"),
        "falls while the input rises (gain -0.9000)",
    );
}

#[test]
fn options_that_make_no_sense_are_one_line() {
    let text = model(NUMBERS, "");
    let expect = |asked: Question, part: &str| {
        let line = design(&text, "m.toml", &asked).unwrap_err();
        assert!(
            line.starts_with(part) && line.lines().count() == 1,
            "{line}"
        );
    };
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        expect(Question { rate, ..ASKED }, "--rate");
        expect(
            Question {
                drive_gain: rate,
                ..ASKED
            },
            "--drive-gain",
        );
    }
    for delay in [-1e-9, f64::NAN, f64::INFINITY] {
        expect(Question { delay, ..ASKED }, "--delay");
        expect(
            Question {
                noise: delay,
                ..ASKED
            },
            "--noise",
        );
    }
    expect(
        Question {
            delay: 2.0,
            ..ASKED
        },
        "--rate 1000: the delay of 2 s is longer than 1000",
    );
}
