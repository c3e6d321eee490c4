//! The commands of the README run as they are, on the records in `examples/data`.

use crate::shell::{args, bowden_in as run, folder_with_examples as folder};

const README: &str = include_str!("../../../../README.md");

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
        assert!(folder.root().join(written).exists(), "{written}");
    }
}

#[test]
fn the_model_of_the_straight_cable_holds_later_and_not_once_the_cable_is_bent() {
    let folder = folder();
    let close = args("identify examples/data/straight.csv --model-out m.toml");
    assert!(run(&folder, &close).status.success());
    let verdict = |record: &str| -> String {
        let output = run(&folder, &["validate", "m.toml", record, "--json"]);
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(report["schema"], "bowden.validate/1");
        report["verdict"].as_str().unwrap().to_owned()
    };
    assert_eq!(verdict("examples/data/straight_later.csv"), "holds");
    assert_ne!(verdict("examples/data/bent.csv"), "holds");
}
