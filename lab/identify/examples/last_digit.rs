//! How far an answer hangs on the last digits of a record.
//!
//! `cargo run --release -p bowden-lab --example last_digit -- FOLDER [COPIES] [ROW…]`; the folder
//! and the rows are those of the example `shared_records`. Each record is closed as it is, and
//! then `COPIES` times (3 if none is given) with white noise added to its output whose standard
//! deviation is 1e-9 of the largest output: far below what any sensor resolves. Printed are the
//! delivered names (a ? marks weak ones), the error on the fit segment and the held-out one, in
//! shares of the output's standard deviation, and how many copies have the names of the record.
#![allow(clippy::unwrap_used)]

#[allow(dead_code)]
#[path = "../tests/shared/mod.rs"]
mod shared;

use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::ledger::Grade;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::Record;
use bowden_lab::search::close;
use shared::{disturbed, Row, ROWS};
use std::path::{Path, PathBuf};

/// The delivered names, weak ones marked, and the errors on the fit and held-out segments.
struct Answer {
    names: Vec<String>,
    error: (f64, f64),
}

impl Answer {
    fn to(row: &Row, record: &Record) -> Result<Self, String> {
        let cutoff = row.asked().cutoff;
        let data = Prepared::new(record, Preparation { cutoff })?;
        let ledger = close(&data, &structure(&row.asked().declare, &data)?, |_| ())?;
        let done = FinalFit::new(&data, &ledger);
        let error = done.rmse.normalised(&data, &data.target);
        let name = |round: &bowden_lab::ledger::Round| {
            let weak = if round.grade == Grade::High { "" } else { "?" };
            format!("{}{weak}", round.candidate.term.effect.name())
        };
        Ok(Self {
            names: ledger.rounds.iter().map(name).collect(),
            error: (error.fit, error.held_out),
        })
    }

    fn print(&self, label: &str) {
        let (fit, held_out) = self.error;
        println!(
            "  {label:<10} {:6.2} % fit {:6.2} % held out  {}",
            100.0 * fit,
            100.0 * held_out,
            self.names.join(" ")
        );
    }

    /// The names in an order of their own, without their grades.
    fn set(&self) -> Vec<&str> {
        let mut set: Vec<&str> = self.names.iter().map(|n| n.trim_end_matches('?')).collect();
        set.sort_unstable();
        set
    }
}

/// Closes a record and its copies; how many of these have the record's names.
fn run(row: &Row, path: &Path, copies: u64) -> Result<u64, String> {
    let record = row.asked().read(path)?;
    println!("{}", row.name);
    let own = Answer::to(row, &record)?;
    own.print("as it is");
    let mut same = 0;
    for seed in 1..=copies {
        let copy = Answer::to(row, &disturbed(&record, seed))?;
        copy.print(&format!("copy {seed}"));
        same += u64::from(copy.set() == own.set());
    }
    Ok(same)
}

fn main() -> Result<(), String> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    if words.is_empty() {
        return Err("give the folder of the records".to_owned());
    }
    let folder = PathBuf::from(words.remove(0));
    let copies = match words.first().map(|word| word.parse::<u64>()) {
        Some(Ok(copies)) => {
            words.remove(0);
            copies
        }
        _ => 3,
    };
    let mut lines = Vec::new();
    for row in &ROWS {
        let path = folder.join(row.file);
        if !words.is_empty() && !words.iter().any(|word| row.name.contains(word.as_str())) {
            continue;
        }
        if !path.exists() {
            println!("{}: skipped, {} is not there", row.name, path.display());
            continue;
        }
        let same = run(row, &path, copies)?;
        lines.push(format!("| {} | {same} of {copies} |", row.name));
    }
    println!("\n| record | copies with its names |\n|---|---|");
    lines.iter().for_each(|line| println!("{line}"));
    Ok(())
}
