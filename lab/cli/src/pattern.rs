//! The files of a pattern such as `runs/*.csv`.
//!
//! The crate `glob` matches names. Its directory walk is not used, because it panics at a name that
//! is not UTF-8. Such a name is matched with a replacement character for each unreadable part.

use super::Failure;
use bowden_lab::facts::is_header_of_vector;
use glob::{MatchOptions, Pattern};
use std::ffi::OsString;
use std::fs;
use std::io::{BufRead as _, BufReader, Read as _};
use std::path::{is_separator, Component, Path, PathBuf};

/// Most bytes of a model file, and of the header of a test vector.
pub const LARGEST: u64 = 1 << 20;

/// As in a shell: `*` stays in its folder and shows no hidden files.
const SHELL: MatchOptions = MatchOptions {
    case_sensitive: true,
    require_literal_separator: true,
    require_literal_leading_dot: true,
};

/// One component of a pattern.
enum Part {
    /// A name without `*`, `?` and `[`.
    Literal(OsString),
    Wild(Pattern),
    /// `**`: the folder itself and all folders below it that are not hidden.
    Folders,
}

/// The files whose names match the pattern, sorted by name.
pub fn files(pattern: &Path) -> Result<Vec<PathBuf>, Failure> {
    let text = pattern.to_string_lossy();
    let refused = |e: glob::PatternError| format!("{text}: invalid pattern: {}", e.msg);
    Pattern::new(&text).map_err(refused)?;
    let (mut root, mut parts) = (PathBuf::new(), Vec::new());
    for component in pattern.components() {
        let name = component.as_os_str();
        let own = name.to_string_lossy();
        match component {
            Component::Prefix(_) | Component::RootDir => root.push(component),
            Component::CurDir => {}
            Component::ParentDir => parts.push(Part::Literal(name.to_owned())),
            Component::Normal(_) if own == "**" => parts.push(Part::Folders),
            Component::Normal(_) if own.contains(['*', '?', '[']) => {
                parts.push(Part::Wild(Pattern::new(&own).map_err(refused)?));
            }
            Component::Normal(_) => parts.push(Part::Literal(name.to_owned())),
        }
    }
    let mut found = Vec::new();
    // A separator at the end asks for folders alone.
    if !text.ends_with(is_separator) {
        walk(root, &parts, &mut found)?;
    }
    found.sort();
    found.dedup();
    Ok(found)
}

/// Whether this is a test vector that `identify --model-out` has written: by its name and its first
/// line.
pub fn is_vector(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let first = || {
        let mut line = String::new();
        let file = fs::File::open(path).ok()?;
        BufReader::new(file.take(LARGEST))
            .read_line(&mut line)
            .ok()?;
        Some(line)
    };
    name.ends_with(".vector.csv") && first().is_some_and(|line| is_header_of_vector(&line))
}

/// Adds the files that the parts match from this path on.
fn walk(path: PathBuf, parts: &[Part], found: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let Some((first, rest)) = parts.split_first() else {
        if path.is_file() {
            found.push(path);
        }
        return Ok(());
    };
    match first {
        Part::Literal(name) => walk(path.join(name), rest, found),
        Part::Wild(pattern) => {
            for name in names(&path)? {
                if pattern.matches_with(&name.to_string_lossy(), SHELL) {
                    walk(path.join(name), rest, found)?;
                }
            }
            Ok(())
        }
        Part::Folders => {
            for name in names(&path)? {
                let below = path.join(&name);
                if !name.to_string_lossy().starts_with('.') && below.is_dir() {
                    walk(below, parts, found)?;
                }
            }
            walk(path, rest, found)
        }
    }
}

/// The names in a folder; none if the path is not a folder.
fn names(folder: &Path) -> Result<Vec<OsString>, Failure> {
    let here = Path::new(".");
    let folder = if folder.as_os_str().is_empty() {
        here
    } else {
        folder
    };
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let read = fs::read_dir(folder).and_then(|entries| {
        let names = entries.map(|entry| entry.map(|entry| entry.file_name()));
        names.collect::<Result<Vec<_>, _>>()
    });
    read.map_err(|e| format!("{}: {e}", folder.display()))
}
