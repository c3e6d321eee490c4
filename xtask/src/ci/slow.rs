//! The slow tests: `cargo test` ignores them, and each names the step that runs it.

use super::shell::{fail, Done, Shell};
use super::STEPS;
use crate::house;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The line before a slow test, up to the name of its step.
const MARK: &str = "#[ignore = \"slow: bash .ci/run ";

/// The slow tests of a file, each with the step that it names.
fn tests(file: &str) -> Result<Vec<(&str, &str)>, String> {
    let mut lines = file.lines().map(str::trim);
    let mut found = Vec::new();
    while let Some(line) = lines.find(|line| line.starts_with("#[ignore")) {
        let step = line.strip_prefix(MARK);
        let step = step.and_then(|rest| rest.strip_suffix("\"]"));
        let step = step.filter(|name| STEPS.iter().any(|step| step.name == *name));
        let test = lines.find_map(|line| line.strip_prefix("fn ")?.split('(').next());
        match (step, test) {
            (Some(step), Some(test)) => found.push((step, test)),
            _ => return Err(format!("no step runs the test after {line}")),
        }
    }
    Ok(found)
}

/// The test target of a file in a folder of tests: `NAME.rs` or `NAME/….rs`.
fn target(tests: &Path, file: &Path) -> Option<String> {
    let name = file.strip_prefix(tests).ok()?.iter().next()?;
    Some(name.to_str()?.trim_end_matches(".rs").to_owned())
}

/// Runs the slow tests that name the step, as `cargo test` has built them: with the same profile and
/// features, so that nothing is built again.
pub fn run(shell: &Shell, step: &str) -> Done {
    let (mut targets, mut names) = (BTreeSet::new(), String::new());
    for folder in ["bound", "lab/identify", "lab/cli", "lab/rig", "lab/trials"] {
        let folder = shell.root.join(folder).join("tests");
        for file in house::files(&folder)? {
            let text = fs::read_to_string(&file)?;
            let tests = match tests(&text) {
                Ok(tests) => tests,
                Err(reason) => return fail(format!("{}: {reason}", file.display())),
            };
            for (_, test) in tests.iter().filter(|(own, _)| *own == step) {
                targets.extend(target(&folder, &file));
                names += " ";
                names += test;
            }
        }
    }
    if targets.is_empty() {
        return fail("no slow test names this step");
    }
    let targets: String = targets.iter().map(|t| format!(" --test {t}")).collect();
    shell.run(&format!("cargo test{targets} -- --ignored{names}"))
}

#[cfg(test)]
mod tests {
    use super::{target, tests};
    use std::path::Path;

    #[test]
    fn a_slow_test_names_a_step() {
        let file = "#[test]\n#[ignore = \"slow: bash .ci/run conclusions\"]\nfn a() {}\n";
        assert_eq!(tests(file), Ok(vec![("conclusions", "a")]));
        assert_eq!(tests("#[test]\nfn a() {}\n"), Ok(vec![]));
        assert!(tests("#[ignore]\nfn a() {}\n").is_err());
        assert!(tests(&file.replace("conclusions", "conclusion")).is_err());
    }

    #[test]
    fn the_target_of_a_test_is_its_file_or_its_folder() {
        let of = |file| target(Path::new("a/tests"), Path::new(file));
        assert_eq!(of("a/tests/one.rs").as_deref(), Some("one"));
        assert_eq!(of("a/tests/two/part.rs").as_deref(), Some("two"));
        assert_eq!(of("b/tests/one.rs"), None);
    }
}
