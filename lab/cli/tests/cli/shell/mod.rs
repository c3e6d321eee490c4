//! The program as a user runs it: what it is asked, and what it answers.

use bowden_synth::{generate, Recipe};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::OnceLock;
use tempfile::TempDir;

/// A command line: one text with blanks between its words, or the words.
pub trait Line {
    fn words(&self) -> Vec<&str>;
}

impl Line for str {
    fn words(&self) -> Vec<&str> {
        self.split_whitespace().collect()
    }
}

impl Line for String {
    fn words(&self) -> Vec<&str> {
        self.as_str().words()
    }
}

impl Line for Vec<&str> {
    fn words(&self) -> Vec<&str> {
        self.clone()
    }
}

impl<const N: usize> Line for [&str; N] {
    fn words(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl Line for [&str] {
    fn words(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl<L: Line + ?Sized> Line for &L {
    fn words(&self) -> Vec<&str> {
        (*self).words()
    }
}

/// The words of a command line.
pub fn args(line: &str) -> Vec<&str> {
    line.words()
}

/// The program with its arguments, to be changed before it runs.
pub fn program<L: Line + ?Sized>(line: &L) -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_bowden"));
    program.args(line.words());
    program
}

pub fn bowden<L: Line + ?Sized>(line: &L) -> Output {
    program(line).output().unwrap()
}

/// The same on that number of threads.
pub fn bowden_on<L: Line + ?Sized>(threads: &str, line: &L) -> Output {
    let mut program = program(line);
    program.env("RAYON_NUM_THREADS", threads).output().unwrap()
}

/// The program in a folder.
pub fn bowden_in<L: Line + ?Sized>(folder: &Folder, line: &L) -> Output {
    program(line).current_dir(folder.root()).output().unwrap()
}

/// A file of `examples/data`.
pub fn example(name: &str) -> String {
    format!("{}/../../examples/data/{name}", env!("CARGO_MANIFEST_DIR"))
}

pub fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

/// What the program prints where all is well.
#[track_caller]
pub fn said<L: Line + ?Sized>(line: &L) -> String {
    let output = bowden(line);
    let complaint = String::from_utf8_lossy(&output.stderr);
    let words = line.words();
    assert_eq!(output.status.code(), Some(0), "{words:?}: {complaint}");
    text(&output.stdout).to_owned()
}

/// The same, which is JSON.
#[track_caller]
pub fn json<L: Line + ?Sized>(line: &L) -> Value {
    serde_json::from_str(&said(line)).unwrap()
}

/// Exit 2, nothing on stdout, and exactly one line on stderr.
#[track_caller]
pub fn refused<L: Line + ?Sized>(line: &L) -> String {
    refusal(&line.words(), &bowden(line))
}

#[track_caller]
fn refusal(words: &[&str], output: &Output) -> String {
    let printed = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(2), "{words:?}: {printed}");
    assert!(printed.is_empty(), "{words:?}");
    let line = text(&output.stderr).trim_end().to_owned();
    assert_eq!(line.lines().count(), 1, "{line}");
    line
}

/// A table of command lines that are refused in a folder, one a line: `COMMAND => PART | PART`.
#[track_caller]
pub fn refuses_all(folder: &Folder, table: &str) {
    for row in table.lines().filter(|row| !row.trim().is_empty()) {
        let (line, parts) = row.trim().split_once(" => ").unwrap();
        let told = refusal(&line.words(), &bowden_in(folder, line));
        has(&told, &parts.split(" | ").collect::<Vec<_>>());
    }
}

/// The same, and the line has each of these parts.
#[track_caller]
pub fn refuses<L: Line + ?Sized>(line: &L, parts: &[&str]) {
    has(&refused(line), parts);
}

#[track_caller]
pub fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part:?} is not in: {text}");
    }
}

/// The JSON of a run but for its seconds, the one thing in it that a clock decides.
pub fn without_seconds(stdout: &[u8]) -> String {
    let (before, rest) = text(stdout).split_once("\"seconds\":{").unwrap();
    let (_, after) = rest.split_once('}').unwrap();
    format!("{before}{after}")
}

/// What `identify --json` says of the built-in record, found once.
pub fn builtin() -> &'static Value {
    static FOUND: OnceLock<Value> = OnceLock::new();
    FOUND.get_or_init(|| json("identify --json"))
}

/// The model of the straight cable, found once and written into a folder.
pub fn straight(folder: &Folder) -> String {
    static MODEL: OnceLock<String> = OnceLock::new();
    let text = MODEL.get_or_init(|| {
        let (own, record) = (Folder::new(), example("straight.csv"));
        let model = own.path("model.toml");
        said(&format!("identify {record} --model-out {model}"));
        own.read("model.toml")
    });
    folder.file("model.toml", text)
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
    pub fn record<L: Line + ?Sized>(&self, name: &str, options: &L) -> String {
        let path = self.path(name);
        said(&[&["generate", "--out", &path][..], &options.words()].concat());
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
    for file in std::fs::read_dir(example("")).unwrap().map(Result::unwrap) {
        if file.path().extension().is_some_and(|e| e == "csv") {
            std::fs::copy(file.path(), data.join(file.file_name())).unwrap();
        }
    }
    folder
}
