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

/// A target of slow tests.
struct Slow {
    package: String,
    target: String,
    /// The step that its tests name.
    step: String,
}

/// The package and the test target that a file belongs to: `tests/NAME.rs` or
/// `tests/NAME/….rs`, below the package's manifest.
fn target(file: &Path) -> Option<(String, String)> {
    let tests = file.ancestors().find(|a| a.ends_with("tests"))?;
    let name = file.strip_prefix(tests).unwrap().iter().next()?;
    let name = name.to_string_lossy().trim_end_matches(".rs").to_owned();
    let manifest = std::fs::read_to_string(tests.with_file_name("Cargo.toml")).unwrap();
    let manifest: toml::Table = manifest.parse().unwrap();
    let package = manifest["package"]["name"].as_str().unwrap().to_owned();
    Some((package, name))
}

/// Each slow test, from the lines `#[ignore = "slow: bash .ci/run STEP"]`.
fn slow() -> Vec<Slow> {
    let mut all = Vec::new();
    for file in files(&repository().join("lab")) {
        let Some((package, target)) = target(&file) else {
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
            all.extend(step.map(|step| Slow {
                package: package.clone(),
                target: target.clone(),
                step: step.to_owned(),
            }));
        }
    }
    all
}

/// Whether a line of a step is `slow_tests PACKAGE … TARGET …`.
fn runs(line: &str, package: &str, target: &str) -> bool {
    let mut words = line.split_whitespace();
    words.next() == Some("slow_tests")
        && words.next() == Some(package)
        && words.any(|word| word == target)
}

#[test]
fn each_slow_test_is_run_by_the_step_that_it_names() {
    let run = std::fs::read_to_string(repository().join(".ci/run")).unwrap();
    let all = slow();
    // Two packages have a target of the same name, so one package alone would not do.
    for package in ["bowden-lab", "bowden-cli", "bowden-trials"] {
        assert!(all.iter().any(|s| s.package == package), "{package}");
    }
    for Slow {
        package,
        target,
        step,
    } in all
    {
        assert!(run.contains(&format!("\nstep {step} ")), "no step {step}");
        let body = run.split_once(&format!("\n{}() {{\n", step.replace('-', "_")));
        let body = body
            .and_then(|(_, rest)| rest.split_once("\n}\n"))
            .unwrap()
            .0;
        assert!(
            body.lines().any(|line| runs(line, &package, &target)),
            "{step} does not run {target} of {package}"
        );
    }
}
