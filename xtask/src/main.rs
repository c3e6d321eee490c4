//! `cargo xtask`: tasks of the repository.

mod ci;
mod house;
mod mutants;
mod source;

use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "\
cargo xtask COMMAND

  house       code lines, interface, constants and tests, each with its goal
  ci STEP…    what .ci/run runs: these steps, or every step
  mutants WORD…
              the changes of mutants.txt that contain a word, or all: does the test of each fail?
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let Some((command, rest)) = arguments.split_first() else {
        return complain(USAGE);
    };
    match (command.as_str(), rest) {
        ("ci", steps) => ci::main(&root, steps),
        ("mutants", words) => match mutants::run(&root, words) {
            Ok(0) => ExitCode::SUCCESS,
            Ok(survived) => complain(&format!("{survived} mutants have not failed a test")),
            Err(error) => complain(&format!("cannot run the mutants: {error}")),
        },
        ("house", []) => match house::counts(&root) {
            Ok(counts) => print(&house::table(&counts)),
            Err(error) => complain(&format!("cannot count: {error}")),
        },
        ("--help", []) => print(USAGE),
        _ => complain(USAGE),
    }
}

/// Prints a text; a closed pipe, for example after `head`, is not an error.
fn print(text: &str) -> ExitCode {
    let _ = std::io::stdout().write_all(text.as_bytes());
    ExitCode::SUCCESS
}

fn complain(text: &str) -> ExitCode {
    eprintln!("{}", text.trim_end());
    ExitCode::from(2)
}
