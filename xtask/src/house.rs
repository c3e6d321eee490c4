//! Size metrics of the repository, each with its goal.

use crate::source;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// One metric.
#[derive(Debug, PartialEq)]
pub struct Count {
    what: String,
    number: usize,
    goal: Option<usize>,
}

impl Count {
    fn new(what: impl Into<String>, number: usize, goal: Option<usize>) -> Self {
        let what = what.into();
        Self { what, number, goal }
    }
}

/// Counts over the files of a folder.
#[derive(Debug, Default, Clone, Copy)]
struct Code {
    lines: usize,
    constants: usize,
}

/// Every metric of the repository in this folder.
pub fn counts(root: &Path) -> io::Result<Vec<Count>> {
    let core = code(&root.join("src"))?;
    let bound = code(&root.join("bound/src"))?;
    let mut counts = vec![
        Count::new("code of the core, src/", core.lines, Some(8_500)),
        Count::new(
            "interface, docs/public-api/bowden.txt",
            lines(&root.join("docs/public-api/bowden.txt"))?,
            Some(750),
        ),
        Count::new(
            "code of the certificates, bound/src/",
            bound.lines,
            Some(2_600),
        ),
    ];
    let mut constants = 0;
    for (room, found) in rooms(root)? {
        constants += found.constants;
        let what = format!("code of {room}, {} constants", found.constants);
        counts.push(Count::new(what, found.lines, None));
    }
    counts.push(Count::new(
        "numeric constants of lab/",
        constants,
        Some(200),
    ));
    let (tests, text) = tests(root)?;
    counts.push(Count::new("code of tests", tests, None));
    counts.push(Count::new("lines of tests", text, Some(18_000)));
    let (longest, file) = longest(root)?;
    let what = format!("longest file, {}", relative(root, &file));
    counts.push(Count::new(what, longest, Some(500)));
    counts.push(Count::new(
        "lines of .ci/run",
        lines(&root.join(".ci/run"))?,
        Some(150),
    ));
    Ok(counts)
}

/// A table of three columns.
pub fn table(counts: &[Count]) -> String {
    let mut text =
        String::from("count                                                      now     goal\n");
    for Count { what, number, goal } in counts {
        let goal = goal.map_or_else(|| "–".to_owned(), |goal| format!("≤ {goal}"));
        let _ = writeln!(text, "{what:<52} {number:>9} {goal:>8}");
    }
    text
}

/// The code folders of the lab: each crate, and each module of `lab/identify`.
fn rooms(root: &Path) -> io::Result<BTreeMap<String, Code>> {
    let mut rooms = BTreeMap::new();
    for krate in folders(&root.join("lab"))? {
        let src = krate.join("src");
        if !src.is_dir() {
            continue;
        }
        rooms.insert(relative(root, &krate), code(&src)?);
        if krate.ends_with("identify") {
            // The modules are subtracted from their crate, so that nothing is counted twice.
            let mut rest = code(&src)?;
            for module in folders(&src)? {
                let found = code(&module)?;
                rest.lines -= found.lines;
                rest.constants -= found.constants;
                rooms.insert(relative(root, &module), found);
            }
            rooms.insert(relative(root, &krate), rest);
        }
    }
    Ok(rooms)
}

/// Code lines and numeric constants of the files in a folder, without unit tests.
fn code(folder: &Path) -> io::Result<Code> {
    let mut of_file = BTreeMap::new();
    let mut test_files = Vec::new();
    for file in files(folder)? {
        let source = source::read(&fs::read_to_string(&file)?);
        // `mod x;` in `mod.rs` or `lib.rs` is `x.rs` next to it, in `y.rs` it is `y/x.rs`.
        let stem = file.file_stem().and_then(|stem| stem.to_str());
        let inside = match (file.parent(), stem) {
            (Some(parent), Some("mod" | "lib" | "main")) => parent.to_owned(),
            _ => file.with_extension(""),
        };
        test_files.extend(
            source
                .test_modules
                .iter()
                .map(|name| inside.join(format!("{name}.rs"))),
        );
        of_file.insert(file, source);
    }
    let mut found = Code::default();
    for (_, source) in of_file
        .iter()
        .filter(|(file, _)| !test_files.contains(file))
    {
        found.lines += source.code.len();
        found.constants += numeric_constants(&source.code.join("\n"));
    }
    Ok(found)
}

/// Number of constants with a numeric type and value, counted as in `lab/identify/tests/house.rs`.
fn numeric_constants(code: &str) -> usize {
    const NUMBERS: [&str; 9] = [
        "f64", "f32", "usize", "u64", "u32", "i64", "i32", "u8", "Duration",
    ];
    let declared = code.split(';').filter_map(|part| {
        let (_, rest) = part.rsplit_once("const ")?;
        let (name, rest) = rest.split_once(": ")?;
        let (kind, value) = rest.split_once('=')?;
        let is_name =
            !name.contains(|c: char| c.is_ascii_lowercase() || !(c.is_alphanumeric() || c == '_'));
        let mut words = kind.split(|c: char| !c.is_alphanumeric());
        // `const N: usize>(` is a parameter, whatever stands behind it.
        let is_other = kind.contains("str") || kind.starts_with("usize>");
        let is_number = words.any(|word| NUMBERS.contains(&word)) && !is_other;
        Some(is_name && is_number && value.contains(|c: char| c.is_ascii_digit()))
    });
    declared.filter(|is| *is).count()
}

/// Code lines and all lines of the integration tests.
fn tests(root: &Path) -> io::Result<(usize, usize)> {
    let mut folders_of_tests = vec![root.join("tests"), root.join("bound/tests")];
    for krate in folders(&root.join("lab"))? {
        folders_of_tests.push(krate.join("tests"));
    }
    let (mut of_code, mut of_text) = (0, 0);
    for folder in folders_of_tests.iter().filter(|folder| folder.is_dir()) {
        for file in files(folder)? {
            of_code += source::read(&fs::read_to_string(&file)?).code.len();
            of_text += lines(&file)?;
        }
    }
    Ok((of_code, of_text))
}

/// The Rust file with the most lines.
fn longest(root: &Path) -> io::Result<(usize, PathBuf)> {
    let mut longest = (0, PathBuf::new());
    for file in files(root)? {
        longest = longest.max((lines(&file)?, file));
    }
    Ok(longest)
}

fn lines(file: &Path) -> io::Result<usize> {
    Ok(fs::read_to_string(file)?.lines().count())
}

/// The subfolders of a folder, sorted by name.
fn folders(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Every Rust file below a folder, except in hidden folders and the build output of cargo.
pub fn files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let (mut found, mut left) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = left.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            let name = path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            if path.is_dir() && name != "target" && !name.starts_with('.') {
                left.push(path);
            } else if name.ends_with(".rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

fn relative(root: &Path, path: &Path) -> String {
    path.strip_prefix(root)
        .unwrap_or(path)
        .display()
        .to_string()
}

#[cfg(test)]
mod tests {
    use super::numeric_constants;

    #[test]
    fn a_numeric_constant_is_one_of_a_number() {
        let code = "const A: f64 = 1.0;\npub(super) const B: (usize, u8) =\n(1, 2);\nconst C: &str = x;\n\
                    let b: f64 = 1.0;\nconst fn f(x: f64) { 1 };\nconst D: Kind = Kind::A;\nconst E: f64 = A;";
        assert_eq!(numeric_constants(code), 2);
    }
}
