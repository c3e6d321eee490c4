//! Do the tests notice a change of one expression?

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// One block of `mutants.txt`.
#[derive(Debug, PartialEq)]
struct Mutant {
    file: String,
    from: String,
    to: String,
    /// The arguments of `cargo test` that must fail.
    test: String,
}

impl Mutant {
    /// What the file is with the change; none if the text does not occur once.
    fn applied(&self, text: &str) -> Option<String> {
        (text.matches(&self.from).count() == 1).then(|| text.replace(&self.from, &self.to))
    }
}

/// The blocks of a list, which blank lines separate.
fn read(list: &str) -> Vec<Mutant> {
    let blocks = list.split("\n\n").filter_map(|block| {
        let part = |key: &str| {
            let mut lines = block.lines().filter_map(|line| line.strip_prefix(key));
            lines.next().map(|rest| rest.trim().to_owned())
        };
        Some(Mutant {
            file: part("file:")?,
            from: part("from:")?,
            to: part("to:")?,
            test: part("test:")?,
        })
    });
    blocks.collect()
}

/// Applies each mutant that contains one of the words, or every one, to a copy of the repository
/// and runs its test there. Prints the survivors; their number.
pub fn run(root: &Path, words: &[String]) -> io::Result<usize> {
    let root = root.canonicalize()?;
    let list = read(&fs::read_to_string(root.join("xtask/mutants.txt"))?);
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let target = root.join(target.unwrap_or_else(|| "target".into()));
    // A copy, so that the repository stays as it is whatever happens.
    let copy = target.join("mutants");
    let _ = fs::remove_dir_all(&copy);
    copy_sources(&root, &copy)?;
    let mut survived = 0;
    for mutant in &list {
        let Mutant {
            file,
            from,
            to,
            test,
        } = mutant;
        let whole = format!("{file}\n{from}\n{to}\n{test}");
        if !words.is_empty() && !words.iter().any(|word| whole.contains(word)) {
            continue;
        }
        let text = fs::read_to_string(copy.join(file))?;
        let Some(changed) = mutant.applied(&text) else {
            println!("STALE    {file}: not once: {from}");
            survived += 1;
            continue;
        };
        fs::write(copy.join(file), changed)?;
        let output = Command::new("cargo")
            .args(["test", "--quiet", "--no-fail-fast"])
            .args(test.split_whitespace())
            .current_dir(&copy)
            .env("CARGO_TARGET_DIR", &target)
            // The tests are few, so that most of the time is the compiler's.
            .env("CARGO_PROFILE_DEV_OPT_LEVEL", "1")
            .stdin(Stdio::null())
            .output()?;
        fs::write(copy.join(file), text)?;
        let printed = String::from_utf8_lossy(&output.stdout);
        if output.status.success() {
            println!("SURVIVED {file}: {from} => {to} ({test})");
            survived += 1;
        } else if printed.contains("test result: FAILED") {
            println!("red      {file}: {from} => {to}");
        } else {
            let error = String::from_utf8_lossy(&output.stderr);
            println!("BROKEN   {file}: {from} => {to}\n{error}");
            survived += 1;
        }
    }
    Ok(survived)
}

/// Copies the files of a folder, except hidden ones and the build output of cargo.
fn copy_sources(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_owned();
        if name == "target" || name == ".git" {
            continue;
        }
        if path.is_dir() {
            copy_sources(&path, &to.join(name))?;
        } else {
            fs::copy(&path, to.join(name))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{read, Mutant};

    #[test]
    fn a_mutant_applies_where_its_text_occurs_once() {
        let list = "# A note.\n\nfile: a.rs\nfrom: a + b\nto: a\ntest: -p a\n\nfile: c.rs\n";
        let mutants = read(list);
        let mutant = Mutant {
            file: "a.rs".to_owned(),
            from: "a + b".to_owned(),
            to: "a".to_owned(),
            test: "-p a".to_owned(),
        };
        assert_eq!(mutants, [mutant]);
        let applied = |text| mutants[0].applied(text);
        assert_eq!(applied("x = a + b;").as_deref(), Some("x = a;"));
        assert_eq!(applied("x = a + b; y = a + b;"), None);
        assert_eq!(applied("x = a;"), None);
    }

    #[test]
    fn each_mutant_of_the_list_changes_one_expression_of_its_file() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let list = std::fs::read_to_string(root.join("xtask/mutants.txt")).unwrap();
        assert_eq!(list.matches("\nfile:").count(), read(&list).len());
        for mutant in read(&list) {
            let text = std::fs::read_to_string(root.join(&mutant.file)).unwrap();
            assert!(mutant.applied(&text).is_some(), "{mutant:?}");
        }
    }
}
