//! Words that the documents, the program and the public documentation of the core do not use.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What is not written, and what is written instead.
const WORDS: &[(&str, &str)] = &[
    ("beside", "next to, together with, besides"),
    ("turned round", "inverted, reversed"),
    ("with its sign turned", "with the opposite sign"),
    ("stands at", "is"),
    ("stands under", "is under"),
    ("stands for", "means"),
    ("as it stands", "as it is"),
    ("in place of", "instead of"),
    ("in the place of", "instead of"),
    ("where not given", "default: …"),
    ("where it is not given", "default: …"),
    ("errs by", "has an error of"),
    ("in no catalogue", "matches no effect in the catalogue"),
    ("hands on", "transmits"),
    ("hands over", "exports"),
    ("handed over", "exported"),
    ("what is left", "the residual"),
    ("the chip", "the microcontroller"),
    ("lives on", "depends on"),
    ("goes on", "continues"),
    ("keeps to", "satisfies"),
    ("was expected", "is needed, is allowed"),
    ("were expected", "are needed, are allowed"),
    ("since a reversal", "since the last reversal"),
    ("declared model", "baseline model"),
    ("bowden close", "bowden identify"),
    ("bowden check", "bowden validate"),
    ("--declare", "--baseline"),
    ("--rounds", "--max-terms"),
    ("--budget", "--time-limit"),
    ("--skip", "--start"),
    ("--until", "--end"),
    ("unneeded", "redundant"),
    ("recurs", "selection frequency"),
    ("ledger", "results table"),
    ("explained-coloured", "structured-residual"),
    ("does-not-carry-over", "not-transferable"),
    ("no-model", "no-input-dependence"),
    ("data-defect", "defective-record"),
    ("pretension step", "preload step"),
    ("data sheet", "parameters"),
    ("hold_for_ever", "hold_indefinitely"),
    ("bad_score", "fault_counter"),
    ("power_up", "restore"),
    ("take_over", "bumpless_transfer"),
];

/// Where a word is right: the end of a path, the word, the reason.
const EXCEPTIONS: &[(&str, &str, &str)] = &[];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The files below a folder with one of these ends.
fn files(folder: &Path, end: &str, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let path = entry.path();
        if path.is_dir() {
            files(&path, end, found);
        } else if path.extension().is_some_and(|own| own == end) {
            found.push(path);
        }
    }
}

/// Pages, the public documentation of the core, and the texts of the program, each with its name.
fn texts() -> Vec<(String, String)> {
    let root = root();
    let mut pages: Vec<PathBuf> = ["README.md", "capi/README.md", "python/README.md"]
        .map(|page| root.join(page))
        .into();
    pages.push(root.join("firmware/README.md"));
    files(&root.join("docs"), "md", &mut pages);
    files(&root.join("src"), "md", &mut pages);
    let page = |path: &PathBuf| {
        (
            path.display().to_string(),
            fs::read_to_string(path).unwrap(),
        )
    };
    let mut all: Vec<(String, String)> = pages.iter().map(page).collect();
    let mut sources = Vec::new();
    files(&root.join("src"), "rs", &mut sources);
    for (name, text) in sources.iter().map(page) {
        let docs = |line: &&str| {
            let line = line.trim_start();
            line.starts_with("///") || line.starts_with("//!")
        };
        // Numbers of lines stay those of the file.
        let lines = text.lines().map(|line| if docs(&line) { line } else { "" });
        all.push((name, lines.collect::<Vec<_>>().join("\n")));
    }
    let mut program = Vec::new();
    for package in ["cli", "identify", "page", "trials"] {
        files(
            &root.join("lab").join(package).join("src"),
            "rs",
            &mut program,
        );
    }
    for (name, text) in program.iter().map(page) {
        // Sentences of the program: the literals that hold a blank.
        let sentences = |line: &str| match line.trim_start().starts_with("//") {
            true => String::new(),
            false => {
                let literals = line.split('"').skip(1).step_by(2);
                literals
                    .filter(|own| own.contains(' '))
                    .collect::<Vec<_>>()
                    .join(" | ")
            }
        };
        let lines: Vec<String> = text.lines().map(sentences).collect();
        all.push((name, lines.join("\n")));
    }
    for topic in [
        "terms", "identify", "validate", "design", "compare", "certify", "power", "plan", "export",
        "generate",
    ] {
        let mut help = Command::new(env!("CARGO_BIN_EXE_bowden"));
        let help = help.args(["help", topic]).output().unwrap();
        assert!(help.status.success(), "{topic}");
        all.push((
            format!("bowden help {topic}"),
            String::from_utf8(help.stdout).unwrap(),
        ));
    }
    all
}

/// Whether `word` is in `line` as a word of its own.
fn has(line: &str, word: &str) -> bool {
    let inside = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    line.match_indices(word).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        let after = line[at + word.len()..].chars().next();
        !before.is_some_and(inside) && !after.is_some_and(inside)
    })
}

#[test]
fn the_documents_and_the_program_use_the_words_of_the_field() {
    let mut found = Vec::new();
    for (name, text) in texts() {
        for (number, line) in text.lines().enumerate() {
            for (word, instead) in WORDS {
                let excepted = EXCEPTIONS
                    .iter()
                    .any(|(end, own, _)| name.ends_with(end) && own == word);
                if !excepted && has(line, word) {
                    found.push(format!("{name}:{}: `{word}`; write: {instead}", number + 1));
                }
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn a_word_is_found_as_a_whole_word_alone() {
    assert!(has("the state stands at zero", "stands at"));
    assert!(!has("besides the rest", "beside"));
    assert!(has("`--skip 8`", "--skip"));
    assert!(!has("--skipped", "--skip"));
}
