//! The program as a user runs it: what it is asked, and what it answers.

use std::path::Path;
use std::process::{Command, Output};

pub fn bowden(arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_bowden"));
    program.args(arguments).output().unwrap()
}

/// The same on that number of threads.
pub fn bowden_on(threads: &str, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bowden"))
        .args(arguments)
        .env("RAYON_NUM_THREADS", threads)
        .output()
        .unwrap()
}

/// A file of `examples/data`.
pub fn example(name: &str) -> String {
    format!("{}/../../examples/data/{name}", env!("CARGO_MANIFEST_DIR"))
}

pub fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

/// What the program prints where all is well.
pub fn said(arguments: &[&str]) -> String {
    let output = bowden(arguments);
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {complaint}");
    text(&output.stdout).to_owned()
}

/// Exit 2, nothing on stdout, and exactly one line on stderr.
pub fn refused(arguments: &[&str]) -> String {
    let output = bowden(arguments);
    let printed = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {printed}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    let line = text(&output.stderr).trim_end().to_owned();
    assert_eq!(line.lines().count(), 1, "{line}");
    line
}

/// The JSON of a run but for its seconds, the one thing in it that a clock decides.
pub fn without_seconds(stdout: &[u8]) -> String {
    let (before, rest) = text(stdout).split_once("\"seconds\":{").unwrap();
    let (_, after) = rest.split_once('}').unwrap();
    format!("{before}{after}")
}

/// A folder that looks like the repository to commands that read `examples/data`.
pub fn folder_with_examples() -> tempfile::TempDir {
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

/// The program in a folder.
pub fn bowden_in(folder: &tempfile::TempDir, arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_bowden"));
    program
        .args(arguments)
        .current_dir(folder.path())
        .output()
        .unwrap()
}
