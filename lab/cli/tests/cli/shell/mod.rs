//! The program as a user runs it: what it is asked, and what it answers.

use bowden_synth::{generate, Recipe};
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// The words of a command line.
pub fn args(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

pub fn bowden(arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_bowden"));
    program.args(arguments).output().unwrap()
}

/// The same on that number of threads.
pub fn bowden_on(threads: &str, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bowden"))
        .args(arguments)
        .env("RAYON_NUM_THREADS", threads)
        .output()
        .unwrap()
}

/// A file of `examples/data`.
pub fn example(name: &str) -> String {
    format!("{}/../../examples/data/{name}", env!("CARGO_MANIFEST_DIR"))
}

pub fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

/// What the program prints where all is well.
pub fn said(arguments: &[&str]) -> String {
    let output = bowden(arguments);
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {complaint}");
    text(&output.stdout).to_owned()
}

/// Exit 2, nothing on stdout, and exactly one line on stderr.
pub fn refused(arguments: &[&str]) -> String {
    let output = bowden(arguments);
    let printed = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {printed}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    let line = text(&output.stderr).trim_end().to_owned();
    assert_eq!(line.lines().count(), 1, "{line}");
    line
}

/// The JSON of a run but for its seconds, the one thing in it that a clock decides.
pub fn without_seconds(stdout: &[u8]) -> String {
    let (before, rest) = text(stdout).split_once("\"seconds\":{").unwrap();
    let (_, after) = rest.split_once('}').unwrap();
    format!("{before}{after}")
}

/// A folder with files that the program reads and writes.
pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn root(&self) -> &Path {
        self.0.path()
    }

    pub fn path(&self, name: &str) -> String {
        self.root().join(name).display().to_string()
    }

    pub fn file(&self, name: &str, bytes: impl AsRef<[u8]>) -> String {
        std::fs::write(self.root().join(name), bytes).unwrap();
        self.path(name)
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.root().join(name)).unwrap()
    }

    /// The names of the files, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.root()).unwrap();
        let name = |e: std::fs::DirEntry| e.file_name().to_string_lossy().into_owned();
        let mut names: Vec<String> = entries.map(|e| name(e.unwrap())).collect();
        names.sort();
        names
    }

    /// A record of the program's generator.
    pub fn record(&self, name: &str, options: &[&str]) -> String {
        let path = self.path(name);
        said(&[&["generate", "--out", &path], options].concat());
        path
    }

    /// A planted record.
    pub fn planted(&self, name: &str, recipe: &Recipe) -> String {
        self.file(name, generate(recipe).unwrap().to_csv())
    }
}

/// A folder that looks like the repository to commands that read `examples/data`.
pub fn folder_with_examples() -> Folder {
    let folder = Folder::new();
    let data = folder.root().join("examples/data");
    std::fs::create_dir_all(&data).unwrap();
    let own = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/data"));
    for file in std::fs::read_dir(own).unwrap().map(Result::unwrap) {
        if file.path().extension().is_some_and(|e| e == "csv") {
            std::fs::copy(file.path(), data.join(file.file_name())).unwrap();
        }
    }
    folder
}

/// The program in a folder.
pub fn bowden_in(folder: &Folder, arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_bowden"));
    program
        .args(arguments)
        .current_dir(folder.root())
        .output()
        .unwrap()
}
