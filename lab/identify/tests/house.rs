//! The packages of the lab and the rooms of this one, floor by floor: a file uses only
//! floors below its own, and the program shows what others compute.
// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// From the ground up, in the order in which data walk through them.
const FLOORS: [&str; 14] = [
    "scale",
    "algebra",
    "alteration",
    "problem",
    "model",
    "fit",
    "score",
    "ledger",
    "search",
    "conclude",
    "foresight",
    "export",
    "check",
    "facts",
];

/// What each package names of ours in its manifest, tests apart.
const DEPENDENCIES: [(&str, &[&str]); 8] = [
    (
        "cli",
        &["bowden-lab", "bowden-page", "bowden-synth", "bowden-trials"],
    ),
    ("fourier", &[]),
    ("identify", &["bowden", "bowden-fourier", "bowden-record"]),
    ("page", &["bowden-lab", "bowden-trials"]),
    ("record", &[]),
    ("rig", &["bowden"]),
    ("synth", &[]),
    (
        "trials",
        &["bowden", "bowden-bound", "bowden-lab", "bowden-rig"],
    ),
];

/// What draws tables and reads arguments; the program alone needs it.
const TERMINAL: [&str; 5] = ["anstream", "anstyle", "clap", "comfy-table", "indicatif"];

/// Longest file \[lines\].
const LONGEST: usize = 500;

/// Named numeric constants of each package, and of each room of this one: thresholds, limits,
/// grids. A constant costs nothing to add and is never missed: these numbers may only fall.
const CONSTANTS: [(&str, usize); 18] = [
    ("cli", 8),
    ("identify/algebra", 1),
    ("identify/check", 6),
    ("identify/conclude", 5),
    ("identify/export", 9),
    ("identify/facts", 1),
    ("identify/fit", 6),
    ("identify/foresight", 6),
    ("identify/model", 8),
    ("identify/problem", 16),
    ("identify/scale", 9),
    ("identify/score", 15),
    ("identify/search", 31),
    ("page", 3),
    ("record", 33),
    ("rig", 3),
    ("synth", 6),
    ("trials", 25),
];

/// The folder of a package of the lab.
fn package(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join(name)
}

