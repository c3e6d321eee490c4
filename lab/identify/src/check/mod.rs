//! Does a model still hold on the next record of the same rig?
//!
//! Nothing is refitted: the model of a file runs on a record that was not used to fit it, with the
//! filter of its fit. Then only a gain and an offset are fitted. Both errors are compared with the
//! error of the model on the held-out part of its own record.
//!
//! **What counts.** There is no fit segment, because nothing is fitted to the record. The motion
//! before the record is unknown: the hysteresis starts at eta = 0, and effects with memory start at
//! rest. As for a file that `identify` holds out as a whole, samples count only after the input has
//! covered its half-range four times (at most a quarter of the record). Estimating eta(0) instead
//! would be a refit. The model also runs from eta = −1 and from eta = 1, to measure the influence
//! of the unknown state.
//!
//! **The rule.** A model *holds* if its error is at most the largest of three values:
//!
//! * [`HOLDS`] times the held-out error that it came with, both as shares of the output's standard
//!   deviation, but at most [`NOTHING`] of the deviation: above this share a model explains less
//!   than half of the output's variance;
//! * [`HOLDS`] times that error in the output's unit, but at most [`POOR`] of the deviation: a
//!   record that moves less makes the same error a larger share;
//! * [`NOISE`] times the noise floor of this record, because noise is not an error of the model.

mod findings;
mod given;
mod logged;
mod play;

use crate::alteration::Suspicion;
use crate::conclude::line::Line;
use crate::conclude::numbers::share as percent;
use crate::conclude::trace::{csv, input, parts, Column};
use crate::conclude::verdict::POOR;
use crate::export::invertible::three_digits;
use crate::fit::Solution;
use crate::problem::{Prepared, Stretch};
use crate::record::{to_unit, Defect, Record};
use crate::scale::{HALF, NOISE, QUARTER};
use crate::score::dependences::{dependences, Dependence};
pub use crate::score::ranges::Outside;
use crate::score::ranges::{beyond, ACCELERATION, POSITION, VELOCITY};
pub(crate) use findings::summary;
pub use given::{one_line, About, Errors, Given, Seen};
use play::{Before, Played};

/// A model holds up to this multiple of its own held-out error. That error is measured on a quarter
/// of a record and therefore scatters: on pairs of generated records of one rig, the error of a
/// correct model on the next record is between 0.6 and 1.9 times as large (`--test ways
/// calibration`).
pub const HOLDS: f64 = 2.0;
/// From this share of the output's standard deviation on a model explains less than half of the
/// output's variance, as one whose verdict is `no-input-dependence`.
pub const NOTHING: f64 = 0.7;
/// The unknown state before the record is mentioned from this share of the error on.
const MATTERS: f64 = 0.2;

/// The verdict of a validation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The error is comparable to that on the model's own record, or is noise.
    Holds,
    /// The model holds only with another gain and offset, which account for most of the error.
    GainOrOffsetMoved,
    /// The model does not hold with any gain and offset.
    DoesNotHold,
    /// The expected error is unknown, or the record cannot test the model.
    CannotTell,
    /// The measurement is defective.
    DefectiveRecord,
}

impl Verdict {
    /// The name in the JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::GainOrOffsetMoved => "gain-or-offset-moved",
            Self::DoesNotHold => "does-not-hold",
            Self::CannotTell => "cannot-tell",
            Self::DefectiveRecord => "defective-record",
        }
    }
}

/// A model on a record that it was not fitted to.
#[derive(Debug, Clone)]
pub struct Check {
    /// The record; its fit segment contains the samples that count.
    pub data: Prepared,
    /// The model on it.
    pub model: Solution,
    /// Gain and offset of its prediction.
    pub line: Line,
    /// Standard deviation of the filtered output, in its unit.
    pub deviation: f64,
    /// Rms error without gain and offset, in the output's unit.
    pub rmse: f64,
    /// Rms error with the fitted gain and offset.
    pub rmse_gain_offset: f64,
    /// Mean of the error without gain and offset: a changed offset.
    pub mean: f64,
    /// Rms error up to which the model holds; `None` if its file states no held-out error and the
    /// noise floor is unknown.
    pub allowed: Option<f64>,
    /// The statements of the model file about its record.
    pub about: About,
    /// The ranges in which this record exceeds the model's own record.
    pub outside: Vec<Outside>,
    /// The variables that the residual after gain and offset depends on, if the model does not
    /// hold.
    pub depends_on: Vec<Dependence>,
    /// A suspected logging error; once it is corrected, the model holds.
    pub suspicion: Option<Suspicion>,
    /// Largest rms change of the prediction by the state before the record, for states within the
    /// range of the record.
    pub start: f64,
    /// Standard deviation of the part of the prediction that depends on the input; `None` if it
    /// cannot be computed.
    pub made_of_input: Option<f64>,
    /// Severe defects of the columns that the model reads.
    pub spoilt: Vec<Defect>,
    /// Seconds at the start that are excluded.
    pub left_out: f64,
    /// The verdict.
    pub verdict: Verdict,
}

