//! The commands of the tutorials run as they are written, on the records in `examples/data`.

use crate::shell::{bowden_in, folder_with_examples, said};

const FIRST: &str = include_str!("../../../../docs/tutorials/1-first-identification.md");
const SECOND: &str = include_str!("../../../../docs/tutorials/2-your-own-recording.md");
const THIRD: &str = include_str!("../../../../docs/tutorials/3-onto-a-microcontroller.md");

/// Lines that build something, and what runs them instead of this test.
const RUN_ELSEWHERE: [(&str, &str); 5] = [
    (
        "cargo install --path lab/cli",
        "the program that this test runs",
    ),
    (
        "cargo run --release -p bowden-lab --example check_vector -- model.toml",
        "lab/cli/tests/cli/hand_over/examples.rs",
    ),
    (
        "cargo run --release --example torque_loop",
        "tests/torque_loop.rs",
    ),
    (
        "(cd firmware && cargo xtask --torque-loop)",
        ".ci/run firmware",
    ),
    (
        "(cd firmware && cargo xtask --step model-2-constant --target thumbv7em-none-eabihf)",
        ".ci/run firmware",
    ),
];

/// The lines of every block of commands, without their remarks.
fn commands(page: &'static str) -> Vec<&'static str> {
    let blocks = page.split("```sh\n").skip(1);
    blocks
        .flat_map(|block| block.split("```").next().unwrap().lines())
        .map(|line| line.split(" #").next().unwrap().trim_end())
        .collect()
}

/// Runs the lines of a page in a folder that looks like the repository to them.
fn run(page: &'static str, written: &[&str]) {
    let folder = folder_with_examples();
    let mut ran = 0;
    for line in commands(page) {
        let Some(arguments) = line.strip_prefix("bowden ") else {
            assert!(RUN_ELSEWHERE.iter().any(|(own, _)| *own == line), "{line}");
            continue;
        };
        let arguments: Vec<&str> = arguments.split_whitespace().collect();
        let output = bowden_in(&folder, &arguments);
        assert_eq!(output.status.code(), Some(0), "{line}: {output:?}");
        ran += 1;
    }
    // Every page has at least four lines for the program: a page whose blocks are not found fails.
    assert!(ran >= 4, "{ran}");
    for file in written {
        assert!(folder.root().join(file).exists(), "{file}");
    }
}

/// On a terminal the text is wrapped; into a pipe it is not.
fn words(text: &str) -> Vec<&str> {
    text.split_whitespace().collect()
}

#[test]
fn the_first_tutorial_shows_all_that_the_first_command_prints() {
    let printed = said(&["identify"]);
    let (_, block) = FIRST.split_once("```text\n").unwrap();
    let (block, _) = block.split_once("```").unwrap();
    assert_eq!(words(&printed), words(block), "{printed}");
}

#[test]
fn the_first_tutorial_runs_as_it_is_written() {
    run(FIRST, &["first.html", "coulomb.csv"]);
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_second_tutorial_runs_as_it_is_written() {
    let files = ["report.html", "trace.csv", "model.toml", "model.vector.csv"];
    run(SECOND, &files);
}

#[test]
fn the_third_tutorial_runs_as_it_is_written() {
    let files = [
        "model.rs",
        "model.toml",
        "gains.rs",
        "feed_forward.rs",
        "model.h",
    ];
    run(THIRD, &files);
}
