//! The files that a command writes: no file overwrites another one, and all are written or none.

use super::Failure;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Allowed endings of the files of an option; none if any ending is allowed.
fn endings(option: &str) -> &'static [&'static str] {
    match option {
        "--report" => &["html", "htm"],
        "--plot" => &["svg"],
        "--trace" => &["csv"],
        _ => &[],
    }
}

/// Checks, before anything is read, that each output can be written: its folder exists and is
/// writable, it is not an input, no other option writes it, and its name has the right ending.
pub fn check(read: &[&Path], outputs: &[(&str, &Path)]) -> Result<(), Failure> {
    for (index, (option, path)) in outputs.iter().enumerate() {
        writable(option, path, read)?;
        let before = outputs.iter().take(index);
        if !is_stream(path) && before.into_iter().any(|(_, other)| same(other, path)) {
            return Err(format!(
                "{option} {}: another option also writes this file",
                path.display()
            ));
        }
    }
    outputs
        .iter()
        .try_for_each(|(option, path)| named(option, path))
}

/// Whether the name ends as one of that form does: a model that is named by mistake stays. A device
/// or a pipe may have any name.
fn named(option: &str, path: &Path) -> Result<(), Failure> {
    let endings = endings(option);
    let own = path.extension().and_then(|own| own.to_str());
    let is_one = own.is_some_and(|own| endings.iter().any(|e| own.eq_ignore_ascii_case(e)));
    if endings.is_empty() || is_one || is_stream(path) {
        return Ok(());
    }
    Err(format!(
        "{option} {}: the file name must end in .{}",
        path.display(),
        endings.join(" or .")
    ))
}

fn writable(option: &str, path: &Path, read: &[&Path]) -> Result<(), Failure> {
    let refuse = |message: String| Err(format!("{option} {}: {message}", path.display()));
    if path.is_dir() {
        return refuse("this is a folder; pass the name of a file".to_owned());
    }
    if let Some(other) = read.iter().find(|other| same(path, other)) {
        return refuse(format!(
            "this would overwrite {}, which is an input",
            other.display()
        ));
    }
    if is_stream(path) {
        return Ok(());
    }
    let part = beside(&behind_links(path), "part");
    match std::fs::File::create(&part) {
        Ok(_) => std::fs::remove_file(&part).map_err(|e| format!("{}: {e}", part.display())),
        Err(e) => refuse(e.to_string()),
    }
}

/// Whether two paths name one file, which need not exist.
fn same(a: &Path, b: &Path) -> bool {
    a == b || matches!((place(a), place(b)), (Some(a), Some(b)) if a == b)
}

/// A path without links and dots; of a file that does not exist, its folder's and its name.
fn place(path: &Path) -> Option<PathBuf> {
    if let Ok(place) = path.canonicalize() {
        return Some(place);
    }
    let folder = match path.parent()? {
        here if here.as_os_str().is_empty() => Path::new("."),
        folder => folder,
    };
    Some(folder.canonicalize().ok()?.join(path.file_name()?))
}

/// Whether the path leads to what takes bytes and is no file: a device, a pipe, a terminal. It is
/// written to, and never replaced.
fn is_stream(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir())
}

/// Where a path leads if it is a link to something that exists; else the path.
fn behind_links(path: &Path) -> PathBuf {
    match std::fs::symlink_metadata(path).is_ok_and(|there| there.is_symlink()) {
        true => path.canonicalize().unwrap_or_else(|_| path.to_owned()),
        false => path.to_owned(),
    }
}

/// A temporary file of this process in the folder of another file.
fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.{ending}", std::process::id()));
    path.with_file_name(name)
}

/// Writes a whole file or none: first a temporary file in the same folder, which is then renamed.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    write_together(&[(path.to_owned(), bytes.to_vec())])
}

