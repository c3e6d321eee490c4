//! Measures what `bowden identify` costs and writes it into `benches/README.md`, between the marks
//! that the page has for it.
//!
//! ```text
//! cargo run --release -p bowden-lab --example bench_report              everything
//! cargo run --release -p bowden-lab --example bench_report -- --quick   what takes minutes
//! ```
//! Cost against samples, against the catalogue and against names; the measured records; the
//! paper's method and SciPy on the same record; and how far each figure is from its limit.
//! `--largest SAMPLES` sets the longest record of the first series (10^6; 10^7 needs 1 GB of
//! disk), `--rows NAME,…` the measured records (`none` for none), `--out FILE` another file,
//! `--program FILE` a program that is built already, as of another version.
//! `BOWDEN_SHARED_RECORDS` names the folder of the measured records, `PYTHON` a Python with
//! SciPy. What is not there, or was not asked for, is said in the file.
#![allow(clippy::unwrap_used)]

mod cases;
mod limits;
mod paper;
mod peers;
mod program;
#[allow(dead_code)]
#[path = "../../tests/shared/mod.rs"]
mod shared;
mod table;

use cases::{measured, of_length, repository, with_angles, with_names, Case, ANGLES, PLANTED};
use limits::limits;
use peers::peers;
use program::{Instrument, Outcome, Program};
use shared::ROWS;
use std::path::{Path, PathBuf};
use table::{document, Measured};

/// What is asked for.
struct Wanted {
    quick: bool,
    largest: u64,
    rows: Option<Vec<String>>,
    out: PathBuf,
    program: Option<PathBuf>,
}

impl Wanted {
    fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut wanted = Self {
            quick: false,
            largest: 0,
            rows: None,
            out: repository().join("benches/README.md"),
            program: None,
        };
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or(format!("{word}: a value is needed"));
            match word.as_str() {
                "--quick" => wanted.quick = true,
                "--largest" => {
                    let text = value()?;
                    let number = text.parse();
                    wanted.largest = number.map_err(|_| format!("--largest {text}: no number"))?;
                }
                "--rows" => wanted.rows = Some(value()?.split(',').map(str::to_owned).collect()),
                "--out" => wanted.out = value()?.into(),
                "--program" => wanted.program = Some(value()?.into()),
                _ => {
                    return Err(format!(
                        "{word}: --quick, --largest, --rows, --out or --program is needed"
                    ))
                }
            }
        }
        if wanted.largest == 0 {
            wanted.largest = if wanted.quick { 100_000 } else { 1_000_000 };
        }
        if wanted.quick && wanted.rows.is_none() {
            // The measured record that takes least.
            wanted.rows = Some(vec!["emps declared".to_owned()]);
        }
        Ok(wanted)
    }

    fn wants(&self, row: &str) -> bool {
        self.rows
            .as_ref()
            .is_none_or(|rows| rows.iter().any(|one| one == row))
    }
}

/// A case and its cost; what is being done goes to stderr, for it takes long.
fn run(program: &Program, series: &str, case: &Case) -> Result<(String, Outcome), String> {
    eprintln!("{series}: {}", case.label);
    Ok((case.label.clone(), program.close(&case.arguments)?))
}

fn measure(wanted: &Wanted, program: &Program, folder: &Path) -> Result<Measured, String> {
    let mut samples = Vec::new();
    for length in [10_000, 20_000, 100_000, 1_000_000, 10_000_000] {
        if length <= wanted.largest {
            let case = of_length(program, folder, length)?;
            samples.push(run(program, "samples", &case)?);
        }
    }
    let (angle_counts, most_planted) = match wanted.quick {
        true => (&ANGLES[..3], 1),
        false => (&ANGLES[..], PLANTED.len()),
    };
    let mut angles = Vec::new();
    for &count in angle_counts {
        let case = with_angles(program, folder, count)?;
        let (label, outcome) = run(program, "angles", &case)?;
        angles.push((label, table::candidates(&case)?, outcome));
    }
    let mut names = Vec::new();
    for count in 0..=most_planted {
        names.push(run(program, "names", &with_names(program, folder, count)?)?);
    }
    let (mut rows, mut missing) = (Vec::new(), Vec::new());
    for row in &ROWS {
        match measured(row) {
            _ if !wanted.wants(row.name) => missing.push(format!("{}: not asked for", row.name)),
            None => missing.push(format!("{}: skipped, {} is not there", row.name, row.file)),
            // Hours of other rows must not be lost with one.
            Some(case) => match run(program, "measured", &case) {
                Ok(done) => rows.push(done),
                Err(message) => missing.push(format!("{}: {message}", row.name)),
            },
        }
    }
    Ok(Measured {
        quick: wanted.quick,
        samples,
        angles,
        names,
        rows,
        missing,
        peers: peers(program, folder)?,
    })
}

/// The paper's method alone, in a process of its own: `--paper FILE.csv MOST`.
fn paper_alone(words: &[String]) -> Result<(), String> {
    let [path, most] = words else {
        return Err("--paper: a file and a number of evaluations are needed".to_owned());
    };
    let most = most
        .parse()
        .map_err(|_| format!("--paper: {most}: no number"))?;
    let record = bowden_lab::record::read(Path::new(path), &Default::default());
    let found = paper::identify(&record.map_err(|e| e.to_string())?, most);
    let text = serde_json::to_string(&found).map_err(|e| e.to_string())?;
    println!("{text}");
    Ok(())
}

/// The page with a text where its marks are, if it has them.
fn between_marks(page: &str, text: &str) -> Option<String> {
    let (open, close) = ("<!-- close -->\n", "<!-- end of close -->");
    let (before, rest) = page.split_once(open)?;
    let (_, after) = rest.split_once(close)?;
    Some(format!("{before}{open}{text}{close}{after}"))
}

fn report(wanted: &Wanted) -> Result<(), String> {
    let program = Program {
        path: wanted.program.clone().map_or_else(program::build, Ok)?,
        instrument: Instrument::of_this_machine(),
    };
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let measured = measure(wanted, &program, folder.path())?;
    let text = document(&measured, &limits(&measured), program.instrument);
    let page = std::fs::read_to_string(&wanted.out).unwrap_or_default();
    let text = between_marks(&page, &text).unwrap_or(text);
    std::fs::write(&wanted.out, text).map_err(|e| format!("{}: {e}", wanted.out.display()))?;
    eprintln!("{} is written", wanted.out.display());
    Ok(())
}

fn main() -> std::process::ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let done = match words.split_first() {
        Some((first, rest)) if first == "--paper" => paper_alone(rest),
        _ => Wanted::parse(words.into_iter()).and_then(|wanted| report(&wanted)),
    };
    match done {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("bench_report: {message}");
            std::process::ExitCode::from(2)
        }
    }
}
