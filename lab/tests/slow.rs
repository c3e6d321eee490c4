//! `cargo test` leaves out what takes long, and `.ci/run` leaves out nothing: each slow test
//! names the step that runs it, and that step runs its file.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

/// The folder that holds `.ci/run`.
fn repository() -> &'static Path {
    let mut above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    above
        .find(|folder| folder.join(".ci/run").exists())
        .unwrap()
}

/// The Rust files below a folder, but for what is built.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.extension().and_then(|e| e.to_str()) {
            _ if path.is_dir() && !path.ends_with("target") => all.extend(files(&path)),
            Some("rs") => all.push(path),
            _ => {}
        }
    }
    all
}

/// The test target that a file belongs to: `tests/NAME.rs` or `tests/NAME/….rs`.
fn target(file: &Path) -> Option<String> {
    let parts = file.components().map(|c| c.as_os_str().to_string_lossy());
    let name = parts.skip_while(|part| part != "tests").nth(1)?;
    Some(name.trim_end_matches(".rs").to_owned())
}

/// Target and step of each slow test, from the lines `#[ignore = "slow: bash .ci/run STEP"]`.
fn slow() -> Vec<(String, String)> {
    let mut all = Vec::new();
    for file in files(&repository().join("lab")) {
        let Some(target) = target(&file) else {
            continue;
        };
        let text = std::fs::read_to_string(&file).unwrap();
        for line in text.lines().map(str::trim) {
            // Any other form would go unrun without anybody being told.
            let Some(reason) = line.strip_prefix("#[ignore") else {
                continue;
            };
            let step = reason.strip_prefix(" = \"slow: bash .ci/run ");
            let step = step.and_then(|s| s.strip_suffix("\"]"));
            assert!(step.is_some(), "{}: {line}", file.display());
            all.extend(step.map(|step| (target.clone(), step.to_owned())));
        }
    }
    all
}

#[test]
fn each_slow_test_is_run_by_the_step_that_it_names() {
    let run = std::fs::read_to_string(repository().join(".ci/run")).unwrap();
    let all = slow();
    assert!(!all.is_empty());
    for (target, step) in all {
        assert!(run.contains(&format!("\nstep {step} ")), "no step {step}");
        let body = run.split_once(&format!("\n{}() {{\n", step.replace('-', "_")));
        let body = body
            .and_then(|(_, rest)| rest.split_once("\n}\n"))
            .unwrap()
            .0;
        let mut words = body.split_whitespace();
        assert!(
            body.contains("slow_tests ") && words.any(|word| word == target),
            "{step} does not run {target}"
        );
    }
}
