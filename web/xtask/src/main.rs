//! Tasks for the web page.
//!
//! - `cargo xtask` builds the page into `web/dist`; `--out DIR` writes it elsewhere.
//! - `cargo xtask serve` serves `web/dist` on this machine; `--port N` chooses the port.
//! - `cargo xtask test` runs the page in Chromium and compares its answers with the program's.
//! - `cargo xtask time` prints the size of the page, and its time next to the program's.
//!
//! Exit status 77: a task cannot run on this machine; a line gives the reason.

mod browser;
mod build;
mod check;
mod native;
mod pages;
mod serve;
mod time;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

const USAGE: &str = "cargo xtask [--out DIR]\n       cargo xtask serve [--port N]\n       cargo xtask test\n       cargo xtask time";

/// Exit status of a task that cannot run on this machine.
const SKIPPED: u8 = 77;

/// Why a task ended.
enum Ended {
    /// Something that the task needs is missing.
    Skipped(String),
    /// Something is wrong.
    Failed(String),
}

type Done = Result<(), Ended>;

impl From<std::io::Error> for Ended {
    fn from(error: std::io::Error) -> Self {
        Self::Failed(error.to_string())
    }
}

impl From<serde_json::Error> for Ended {
    fn from(error: serde_json::Error) -> Self {
        Self::Failed(error.to_string())
    }
}

fn failed(message: impl Into<String>) -> Ended {
    Ended::Failed(message.into())
}

/// The folder `web`.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .map_or_else(PathBuf::new, Path::to_owned)
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let dist = root().join("dist");
    let done = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => build::build(&dist),
        ["--out", folder] => build::build(Path::new(folder)),
        ["serve"] => serve::serve(&dist, 8047),
        ["serve", "--port", port] => match port.parse() {
            Ok(port) => serve::serve(&dist, port),
            Err(_) => Err(failed(format!("--port {port}: is no port"))),
        },
        ["test"] => check::check(),
        ["time"] => time::time(),
        _ => {
            eprintln!("usage: {USAGE}");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Ended::Skipped(why)) => {
            println!("skipped: {why}");
            ExitCode::from(SKIPPED)
        }
        Err(Ended::Failed(why)) => {
            eprintln!("FAILED: {why}");
            ExitCode::FAILURE
        }
    }
}
