//! A file of firmware as its user compiles it.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The newest build of the crate `bowden` beside this test.
fn library(folder: &Path) -> PathBuf {
    let entries = std::fs::read_dir(folder).unwrap().map(Result::unwrap);
    let is_own = |name: &str| name.starts_with("libbowden-") && name.ends_with(".rlib");
    let own = entries.filter(|entry| is_own(&entry.file_name().to_string_lossy()));
    let newest = own.max_by_key(|entry| entry.metadata().unwrap().modified().unwrap());
    newest.unwrap().path()
}

fn output(command: &mut Command) -> Vec<u8> {
    let output = command.output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    output.stdout
}

/// Compiles a program of that text with all warnings as errors, runs it, returns its words.
pub fn compiled_and_run(text: &str, folder: &Path) -> String {
    let (source, program) = (folder.join("program.rs"), folder.join("program"));
    std::fs::write(&source, text).unwrap();
    let test = std::env::current_exe().unwrap();
    let built = test.parent().unwrap();
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let mut compiler = Command::new(compiler);
    compiler.args(["--edition", "2021", "-D", "warnings", "-C", "opt-level=0"]);
    compiler.arg(format!("--extern=bowden={}", library(built).display()));
    compiler.arg(format!("-Ldependency={}", built.display()));
    output(compiler.arg("-o").arg(&program).arg(&source));
    String::from_utf8(output(&mut Command::new(&program))).unwrap()
}

/// A file of firmware as a module of a program; only `model()` is called.
pub fn module(name: &str, text: &str) -> String {
    format!("mod {name} {{\n{text}}}\n")
}
