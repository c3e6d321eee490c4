//! Measured records through both methods: fit and held-out error, names, cost.

use crate::planted::{cost, usual};
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::ledger::Ledger;
use bowden_lab::model::declared::structure;
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::intervals::term_name;
use bowden_lab::record::{read, Mode, Options};
use bowden_lab::search;
use std::path::Path;

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
    /// NRMSE to reach on the fit and held-out segments [%].
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

const PIEZO: Row = Row {
    columns: ("control_V", "displacement_um"),
    skip: 2.0,
    cutoff: 40.0,
    ..PLAIN
};

const DAVINCI: Row = Row {
    mode: Mode::Torque,
    columns: ("drive_torque_Nm", "jaw_torque_Nm"),
    channels: &[("phi_p", "drive_angle_rad"), ("phi_d", "jaw_angle_rad")],
    skip: 2.5,
    ..PLAIN
};

const EMPS: Row = Row {
    file: "emps/emps_estimation.csv",
    columns: ("q_m", "force_N"),
    ..PLAIN
};

const ROWS: &[Row] = &[
    Row {
        name: "emps plain",
        reach: (5.0, 5.3),
        ..EMPS
    },
    Row {
        name: "emps declared",
        declare: &["inertia", "viscous", "coulomb", "offset"],
        reach: (2.9, 3.0),
        ..EMPS
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
        reach: (0.6, 0.9),
        ..PIEZO
    },
    Row {
        name: "piezo varying",
        file: "piezo_stage/sine_1Hz_varying_amplitude.csv",
        reach: (1.6, 2.4),
        ..PIEZO
    },
    Row {
        name: "pneumatic",
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
        reach: (13.0, 13.5),
        ..DAVINCI
    },
    Row {
        name: "davinci 4_03",
        file: "davinci_cable_tool/tool4_l_4_03.csv",
        reach: (12.0, 15.0),
        ..DAVINCI
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

fn prepared(row: &Row, path: &Path) -> Result<Prepared, String> {
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
    let cutoff = Some(row.cutoff);
    Prepared::new(&record, Preparation { cutoff })
}

fn line(row: &Row, method: &str, data: &Prepared, made: (Result<Ledger, String>, f64, f64)) {
    let (ledger, seconds, evaluations) = made;
    let ledger = match ledger {
        Ok(ledger) => ledger,
        Err(message) => return println!("{:18} {method}: {message}", row.name),
    };
    let done = FinalFit::new(data, &ledger);
    let share = done.rmse.normalised(data, &data.target);
    let (fit, held_out) = (100.0 * share.fit, 100.0 * share.held_out);
    let is_met = fit <= row.reach.0 && held_out <= row.reach.1;
    let names: Vec<String> = ledger
        .rounds
        .iter()
        .map(|r| format!("{}({})", term_name(data, &r.candidate.term), r.rivals.len()))
        .collect();
    let unknown = ledger.unknown.as_ref().map(|u| u.variable.name(data));
    println!(
        "{:18} {method:10} {fit:6.2} / {held_out:6.2} {} CPU {seconds:7.2} s {evaluations:6.0} evals: {} {}",
        row.name,
        if is_met { "met    " } else { "NOT met" },
        names.join(", "),
        unknown.map_or_else(String::new, |v| format!("unknown: {v}"))
    );
}

/// All rows whose file is there, or those that are named.
pub fn all(folder: &str, only: &[String]) {
    println!("\nmeasured records: NRMSE of the final model, fit / held out [%]");
    let chosen = |r: &&Row| only.is_empty() || only.iter().any(|o| r.name.contains(o.as_str()));
    for row in ROWS.iter().filter(chosen) {
        let path = Path::new(folder).join(row.file);
        if !path.exists() {
            println!("{}: skipped, {} is not there", row.name, path.display());
            continue;
        }
        let list: Vec<String> = row.declare.iter().map(|s| (*s).to_owned()).collect();
        let ready = prepared(row, &path).and_then(|d| Ok((structure(&list, &d)?, d)));
        match ready {
            Ok((declared, data)) => {
                let one = cost(|| search::close(&data, &declared, |_| ()));
                line(row, "one search", &data, one);
                let usual = cost(|| usual(&data, &declared));
                line(row, "loop", &data, usual);
            }
            Err(message) => println!("{}: {message}", row.name),
        }
    }
}
