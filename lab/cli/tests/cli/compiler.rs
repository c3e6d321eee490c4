//! A file of firmware as its user compiles it.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Names of the files in a folder.
fn names(folder: &Path) -> impl Iterator<Item = String> {
    let entries = std::fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
}

/// The newest build of a crate beside this test.
fn library(folder: &Path, name: &str) -> PathBuf {
    let built = names(folder).filter(|f| {
        f.strip_prefix(&format!("lib{name}-"))
            .is_some_and(|rest| rest.ends_with(".rlib"))
    });
    let built = built.map(|file| folder.join(file));
    let age = |path: &PathBuf| std::fs::metadata(path).unwrap().modified().unwrap();
    built.max_by_key(age).unwrap()
}

/// Compiles a program of that text with all warnings as errors, runs it, returns its words.
pub fn compiled_and_run(text: &str, folder: &Path) -> String {
    let (source, program) = (folder.join("program.rs"), folder.join("program"));
    std::fs::write(&source, text).unwrap();
    let built = std::env::current_exe()
        .unwrap()
        .parent()
        .unwrap()
        .to_owned();
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let output = Command::new(compiler)
        .args([
            "--edition",
            "2021",
            "-D",
            "warnings",
            "-C",
            "opt-level=0",
            "-o",
        ])
        .arg(&program)
        .arg("--extern")
        .arg(format!("bowden={}", library(&built, "bowden").display()))
        .arg("-L")
        .arg(format!("dependency={}", built.display()))
        .arg(&source)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let ran = Command::new(&program).output().unwrap();
    assert!(
        ran.status.success(),
        "{}",
        String::from_utf8_lossy(&ran.stderr)
    );
    String::from_utf8(ran.stdout).unwrap()
}

/// A file of firmware as a module of a program; only `model()` is called.
pub fn module(name: &str, text: &str) -> String {
    format!("mod {name} {{\n{text}}}\n")
}
