//! The rooms of the lab, floor by floor: a file uses only floors below its own.
// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// From the ground up, in the order in which data walk through them.
const FLOORS: [&str; 15] = [
    "record",
    "problem",
    "model",
    "fit",
    "score",
    "ledger",
    "closing",
    "conclude",
    "foresight",
    "export",
    "check",
    "facts",
    "compare",
    "report",
    "cli",
];

/// Rooms that show what was found and compute nothing.
const VIEWS: [&str; 2] = ["report", "cli"];

/// What a view may use beside its own kind: plain data, and the questions that they answer.
const FACTS: [&[&str]; 2] = [&["facts"], &["compare", "facts"]];

/// Longest file \[lines\].
const LONGEST: usize = 500;

fn sources() -> Vec<(Vec<String>, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut folders = vec![root.clone()];
    let mut all = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                all.push((module(path.strip_prefix(&root).unwrap()), text));
            }
        }
    }
    assert!(all.len() > 100, "{} sources were found", all.len());
    all
}

/// `score/scan/mod.rs` as `score`, `scan`.
fn module(path: &Path) -> Vec<String> {
    let mut parts: Vec<String> = PathBuf::from(path)
        .with_extension("")
        .iter()
        .map(|part| part.to_string_lossy().into_owned())
        .collect();
    if matches!(
        parts.last().map(String::as_str),
        Some("mod" | "lib" | "main")
    ) {
        parts.pop();
    }
    parts
}

/// What stands before the unit tests of a file, without comments.
fn code(text: &str) -> String {
    let code = text.split("#[cfg(test)]").next().unwrap();
    let lines = code
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    lines.collect::<Vec<_>>().join("\n")
}

/// The paths of a `use` tree.
fn leaves(prefix: &str, tree: &str, found: &mut Vec<String>) {
    let tree = tree.trim();
    let Some((head, rest)) = tree.split_once('{') else {
        found.push(format!(
            "{prefix}{}",
            tree.split(" as ").next().unwrap().trim()
        ));
        return;
    };
    let head = format!("{prefix}{}", head.trim());
    let inner = &rest[..rest.rfind('}').unwrap()];
    let (mut depth, mut start) = (0, 0);
    for (at, c) in inner.char_indices().chain([(inner.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                if !inner[start..at].trim().is_empty() {
                    leaves(&head, &inner[start..at], found);
                }
                start = at + 1;
            }
            _ => {}
        }
    }
}

/// All paths of a file's `use` lines, from the root of the crate; those of other crates have
/// no module of ours and drop out later.
fn used(own: &[String], text: &str) -> Vec<Vec<String>> {
    let mut paths = Vec::new();
    for piece in code(text).split(';') {
        let Some(start) = piece.rfind("use ") else {
            continue;
        };
        let before = piece[..start].lines().last().unwrap_or_default().trim();
        if before.is_empty() || before.starts_with("pub") {
            leaves("", &piece[start + 4..], &mut paths);
        }
    }
    let absolute = |path: String| {
        let mut parts = path.split("::").peekable();
        let mut base = own.to_vec();
        match parts.peek() {
            Some(&"crate") => {
                parts.next();
                base.clear();
            }
            Some(&"self") => {
                parts.next();
            }
            _ => {
                while parts.peek() == Some(&"super") {
                    parts.next();
                    base.pop();
                }
            }
        }
        base.extend(parts.map(str::to_owned));
        base
    };
    paths.into_iter().map(absolute).collect()
}

/// Which file uses which.
fn graph() -> BTreeMap<Vec<String>, BTreeSet<Vec<String>>> {
    let sources = sources();
    let modules: BTreeSet<Vec<String>> = sources.iter().map(|(m, _)| m.clone()).collect();
    let resolve = |mut path: Vec<String>| {
        while !modules.contains(&path) {
            path.pop()?;
        }
        (!path.is_empty()).then_some(path)
    };
    let of = |(own, text): &(Vec<String>, String)| {
        let targets = used(own, text).into_iter().filter_map(resolve);
        (own.clone(), targets.filter(|to| to != own).collect())
    };
    sources.iter().map(of).collect()
}

