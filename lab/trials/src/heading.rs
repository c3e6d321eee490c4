//! The conditions of a comparison.

use super::decimal::places;
use super::gains::GainsFile;
use super::lineup::Laws;
use super::own_rig::RigChanges;
use super::setup::Setup;
use bowden_rig::{Drift, Reference, RigConfig};
use std::path::Path;

/// The conditions of the trials.
#[derive(Debug, Clone, PartialEq)]
pub struct Heading {
    /// White noise of the sensor \[N·m rms\].
    pub noise: f64,
    /// Whether the conduit moves.
    pub varying: bool,
    /// Length of a trial \[s\].
    pub seconds: f64,
    /// Start of the time over which errors are computed \[s\].
    pub from: f64,
    /// Length of the transient \[s\].
    pub transient: f64,
    /// Number of trials.
    pub seeds: usize,
    /// The changes that made the model of `--model` invertible, if any.
    pub fed_with: Option<String>,
    /// The file of the model whose transmission the rig has, without folders; `None` for the
    /// reference rig.
    pub model: Option<String>,
    /// The file of gains from `bowden design`, without folders; `None` for the paper's gains.
    pub gains: Option<String>,
    /// The file of the model that these gains were designed for, without folders.
    pub designed_model: Option<String>,
    /// The drive gain that these gains were designed for \[N·m/unit\].
    pub designed_drive_gain: Option<f64>,
    /// The file of gains and rig, without folders, if there is one.
    pub setup: Option<String>,
    /// The rig's drive gain \[N·m/unit\].
    pub drive_gain: f64,
    /// The parameters of the rig that were given as options.
    pub rig: RigChanges,
    /// Whether the reference is a gait instead of the paper's.
    pub gait: bool,
    /// Range of the reference \[N·m\], if it is shifted or scaled.
    pub reference: Option<[f64; 2]>,
    /// True error that the lag of the sensor causes for a law with zero measured error \[N·m rms\].
    pub lag_error: f64,
    /// Whether rig, gains and reference are those of the paper's experiment, with any noise.
    pub is_paper: bool,
}

impl Heading {
    /// One sentence on each condition that the user has changed, except for the model: gains,
    /// reference, parameters of the rig.
    #[must_use]
    pub fn own(&self) -> Vec<String> {
        let mut all = Vec::new();
        if let Some(setup) = &self.setup {
            all.push(format!("Gains and rig: from {setup}."));
        }
        if let Some(gains) = &self.gains {
            let of_another = self.designed_model.as_ref().filter(|of| {
                let differs = |own: &String| own != *of;
                self.model.as_ref().is_some_and(differs)
            });
            all.push(match of_another {
                None => format!("Gains: from {gains}."),
                Some(other) => {
                    format!("Gains: from {gains}, designed for {other} and not for this model.")
                }
            });
        }
        if let Some(designed) = self.designed_drive_gain {
            let own = self.drive_gain;
            #[allow(clippy::float_cmp)] // Copied, or typed: no arithmetic stands between.
            all.push(match own == designed {
                true => format!("Drive gain: {own} N·m/unit, as in the design of the gains."),
                false => format!(
                    "Drive gain: {own} N·m/unit, but the gains were designed for {designed} N·m/unit."
                ),
            });
        }
        if let Some([low, high]) = self.reference {
            let places = places(low.abs().max(high.abs()), 2);
            all.push(format!(
                "Reference: {} between {low:.places$} and {high:.places$} N·m, within the range of the model's record.",
                match self.gait {
                    true => "one push-off per second,",
                    false => "as in Nguyen et al. (2018),",
                }
            ));
        }
        if self.gait && self.reference.is_none() {
            all.push("Reference: 5 N·m, plus a push-off of 30 N·m once per second.".to_owned());
        }
        if self.gait {
            let error = self.lag_error;
            all.push(format!(
                "Even if the measured error is zero, the lag of the torque sensor causes a true error of {error:.3} N·m rms."
            ));
        }
        let rig = &self.rig;
        let given = [
            ("drive gain", rig.drive_gain, "N·m/unit"),
            ("inertia", rig.motor_inertia, "kg·m²"),
            ("damping", rig.motor_damping, "N·m·s/rad"),
            ("joint inertia", rig.joint_inertia, "kg·m²"),
            ("joint damping", rig.joint_damping, "N·m·s/rad"),
            ("spring", rig.load_stiffness, "N·m/rad"),
            ("drive lag", rig.drive_lag, "s"),
            ("sensor lag", rig.sensor_lag, "s"),
            ("delay", rig.delay.map(f64::from), "samples"),
        ];
        let given: Vec<String> = given
            .iter()
            .filter_map(|(name, value, unit)| Some(format!("{name} {} {unit}", (*value)?)))
            .collect();
        if !given.is_empty() {
            all.push(format!("Rig: {}.", given.join(", ")));
        }
        all
    }

    /// Mean and standard deviation of a controller in Table 3 of the paper \[N·m\], if rig and
    /// gains are the paper's and the table has a row for the controller.
    #[must_use]
    pub fn paper(&self, controller: &str) -> Option<[f64; 2]> {
        let row = PAPER.iter().find(|row| row.0 == controller)?;
        let row = if self.varying { row.2 } else { row.1 };
        self.is_paper.then_some(row)
    }
}

/// Table 3 of the paper: mean and standard deviation, fixed and varying \[N·m\].
const PAPER: [(&str, [f64; 2], [f64; 2]); 4] = [
    ("pi", [0.5991, 0.0154], [0.6034, 0.0182]),
    ("pid", [0.6093, 0.0164], [0.6139, 0.0153]),
    ("piv", [0.5320, 0.0134], [0.5323, 0.0186]),
    ("adaptive", [0.3027, 0.0081], [0.3195, 0.0120]),
];

/// Rms of the rate of the reference over a part of a trial, times the lag of the sensor \[s\].
pub(super) fn lag_error(reference: &Reference<f64>, lag: f64, (from, to): (f64, f64)) -> f64 {
    let steps = 1000.0 * (to - from).max(0.0);
    let times = (0..steps as usize).map(|k| from + k as f64 * 1e-3);
    let squares = times.map(|t| reference.motion(t).velocity.powi(2));
    lag * (squares.sum::<f64>() / steps.max(1.0)).sqrt()
}

/// Whether rig and gains of a setup are those of Table 3. The noise may differ, because a
/// comparison without noise is also shown next to the paper's values.
pub(super) fn is_paper(setup: &Setup) -> bool {
    let paper = Setup::default();
    let drift = setup.rig.drift;
    let rig = RigConfig {
        noise: paper.rig.noise,
        input_noise: paper.rig.input_noise,
        drift: None,
        ..setup.rig
    };
    let laws = |setup: &Setup| {
        let laws = Laws::new(setup).ok()?;
        Some([laws.pi, laws.pid, laws.piv, laws.matched_pi].map(|law| *law.settings()))
    };
    rig == paper.rig
        && drift.is_none_or(|drift| drift == Drift::reference())
        && laws(setup) == laws(&paper)
        && setup.adaptive == paper.adaptive
}

/// Sets the drive gain to that of the gains file if the options of the rig do not specify a drive
/// gain.
pub(super) fn with_drive_gain(rig: RigChanges, gains: Option<&GainsFile>) -> RigChanges {
    let designed = gains.map(|gains| gains.design.drive_gain);
    RigChanges {
        drive_gain: rig.drive_gain.or(designed),
        ..rig
    }
}

/// A file's name without folders.
pub(super) fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(
        || path.display().to_string(),
        |n| n.to_string_lossy().into_owned(),
    )
}
