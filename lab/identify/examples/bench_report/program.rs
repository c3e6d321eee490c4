//! Runs the program `bowden` on a record and reads what that cost.
//!
//! Seconds, memory and counts come from one run, user instructions from a second one under
//! an instrument. All runs have one thread: then instructions repeat to about 1e-4.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// What counts user instructions here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instrument {
    Perf,
    Cachegrind,
    Neither,
}

impl Instrument {
    /// The counter of the processor where it may be read, else a simulated processor.
    pub fn of_this_machine() -> Self {
        let counted = |one: &Self| one.count(Path::new("true"), &[]).is_some();
        [Self::Perf, Self::Cachegrind]
            .into_iter()
            .find(counted)
            .unwrap_or(Self::Neither)
    }

    pub fn words(self) -> &'static str {
        match self {
            Self::Perf => "User instructions are those of `perf stat -e instructions:u`.",
            Self::Cachegrind => {
                "User instructions are those of `valgrind --tool=cachegrind --cache-sim=no`."
            }
            Self::Neither => {
                "**No instructions were counted**: neither `perf stat` nor `valgrind` can count them on this machine."
            }
        }
    }

    /// User instructions of a command that succeeds, start of the process included.
    pub fn count(self, program: &Path, arguments: &[String]) -> Option<f64> {
        let file = tempfile::NamedTempFile::new().ok()?;
        let log = file.path();
        let mut command = match self {
            Self::Perf => {
                let mut perf = Command::new("perf");
                perf.args(["stat", "-x", ",", "-e", "instructions:u", "-o"]);
                perf.arg(log).arg("--");
                perf
            }
            Self::Cachegrind => {
                let mut valgrind = Command::new("valgrind");
                valgrind.args(["--tool=cachegrind", "--cache-sim=no"]);
                valgrind.arg("--cachegrind-out-file=/dev/null");
                valgrind.arg(format!("--log-file={}", log.display()));
                valgrind
            }
            Self::Neither => return None,
        };
        command.arg(program).args(arguments);
        command.env("RAYON_NUM_THREADS", "1");
        command.stdout(Stdio::null()).stderr(Stdio::null());
        if !command.status().ok()?.success() {
            return None;
        }
        let text = std::fs::read_to_string(log).ok()?;
        // perf: `1234,,instructions:u,…`; cachegrind: `==7== I refs:  1,234`.
        let number = |line: &str| -> Option<f64> {
            let digits = match self {
                Self::Perf => line.split(',').next()?.to_owned(),
                _ => line.split_once("refs:")?.1.replace(',', ""),
            };
            digits.trim().parse().ok()
        };
        text.lines().find_map(number)
    }
}

/// What one run of `identify` has cost, and what it has found.
#[derive(Debug, Clone, Default)]
pub struct Outcome {
    pub samples: f64,
    pub names: Vec<String>,
    pub verdict: String,
    pub evaluations: f64,
    pub jacobians: f64,
    pub columns: f64,
    pub searches: f64,
    /// Wall time of the whole process \[s\].
    pub seconds: f64,
    /// Share of the search in the stages' time.
    pub search_share: f64,
    /// User instructions, where they can be counted.
    pub instructions: Option<f64>,
    /// Largest resident memory \[B\], where the system tells.
    pub peak: Option<f64>,
}

impl Outcome {
    fn of(report: &Value) -> Option<Self> {
        let cost = &report["cost"];
        let count = |name: &str| cost[name].as_f64();
        let stages: Vec<f64> = cost["seconds"]
            .as_object()?
            .values()
            .filter_map(Value::as_f64)
            .collect();
        let rounds = report["rounds"].as_array()?;
        let name = |round: &Value| -> Option<String> { Some(round["effect"].as_str()?.to_owned()) };
        Some(Self {
            samples: report["record"]["samples"].as_f64()?,
            names: rounds.iter().filter_map(name).collect(),
            verdict: report["verdict"].as_str()?.to_owned(),
            evaluations: count("evaluations")?,
            jacobians: count("jacobians")?,
            columns: count("columns_filtered")?,
            searches: count("searches")?,
            search_share: cost["seconds"]["searching"].as_f64()? / stages.iter().sum::<f64>(),
            ..Self::default()
        })
    }

    /// Evaluations for each name; of a run without any, all of them.
    pub fn evaluations_a_name(&self) -> f64 {
        self.evaluations / self.names.len().max(1) as f64
    }
}

/// The program under test.
pub struct Program {
    pub path: PathBuf,
    pub instrument: Instrument,
}

impl Program {
    /// Runs a subcommand that only has to succeed.
    pub fn run(&self, arguments: &[String]) -> Result<(), String> {
        let output = Command::new(&self.path).args(arguments).output();
        let output = output.map_err(|e| format!("{}: {e}", self.path.display()))?;
        match output.status.success() {
            true => Ok(()),
            false => Err(String::from_utf8_lossy(&output.stderr).trim().to_owned()),
        }
    }

    /// `bowden identify ARGUMENTS --json`, once timed and once counted.
    pub fn close(&self, arguments: &[String]) -> Result<Outcome, String> {
        let mut all = vec!["close".to_owned()];
        all.extend_from_slice(arguments);
        all.push("--json".to_owned());
        let (stdout, seconds, peak) = timed(&self.path, &all)?;
        let report: Value = serde_json::from_str(&stdout).map_err(|e| e.to_string())?;
        let outcome = Outcome::of(&report).ok_or("the JSON of close has no cost")?;
        Ok(Outcome {
            seconds,
            peak,
            instructions: self.instrument.count(&self.path, &all),
            ..outcome
        })
    }
}

/// Builds the program as a user would, in the release profile.
pub fn build() -> Result<PathBuf, String> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .args(["build", "--release", "--bin", "bowden"])
        .args(["--message-format", "json-render-diagnostics"])
        .stderr(Stdio::inherit())
        .output()
        .map_err(|e| format!("cargo: {e}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let executable = |line: &str| -> Option<PathBuf> {
        let message: Value = serde_json::from_str(line).ok()?;
        Some(message["executable"].as_str()?.into())
    };
    let path = text.lines().filter_map(executable).next_back();
    path.ok_or_else(|| "the program bowden could not be built".to_owned())
}

/// Standard output, wall time \[s\] and largest resident memory \[B\] of a command.
pub fn timed(program: &Path, arguments: &[String]) -> Result<(String, f64, Option<f64>), String> {
    let named = |e: std::io::Error| format!("{}: {e}", program.display());
    let out = tempfile::NamedTempFile::new().map_err(named)?;
    let begun = Instant::now();
    let mut child = Command::new(program)
        .args(arguments)
        .env("RAYON_NUM_THREADS", "1")
        .stdout(out.reopen().map_err(named)?)
        .stderr(Stdio::piped())
        .spawn()
        .map_err(named)?;
    let mut peak: Option<f64> = None;
    let status = loop {
        peak = resident(child.id()).or(peak);
        if let Some(status) = child.try_wait().map_err(named)? {
            break status;
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let seconds = begun.elapsed().as_secs_f64();
    if !status.success() {
        let message = child.wait_with_output().map_err(named)?.stderr;
        return Err(String::from_utf8_lossy(&message).trim().to_owned());
    }
    let text = std::fs::read_to_string(out.path()).map_err(named)?;
    Ok((text, seconds, peak))
}

/// Largest resident memory of a running process so far \[B\]; Linux tells it.
fn resident(process: u32) -> Option<f64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(1024.0 * kilobytes)
}
