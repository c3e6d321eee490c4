//! The model that is validated, and the statements of its file about its origin.

use crate::export::clockwork::counts_from_the_start;
use crate::export::ModelFile;
use crate::record::Mode;
use bowden::effect::{Info, Quantity, CATALOGUE};
use serde::Deserialize;
use std::collections::BTreeMap;

/// Schema of a model file.
const SCHEMA: &str = "bowden.model/1";

/// A model from a file.
#[derive(Debug, Clone)]
pub struct Given {
    /// The model, without the terms that belong to the record it came from.
    pub file: ModelFile,
    /// Names of the terms that are excluded for this reason.
    pub left_out: Vec<String>,
    /// The origin of the model.
    pub about: About,
}

/// The statements of a model file about its record; each may be missing.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
pub struct About {
    /// Cut-off of the filter of the fit \[Hz\].
    pub cutoff_hz: Option<f64>,
    /// Sampling rate of the record \[Hz\].
    pub rate_hz: Option<f64>,
    /// Units by name: `input`, `output`, and the channels.
    #[serde(default)]
    pub units: BTreeMap<String, String>,
    /// Definitions of channels that are sums or differences of others, by name.
    #[serde(default)]
    pub definitions: BTreeMap<String, String>,
    /// Ranges of the record, by name: `input`, and the channels.
    #[serde(default)]
    pub ranges: BTreeMap<String, Seen>,
    /// Errors of the model as shares of the output's standard deviation.
    pub nrmse: Option<Errors>,
    /// Held-out error, in the output's unit.
    pub held_out_rmse: Option<f64>,
    /// The verdict on the model's record.
    pub verdict: Option<String>,
}

/// The ranges of one motion in a record.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
pub struct Seen {
    /// Smallest and largest position, in the source's unit.
    pub position: Option<[f64; 2]>,
    /// Smallest and largest velocity, in the source's unit per second.
    pub velocity: Option<[f64; 2]>,
    /// Smallest and largest acceleration, in the source's unit per second squared.
    pub acceleration: Option<[f64; 2]>,
}

/// Errors on the segments of the model's record.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize, serde::Serialize)]
pub struct Errors {
    /// On the fit segment.
    pub fit: Option<f64>,
    /// On the selection segment.
    pub selection: Option<f64>,
    /// On the held-out segment.
    pub held_out: Option<f64>,
}

impl Given {
    /// Reads a model file.
    ///
    /// # Errors
    /// A message if the text is not TOML, not a model of this schema, or a model that the core
    /// refuses.
    pub fn parse(text: &str) -> Result<Self, String> {
        let one_line = |e: toml::de::Error| one_line(&e.to_string());
        let mut table: toml::Table = toml::from_str(text).map_err(one_line)?;
        match table.get("schema").and_then(toml::Value::as_str) {
            Some(SCHEMA) => {}
            Some(other) => return Err(format!("schema {other:?} must be {SCHEMA}")),
            None => {
                return Err(format!(
                    "no schema: pass a model written by `bowden identify --model-out` ({SCHEMA})"
                ))
            }
        }
        let about = match table.remove("about") {
            Some(about) => about
                .try_into()
                .map_err(|e: toml::de::Error| format!("about: {}", one_line(e)))?,
            None => About::default(),
        };
        let mut about: About = about;
        about.cutoff_hz = about.cutoff_hz.filter(|hz| hz.is_finite() && *hz > 0.0);
        let mut file: ModelFile = toml::Value::Table(table).try_into().map_err(one_line)?;
        // Refused here and not later: what the core does not accept cannot be checked.
        file.model::<MOST_TERMS>()?;
        if file.transmission.is_none() && file.terms.is_empty() {
            return Err("the model has no parts, so there is nothing to validate".to_owned());
        }
        let mut left_out = Vec::new();
        file.terms.retain(|term| {
            let clockwork = of_the_record(&term.effect);
            if clockwork {
                left_out.push(term.effect.clone());
            }
            !clockwork
        });
        let given = Self {
            file,
            left_out,
            about,
        };
        given.mode()?;
        Ok(given)
    }

    /// The mode of the model.
    ///
    /// # Errors
    /// A message if the mode is invalid.
    pub fn mode(&self) -> Result<Mode, String> {
        match self.file.mode.as_str() {
            "torque" => Ok(Mode::Torque),
            "displacement" => Ok(Mode::Displacement),
            other => Err(format!("mode {other:?} must be torque or displacement")),
        }
    }

    /// The channels that the model reads, which a record must contain.
    #[must_use]
    pub fn reads(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        let loaded = self.file.channels.iter().any(|c| c == "load");
        for term in &self.file.terms {
            let load = loaded && reads_load(&term.effect);
            let source = (term.source != "input").then_some(term.source.as_str());
            names.extend(source.into_iter().chain(load.then_some("load")));
        }
        names.sort_unstable();
        names.dedup();
        names
    }
}

/// What a model reads of the motion of a channel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Reads {
    pub(super) position: bool,
    pub(super) velocity: bool,
    pub(super) acceleration: bool,
}

impl Given {
    /// The quantities of the input (`input`) or of a channel that the model reads. An effect that
    /// acts in time, such as creep, depends on the velocity of its source; a lag and a delay, which
    /// read the whole output, depend on the velocity of every source whose position is read.
    pub(super) fn reads_of(&self, channel: &str) -> Reads {
        let load = match self.file.channels.iter().any(|c| c == "load") {
            true => "load",
            false => "input",
        };
        let hysteresis = self.file.transmission.is_some() && channel == "input";
        let mut reads = Reads {
            position: hysteresis,
            ..Reads::default()
        };
        let mut in_time = false;
        for term in &self.file.terms {
            let read = info(&term.effect).map_or(&[][..], |info| info.reads);
            let has = |quantity| read.contains(&quantity);
            let own = term.source == channel;
            reads.position |= own && has(Quantity::Position)
                || load == channel && has(Quantity::Load)
                || channel == "input" && has(Quantity::Input);
            reads.velocity |= own && (has(Quantity::Velocity) || has(Quantity::Dt));
            reads.acceleration |= own && has(Quantity::Acceleration);
            in_time |= has(Quantity::Output);
        }
        reads.velocity |= in_time && reads.position;
        reads
    }
}

/// Most terms of a model that is checked.
pub(super) const MOST_TERMS: usize = 64;

fn info(name: &str) -> Option<&'static Info> {
    CATALOGUE.iter().copied().find(|info| info.name == name)
}

fn reads_load(name: &str) -> bool {
    info(name).is_some_and(|info| info.reads.contains(&Quantity::Load))
}

/// Whether an effect is of the record that the model came from, and not of the rig: its clock
/// has begun with that record.
fn of_the_record(name: &str) -> bool {
    info(name).is_some_and(|info| counts_from_the_start(info.family))
}

/// The message of the TOML reader without its copy of the line.
pub fn one_line(text: &str) -> String {
    let lines = text.lines().map(str::trim);
    let told: Vec<&str> = lines
        .filter(|line| !line.is_empty() && !line.contains('|'))
        .collect();
    told.join(": ")
}
