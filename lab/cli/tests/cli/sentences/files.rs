//! Records to be closed.

use crate::shell::{bowden, Folder};
use serde_json::Value;

/// Rows of a record: time first.
pub struct Rows {
    pub header: String,
    pub rows: Vec<Vec<f64>>,
}

/// Columns of a generated torque record.
pub const T: usize = 0;
pub const TAU_I: usize = 1;
pub const TAU_O: usize = 2;
pub const PHI_P: usize = 3;

impl Rows {
    /// A record of the program's generator.
    pub fn generated(arguments: &[&str]) -> Self {
        let output = bowden(&[&["generate"], arguments].concat());
        assert!(output.status.success(), "{output:?}");
        let text = String::from_utf8(output.stdout).unwrap();
        let mut lines = text.lines();
        let header = lines.next().unwrap().to_owned();
        let rows = lines.map(|line| line.split(',').map(|c| c.parse().unwrap()).collect());
        Self {
            rows: rows.collect(),
            header,
        }
    }

    /// Replaces a column by a function of the row's index and its old values.
    pub fn set(&mut self, column: usize, mut of: impl FnMut(usize, &[f64]) -> f64) {
        for (i, row) in self.rows.iter_mut().enumerate() {
            row[column] = of(i, row);
        }
    }

    pub fn seconds(&self) -> f64 {
        self.rows.last().unwrap()[T]
    }

    pub fn write(&self, folder: &Folder, name: &str) -> String {
        let mut text = self.header.clone();
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(f64::to_string).collect();
            text += "\n";
            text += &cells.join(",");
        }
        let path = folder.root().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    }

    /// What `identify` says of it, for people and for programs.
    pub fn close(&self, options: &[&str]) -> Closed {
        let folder = Folder::new();
        let path = self.write(&folder, "record.csv");
        Closed {
            _folder: Some(folder),
            ..Closed::of(&[&[path.as_str()], options].concat())
        }
    }
}

pub struct Closed {
    arguments: Vec<String>,
    pub json: Value,
    /// The record, as long as the program may have to read it again.
    _folder: Option<Folder>,
}

fn close(arguments: &[&str], more: &[&str]) -> String {
    let output = bowden(&[&["identify"], arguments, more].concat());
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

impl Closed {
    pub fn of(arguments: &[&str]) -> Self {
        let json: Value = serde_json::from_str(&close(arguments, &["--json"])).unwrap();
        println!("{}: {}", json["verdict"], json["summary"]);
        Self {
            arguments: arguments.iter().map(|a| (*a).to_owned()).collect(),
            json,
            _folder: None,
        }
    }

    /// What is printed for people; a second run.
    pub fn text(&self) -> String {
        let arguments: Vec<&str> = self.arguments.iter().map(String::as_str).collect();
        let text = close(&arguments, &[]);
        // Errors come before the terms. The headline names the mechanisms, with which the sentence may
        // begin.
        let findings = self.json["findings"].as_array().unwrap().iter();
        let errors = findings.filter(|finding| finding["severity"] == "error");
        let errors = errors.map(|error| error["words"].as_str().unwrap());
        let errors = errors.collect::<Vec<_>>().join(" ");
        let rest = self.sentence().strip_prefix(&errors).unwrap().trim_start();
        let told = rest.strip_prefix("The baseline model lacks ");
        let told = told.and_then(|rest| Some(&rest[rest.find(". With ")? + 2..]));
        for part in [&errors, told.unwrap_or(rest)] {
            assert!(text.contains(part), "{part} is not in {text}");
        }
        text
    }

    pub fn verdict(&self) -> &str {
        self.json["verdict"].as_str().unwrap()
    }

    pub fn sentence(&self) -> &str {
        self.json["summary"].as_str().unwrap()
    }

    /// The evidence of the finding with this code.
    pub fn finding(&self, code: &str) -> Option<&Value> {
        evidence(&self.json, code)
    }

    /// A share of the held-out output's variance.
    pub fn explains(&self, what: &str) -> f64 {
        self.json["explains"][what].as_f64().unwrap()
    }

    pub fn names(&self) -> Vec<&str> {
        let rounds = self.json["terms"].as_array().unwrap();
        rounds
            .iter()
            .map(|r| r["effect"].as_str().unwrap())
            .collect()
    }

    /// Asserts that the sentence holds each of the texts.
    pub fn says(&self, texts: &[&str]) {
        let told = self.sentence();
        for text in texts {
            assert!(told.contains(text), "{text:?} is not in: {told}");
        }
    }
}

/// The evidence of the finding with this code in an answer.
pub fn evidence<'a>(json: &'a Value, code: &str) -> Option<&'a Value> {
    let mut all = json["findings"].as_array().unwrap().iter();
    let found = all.find(|finding| finding["code"] == code)?;
    // A finding without evidence has none.
    Some(found.get("evidence").unwrap_or(&Value::Null))
}

/// Pseudo-random, uniform in −1…1: the fraction of a large sine (an old trick of shaders).
pub fn uniform(row: usize) -> f64 {
    2.0 * ((row as f64 * 12.9898).sin() * 43758.5453).rem_euclid(1.0) - 1.0
}

/// Nearly normal with unit variance: the sum of twelve of the above.
pub fn noise(row: usize) -> f64 {
    let sum: f64 = (0..12).map(|k| uniform(12 * row + k)).sum();
    sum / 2.0
}
