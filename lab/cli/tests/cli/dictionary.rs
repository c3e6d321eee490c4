//! Words that the documents, the program and the public documentation of the core do not use.

use crate::shell::{args, said};
use std::fs;
use std::path::Path;

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

/// The files below a folder of the repository with this end, or the file itself.
fn files(path: &Path, end: &str, found: &mut Vec<(String, String)>) {
    if path.is_dir() {
        for entry in fs::read_dir(path).unwrap().map(Result::unwrap) {
            files(&entry.path(), end, found);
        }
    } else if path.extension().is_some_and(|own| own == end) {
        let text = fs::read_to_string(path).unwrap();
        found.push((path.display().to_string(), text));
    }
}

/// The texts of some folders and files; numbers of lines stay those of the file.
fn texts_of(paths: &[&str], end: &str, of_line: fn(&str) -> String) -> Vec<(String, String)> {
    let (root, mut found) = (
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."),
        Vec::new(),
    );
    paths
        .iter()
        .for_each(|path| files(&root.join(path), end, &mut found));
    let lines = |text: &str| text.lines().map(of_line).collect::<Vec<_>>().join("\n");
    found
        .into_iter()
        .map(|(name, text)| (name, lines(&text)))
        .collect()
}

/// A line of the public documentation.
fn documentation(line: &str) -> String {
    let own = line.trim_start();
    let is_public = own.starts_with("///") || own.starts_with("//!");
    if is_public {
        line.to_owned()
    } else {
        String::new()
    }
}

/// Sentences of the program: the literals that hold a blank.
fn sentences(line: &str) -> String {
    if line.trim_start().starts_with("//") {
        return String::new();
    }
    let literals = line.split('"').skip(1).step_by(2);
    literals
        .filter(|own| own.contains(' '))
        .collect::<Vec<_>>()
        .join(" | ")
}

/// Pages, the public documentation of the core, and the texts of the program, each with its name.
fn texts() -> Vec<(String, String)> {
    let pages = "README.md capi/README.md python/README.md firmware/README.md docs src";
    let program = "lab/cli/src lab/identify/src lab/page/src lab/trials/src";
    let mut all = texts_of(&args(pages), "md", str::to_owned);
    all.extend(texts_of(&["src"], "rs", documentation));
    all.extend(texts_of(&args(program), "rs", sentences));
    let topics = "terms identify validate design compare certify power plan export generate";
    for topic in args(topics) {
        let help = said(&format!("help {topic}"));
        all.push((format!("bowden help {topic}"), help));
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
                if has(line, word) {
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
