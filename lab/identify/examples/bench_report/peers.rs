//! Others on the same record: the paper's method, and SciPy where there is a Python with it.

use crate::cases::{generated, repository};
use crate::program::{timed, Outcome, Program};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// The record of the bare command; and the same one with nothing that a peer could not fit.
const RECORDS: [(&str, &str); 2] = [
    (
        "a viscous term that the baseline lacks",
        "--mode torque --effect viscous --seed 7",
    ),
    ("nothing that the baseline lacks", "--mode torque --seed 7"),
];

/// Samples of which SciPy is given the mean: 200 Hz are enough for tones of 1 Hz, and
/// Python's loop takes hours for more.
const THIN: &str = "5";

/// One method on one record.
pub struct Peer {
    pub method: &'static str,
    pub record: &'static str,
    pub samples: f64,
    pub evaluations: f64,
    pub seconds: f64,
    pub instructions: Option<f64>,
    /// Names and error as far as the method has them.
    pub reached: String,
}

/// What was run, and why something was not.
pub type Peers = (Vec<Peer>, Vec<String>);

/// All methods on both records.
pub fn peers(program: &Program, folder: &Path) -> Result<Peers, String> {
    let (mut all, mut notes) = (Vec::new(), Vec::new());
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has_scipy = Command::new(&python)
        .args(["-c", "import scipy.optimize"])
        .output()
        .is_ok_and(|o| o.status.success());
    if !has_scipy {
        notes.push(format!(
            "SciPy: skipped, `{python}` cannot import it (PYTHON names another interpreter)"
        ));
    }
    for (record, recipe) in RECORDS {
        let path = generated(program, folder, "peers.csv", recipe)?;
        eprintln!("peers: {record}: close");
        let outcome = program.close(&[path.display().to_string()])?;
        all.push(close(record, outcome));
        eprintln!("peers: {record}: the paper's method");
        all.push(paper(program, record, &path)?);
        if has_scipy {
            eprintln!("peers: {record}: SciPy");
            match scipy(&python, record, &path) {
                Ok(peer) => all.push(peer),
                Err(message) => notes.push(format!("SciPy: {message}")),
            }
        }
    }
    Ok((all, notes))
}

fn close(record: &'static str, outcome: Outcome) -> Peer {
    let named = match outcome.names.is_empty() {
        true => "nothing named".to_owned(),
        false => format!("named {}", outcome.names.join(", ")),
    };
    Peer {
        method: "`bowden identify`",
        record,
        samples: outcome.samples,
        evaluations: outcome.evaluations,
        seconds: outcome.seconds,
        instructions: outcome.instructions,
        reached: format!("{named}; {}", outcome.verdict),
    }
}

fn number(report: &Value, name: &str) -> Result<f64, String> {
    let value = report[name].as_f64();
    value.ok_or_else(|| format!("a peer did not print {name}"))
}

fn peer(
    method: &'static str,
    record: &'static str,
    (stdout, seconds): (&str, f64),
) -> Result<Peer, String> {
    let report: Value = serde_json::from_str(stdout).map_err(|e| e.to_string())?;
    let of = |name: &str| number(&report, name);
    Ok(Peer {
        method,
        record,
        samples: of("samples")?,
        evaluations: of("evaluations")?,
        seconds,
        instructions: None,
        reached: format!(
            "RMSE {:.4}; rho {:.3}, sigma {:.2}, n {:.3}",
            of("rmse")?,
            of("rho")?,
            of("sigma")?,
            of("n")?
        ),
    })
}

/// Evaluations of the two runs from which the price of one is told.
const FEW: usize = 100;
const MORE: usize = 200;

fn paper(program: &Program, record: &'static str, path: &Path) -> Result<Peer, String> {
    let own = std::env::current_exe().map_err(|e| e.to_string())?;
    let arguments = |most: usize| -> Vec<String> {
        let path = path.display().to_string();
        vec!["--paper".to_owned(), path, most.to_string()]
    };
    let (stdout, seconds, _) = timed(&own, &arguments(usize::MAX))?;
    let whole = peer(
        "the paper's: genetic, then Nelder-Mead",
        record,
        (&stdout, seconds),
    )?;
    // Each evaluation takes the same instructions but for its powers, and under an
    // instrument all of them would take an hour.
    let count = |most: usize| -> Option<(f64, f64)> {
        let counted = program.instrument.count(&own, &arguments(most))?;
        let (stdout, ..) = timed(&own, &arguments(most)).ok()?;
        let report: Value = serde_json::from_str(&stdout).ok()?;
        Some((report["evaluations"].as_f64()?, counted))
    };
    let instructions = count(FEW).zip(count(MORE)).map(|((n, few), (m, more))| {
        let each = (more - few) / (m - n);
        few + each * (whole.evaluations - n)
    });
    Ok(Peer {
        instructions,
        ..whole
    })
}

fn scipy(python: &str, record: &'static str, path: &Path) -> Result<Peer, String> {
    let script = repository().join("benches/peers/bouc_wen_scipy.py");
    let path = path.display().to_string();
    let arguments = [
        script.display().to_string(),
        path,
        "--thin".to_owned(),
        THIN.to_owned(),
    ];
    let (stdout, seconds, _) = timed(Path::new(python), &arguments)?;
    peer(
        "SciPy: differential evolution, then least squares",
        record,
        (&stdout, seconds),
    )
}
