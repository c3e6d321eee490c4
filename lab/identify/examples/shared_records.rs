//! Closes the loop on the shared measured records and prints what was reached.
//!
//! `cargo run --release -p bowden-lab --example shared_records -- FOLDER [ROW…]`;
//! the folder holds one sub-folder a record (`emps/emps_estimation.csv`, …). Rows whose
//! file is absent are skipped and said so; those with a stretch are closed only where they are
//! named (`difference`, `sum`). After the ledgers comes a table: NRMSE of the
//! filtered output [%] on the fit segment / held out.
#![allow(clippy::unwrap_used)]

#[allow(dead_code)]
#[path = "../tests/shared/mod.rs"]
mod shared;

use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::intervals::term_name;
use bowden_lab::conclude::verdict::verdict;
use bowden_lab::export::hand_over::HandOver;
use bowden_lab::facts::{percent, Detail, Facts};
use bowden_lab::fit::Segments;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::search::{close, MOST_NAMES};
use shared::{Row, ROWS, STRETCHED};
use std::path::{Path, PathBuf};

/// The rounds with their errors, the parameters, the sentence; `bowden identify` prints it all.
fn print(facts: &Facts) {
    println!(
        "{}: declared {}",
        facts.label,
        facts.declared.effects.join(", ")
    );
    let step = |name: &str, rmse: &Segments| {
        let floors = |error: f64| facts.record.floors(error).unwrap_or(f64::NAN);
        println!(
            "  {name:<40} fit {:.5} ({:.1} floors), held out {:.5} ({:.1} floors)",
            rmse.fit,
            floors(rmse.fit),
            rmse.held_out,
            floors(rmse.held_out)
        );
    };
    step("as declared", &facts.declared.rmse);
    for round in &facts.rounds {
        step(
            &format!("+ {} ({:?})", round.title, round.grade),
            &round.after,
        );
    }
    step("as delivered", &facts.last.rmse);
    for (title, parameter) in facts.last.titles.iter().zip(&facts.last.parameters) {
        println!("    {title} = {} {:?}", parameter.value, parameter.ci95);
    }
    let (before, after) = (&facts.declared.nrmse, &facts.last.nrmse);
    println!(
        "  held out {} -> {}; {}: {}\n",
        percent(before.held_out),
        percent(after.held_out),
        facts.verdict.name(),
        facts.sentence
    );
}

/// Closes one record; returns the row of the summary table.
fn run(row: &Row, path: &Path) -> Result<String, String> {
    let asked = row.asked();
    let record = asked.read(path)?;
    let cutoff = asked.cutoff;
    let data = Prepared::new(&record, Preparation { cutoff })?;
    let declared = structure(&asked.declare, &data)?;
    let started = std::time::Instant::now();
    let ledger = close(&data, &declared, |_| ())?;
    let done = FinalFit::new(&data, &ledger);
    let seconds = started.elapsed().as_secs_f64();
    let hand = HandOver::new(&[record], &data, &ledger, &done, false, |_| ());
    let hand = hand.as_ref().map_err(String::as_str);
    let facts = Facts::new(row.name, &data, &ledger, &done, hand, Detail::Ledger);
    print(&facts);
    let percent = |s: &Segments| {
        let n = s.normalised(&data, &data.target);
        (100.0 * n.fit, 100.0 * n.held_out)
    };
    let (before, after) = (percent(&ledger.declared.rmse), percent(&done.rmse));
    let names: Vec<String> = ledger
        .rounds
        .iter()
        .map(|r| term_name(&data, &r.candidate.term))
        .collect();
    let mut gates: Vec<&str> = ledger.rejected.iter().map(|r| r.gate.words()).collect();
    gates.sort_unstable();
    gates.dedup();
    let stopped = match (ledger.rounds.len() >= MOST_NAMES, gates.is_empty()) {
        (true, _) => "eight rounds".to_owned(),
        (false, true) => "no candidate left".to_owned(),
        (false, false) => gates.join("; "),
    };
    let met = if after.0 <= row.reach.0 && after.1 <= row.reach.1 {
        "yes"
    } else {
        "**no**"
    };
    Ok(format!(
        "| {} | {:.1} / {:.1} | {:.2} / {:.2} | {} / {} | {met} | {} | {} | {stopped} | {seconds:.1} s |",
        row.name,
        before.0,
        before.1,
        after.0,
        after.1,
        row.reach.0,
        row.reach.1,
        names.join(", "),
        verdict(&data, &ledger, &done).name()
    ))
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let Some(folder) = arguments.next().map(PathBuf::from) else {
        println!("give the folder of the records");
        return;
    };
    let only: Vec<String> = arguments.collect();
    let mut lines = Vec::new();
    let named = |row: &&Row| only.iter().any(|o| row.name.contains(o.as_str()));
    let stretched = STRETCHED.iter().filter(named);
    let rows = ROWS.iter().filter(|row| only.is_empty() || named(row));
    for row in rows.chain(stretched) {
        let path = folder.join(row.file);
        if !path.exists() {
            println!("{}: skipped, {} is not there", row.name, path.display());
            continue;
        }
        match run(row, &path) {
            Ok(line) => lines.push(line),
            Err(message) => lines.push(format!("| {} | {message} |", row.name)),
        }
    }
    println!("| record | declared | reached | to reach | met | added, in order | verdict | what stopped it | time |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for line in lines {
        println!("{line}");
    }
}
