//! What one model for 1, 4, 16 and 64 files costs; prints the table of `lab/notes/fleet.md`.
//!
//! ```sh
//! cargo run --release -p bowden-lab --example many_files
//! cargo run --release -p bowden-lab --example many_files -- --gains 4 16
//! cargo run --release -p bowden-lab --example many_files -- --program OTHER/bowden 1 4 16
//! ```
//!
//! `bowden generate` makes one record of 1280 s at 500 Hz whose model lacks viscous friction. It
//! is cut into 64 files, and `bowden identify` fits one model to the first of them, on one thread.
//! `--gains` gives each file gains of its own, `--program` measures another build in place of the
//! present one.

use serde_json::Value;
use std::error::Error;
use std::path::{Path, PathBuf};

#[allow(dead_code)]
#[path = "../bench_report/program.rs"]
mod program;

use program::{build, timed, Instrument, Program};

/// Files that are made.
const FILES: usize = 64;
/// Rows of each.
const ROWS: usize = 10_000;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (mut other, mut counts, mut close) = (None, Vec::new(), vec!["close", "--json"]);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--program" => other = Some(PathBuf::from(arguments.next().ok_or("--program PATH")?)),
            "--gains" => close.extend(["--per-file", "gains"]),
            count => counts.push(count.parse::<usize>()?),
        }
    }
    if counts.is_empty() {
        counts = vec![1, 4, 16, FILES];
    }
    let path = other.map_or_else(build, Ok)?;
    let instrument = Instrument::Neither;
    let program = Program { path, instrument };
    let folder = tempfile::tempdir()?;
    let files = files(&program, folder.path())?;
    println!("| files | rows | processor time [s] | peak [MiB] | evaluations | found |");
    println!("|---|---|---|---|---|---|");
    for count in counts {
        let given = files.get(..count).ok_or("at most 64 files")?;
        println!("{}", row(&program, &close, given)?);
    }
    Ok(())
}

/// One record, cut into files.
fn files(program: &Program, folder: &Path) -> Result<Vec<String>, Box<dyn Error>> {
    let whole = folder.join("whole.csv").display().to_string();
    let seconds = (FILES * ROWS / 500).to_string();
    let arguments = ["generate", "--rate", "500", "--effect", "viscous:2"];
    let arguments = arguments
        .into_iter()
        .chain(["--seconds", &seconds, "--out", &whole]);
    program.run(&arguments.map(str::to_owned).collect::<Vec<_>>())?;
    let text = std::fs::read_to_string(&whole)?;
    let (header, rows) = text.split_once('\n').ok_or("the record is empty")?;
    let rows: Vec<&str> = rows.lines().collect();
    let mut files = Vec::with_capacity(FILES);
    for (index, own) in rows.chunks_exact(ROWS).enumerate() {
        let path = folder.join(format!("{index:02}.csv"));
        std::fs::write(&path, format!("{header}\n{}\n", own.join("\n")))?;
        files.push(path.display().to_string());
    }
    Ok(files)
}

/// One line of the table.
fn row(program: &Program, close: &[&str], files: &[String]) -> Result<String, Box<dyn Error>> {
    let close = close.iter().map(|&word| word.to_owned());
    let all: Vec<String> = close.chain(files.iter().cloned()).collect();
    let before = processor_time()?;
    let (json, _, peak) = timed(&program.path, &all)?;
    let seconds = processor_time()? - before;
    let report: Value = serde_json::from_str(&json)?;
    let rounds = report["rounds"].as_array().ok_or("no rounds")?;
    let found: Vec<&str> = rounds.iter().filter_map(|r| r["effect"].as_str()).collect();
    let peak = peak.map_or_else(
        || "not told".to_owned(),
        |b| format!("{:.0}", b / 1048576.0),
    );
    Ok(format!(
        "| {} | {} | {seconds:.1} | {peak} | {} | {} |",
        files.len(),
        files.len() * ROWS,
        report["cost"]["evaluations"],
        found.join(", "),
    ))
}

/// Processor time of all programs that were run and have ended \[s\]; Linux tells it, in ticks of
/// ten milliseconds.
fn processor_time() -> Result<f64, Box<dyn Error>> {
    let status = std::fs::read_to_string("/proc/self/stat")?;
    // Behind the name, which may hold spaces: fields 16 and 17 are those of the children.
    let (_, rest) = status.rsplit_once(')').ok_or("no status of this process")?;
    let ticks = rest.split_whitespace().skip(13).take(2);
    let ticks: Vec<f64> = ticks.map(str::parse).collect::<Result<_, _>>()?;
    Ok(ticks.iter().sum::<f64>() / 100.0)
}
