//! The slow tests: `cargo test` ignores them, and each names the step that runs it.

use super::shell::{fail, Done, Shell};
use super::STEPS;
use crate::house;
use std::collections::BTreeMap;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The line before a slow test, up to the name of its step.
const MARK: &str = "#[ignore = \"slow: bash .ci/run ";

/// The steps that the slow tests of a file name.
fn steps_of(file: &str) -> Result<Vec<&str>, String> {
    let marked = file.lines().map(str::trim);
    let marked = marked.filter(|line| line.starts_with("#[ignore"));
    marked
        .map(|line| {
            let step = line.strip_prefix(MARK);
            let step = step.and_then(|rest| rest.strip_suffix("\"]"));
            let step = step.filter(|name| STEPS.iter().any(|step| step.name == *name));
            step.ok_or_else(|| format!("no step runs the test after {line}"))
        })
        .collect()
}

/// The test target of a file in a folder of tests: `NAME.rs` or `NAME/….rs`.
fn target(tests: &Path, file: &Path) -> Option<String> {
    let name = file.strip_prefix(tests).ok()?.iter().next()?;
    Some(name.to_str()?.trim_end_matches(".rs").to_owned())
}

/// Runs the slow tests that name the step, in the profile in which `cargo test` has built them:
/// with overflow checks, and hardly slower than the release profile.
pub fn run(shell: &Shell, step: &str) -> Done {
    let mut targets = BTreeMap::<&str, BTreeSet<String>>::new();
    for (package, folder) in [
        ("bowden-bound", "bound"),
        ("bowden-lab", "lab/identify"),
        ("bowden-cli", "lab/cli"),
        ("bowden-rig", "lab/rig"),
        ("bowden-trials", "lab/trials"),
    ] {
        let tests = shell.root.join(folder).join("tests");
        for file in house::files(&tests)? {
            let steps = fs::read_to_string(&file)?;
            let steps = match steps_of(&steps) {
                Ok(steps) => steps.contains(&step),
                Err(reason) => return fail(format!("{}: {reason}", file.display())),
            };
            if steps {
                targets
                    .entry(package)
                    .or_default()
                    .extend(target(&tests, &file));
            }
        }
    }
    if targets.is_empty() {
        return fail("no slow test names this step");
    }
    for (package, targets) in targets {
        let targets: String = targets.iter().map(|t| format!(" --test {t}")).collect();
        shell.run(&format!("cargo test -p {package}{targets} -- --ignored"))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{steps_of, target};
    use std::path::Path;

    #[test]
    fn a_slow_test_names_a_step() {
        let file = "#[test]\n#[ignore = \"slow: bash .ci/run conclusions\"]\nfn a() {}\n";
        assert_eq!(steps_of(file), Ok(vec!["conclusions"]));
        assert_eq!(steps_of("#[test]\nfn a() {}\n"), Ok(vec![]));
        assert!(steps_of("#[ignore]\n").is_err());
        assert!(steps_of(&file.replace("conclusions", "conclusion")).is_err());
    }

    #[test]
    fn the_target_of_a_test_is_its_file_or_its_folder() {
        let of = |file| target(Path::new("a/tests"), Path::new(file));
        assert_eq!(of("a/tests/one.rs").as_deref(), Some("one"));
        assert_eq!(of("a/tests/two/part.rs").as_deref(), Some("two"));
        assert_eq!(of("b/tests/one.rs"), None);
    }
}
