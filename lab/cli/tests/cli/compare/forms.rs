//! The TOML form: what it takes, and that it refuses the rest in one line.

use super::row;
use crate::shell::{bowden, has, json, refuses, refuses_all, said, straight, Folder};

#[test]
fn what_the_form_does_not_take_is_named_with_line_and_column() {
    let model = "schema = \"bowden.model/1\"\nmode = \"torque\"\nchannels = []\ncolour = 1\n";
    let folder = Folder::new();
    for (text, parts) in [
        (
            "[pi]\nk_p = 3.0\nki = 1.0\n",
            ["gains.toml:3:1: `ki`", "k_i"],
        ),
        (
            "[rig]\nnoice = 0.1\n",
            ["gains.toml:2:1: `noice`", "unknown field"],
        ),
        ("[rigg]\nnoise = 0.1\n", ["gains.toml:1:", "rigg"]),
        (&format!("[model]\n{model}"), ["gains.toml", "colour"]),
        (
            "[pi]\nk_p = \"much\"\n",
            ["gains.toml:2:7: `k_p`", "string"],
        ),
        ("[pi\nk_p = 30.0\n", ["gains.toml:1:", ""]),
        // Numbers that the core refuses.
        ("[rig]\njoint_inertia = 0.0\n", ["[rig]", "joint_inertia"]),
        ("[pi]\nk_p = 30.0\nk_i = -1.0\n", ["[pi]", "k_p and k_i"]),
        ("[adaptive]\nlambda = nan\n", ["[adaptive]", "lambda"]),
        ("[observer]\nfrequency = 0.0\n", ["[observer]", "frequency"]),
        ("[observer]\nlimit = -1.0\n", ["[observer]", "limit"]),
    ] {
        let path = folder.file("gains.toml", text);
        refuses(&format!("compare --model {path}"), &parts);
        refuses(&format!("certify --gains {path}"), &parts);
    }
}

#[test]
fn what_makes_no_sense_on_the_command_line_is_one_line_too() {
    refuses_all(
        &Folder::new(),
        "compare --noise -1 => --noise -1 is out of range (0
        compare --inertia 0 => --inertia 0 is out of range; it must be positive
        compare --delay 9 => 9 is not in 0..=8
        compare --seconds 0 => seconds
        compare --effect viscos => viscos
        compare --effect viscous:much => much
        compare --effect viscous@elbow => elbow
        compare --effect temperature => temperature
        compare --model none.toml => none.toml",
    );
    assert_eq!(bowden("compare --seeds 0").status.code(), Some(2));
}

#[test]
fn gains_in_the_form_are_the_gains_that_run() {
    let folder = Folder::new();
    let path = folder.file("g.toml", "[pi]\nk_i = 320.0\n\n[rig]\nnoise = 0.02\n");
    let report = json(&format!(
        "compare --model {path} --seconds 14 --seeds 1 --json"
    ));
    // PI is now the matched PI, on the same seed.
    let [own, matched] = ["pi", "matched-pi"].map(|name| &row(&report, name)["rmse_true"]);
    assert_eq!(own, matched);
    assert_eq!(report["conditions"]["noise"], 0.02);
}

#[test]
fn a_model_that_close_has_written_is_fed_forward() {
    let folder = Folder::new();
    let model = straight(&folder);
    let report = json(&format!(
        "compare --model {model} --seconds 9 --seeds 1 --json"
    ));
    assert_eq!(row(&report, "adaptive-feed-forward")["diverged"], 0);
}

#[test]
fn the_papers_results_stand_beside_the_papers_rig_and_gains_alone() {
    let folder = Folder::new();
    let weak = folder.file("weak.toml", "[pi]\nk_i = 9.0\n");
    let light = folder.file("light.toml", "[rig]\nmotor_inertia = 0.1\n");
    let same = folder.file("same.toml", "[pi]\nk_i = 18.0\n[rig]\nnoise = 0.1\n");
    for (asked, is_papers, words) in [
        ("--inertia 0.4", false, "Rig: inertia 0.4 kg·m²."),
        ("--drive-gain 0.5", false, ""),
        (
            &*format!("--model {weak}"),
            false,
            "Gains and rig: from weak.toml.",
        ),
        (&*format!("--model {light}"), false, ""),
        ("--noise 0.02", true, ""),
        ("--inertia 0.2", true, ""),
        (&*format!("--model {same}"), true, ""),
    ] {
        let table = said(&format!("compare --seconds 8 --seeds 1 {asked}"));
        // The table says what runs.
        has(&table, &[words]);
        for paper in ["0.5991", "are not reproduced"] {
            assert_eq!(table.contains(paper), is_papers, "{asked}: {table}");
        }
        let no_paper = "Table 3 of Nguyen et al. (2018) does not apply";
        assert_eq!(table.contains(no_paper), !is_papers, "{asked}: {table}");
    }
}