impl Check {
    /// Validates a model on a record, at the model's own cut-off unless another one is given
    /// \[Hz\].
    ///
    /// # Errors
    /// A message if the record lacks a channel that the model reads, if a unit cannot be converted,
    /// or if the record is too short.
    pub fn new(mut record: Record, given: &Given, cutoff: Option<f64>) -> Result<Self, String> {
        if record.mode != given.mode()? {
            return Err(format!(
                "the model is in {} mode, but the record is not",
                given.file.mode
            ));
        }
        if let Some(name) = given
            .reads()
            .iter()
            .find(|name| record.channel(name).is_none())
        {
            return Err(play::missing(given, name));
        }
        convert(&mut record, given)?;
        let mut played = Played::of(&record, given, cutoff)?;
        played.data.notes.extend(remarks(given, cutoff));
        let mut check = Self::judged(played, given)?;
        if check.verdict == Verdict::DoesNotHold {
            check.suspicion = check.suspicion(&record, given, cutoff);
        }
        Ok(check)
    }

    fn judged(played: Played, given: &Given) -> Result<Self, String> {
        let (deviation, mean) = (played.deviation(), played.mean(&played.model.residual));
        let Played { data, model, from } = played;
        let rms = |signal: &[f64]| play::rms(&data, signal, 0.0);
        let line = Line::fit(&data, &model.prediction);
        let moved = line.of(&model.prediction);
        let residual: Vec<f64> = data.target.iter().zip(&moved).map(|(y, p)| y - p).collect();
        // As far as the record itself takes it: with a small rho it never comes near 1.
        let most = model
            .eta
            .iter()
            .fold(0.0, |most: f64, eta| eta.abs().max(most));
        let mut start: f64 = 0.0;
        let ends = [(-most, Before::Low), (most, Before::High)];
        for (eta0, before) in ends.into_iter().filter(|_| play::remembers(&model)) {
            let other = play::play(&data, given, eta0, before)?;
            let pairs = other.prediction.iter().zip(&model.prediction);
            let difference: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
            start = start.max(rms(&difference));
        }
        let mut check = Self {
            rmse: rms(&model.residual),
            rmse_gain_offset: rms(&residual),
            mean,
            allowed: allowed(&data, &given.about, deviation),
            about: given.about.clone(),
            outside: outside(&data, given),
            depends_on: Vec::new(),
            suspicion: None,
            spoilt: spoilt(&data, given),
            made_of_input: play::made_of_input(&data, given, &model.prediction),
            left_out: from as f64 * data.dt * data.stride as f64,
            verdict: Verdict::CannotTell,
            line,
            deviation,
            start,
            data,
            model,
        };
        if check.start > MATTERS * check.rmse {
            let share = three_digits(100.0 * check.start / check.deviation);
            check.data.notes.push(format!("the motion before the record is unknown, and the initial state of the model changes the prediction by up to {share} % of the output's standard deviation"));
        }
        check.verdict = check.found();
        if check.verdict == Verdict::DoesNotHold {
            let held = [moved, vec![1.0; check.data.target.len()]].map(Stretch::from);
            let behind = Solution {
                residual,
                ..check.model.clone()
            };
            check.depends_on = dependences(&check.data, &behind, &held);
        }
        Ok(check)
    }

    fn found(&self) -> Verdict {
        if !self.spoilt.is_empty() {
            return Verdict::DefectiveRecord;
        }
        let Some(allowed) = self.allowed.filter(|_| !self.is_quiet()) else {
            return Verdict::CannotTell;
        };
        let by_share = by_share(&self.data, &self.about, self.deviation);
        let moved = self.line.gain_moved() || self.line.offset_moved(self.deviation);
        if by_share.is_some_and(|most| self.rmse <= most)
            || self.rmse <= allowed && !(moved && self.is_mended())
        {
            Verdict::Holds
        } else if self.reference().is_none() {
            // More than noise, and nothing says how much more it was.
            Verdict::CannotTell
        } else if self.rmse_gain_offset <= allowed && self.line.gain.value > 0.0 && self.is_mended()
        {
            Verdict::GainOrOffsetMoved
        } else if !moved && (self.is_as_at_home() || self.is_just_above()) {
            Verdict::CannotTell
        } else {
            Verdict::DoesNotHold
        }
    }

