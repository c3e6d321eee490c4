//! Closes the loop on the shared measured records and prints what was reached.
//!
//! `cargo run --release -p bowden-lab --example shared_records -- FOLDER [ROW…]`;
//! the folder holds one sub-folder a record (`emps/emps_estimation.csv`, …). Rows whose
//! file is absent are skipped and said so. After the ledgers comes a table: NRMSE of the
//! filtered output [%] on the fit segment / held out.
#![allow(clippy::unwrap_used)]

use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::intervals::term_name;
use bowden_lab::conclude::verdict::verdict;
use bowden_lab::export::hand_over::HandOver;
use bowden_lab::facts::{percent, Detail, Facts};
use bowden_lab::fit::Segments;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{read, Mode, Options};
use bowden_lab::search::{close, MOST_NAMES};
use std::path::{Path, PathBuf};

struct Row {
    name: &'static str,
    file: &'static str,
    mode: Mode,
    columns: (&'static str, &'static str),
    channels: &'static [(&'static str, &'static str)],
    declare: &'static [&'static str],
    skip: f64,
    until: Option<f64>,
    cutoff: f64,
    rate: Option<f64>,
    reach: (f64, f64),
}

const PLAIN: Row = Row {
    name: "",
    file: "",
    mode: Mode::Displacement,
    columns: ("", ""),
    channels: &[],
    declare: &["bouc-wen"],
    skip: 0.0,
    until: None,
    cutoff: 20.0,
    rate: None,
    reach: (0.0, 0.0),
};

const ROWS: &[Row] = &[
    Row {
        name: "emps plain",
        file: "emps/emps_estimation.csv",
        columns: ("q_m", "force_N"),
        reach: (5.0, 5.3),
        ..PLAIN
    },
    Row {
        name: "emps declared",
        file: "emps/emps_estimation.csv",
        columns: ("q_m", "force_N"),
        declare: &["inertia", "viscous", "coulomb", "offset"],
        reach: (2.9, 3.0),
        ..PLAIN
    },
    Row {
        name: "mr damper",
        file: "mr_damper_utfsm/sine_25mm0x25Hz0x5A.csv",
        columns: ("displacement_mm", "force_N"),
        reach: (7.3, 9.3),
        ..PLAIN
    },
    Row {
        name: "piezo full range",
        file: "piezo_stage/sine_1Hz_full_range.csv",
        columns: ("control_V", "displacement_um"),
        skip: 2.0,
        cutoff: 40.0,
        reach: (0.6, 0.9),
        ..PLAIN
    },
    Row {
        name: "piezo varying",
        file: "piezo_stage/sine_1Hz_varying_amplitude.csv",
        columns: ("control_V", "displacement_um"),
        skip: 2.0,
        cutoff: 40.0,
        reach: (1.6, 2.4),
        ..PLAIN
    },
    Row {
        name: "pneumatic kdn_3bar",
        file: "pneumatic_cylinder/kdn_3bar.csv",
        columns: ("position_mm", "force_N"),
        skip: 8.0,
        cutoff: 8.0,
        reach: (6.1, 6.8),
        ..PLAIN
    },
    Row {
        name: "faster",
        file: "faster_fatigue_rig/faster.csv",
        columns: ("displacement_mm", "force_norm"),
        cutoff: 25.0,
        rate: Some(128.0),
        reach: (2.4, 2.2),
        ..PLAIN
    },
    Row {
        name: "davinci 4_23",
        file: "davinci_cable_tool/tool4_l_4_23.csv",
        mode: Mode::Torque,
        columns: ("drive_torque_Nm", "jaw_torque_Nm"),
        channels: &[("phi_p", "drive_angle_rad"), ("phi_d", "jaw_angle_rad")],
        skip: 2.5,
        reach: (13.0, 13.5),
        ..PLAIN
    },
    Row {
        name: "davinci 4_03",
        file: "davinci_cable_tool/tool4_l_4_03.csv",
        mode: Mode::Torque,
        columns: ("drive_torque_Nm", "jaw_torque_Nm"),
        channels: &[("phi_p", "drive_angle_rad"), ("phi_d", "jaw_angle_rad")],
        skip: 2.5,
        reach: (12.0, 15.0),
        ..PLAIN
    },
    Row {
        name: "tribometer",
        file: "tribometer_friction/reciprocating_friction.csv",
        columns: ("position_mm", "friction_N"),
        skip: 20.0,
        until: Some(209.0),
        reach: (2.4, 3.8),
        ..PLAIN
    },
];

/// The rounds with their errors, the parameters, the sentence; `bowden close` prints it all.
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
    let own = |(a, b): &(&str, &str)| ((*a).to_owned(), (*b).to_owned());
    let options = Options {
        mode: Some(row.mode),
        time: Some("time_s".to_owned()),
        input: Some(row.columns.0.to_owned()),
        output: Some(row.columns.1.to_owned()),
        channels: row.channels.iter().map(own).collect(),
        skip: row.skip,
        until: row.until,
        rate: row.rate,
    };
    let record = read(path, &options).map_err(|e| e.to_string())?;
    let data = Prepared::new(
        &record,
        Preparation {
            cutoff: Some(row.cutoff),
        },
    )?;
    let list: Vec<String> = row.declare.iter().map(|s| (*s).to_owned()).collect();
    let started = std::time::Instant::now();
    let ledger = close(&data, &structure(&list, &data)?, |_| ())?;
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
    for row in ROWS
        .iter()
        .filter(|r| only.is_empty() || only.iter().any(|o| r.name.contains(o.as_str())))
    {
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