/// Each file of a package with the path of its module.
fn sources(name: &str) -> Vec<(Vec<String>, String)> {
    let root = package(name).join("src");
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
    // The Fourier transforms are one file.
    assert!(
        all.len() > 5 || name == "fourier",
        "{} sources of {name:?}",
        all.len()
    );
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

/// The paths in expressions and types that begin at the root of the crate or at a parent.
fn inline(code: &str, found: &mut Vec<String>) {
    for root in ["crate::", "super::"] {
        for (at, _) in code.match_indices(root) {
            let before = &code[..at];
            // `super::super::a` begins once, and `pub(in crate::a)` uses nothing.
            let goes_on = |c: char| c.is_alphanumeric() || matches!(c, ':' | '_' | '$');
            if !before.ends_with(goes_on) && !before.ends_with("(in ") {
                let path = code[at..].split(|c: char| !(c.is_alphanumeric() || ":_".contains(c)));
                let path = path.into_iter().next().unwrap_or_default();
                found.push(path.trim_end_matches(':').to_owned());
            }
        }
    }
}

/// All paths of a file, in its `use` lines and elsewhere, from the root of the crate; those of
/// other crates have no module of ours and drop out later.
fn used(own: &[String], text: &str) -> Vec<Vec<String>> {
    let mut paths = Vec::new();
    for piece in code(text).split(';') {
        let start = piece.rfind("use ").filter(|start| {
            let before = piece[..*start].lines().last().unwrap_or_default().trim();
            // A sentence may go on with `use` behind a semicolon.
            let is_sentence = piece[*start..].contains('"');
            !is_sentence && (before.is_empty() || before.starts_with("pub"))
        });
        if let Some(start) = start {
            leaves("", &piece[start + 4..], &mut paths);
        }
        inline(&piece[..start.unwrap_or(piece.len())], &mut paths);
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

/// Which file of a package uses which.
fn graph(name: &str) -> BTreeMap<Vec<String>, BTreeSet<Vec<String>>> {
    let sources = sources(name);
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
    for (own, targets) in graph("identify") {
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

/// What the code of a file names of a crate, in `use` lines and elsewhere.
fn named(crate_name: &str, own: &[String], text: &str) -> Vec<Vec<String>> {
    let code = code(text);
    let prefix = format!("{crate_name}::");
    let inline = code.split(&prefix).skip(1).map(|rest| {
        let path = rest.chars();
        let path: String = path
            .take_while(|c| c.is_alphanumeric() || *c == '_' || *c == ':')
            .collect();
        path.split("::").map(str::to_owned).collect::<Vec<_>>()
    });
    // After `bowden_lab::{` a tree opens, whose leaves are those of the `use` lines.
    let inline = inline.filter(|path| !path[0].is_empty());
    let trees = used(own, text).into_iter().filter_map(|path| {
        let at = path.iter().position(|part| part == crate_name)?;
        Some(path[at + 1..].to_vec())
    });
    inline.chain(trees).collect()
}

#[test]
fn the_program_and_its_pages_show_facts_and_compute_nothing() {
    let mut seen = 0;
    for (own, text) in sources("cli").into_iter().chain(sources("page")) {
        for crate_name in ["bowden_lab", "bowden_trials"] {
            for path in named(crate_name, &own, &text) {
                seen += 1;
                assert_eq!(
                    path[0],
                    "facts",
                    "cli: {own:?} uses {crate_name}::{}: the program shows facts and computes none",
                    path.join("::")
                );
            }
        }
        for crate_name in ["bowden", "bowden_rig", "nalgebra", "rayon"] {
            let paths = named(crate_name, &own, &text);
            assert!(paths.is_empty(), "cli: {own:?} uses {crate_name}");
        }
    }
    assert!(seen > 20, "{seen} uses of facts were found");
}

#[test]
fn packages_depend_on_each_other_downwards_and_the_program_alone_on_a_terminal() {
    for (name, expected) in DEPENDENCIES {
        let manifest = std::fs::read_to_string(package(name).join("Cargo.toml")).unwrap();
        let manifest: toml::Table = manifest.parse().unwrap();
        let own = manifest["dependencies"].as_table().unwrap();
        let ours = own.keys().filter(|key| key.starts_with("bowden"));
        assert_eq!(ours.collect::<Vec<_>>(), expected, "{name:?}");
        if name != "cli" {
            for crate_name in TERMINAL {
                assert!(!own.contains_key(crate_name), "{name:?} needs {crate_name}");
            }
        }
    }
}

#[test]
fn files_do_not_use_each_other_in_a_circle() {
    for (name, _) in DEPENDENCIES {
        no_circle(name);
    }
}

/// Fails if a file of a package uses itself over others.
fn no_circle(name: &str) {
    // A folder's `mod.rs` is its door: what goes in and out there is no circle.
    let graph: BTreeMap<_, BTreeSet<_>> = graph(name)
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
            assert!(
                next != start,
                "{name} {start:?} uses itself over {reached:?}"
            );
            if reached.insert(next) {
                open.extend(&graph[next]);
            }
        }
    }
}

#[test]
fn no_file_is_longer_than_a_reader_holds_in_mind() {
    for (name, _) in DEPENDENCIES {
        for (own, text) in sources(name) {
            let lines = text.lines().count();
            assert!(lines <= LONGEST, "{name} {own:?} has {lines} lines");
        }
    }
}

/// Number of constants in a file whose type and value are numeric, tests apart.
fn constants(text: &str) -> usize {
    let text = text.split("#[cfg(test)]").next().unwrap();
    let declared = text.split(';').filter_map(|part| {
        let (_, rest) = part.rsplit_once("const ")?;
        let (name, rest) = rest.split_once(": ")?;
        let (kind, value) = rest.split_once('=')?;
        let is_name = name
            .bytes()
            .all(|b| b.is_ascii_uppercase() || b.is_ascii_digit() || b == b'_');
        let mut words = kind.split(|c: char| !c.is_alphanumeric());
        let is_number = words.any(|word| {
            matches!(
                word,
                "f64" | "f32" | "usize" | "u64" | "u32" | "i64" | "i32" | "u8" | "Duration"
            )
        });
        // `const N: usize>(` is a parameter, whatever stands behind it.
        let is_text = kind.contains("str") || kind.starts_with("usize>");
        Some(is_name && is_number && !is_text && value.contains(|c: char| c.is_ascii_digit()))
    });
    declared.filter(|&is| is).count()
}

#[test]
fn numeric_constants_only_become_fewer() {
    let mut counted: BTreeMap<String, usize> = BTreeMap::new();
    for name in DEPENDENCIES.map(|(name, _)| name) {
        for (path, text) in sources(name) {
            let room = match (name, path.first()) {
                ("identify", Some(room)) => format!("{name}/{room}"),
                _ => name.to_owned(),
            };
            *counted.entry(room).or_default() += constants(&text);
        }
    }
    counted.retain(|_, count| *count > 0);
    let kept: BTreeMap<String, usize> = CONSTANTS
        .iter()
        .map(|(room, n)| ((*room).to_owned(), *n))
        .collect();
    let total: usize = counted.values().sum();
    assert_eq!(counted, kept, "{total} in all: lower the number of a room that has fewer, and take one out of a room that has more");
}

#[test]
fn the_graph_is_read_from_use_lines_and_from_paths_in_expressions() {
    let own = ["a".to_owned(), "b".to_owned()];
    let text = "//! use crate::no::line;\nuse super::c::{d, e::{f as g, h}};\npub(crate) use crate::i;\nuse j::k;\n\
                pub(in crate::no) fn l(m: &crate::n::O) { super::super::p::q(m); }\n";
    let found: Vec<String> = used(&own, text).iter().map(|p| p.join("::")).collect();
    assert_eq!(
        found,
        [
            "a::c::d",
            "a::c::e::f",
            "a::c::e::h",
            "i",
            "a::b::j::k",
            "n::O",
            "p::q"
        ]
    );
}
