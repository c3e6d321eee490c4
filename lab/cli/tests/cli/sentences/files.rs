//! Records to be closed and checked, and what the program says of them.

use crate::shell::{has, json, said, Folder};
use serde_json::Value;
use std::sync::OnceLock;

/// Rows of a record: time first.
#[derive(Clone)]
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
    pub fn new(header: &str, rows: impl IntoIterator<Item = Vec<f64>>) -> Self {
        Self {
            header: header.to_owned(),
            rows: rows.into_iter().collect(),
        }
    }

    /// Of a record as text.
    pub fn parsed(text: &str) -> Self {
        let (header, rows) = text.split_once('\n').unwrap();
        let row = |line: &str| line.split(',').map(|c| c.parse().unwrap()).collect();
        Self::new(header, rows.lines().map(row))
    }

    /// A record of the program's generator.
    pub fn generated(options: &str) -> Self {
        Self::parsed(&said(&format!("generate {options}")))
    }

    /// Replaces a column by a function of the row's index and its old values.
    pub fn set(&mut self, column: usize, mut of: impl FnMut(usize, &[f64]) -> f64) {
        for (i, row) in self.rows.iter_mut().enumerate() {
            row[column] = of(i, row);
        }
    }

    pub fn column(&self, column: usize) -> Vec<f64> {
        self.rows.iter().map(|row| row[column]).collect()
    }

    /// The difference of a column over so many rows to either side of a row, for each row.
    pub fn differences(&self, column: usize, to_either_side: usize) -> Vec<f64> {
        let all = self.column(column);
        let at = |i: usize| all[i.min(all.len() - 1)];
        let difference = |i: usize| at(i + to_either_side) - at(i.saturating_sub(to_either_side));
        (0..all.len()).map(difference).collect()
    }

    /// The record in so many parts of one length, each of which begins at zero.
    pub fn parts(&self, number: usize) -> Vec<Self> {
        let length = self.rows.len() / number;
        let part = |rows: &[Vec<f64>]| {
            let mut part = Self::new(&self.header, rows.to_vec());
            let begin = rows[0][T];
            part.set(T, |_, row| row[T] - begin);
            part
        };
        self.rows.chunks_exact(length).map(part).collect()
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
        folder.file(name, text)
    }

    /// What `identify` says of it, for people and for programs.
    pub fn close(&self, options: &str) -> Closed {
        let folder = Folder::new();
        let path = self.write(&folder, "record.csv");
        Closed::within(folder, &format!("{path} {options}"))
    }
}

pub struct Closed {
    asked: String,
    pub json: Value,
    /// The records, as long as the program may have to read them again.
    _folder: Folder,
}

impl Closed {
    pub fn of(asked: &str) -> Self {
        Self::within(Folder::new(), asked)
    }

    /// Of records in a folder that is kept.
    pub fn within(folder: Folder, asked: &str) -> Self {
        let json = json(&format!("identify {asked} --json"));
        println!("{}: {}", json["verdict"], json["summary"]);
        Self {
            asked: asked.to_owned(),
            json,
            _folder: folder,
        }
    }

    /// Of several records, each with its name.
    pub fn files<'a>(files: impl IntoIterator<Item = (&'a str, Rows)>, options: &str) -> Self {
        let folder = Folder::new();
        let files = files.into_iter();
        let paths: Vec<String> = files.map(|(name, own)| own.write(&folder, name)).collect();
        Self::within(folder, &format!("{} {options}", paths.join(" ")))
    }

    /// What is printed for people; a second run.
    pub fn text(&self) -> String {
        let text = said(&format!("identify {}", self.asked));
        // Errors come before the terms. The headline names the mechanisms, with which the sentence
        // may begin.
        let findings = self.json["findings"].as_array().unwrap().iter();
        let errors = findings.filter(|finding| finding["severity"] == "error");
        let errors: Vec<_> = errors.map(|e| e["words"].as_str().unwrap()).collect();
        let errors = errors.join(" ");
        let rest = self.sentence().strip_prefix(&errors).unwrap().trim_start();
        let told = rest.strip_prefix("The baseline model lacks ");
        let told = told.and_then(|rest| Some(&rest[rest.find(". With ")? + 2..]));
        has(&text, &[&errors, told.unwrap_or(rest)]);
        text
    }

    pub fn verdict(&self) -> &str {
        self.json["verdict"].as_str().unwrap()
    }

    pub fn sentence(&self) -> &str {
        self.json["summary"].as_str().unwrap()
    }

    /// A number of the JSON, by its place in it.
    pub fn number(&self, place: &str) -> f64 {
        self.json.pointer(place).unwrap().as_f64().unwrap()
    }

    /// The evidence of the finding with this code.
    pub fn finding(&self, code: &str) -> Option<&Value> {
        evidence(&self.json, code)
    }

    pub fn names(&self) -> Vec<&str> {
        let rounds = self.json["terms"].as_array().unwrap().iter();
        rounds.map(|r| r["effect"].as_str().unwrap()).collect()
    }

    pub fn notes(&self) -> Vec<&str> {
        let notes = self.json["notes"].as_array().unwrap().iter();
        notes.map(|note| note.as_str().unwrap()).collect()
    }

    /// Asserts that the sentence holds each of the texts.
    #[track_caller]
    pub fn says(&self, texts: &[&str]) {
        has(self.sentence(), texts);
    }

    #[track_caller]
    pub fn does_not_say(&self, text: &str) {
        assert!(!self.sentence().contains(text), "{}", self.sentence());
    }
}

