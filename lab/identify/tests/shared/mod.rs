//! The records that others measured: where they are, and how each is read.
//!
//! They are not part of the project. `BOWDEN_SHARED_RECORDS` names their folder; without it
//! the folder is `../../../shared/data`, seen from this package. A record that is absent is
//! skipped, and a line on stdout says so.

use bowden_lab::facts::Asked;
use bowden_lab::record::{Mode, Options, Record};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use std::path::PathBuf;

/// A record, how it is read, and what is declared of it.
#[derive(Clone, Copy)]
pub struct Row {
    pub name: &'static str,
    /// Below the folder of the records.
    pub file: &'static str,
    pub mode: Mode,
    /// Input and output; the time is `time_s` in all of them.
    pub columns: (&'static str, &'static str),
    pub channels: &'static [(&'static str, &'static str)],
    pub declare: &'static [&'static str],
    pub skip: f64,
    pub until: Option<f64>,
    pub cutoff: f64,
    pub rate: Option<f64>,
    /// NRMSE of the filtered output to reach on the fit and held-out segments \[%\]: what a
    /// prototype of the method reached, plus 15 to 20 %.
    pub reach: (f64, f64),
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

pub const EMPS: Row = Row {
    name: "emps plain",
    file: "emps/emps_estimation.csv",
    columns: ("q_m", "force_N"),
    reach: (5.0, 5.3),
    ..PLAIN
};

/// With the model that its authors published.
pub const EMPS_DECLARED: Row = Row {
    name: "emps declared",
    declare: &["inertia", "viscous", "coulomb", "offset"],
    reach: (2.9, 3.0),
    ..EMPS
};

pub const DAMPER: Row = Row {
    name: "mr damper",
    file: "mr_damper_utfsm/sine_25mm0x25Hz0x5A.csv",
    columns: ("displacement_mm", "force_N"),
    reach: (7.3, 9.3),
    ..PLAIN
};

pub const PIEZO_FULL: Row = Row {
    name: "piezo full range",
    file: "piezo_stage/sine_1Hz_full_range.csv",
    columns: ("control_V", "displacement_um"),
    skip: 2.0,
    cutoff: 40.0,
    reach: (0.6, 0.9),
    ..PLAIN
};

pub const PIEZO_VARYING: Row = Row {
    name: "piezo varying",
    file: "piezo_stage/sine_1Hz_varying_amplitude.csv",
    reach: (1.6, 2.4),
    ..PIEZO_FULL
};

pub const PNEUMATIC: Row = Row {
    name: "pneumatic kdn_3bar",
    file: "pneumatic_cylinder/kdn_3bar.csv",
    columns: ("position_mm", "force_N"),
    skip: 8.0,
    cutoff: 8.0,
    reach: (6.1, 6.8),
    ..PLAIN
};

/// Its time column is rounded, so that the rate has to be given.
pub const FATIGUE: Row = Row {
    name: "faster",
    file: "faster_fatigue_rig/faster.csv",
    columns: ("displacement_mm", "force_norm"),
    cutoff: 25.0,
    rate: Some(128.0),
    reach: (2.4, 2.2),
    ..PLAIN
};

pub const DAVINCI_23: Row = Row {
    name: "davinci 4_23",
    file: "davinci_cable_tool/tool4_l_4_23.csv",
    mode: Mode::Torque,
    columns: ("drive_torque_Nm", "jaw_torque_Nm"),
    channels: &[("phi_p", "drive_angle_rad"), ("phi_d", "jaw_angle_rad")],
    skip: 2.5,
    reach: (13.0, 13.5),
    ..PLAIN
};

pub const DAVINCI_03: Row = Row {
    name: "davinci 4_03",
    file: "davinci_cable_tool/tool4_l_4_03.csv",
    reach: (12.0, 15.0),
    ..DAVINCI_23
};

pub const TRIBOMETER: Row = Row {
    name: "tribometer",
    file: "tribometer_friction/reciprocating_friction.csv",
    columns: ("position_mm", "friction_N"),
    skip: 20.0,
    until: Some(209.0),
    reach: (2.4, 3.8),
    ..PLAIN
};

