//! What `--coq` and `--gappa` write, checked by Coq and by Gappa, where they are there.

use crate::shell::{bowden, example, refused, said, Folder};
use std::path::Path;
use std::process::Command;

/// The gains of an example in another float, their certificates written into a folder.
fn written(folder: &Path, name: &str, float: &str) -> (String, String) {
    let given = std::fs::read_to_string(example(name)).unwrap();
    let toml = folder.join(format!("{float}_{name}"));
    std::fs::write(&toml, given.replace("\"f32\"", &format!("\"{float}\""))).unwrap();
    let stem = name.strip_suffix(".toml").unwrap();
    let path = |end: &str| {
        folder
            .join(format!("{stem}_{float}.{end}"))
            .to_str()
            .unwrap()
            .to_owned()
    };
    let (coq, gappa) = (path("v"), path("g"));
    said(&[
        "certify",
        toml.to_str().unwrap(),
        "--coq",
        &coq,
        "--gappa",
        &gappa,
    ]);
    (coq, gappa)
}

/// Whether a tool takes a file; `None` where the tool is not there.
fn takes(tool: &str, arguments: &[&str], file: &str) -> Option<bool> {
    let run = Command::new(tool).args(arguments).arg(file).output();
    if run.is_err() {
        println!("skipped: {tool} is not there");
    }
    run.ok().map(|output| output.status.success())
}

/// A file with one text of it changed.
fn tampered(file: &str, from: &str, to: &str) -> String {
    let given = std::fs::read_to_string(file).unwrap();
    assert!(given.contains(from), "{from} is not in {file}");
    let (stem, end) = file.rsplit_once('.').unwrap();
    let path = format!("{stem}_tampered.{end}");
    std::fs::write(&path, given.replacen(from, to, 1)).unwrap();
    path
}

const CASES: [(&str, &str); 3] = [
    ("gains_table2.toml", "f32"),
    ("gains_own.toml", "f32"),
    ("gains_own.toml", "f64"),
];

#[test]
fn gappa_takes_the_roundings_and_refuses_smaller_ones() {
    let folder = Folder::new();
    for (name, float) in CASES {
        let (_, script) = written(folder.root(), name, float);
        if takes("gappa", &[], &script) == Some(false) {
            panic!("gappa refuses {script}");
        }
        let text = std::fs::read_to_string(&script).unwrap();
        // The last bound, a quarter of it.
        let (_, last) = text.trim_end().rsplit_once("<= ").unwrap();
        let (mantissa, exponent) = last.trim_end_matches(" }").split_once('b').unwrap();
        let smaller = format!("<= {mantissa}b{} }}", exponent.parse::<i32>().unwrap() - 2);
        let path = tampered(&script, &format!("<= {last}"), &smaller);
        assert_ne!(takes("gappa", &[], &path), Some(true), "{path}");
    }
}

#[test]
fn what_is_not_proved_is_not_written() {
    let folder = Folder::new();
    let file = folder.root().join("refused.v");
    let path = file.to_str().unwrap();
    let output = bowden(&["certify", &example("gains_refused.toml"), "--coq", path]);
    assert_eq!(output.status.code(), Some(1));
    assert!(!file.exists());
    let nowhere = folder.root().join("none").join("c.v");
    let line = refused(&[
        "certify",
        &example("gains_own.toml"),
        "--coq",
        nowhere.to_str().unwrap(),
    ]);
    assert!(line.contains("--coq"), "{line}");
    // Without gains of one's own there is nothing to write.
    assert_eq!(bowden(&["certify", "--coq", path]).status.code(), Some(2));
}