/// Writes all files or none: first temporary files in the same folders; when all are on the disk,
/// they are renamed, the last ones first. An existing file keeps its bytes until then, and gets
/// them back if a later file cannot be written. If the path is a link, its target is written.
/// Devices and pipes receive their bytes after all files.
pub fn write_together(files: &[(PathBuf, Vec<u8>)]) -> Result<(), Failure> {
    let (streams, files): (Vec<_>, Vec<_>) = files.iter().partition(|(path, _)| is_stream(path));
    let files: Vec<(PathBuf, &[u8])> = files
        .into_iter()
        .map(|(path, bytes)| (behind_links(path), &bytes[..]))
        .collect();
    write_files(&files)?;
    for (path, bytes) in streams {
        let opened = std::fs::OpenOptions::new().write(true).open(path);
        let written = opened.and_then(|mut stream| stream.write_all(bytes));
        written.map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(())
}

fn write_files(files: &[(PathBuf, &[u8])]) -> Result<(), Failure> {
    for (index, (path, _)) in files.iter().enumerate() {
        if files.iter().take(index).any(|(other, _)| same(other, path)) {
            return Err(format!(
                "{}: this file would be written twice",
                path.display()
            ));
        }
    }
    let written = write_parts(files).and_then(|()| take_names(files));
    // No part stays behind; that it may be absent already is fine.
    for (path, _) in files {
        let _ = std::fs::remove_file(beside(path, "part"));
    }
    written
}

fn write_parts(files: &[(PathBuf, &[u8])]) -> Result<(), Failure> {
    for (path, bytes) in files {
        let failed = |e: std::io::Error| format!("{}: {e}", path.display());
        std::fs::write(beside(path, "part"), bytes).map_err(failed)?;
    }
    Ok(())
}

fn take_names(files: &[(PathBuf, &[u8])]) -> Result<(), Failure> {
    let mut done: Vec<&Path> = Vec::new();
    for (path, _) in files.iter().rev() {
        let renamed = keep(path).and_then(|()| std::fs::rename(beside(path, "part"), path));
        if let Err(e) = renamed {
            let _ = std::fs::remove_file(beside(path, "kept"));
            for path in done {
                restore(path);
            }
            return Err(format!("{}: {e}", path.display()));
        }
        done.push(path);
    }
    for path in done {
        let _ = std::fs::remove_file(beside(path, "kept"));
    }
    Ok(())
}

/// A second name for the file that is there, if there is one; a copy where the file system has
/// no links.
fn keep(path: &Path) -> std::io::Result<()> {
    let is_file = std::fs::symlink_metadata(path).is_ok_and(|there| !there.is_dir());
    if !is_file {
        return Ok(());
    }
    let kept = beside(path, "kept");
    std::fs::hard_link(path, &kept).or_else(|_| std::fs::copy(path, &kept).map(drop))
}

/// The file that was there before, or none. What cannot be put back stays under its second name.
fn restore(path: &Path) {
    let kept = beside(path, "kept");
    let _ = match std::fs::symlink_metadata(&kept) {
        Ok(_) => std::fs::rename(kept, path),
        Err(_) => std::fs::remove_file(path),
    };
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::write_together;
    use std::path::Path;

    fn names(folder: &Path) -> Vec<std::ffi::OsString> {
        let entries = std::fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name()).collect()
    }

    #[test]
    fn of_files_that_cannot_all_be_written_none_is() {
        // The place of the first or of the last one is taken by a folder.
        for taken in ["a", "c"] {
            let folder = tempfile::tempdir().unwrap();
            std::fs::create_dir(folder.path().join(taken)).unwrap();
            let file = |name: &str| (folder.path().join(name), name.as_bytes().to_vec());
            let line = write_together(&["a", "b", "c"].map(file)).unwrap_err();
            assert!(line.contains(&folder.path().join(taken).display().to_string()));
            assert_eq!(names(folder.path()), [taken]);
        }
    }

    #[test]
    fn a_file_that_was_there_has_its_bytes_again_where_another_cannot_be_written() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("a")).unwrap();
        std::fs::write(folder.path().join("c"), "before").unwrap();
        let file = |name: &str| (folder.path().join(name), name.as_bytes().to_vec());
        write_together(&["a", "b", "c"].map(file)).unwrap_err();
        assert_eq!(std::fs::read(folder.path().join("c")).unwrap(), b"before");
        let mut left = names(folder.path());
        left.sort();
        assert_eq!(left, ["a", "c"]);
        // Over files that are there, all are written, and nothing else is left.
        write_together(&["b", "c"].map(file)).unwrap();
        assert_eq!(std::fs::read(folder.path().join("c")).unwrap(), b"c");
        let mut left = names(folder.path());
        left.sort();
        assert_eq!(left, ["a", "b", "c"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_the_file_behind_it_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let (real, link) = (folder.path().join("real"), folder.path().join("link"));
        std::fs::write(&real, "before").unwrap();
        std::os::unix::fs::symlink("real", &link).unwrap();
        write_together(&[(link.clone(), b"now".to_vec())]).unwrap();
        assert_eq!(std::fs::read(&real).unwrap(), b"now");
        assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
        let mut left = names(folder.path());
        left.sort();
        assert_eq!(left, ["link", "real"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_stays_one_and_gets_the_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        if !made.is_ok_and(|status| status.success()) {
            println!("skipped: there is no mkfifo");
            return;
        }
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || std::fs::read(pipe).unwrap()
        });
        super::check(&[], &[("--out", &pipe)]).unwrap();
        write_together(&[(pipe.clone(), b"bytes".to_vec())]).unwrap();
        assert_eq!(reader.join().unwrap(), b"bytes");
        assert!(super::is_stream(&pipe));
        assert_eq!(names(folder.path()), ["pipe"]);
    }

    #[test]
    fn one_file_twice_is_refused_and_what_was_there_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("same");
        std::fs::write(&path, "before").unwrap();
        let name = folder.path().file_name().unwrap();
        let again = folder.path().join("..").join(name).join("same");
        for other in [path.clone(), again] {
            let files = [(path.clone(), b"1".to_vec()), (other, b"2".to_vec())];
            let line = write_together(&files).unwrap_err();
            assert!(line.contains("would be written twice"), "{line}");
            assert_eq!(std::fs::read(&path).unwrap(), b"before");
            assert_eq!(names(folder.path()), ["same"]);
        }
    }
}
