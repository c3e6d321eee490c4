//! The commands of the README run as they stand, on the records in `examples/data`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::Path;
use std::process::{Command, Output};

const README: &str = include_str!("../../../README.md");

/// The lines of the README's section "Your own record", without their remarks.
fn commands() -> Vec<Vec<&'static str>> {
    let (_, section) = README.split_once("## Your own record").unwrap();
    let (_, block) = section.split_once("```sh\n").unwrap();
    let (block, _) = block.split_once("```").unwrap();
    let words = |line: &'static str| {
        let line = line.split(" #").next().unwrap();
        line.split_whitespace().skip(1).collect()
    };
    block.lines().map(words).collect()
}

/// A folder that looks like the repository to the commands.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("examples/data");
    std::fs::create_dir_all(&data).unwrap();
    let own = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/data"));
    for file in std::fs::read_dir(own).unwrap().map(Result::unwrap) {
        if file.path().extension().is_some_and(|e| e == "csv") {
            std::fs::copy(file.path(), data.join(file.file_name())).unwrap();
        }
    }
    folder
}

fn run(folder: &tempfile::TempDir, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bowden"))
        .args(arguments)
        .current_dir(folder.path())
        .output()
        .unwrap()
}

#[test]
fn every_command_for_a_record_of_ones_own_runs_as_it_stands() {
    let (folder, commands) = (folder(), commands());
    assert!(commands.len() >= 7, "{commands:?}");
    for arguments in &commands {
        let output = run(&folder, arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {output:?}");
        println!("{}", String::from_utf8(output.stdout).unwrap());
    }
    for written in ["model.toml", "trace.csv", "model.rs", "try.csv"] {
        assert!(folder.path().join(written).exists(), "{written}");
    }
}

#[test]
fn the_model_of_the_straight_cable_holds_later_and_not_once_the_cable_is_bent() {
    let folder = folder();
    let close = [
        "close",
        "examples/data/straight.csv",
        "--model-out",
        "m.toml",
    ];
    assert!(run(&folder, &close).status.success());
    let verdict = |record: &str| -> String {
        let output = run(&folder, &["check", "m.toml", record, "--json"]);
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(report["schema"], "bowden.check/1");
        report["verdict"].as_str().unwrap().to_owned()
    };
    assert_eq!(verdict("examples/data/straight_later.csv"), "holds");
    assert_ne!(verdict("examples/data/bent.csv"), "holds");
}
