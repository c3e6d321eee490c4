//! Steps that read the files of the repository.

use super::links;
use super::shell::{fail, skip, text, Done, Shell};
use std::fs;

const LONGEST_FILE: usize = 500;

fn needs_git(shell: &Shell) -> Done {
    if shell.succeeds("git rev-parse --is-inside-work-tree") {
        return Ok(());
    }
    skip("git is not installed, or this is not a git repository")
}

pub fn tracked_files(shell: &Shell) -> Done {
    needs_git(shell)?;
    let mut wrong = Vec::new();
    for file in shell.output("git ls-files")?.lines() {
        if file.split('/').any(|folder| folder == "target") {
            wrong.push(format!("{file} is a build product"));
        }
        if file.ends_with(".rs") {
            // A file that is deleted but still tracked has no lines.
            let text = fs::read_to_string(shell.root.join(file)).unwrap_or_default();
            let lines = text.lines().count();
            if lines > LONGEST_FILE {
                wrong.push(format!(
                    "{file} has {lines} lines, more than {LONGEST_FILE}"
                ));
            }
        }
    }
    let own = "(^|[^A-Za-z0-9_.)}~-])/(work|tmp|home|root|Users|var/tmp)(/|[^A-Za-z0-9_]|$)";
    let found = shell.ask(&format!("git grep -nIE {own}"))?;
    for line in text(&found.stdout).lines() {
        wrong.push(format!("a machine-specific path: {line}"));
    }
    none(&wrong)
}

pub fn lock_file(shell: &Shell) -> Done {
    if needs_git(shell).is_ok() {
        shell.run("git ls-files --error-unmatch Cargo.lock")?;
    }
    if shell
        .output("cargo metadata --locked --format-version 1")
        .is_err()
    {
        return fail("Cargo.lock is not up to date: run cargo check and commit it");
    }
    Ok(())
}

/// Every link from a page to a file of the repository must lead to an existing file.
pub fn page_links(shell: &Shell) -> Done {
    needs_git(shell)?;
    let mut wrong = Vec::new();
    let pages = shell.output("git ls-files --cached --others --exclude-standard *.md")?;
    for page in pages.lines().map(|page| shell.root.join(page)) {
        // A page that is deleted but still tracked has no links.
        let text = fs::read_to_string(&page).unwrap_or_default();
        for link in links::of(&text) {
            if !page.with_file_name(link).exists() {
                wrong.push(format!("{}: {link} does not exist", page.display()));
            }
        }
    }
    none(&wrong)
}

fn none(wrong: &[String]) -> Done {
    if wrong.is_empty() {
        return Ok(());
    }
    fail(wrong.join("\n    "))
}

/// docs/public-api lists what a user can name. A change to this list is a change to the interface:
/// it must be deliberate and visible in the diff. RUSTC_BOOTSTRAP lets stable Rust write JSON.
pub fn public_api(shell: &Shell) -> Done {
    if !shell.succeeds("python3 --version") {
        return skip("python3 is not installed");
    }
    let mut changed = false;
    for package in ["bowden", "bowden-bound", "bowden-rig"] {
        shell.env("RUSTC_BOOTSTRAP", "1").run(&format!(
            "cargo rustdoc -p {package} --lib --all-features --target-dir target/public-api --quiet \
             -- -Z unstable-options --output-format json"
        ))?;
        let json = format!("target/public-api/doc/{}.json", package.replace('-', "_"));
        let listed = shell.ask(&format!("python3 .ci/public_api.py {json}"))?;
        match listed.status.code() {
            Some(0) => {}
            Some(77) => return skip(text(&listed.stderr).trim()),
            _ => return fail(text(&listed.stderr)),
        }
        let found = format!("target/public-api/{package}.txt");
        fs::write(shell.root.join(&found), &listed.stdout)?;
        if fs::read(shell.root.join(format!("docs/public-api/{package}.txt")))? != listed.stdout {
            changed = true;
            // Fails, because the files differ.
            let _ = shell.run(&format!("diff -u docs/public-api/{package}.txt {found}"));
            println!("    if this is meant: cp {found} docs/public-api/");
        }
    }
    if changed {
        return fail("the public interface has changed");
    }
    Ok(())
}
