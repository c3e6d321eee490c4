//! Completions and manual pages are made of the commands that the program has.

use crate::shell::{bowden, refused, said, text, Folder};
use std::process::{Command, Stdio};

/// What `bowden --help` lists under Commands.
fn subcommands() -> Vec<String> {
    let help = said(&["--help"]);
    let (_, list) = help.split_once("Commands:\n").unwrap();
    let (list, _) = list.split_once("\n\n").unwrap();
    let names = list
        .lines()
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names: Vec<String> = names
        .map(|line| line.split_whitespace().next().unwrap().to_owned())
        .collect();
    assert!(
        names.len() >= 12 && names.contains(&"identify".to_owned()),
        "{names:?}"
    );
    names
}

/// The long options that the help of a subcommand lists.
fn options(subcommand: &str) -> Vec<String> {
    let help = said(&["help", subcommand]);
    let mut long: Vec<String> = help
        .lines()
        .filter(|line| line.trim_start().starts_with('-'))
        .flat_map(|line| line.split_whitespace().take(2))
        .filter(|word| word.starts_with("--"))
        .map(|word| word.trim_end_matches(',').to_owned())
        .collect();
    long.dedup();
    long
}

#[test]
fn completions_of_each_shell_name_every_subcommand() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = said(&["completions", shell]);
        for name in subcommands() {
            assert!(script.contains(&name), "{shell} does not know {name}");
        }
        for option in options("identify") {
            // fish has the names without their dashes.
            let name = option.trim_start_matches('-');
            assert!(
                script.contains(name),
                "{shell} does not know close {option}"
            );
        }
    }
}

#[test]
fn bash_completes_a_subcommand() {
    let script = said(&["completions", "bash"]);
    let asked = format!(
        "{script}\nCOMP_WORDS=(bowden gen) COMP_CWORD=1\n_bowden bowden gen bowden\n\
         echo \"${{COMPREPLY[@]}}\""
    );
    let shell = Command::new("bash")
        .args(["--norc", "-c", &asked])
        .stderr(Stdio::piped())
        .output();
    let Ok(output) = shell else {
        println!("skipped: there is no bash");
        return;
    };
    assert_eq!(text(&output.stdout).trim(), "generate", "{output:?}");
}

#[test]
fn the_manual_has_a_page_of_each_subcommand_with_all_its_options() {
    let folder = Folder::new();
    let path = folder.root().to_str().unwrap();
    assert_eq!(said(&["man", "--out", path]), "");
    let read = |name: &str| std::fs::read_to_string(folder.root().join(name)).unwrap();
    let program = read("bowden.1");
    assert_eq!(program, said(&["man"]));
    assert!(program.contains(".TH bowden 1"), "{program}");
    for name in subcommands() {
        assert!(program.contains(&format!("bowden\\-{name}(1)")), "{name}");
        let page = read(&format!("bowden-{name}.1"));
        assert_eq!(page, said(&["man", &name]));
        assert!(page.contains(&format!("\\fBbowden {name}\\fR")), "{page}");
        for option in options(&name) {
            let shown = option.replace('-', "\\-");
            assert!(page.contains(&shown), "{name} {option}: {page}");
        }
    }
}

#[test]
fn what_is_no_shell_no_subcommand_or_no_folder_is_refused() {
    let shell = bowden(&["completions", "cmd"]);
    assert_eq!(shell.status.code(), Some(2));
    assert!(text(&shell.stderr).contains("'cmd'"), "{shell:?}");
    assert!(refused(&["man", "clsoe"]).contains("clsoe"));
    let folder = Folder::new();
    let missing = folder.root().join("missing");
    let line = refused(&["man", "--out", missing.to_str().unwrap()]);
    assert!(line.contains("no such folder"), "{line}");
}