#[test]
fn a_file_uses_only_rooms_below_its_own() {
    let floor = |room: &str| FLOORS.iter().position(|floor| *floor == room);
    let mut crossed = 0;
    for (own, targets) in graph() {
        let Some(room) = own.first() else { continue };
        for to in targets {
            let (from, below) = (floor(room), floor(&to[0]));
            match (from, below) {
                _ if *room == to[0] => {}
                (Some(from), Some(below)) => {
                    crossed += 1;
                    assert!(below < from, "{own:?} uses {to:?}, which is not below it");
                }
                _ => panic!("{own:?} or {to:?} stands on no floor"),
            }
        }
    }
    assert!(crossed > 200, "{crossed} uses of other rooms were found");
}

/// Every path from the root of the crate that stands in the code of a file, in `use` lines and
/// elsewhere; `None` where the code reaches into the crate in another way.
fn reached(own: &[String], text: &str) -> Vec<Vec<String>> {
    let code = code(text);
    let inline = code.split("crate::").skip(1).map(|rest| {
        let path: String = rest
            .chars()
            .take_while(|c| c.is_alphanumeric() || *c == '_' || *c == ':')
            .collect();
        path.split("::").map(str::to_owned).collect()
    });
    // A `use` tree opens after `crate::a::{`: its leaves are read below.
    let whole = |path: &Vec<String>| path.last().is_some_and(|last: &String| !last.is_empty());
    inline.filter(whole).chain(used(own, text)).collect()
}

#[test]
fn a_view_uses_facts_and_computes_nothing() {
    let modules: BTreeSet<String> = sources()
        .iter()
        .filter_map(|(m, _)| m.first().cloned())
        .collect();
    let mut seen = 0;
    for (own, text) in sources() {
        if !own
            .first()
            .is_some_and(|room| VIEWS.contains(&room.as_str()))
        {
            continue;
        }
        for path in reached(&own, &text) {
            // Other crates have no module of ours.
            if !modules.contains(&path[0]) || VIEWS.contains(&path[0].as_str()) {
                continue;
            }
            seen += 1;
            let is_fact = |facts: &&[&str]| {
                path.iter().zip(*facts).filter(|(a, b)| a == b).count() == facts.len()
            };
            assert!(
                FACTS.iter().any(is_fact),
                "{own:?} uses {path:?}: a view shows facts, and computes none"
            );
        }
    }
    assert!(seen > 20, "{seen} uses of facts were found");
}

#[test]
fn files_of_a_room_do_not_use_each_other_in_a_circle() {
    // A folder's `mod.rs` is its door: what goes in and out there is no circle.
    let graph: BTreeMap<_, BTreeSet<_>> = graph()
        .into_iter()
        .map(|(own, targets)| {
            let others = targets.into_iter().filter(|to| !own.starts_with(to));
            (own.clone(), others.collect())
        })
        .collect();
    for start in graph.keys() {
        let mut reached = BTreeSet::new();
        let mut open: Vec<&Vec<String>> = graph[start].iter().collect();
        while let Some(next) = open.pop() {
            assert!(next != start, "{start:?} uses itself over {reached:?}");
            if reached.insert(next) {
                open.extend(&graph[next]);
            }
        }
    }
}

#[test]
fn no_file_is_longer_than_a_reader_holds_in_mind() {
    for (own, text) in sources() {
        let lines = text.lines().count();
        assert!(lines <= LONGEST, "{own:?} has {lines} lines");
    }
}

#[test]
fn the_graph_is_read_from_nested_and_relative_use_lines() {
    let own = ["a".to_owned(), "b".to_owned()];
    let text = "//! use crate::no::line;\nuse super::c::{d, e::{f as g, h}};\npub(crate) use crate::i;\nuse j::k;\n";
    let found: Vec<String> = used(&own, text).iter().map(|p| p.join("::")).collect();
    assert_eq!(
        found,
        ["a::c::d", "a::c::e::f", "a::c::e::h", "i", "a::b::j::k"]
    );
}