    /// Whether the error on the model's own record exceeded the noise.
    #[must_use]
    pub fn was_inexact(&self) -> bool {
        at_home(&self.about).is_some_and(|own| own > NOISE * self.data.noise_floor)
    }

    /// Whether the error exceeds the limit by at most a quarter, and the model was inexact on its
    /// own record. Another motion often has this effect (`docs/results/transfer.md`).
    #[must_use]
    pub fn is_just_above(&self) -> bool {
        let mut allowed = self.allowed.into_iter();
        self.was_inexact() && allowed.any(|most| self.rmse <= (1.0 + QUARTER) * most)
    }

    /// Whether gain and offset account for most of the error.
    #[must_use]
    pub fn is_mended(&self) -> bool {
        self.rmse_gain_offset.powi(2) <= HALF * self.rmse.powi(2)
    }

    /// Whether the error is the sensor's noise.
    fn is_noise(&self) -> bool {
        self.rmse <= NOISE * self.data.noise_floor
    }

    /// The error up to which the model holds, in words.
    #[must_use]
    pub fn rule(&self) -> String {
        let noise = format!("{NOISE} times the noise floor");
        let Some(own) = self.reference() else {
            return noise;
        };
        if HOLDS * own > NOTHING {
            return format!(
                "the larger of {} of the standard deviation (above this, a model explains less than half of the variance) and {noise}",
                percent(NOTHING)
            );
        }
        match self.about.held_out_rmse.is_some() {
            true => format!(
                "the largest of three limits: {HOLDS} times the held-out NRMSE in the model file; {HOLDS} times the held-out RMSE in the model file, but at most {} of this record's standard deviation; {noise}",
                percent(POOR)
            ),
            false => format!("the larger of {HOLDS} times the held-out NRMSE in the model file and {noise}"),
        }
    }

    /// Whether the output moves so little that a model cannot be distinguished from a constant.
    #[must_use]
    pub fn is_quiet(&self) -> bool {
        HALF * self.deviation <= self.data.noise_floor || self.deviation <= 0.0
    }

    /// The model's own held-out error, as a share of the standard deviation.
    #[must_use]
    pub fn reference(&self) -> Option<f64> {
        reference(&self.about)
    }

    /// Whether the error in the output's unit is within the limit from the model's own record.
    #[must_use]
    pub fn is_as_at_home(&self) -> bool {
        at_home(&self.about).is_some_and(|own| self.rmse <= HOLDS * own)
    }

    /// Rms error with a fitted offset only.
    #[must_use]
    pub fn rmse_offset(&self) -> f64 {
        (self.rmse.powi(2) - self.mean.powi(2)).max(0.0).sqrt()
    }

    /// The signals over time as CSV: the measured output, the model without and with gain and
    /// offset, both residuals, and the contribution of each part of the model.
    ///
    /// # Errors
    /// A message if the trace cannot be computed.
    pub fn trace(&self) -> Result<String, String> {
        let unit = self.data.output_unit.as_deref();
        let moved = self.line.of(&self.model.prediction);
        let pairs = self.data.target.iter().zip(&moved);
        let rest = pairs.map(|(y, p)| y - p).collect();
        let mut columns = vec![
            input(&self.data),
            Column::new("measured", unit, self.data.target.clone()),
            Column::new("model", unit, self.model.prediction.clone()),
            Column::new("residual", unit, self.model.residual.clone()),
            Column::new("model-gain-offset", unit, moved),
            Column::new("residual-gain-offset", unit, rest),
        ];
        columns.extend(parts(&self.data, &self.model)?);
        let mut segments = vec!["dropped"; self.data.target.len()];
        for &row in &self.data.split.fit {
            segments[row] = "checked";
        }
        csv(&self.data, &segments, &columns)
    }
}

/// Severe defects of the columns that the model reads.
fn spoilt(data: &Prepared, given: &Given) -> Vec<Defect> {
    let reads = given.reads();
    let is_read = |name: &str| {
        data.channels.iter().all(|channel| channel.name != name) || reads.contains(&name)
    };
    let defects = data.defects.iter();
    let defects = defects.filter(|defect| defect.grave && is_read(&defect.channel));
    defects.cloned().collect()
}

