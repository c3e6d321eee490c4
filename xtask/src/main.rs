//! `cargo xtask`: tasks of the repository.

mod ci;
mod house;
mod source;

use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "\
cargo xtask COMMAND

  house       code lines, interface, constants and tests, each with its goal
  ci STEP…    what .ci/run runs: these steps, or every step
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    if let [command, names @ ..] = &arguments[..] {
        if command == "ci" {
            return ci::main(&root, names);
        }
    }
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["house"] => match house::counts(&root) {
            Ok(counts) => print(&house::table(&counts)),
            Err(error) => complain(&format!("cannot count: {error}")),
        },
        ["--help"] => print(USAGE),
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