/// The evidence of the finding with this code in an answer.
pub fn evidence<'a>(json: &'a Value, code: &str) -> Option<&'a Value> {
    let mut all = json["findings"].as_array().unwrap().iter();
    let found = all.find(|finding| finding["code"] == code)?;
    // A finding without evidence has none.
    Some(found.get("evidence").unwrap_or(&Value::Null))
}

/// The model of a record, to be checked on others.
pub struct Bench {
    /// The text of its file.
    pub model: String,
}

impl Bench {
    pub fn of(first: &Rows) -> Self {
        let folder = Folder::new();
        let (first, model) = (first.write(&folder, "first.csv"), folder.path("model.toml"));
        said(&format!("identify {first} --model-out {model}"));
        let model = folder.read("model.toml");
        Self { model }
    }

    /// Of the sound spring.
    pub fn of_spring() -> &'static Self {
        static BENCH: OnceLock<Bench> = OnceLock::new();
        BENCH.get_or_init(|| Self::of(&spring()))
    }

    pub fn check(&self, next: &Rows) -> Value {
        let folder = Folder::new();
        let record = next.write(&folder, "next.csv");
        let model = folder.file("model.toml", &self.model);
        let report = json(&format!("validate {model} {record} --json"));
        println!("{}: {}", report["verdict"], report["summary"]);
        report
    }
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

/// Forty seconds at 500 Hz of noise behind four low-passes of that corner \[Hz\].
pub fn low_passed(corner: f64, seed: usize) -> impl Iterator<Item = f64> {
    let share = 1.0 - (-std::f64::consts::TAU * corner / 500.0).exp();
    let mut stages = [0.0; 4];
    (0..20_000).map(move |i| {
        let mut signal = uniform(i + 1000 * seed);
        for stage in &mut stages {
            *stage += share * (signal - *stage);
            signal = *stage;
        }
        100.0 * signal
    })
}

/// Bouc-Wen of fixed shape, integrated along straight lines.
#[derive(Default)]
pub struct Hysteresis {
    pub before: f64,
    pub z: f64,
}

impl Hysteresis {
    pub fn step(&mut self, to: f64, substeps: u8) -> f64 {
        let dx = (to - self.before) / f64::from(substeps);
        for _ in 0..substeps {
            self.z += 0.9 * (dx - 0.8 * dx.abs() * self.z - 0.2 * dx * self.z.abs());
        }
        self.before = to;
        self.z
    }
}

/// 24 seconds of a spring with a hysteresis, moved by tones.
pub fn spring() -> Rows {
    spring_of(1.0, |_| 0.0)
}

/// The same moved by so many times the tones; the clamp has slipped by `slipped` at a time.
pub fn spring_of(times: f64, slipped: impl Fn(f64) -> f64) -> Rows {
    let mut hysteresis = Hysteresis::default();
    let row = |i: usize| {
        let t = i as f64 / 500.0;
        let tones = 2.0 * (5.3 * t).sin() + 1.1 * (2.1 * t + 0.4).sin() + 0.6 * (9.7 * t).sin();
        let x = times * tones;
        let own = x - slipped(t);
        let z = hysteresis.step(own, 10);
        vec![t, x, 1.5 * own + 4.0 * z + 0.02 * noise(i)]
    };
    Rows::new("t,x [mm],f [N]", (0..12_000).map(row))
}
