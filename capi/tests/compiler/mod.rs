//! What C programs are built with here, or why they cannot be.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder `capi/`.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Where programs are built, a folder for each test.
pub fn scratch(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Whether a program can be started.
pub fn is_there(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok()
}

/// The first of these programs that is there; says so where none is.
pub fn first_of(test: &str, programs: &[&'static str]) -> Option<&'static str> {
    let found = programs.iter().find(|program| is_there(program));
    if found.is_none() {
        println!(
            "skipped: {test}: none of {} is installed",
            programs.join(", ")
        );
    }
    found.copied()
}

/// Text of a command that ended well.
pub fn said(command: &mut Command) -> String {
    let Output {
        status,
        stdout,
        stderr,
    } = command.output().unwrap();
    let (out, err) = (
        String::from_utf8_lossy(&stdout),
        String::from_utf8_lossy(&stderr),
    );
    assert!(status.success(), "{command:?}\n{out}\n{err}");
    out.into_owned()
}

/// The static library, for the host or for a target, optimised.
pub fn library(target: Option<&str>) -> PathBuf {
    let mut cargo = Command::new(env!("CARGO"));
    cargo
        .args(["build", "--release", "--locked", "--quiet"])
        .current_dir(root());
    // Its own folder, wherever that of this test is.
    let folder = root().join("target");
    cargo.arg("--target-dir").arg(&folder);
    let mut built = folder;
    if let Some(target) = target {
        cargo.args(["--target", target]);
        built = built.join(target);
    }
    said(&mut cargo);
    built.join("release/libbowden.a")
}

/// The warnings that must not be, and the arithmetic as it is written: without it a compiler may
/// fuse a product and a sum of the example's own, which the comparison to the bit would see.
pub const FLAGS: [&str; 5] = [
    "-Wall",
    "-Wextra",
    "-pedantic",
    "-Werror",
    "-ffp-contract=off",
];

/// A compiler of C with the header's folders, for files that the caller adds.
pub fn compiler(program: &str) -> Command {
    let mut command = Command::new(program);
    command.args(["-std=c99", "-O2"]).args(FLAGS);
    for folder in ["include", "examples"] {
        command.arg("-I").arg(root().join(folder));
    }
    command
}

/// What the static library needs of a Unix host.
pub const HOST_LIBRARIES: [&str; 3] = ["-lm", "-lpthread", "-ldl"];