/// The ten rows of `docs/results/measured.md`.
pub const ROWS: [Row; 10] = [
    EMPS,
    EMPS_DECLARED,
    DAMPER,
    PIEZO_FULL,
    PIEZO_VARYING,
    PNEUMATIC,
    FATIGUE,
    DAVINCI_23,
    DAVINCI_03,
    TRIBOMETER,
];

/// The da Vinci rows with a stretch, for the example alone. Drive and jaw turn against each
/// other there, so that the sum is the stretch, and the difference an angle.
pub const STRETCHED: [Row; 4] = [
    stretched(DAVINCI_23, "davinci 4_23 difference", DIFFERENCE),
    stretched(DAVINCI_23, "davinci 4_23 sum", SUM),
    stretched(DAVINCI_03, "davinci 4_03 difference", DIFFERENCE),
    stretched(DAVINCI_03, "davinci 4_03 sum", SUM),
];

type Channels = &'static [(&'static str, &'static str)];

const DIFFERENCE: Channels = &[
    ("phi_p", "drive_angle_rad"),
    ("phi_d", "jaw_angle_rad"),
    ("stretch", "phi_p-phi_d"),
];
const SUM: Channels = &[
    ("phi_p", "drive_angle_rad"),
    ("phi_d", "jaw_angle_rad"),
    ("stretch", "phi_p+phi_d"),
];

const fn stretched(row: Row, name: &'static str, channels: Channels) -> Row {
    Row {
        name,
        channels,
        ..row
    }
}

/// The folder of the records.
pub fn folder() -> PathBuf {
    std::env::var_os("BOWDEN_SHARED_RECORDS").map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")),
        PathBuf::from,
    )
}

impl Row {
    /// Another record of the same rig, read in the same way.
    pub fn of_file(self, file: &'static str) -> Self {
        Self { file, ..self }
    }

    /// Where the record is; `None`, and a line on stdout, where it is absent.
    pub fn path(&self) -> Option<PathBuf> {
        let path = folder().join(self.file);
        if !path.exists() {
            println!("skipped: {} is not there", path.display());
            return None;
        }
        Some(path)
    }

    /// What `bowden identify` would be asked.
    pub fn asked(&self) -> Asked {
        let own = |(a, b): &(&str, &str)| ((*a).to_owned(), (*b).to_owned());
        Asked {
            options: Options {
                mode: Some(self.mode),
                time: Some("time_s".to_owned()),
                input: Some(self.columns.0.to_owned()),
                output: Some(self.columns.1.to_owned()),
                channels: self.channels.iter().map(own).collect(),
                skip: self.skip,
                until: self.until,
                rate: self.rate,
                ..Options::default()
            },
            cutoff: Some(self.cutoff),
            declare: self.declare.iter().map(|&name| name.to_owned()).collect(),
            ..Asked::default()
        }
    }

    /// The same as options of the program.
    pub fn options(&self) -> Vec<String> {
        let mut all = vec![
            ("mode", self.mode.name().to_owned()),
            ("time", "time_s".to_owned()),
            ("input", self.columns.0.to_owned()),
            ("output", self.columns.1.to_owned()),
        ];
        let channels = self.channels.iter();
        all.extend(channels.map(|(name, column)| ("channel", format!("{name}={column}"))));
        all.push(("cutoff", self.cutoff.to_string()));
        all.push(("skip", self.skip.to_string()));
        all.extend(self.until.map(|s| ("until", s.to_string())));
        all.extend(self.rate.map(|hz| ("rate", hz.to_string())));
        all.push(("declare", self.declare.join(",")));
        let words = |(name, value)| [format!("--{name}"), value];
        all.into_iter().flat_map(words).collect()
    }
}

/// Standard deviation of the noise of a copy, in multiples of the largest output.
const SIZE: f64 = 1e-9;

/// A copy with white noise added to its output, far below what any sensor resolves.
pub fn disturbed(record: &Record, seed: u64) -> Record {
    let mut copy = record.clone();
    let values = &mut copy.output.values;
    let largest = values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let noise = Normal::new(0.0, SIZE * largest).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    values.iter_mut().for_each(|v| *v += noise.sample(&mut rng));
    copy
}
