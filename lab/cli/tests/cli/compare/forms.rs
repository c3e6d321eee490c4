//! The TOML form: what it takes, and that it refuses the rest in one line.

use super::{bowden, json, row};
use crate::shell::{args, said, Folder};

fn file(text: &str) -> (Folder, String) {
    let folder = Folder::new();
    let path = folder.root().join("gains.toml");
    std::fs::write(&path, text).unwrap();
    let path = path.to_str().unwrap().to_owned();
    (folder, path)
}

/// One line on stderr, exit status 2.
#[track_caller]
fn refused(text: &str, expected: &[&str]) {
    let (_folder, path) = file(text);
    for command in [
        vec!["compare", "--model", &path],
        vec!["certify", "--gains", &path],
    ] {
        let output = bowden(&command);
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(message.trim_end().lines().count(), 1, "{message}");
        for part in expected {
            assert!(message.contains(part), "{part:?} is missing in {message}");
        }
    }
}

#[test]
fn an_unknown_key_is_named_with_line_and_column() {
    refused(
        "[pi]\nk_p = 30.0\nki = 18.0\n",
        &["gains.toml:3:1: `ki`", "unknown field", "k_i"],
    );
    refused("[rig]\nnoice = 0.1\n", &["gains.toml:2:1: `noice`"]);
    refused("[rigg]\nnoise = 0.1\n", &["gains.toml:1:", "rigg"]);
    refused(
        "[model]\nschema = \"bowden.model/1\"\nmode = \"torque\"\nchannels = []\ncolour = 1\n",
        &["colour"],
    );
}

#[test]
fn what_is_no_number_or_no_toml_is_told_where_it_stands() {
    refused("[pi]\nk_p = \"much\"\n", &["gains.toml:2:7: `k_p`"]);
    refused("[pi\nk_p = 30.0\n", &["gains.toml:1:"]);
}

#[test]
fn numbers_that_the_core_refuses_are_named() {
    refused("[rig]\njoint_inertia = 0.0\n", &["[rig]", "joint_inertia"]);
    refused("[pi]\nk_p = 30.0\nk_i = -1.0\n", &["[pi]", "k_p and k_i"]);
    refused("[adaptive]\nlambda = nan\n", &["[adaptive]", "lambda"]);
    refused(
        "[observer]\nfrequency = 0.0\n",
        &["[observer]", "frequency"],
    );
    refused("[observer]\nlimit = -1.0\n", &["[observer]", "limit"]);
}

#[test]
fn what_makes_no_sense_on_the_command_line_is_one_line_too() {
    for arguments in [
        ["compare", "--noise", "-1"].as_slice(),
        &["compare", "--seconds", "0"],
        &["compare", "--seeds", "0"],
        &["compare", "--effect", "viscos"],
        &["compare", "--effect", "viscous:much"],
        &["compare", "--effect", "viscous@elbow"],
        &["compare", "--effect", "temperature"],
        &["compare", "--model", "/nowhere/at/all.toml"],
    ] {
        let output = bowden(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?} {output:?}");
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn gains_in_the_form_are_the_gains_that_run() {
    let (_folder, path) = file("[pi]\nk_i = 320.0\n\n[rig]\nnoise = 0.02\n");
    let report = json(&args(&format!(
        "compare --model {path} --seconds 14 --seeds 1 --json"
    )));
    // PI is now the matched PI, on the same seed.
    assert_eq!(
        row(&report, "pi")["rmse_true"],
        row(&report, "matched-pi")["rmse_true"]
    );
    assert_eq!(report["conditions"]["noise"], 0.02);
}

#[test]
fn a_model_that_close_has_written_is_fed_forward() {
    let folder = Folder::new();
    let (record, model) = (folder.root().join("r.csv"), folder.root().join("m.toml"));
    let (record, model) = (record.to_str().unwrap(), model.to_str().unwrap());
    assert!(bowden(&["generate", "--out", record]).status.success());
    let closed = bowden(&["identify", record, "--model-out", model]);
    assert!(closed.status.success(), "{closed:?}");
    let report = json(&args(&format!(
        "compare --model {model} --seconds 9 --seeds 1 --json"
    )));
    assert_eq!(row(&report, "adaptive-feed-forward")["diverged"], 0);
}

#[test]
fn the_papers_results_stand_beside_the_papers_rig_and_gains_alone() {
    let short = ["compare", "--seconds", "8", "--seeds", "1"];
    let with = |more: &[&str]| said(&[&short, more].concat());
    let (_weak, weak) = file("[pi]\nk_i = 9.0\n");
    let (_light, light) = file("[rig]\nmotor_inertia = 0.1\n");
    let (_same, same) = file("[pi]\nk_i = 18.0\n[rig]\nnoise = 0.1\n");
    for own in [
        &["--inertia", "0.4"][..],
        &["--drive-gain", "0.5"],
        &["--model", &weak],
        &["--model", &light],
    ] {
        let table = with(own);
        assert!(
            !table.contains("0.5991") && !table.contains("are not reproduced"),
            "{table}"
        );
        assert!(
            table.contains("Table 3 of Nguyen et al. (2018) does not apply"),
            "{table}"
        );
    }
    for paper in [
        &["--noise", "0.02"][..],
        &["--inertia", "0.2"],
        &["--model", &same],
    ] {
        let table = with(paper);
        assert!(
            table.contains("0.5991") && table.contains("are not reproduced"),
            "{table}"
        );
    }
    // The table says what runs.
    assert!(with(&["--inertia", "0.4"]).contains("Rig: inertia 0.4 kg·m²."));
    assert!(with(&["--model", &weak]).contains("Gains and rig: from gains.toml."));
}