fn reference(about: &About) -> Option<f64> {
    let held_out = about.nrmse?.held_out?;
    (held_out.is_finite() && held_out > 0.0).then_some(held_out)
}

/// The held-out error that the model came with, in the output's unit.
fn at_home(about: &About) -> Option<f64> {
    reference(about)?;
    about.held_out_rmse.filter(|own| own.is_finite())
}

/// Rms error up to which the model holds.
fn allowed(data: &Prepared, about: &About, deviation: f64) -> Option<f64> {
    let own = at_home(about).map(|own| (HOLDS * own).min(POOR * deviation));
    let by_share = by_share(data, about, deviation);
    by_share.into_iter().chain(own).reduce(f64::max)
}

/// Rms error up to which the model holds as a share of the standard deviation, or as noise.
fn by_share(data: &Prepared, about: &About, deviation: f64) -> Option<f64> {
    let own = reference(about).map(|share| HOLDS * share);
    let noise = (data.noise_floor > 0.0).then_some(NOISE * data.noise_floor);
    let own = own.map(|share| share.min(NOTHING) * deviation);
    own.into_iter().chain(noise).reduce(f64::max)
}

/// Brings the record to the units of the model. A record that states no unit at all, as from a
/// `.mat` file, is taken to be in these; one that states some must state all.
fn convert(record: &mut Record, given: &Given) -> Result<(), String> {
    let reads = given.reads();
    let path = record.path.clone();
    let mut notes = Vec::new();
    let columns = [&record.input, &record.output];
    let states_none = columns.into_iter().chain(&record.channels);
    let states_none = states_none.map(|c| &c.unit).all(Option::is_none);
    if states_none && !given.about.units.is_empty() {
        notes.push("the record has no units, so the model's units are assumed".to_owned());
    }
    let Record {
        input,
        output,
        channels,
        ..
    } = record;
    let read = channels
        .iter_mut()
        .filter(|c| reads.contains(&c.name.as_str()));
    let own = read.map(|column| (column.name.clone(), column));
    let ends = [("input".to_owned(), input), ("output".to_owned(), output)];
    for (name, column) in ends.into_iter().chain(own) {
        if let Some(unit) = given.about.units.get(&name) {
            if states_none {
                column.unit = Some(unit.clone());
            }
            let converted = to_unit(column, unit, "the model", &path);
            notes.extend(converted.map_err(|e| e.to_string())?);
        }
    }
    record.notes.extend(notes);
    Ok(())
}

/// What is to be known of how the model was taken.
fn remarks(given: &Given, cutoff: Option<f64>) -> Vec<String> {
    let about = &given.about;
    let mut notes = Vec::new();
    if about.units.is_empty() {
        notes
            .push("the model file has no units, so the units of the record are assumed".to_owned());
    }
    match (about.cutoff_hz, cutoff) {
        (Some(own), Some(cutoff)) if own != cutoff => notes.push(format!(
            "the model was fitted with a cut-off of {own} Hz, so its own error is not exactly comparable"
        )),
        (None, None) => notes.push(
            "the model file has no cut-off, so it is derived from the input of this record; --cutoff sets it".to_owned(),
        ),
        _ => {}
    }
    if !given.left_out.is_empty() {
        notes.push(format!(
            "excluded terms, which belong to the model's own record: {}",
            given.left_out.join(", ")
        ));
    }
    notes
}

/// The ranges in which the record exceeds the model's record, the input first.
fn outside(data: &Prepared, given: &Given) -> Vec<Outside> {
    let channels = data.channels.iter().map(|c| (c.name.as_str(), c));
    let all = std::iter::once(("input", &data.input)).chain(channels);
    let mut found = Vec::new();
    for (name, channel) in all {
        let Some(seen) = given.about.ranges.get(name) else {
            continue;
        };
        let reads = given.reads_of(name);
        let quantities = [
            (reads.position, POSITION, seen.position),
            (reads.velocity, VELOCITY, seen.velocity),
            (reads.acceleration, ACCELERATION, seen.acceleration),
        ];
        for (is_read, of, seen) in quantities {
            let seen = seen.filter(|_| is_read);
            found.extend(seen.and_then(|seen| beyond(data, channel, &data.split.fit, of, seen)));
        }
    }
    found
}
