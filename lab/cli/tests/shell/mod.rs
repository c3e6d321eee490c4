//! The program as a user runs it: what it is asked, and what it answers.

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
