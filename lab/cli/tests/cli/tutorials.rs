//! The commands of the README and of the tutorials run as they are written, on the records in
//! `examples/data`.

use crate::shell::{bowden_in, example, folder_with_examples, json, said, straight, Folder};

const README: &str = include_str!("../../../../README.md");
const FIRST: &str = include_str!("../../../../docs/tutorials/1-first-identification.md");
const SECOND: &str = include_str!("../../../../docs/tutorials/2-your-own-recording.md");
const THIRD: &str = include_str!("../../../../docs/tutorials/3-onto-a-microcontroller.md");

/// Lines that build something. They run elsewhere: this test runs the installed program,
/// `lab/cli/tests/cli/hand_over/postcard_file.rs` the check of the vector, `tests/torque_loop.rs` the
/// example, and `.ci/run firmware` the rest.
const RUN_ELSEWHERE: [&str; 5] = [
    "cargo install --path lab/cli",
    "cargo run --release -p bowden-lab --example check_vector -- model.toml",
    "cargo run --release --example torque_loop",
    "(cd firmware && cargo xtask --torque-loop)",
    "(cd firmware && cargo xtask --step model-2-constant --target thumbv7em-none-eabihf)",
];

/// Runs the lines of every block of commands of a page, without their remarks, in a folder that
/// looks like the repository to them.
fn run(page: &'static str, written: &str) {
    let folder = folder_with_examples();
    let mut ran = 0;
    let blocks = page.split("```sh\n").skip(1);
    for line in blocks.flat_map(|block| block.split("```").next().unwrap().lines()) {
        let line = line.split(" #").next().unwrap().trim_end();
        let Some(arguments) = line.strip_prefix("bowden ") else {
            assert!(RUN_ELSEWHERE.contains(&line), "{line}");
            continue;
        };
        let output = bowden_in(&folder, arguments);
        assert_eq!(output.status.code(), Some(0), "{line}: {output:?}");
        ran += 1;
    }
    // Every page has at least four lines for the program: a page whose blocks are not found fails.
    assert!(ran >= 4, "{ran}");
    for file in written.split(' ') {
        assert!(folder.names().contains(&file.to_owned()), "{file}");
    }
}

#[test]
fn every_command_of_the_readme_for_a_record_of_ones_own_runs_as_it_stands() {
    let (_, section) = README.split_once("## Your own record").unwrap();
    let (end, _) = section.match_indices("```").nth(1).unwrap();
    assert!(section[..end].matches("\nbowden ").count() >= 7);
    run(&section[..end], "model.toml trace.csv model.rs try.csv");
}

#[test]
fn the_model_of_the_straight_cable_holds_later_and_not_once_the_cable_is_bent() {
    let folder = Folder::new();
    let model = straight(&folder);
    for (record, holds) in [("straight_later.csv", true), ("bent.csv", false)] {
        let report = json(&format!("validate {model} {} --json", example(record)));
        assert_eq!(report["schema"], "bowden.validate/1");
        assert_eq!(report["verdict"] == "holds", holds, "{record}");
    }
}

#[test]
fn the_first_tutorial_shows_all_that_the_first_command_prints() {
    // On a terminal the text is wrapped; into a pipe it is not.
    let words = |text: &str| {
        text.split_whitespace()
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let (_, block) = FIRST.split_once("```text\n").unwrap();
    let (block, _) = block.split_once("```").unwrap();
    assert_eq!(words(&said("identify")), words(block));
}

#[test]
fn the_first_tutorial_runs_as_it_is_written() {
    run(FIRST, "first.html coulomb.csv");
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_second_tutorial_runs_as_it_is_written() {
    run(SECOND, "report.html trace.csv model.toml model.vector.csv");
}

#[test]
fn the_third_tutorial_runs_as_it_is_written() {
    run(
        THIRD,
        "model.rs model.toml gains.rs feed_forward.rs model.h",
    );
}
