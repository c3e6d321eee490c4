//! Completions and manual pages are made of the commands that the program has.

use crate::shell::{has, said, text, Folder};
use std::process::Command;

/// What `bowden --help` lists under Commands.
fn subcommands() -> Vec<String> {
    let help = said("--help");
    let (_, list) = help.split_once("Commands:\n").unwrap();
    let (list, _) = list.split_once("\n\n").unwrap();
    let names = list
        .lines()
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names = names.filter_map(|line| line.split_whitespace().next());
    let names: Vec<String> = names.map(str::to_owned).collect();
    assert!(names.len() >= 12, "{names:?}");
    names
}

/// The long options that the help of a subcommand lists.
fn options(subcommand: &str) -> Vec<String> {
    let help = said(&format!("help {subcommand}"));
    let lines = help
        .lines()
        .filter(|line| line.trim_start().starts_with('-'));
    let words = lines.flat_map(|line| line.split_whitespace().take(2));
    let long = words.filter(|word| word.starts_with("--"));
    let mut long: Vec<String> = long
        .map(|word| word.trim_end_matches(',').to_owned())
        .collect();
    long.dedup();
    long
}

#[test]
fn completions_of_each_shell_name_every_subcommand() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = said(&format!("completions {shell}"));
        for name in subcommands().iter().chain(&options("identify")) {
            // fish has the names of options without their dashes.
            let name = name.trim_start_matches('-');
            assert!(script.contains(name), "{shell} does not know {name}");
        }
    }
    let script = said("completions bash");
    let complete = "COMP_WORDS=(bowden gen) COMP_CWORD=1\n_bowden bowden gen bowden";
    let asked = format!("{script}\n{complete}\necho \"${{COMPREPLY[@]}}\"");
    let Ok(output) = Command::new("bash").args(["--norc", "-c", &asked]).output() else {
        println!("skipped: there is no bash");
        return;
    };
    assert_eq!(text(&output.stdout).trim(), "generate", "{output:?}");
}

#[test]
fn the_manual_has_a_page_of_each_subcommand_with_all_its_options() {
    let folder = Folder::new();
    assert_eq!(said(&format!("man --out {}", folder.path(""))), "");
    let program = folder.read("bowden.1");
    assert_eq!(program, said("man"));
    has(&program, &[".TH bowden 1"]);
    for name in subcommands() {
        has(&program, &[&format!("bowden\\-{name}(1)")]);
        let page = folder.read(&format!("bowden-{name}.1"));
        assert_eq!(page, said(&format!("man {name}")));
        has(&page, &[&format!("\\fBbowden {name}\\fR")]);
        for option in options(&name) {
            has(&page, &[&option.replace('-', "\\-")]);
        }
    }
}
