//! The exported model as a file: TOML for tools; Rust, C or postcard for firmware.
//!
//! All files contain the same numbers: TOML in `f64`, Rust and postcard rounded to `f32`, C both.
//! The table `about` contains the data that the core does not need, such as units, ranges and
//! errors. A test vector accompanies each file ([`vector`]).

mod about;
mod after_steps;
mod c;
mod c_names;
pub mod causal;
pub mod clockwork;
mod firmware;
pub mod hand_over;
pub mod invertible;
mod rust;
pub mod vector;

pub use about::{About, Errors, LeftOut, NotIdentified, PlayBefore, Span};
pub use c_names::prefix;
pub use firmware::{postcard, CHECKSUM};

use crate::fit::Solution;
use crate::model::structure::Role;
use crate::problem::Prepared;
use crate::record::Mode;
use bowden::model::{Model, Source, Term};
use bowden::Real;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Terms for which a [`FixedModel`](bowden::model::FixedModel) has room, and terms and channels for
/// which the C interface has: `BOWDEN_TERMS`, `BOWDEN_CHANNELS`.
const ROOM: usize = 16;
/// Maximum number of terms of an exported model.
pub const MOST_TERMS: usize = 32;

/// A model file, schema `bowden.model/1`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelFile {
    /// `bowden.model/1`.
    pub schema: String,
    /// `torque` or `displacement`.
    pub mode: String,
    /// Names of the channels that terms may read, in the order of the sample's channels.
    pub channels: Vec<String>,
    /// The transmission, if there is one.
    pub transmission: Option<TransmissionFile>,
    /// The effects, in order.
    #[serde(default)]
    pub terms: Vec<TermFile>,
    /// The meaning and the accuracy of the numbers; the core does not read it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub about: Option<About>,
}

/// The Bouc-Wen transmission of a model file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TransmissionFile {
    /// B in torque mode (6), kappa_x in displacement mode (1).
    pub gain: f64,
    /// Amplitude of the hysteresis.
    pub kappa_eta: f64,
    /// T0 in torque mode (subtracted), the constant force in displacement mode (added).
    pub offset: f64,
    /// Bouc-Wen rho.
    pub rho: f64,
    /// Bouc-Wen sigma.
    pub sigma: f64,
    /// Bouc-Wen n.
    pub n: f64,
}

/// One effect of a model file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TermFile {
    /// The effect's own name.
    pub effect: String,
    /// `input`, or the name of a channel.
    pub source: String,
    /// Origin from which the effect measures the position.
    #[serde(default)]
    pub origin: f64,
    /// Its gain.
    pub gain: f64,
    /// Its shapes, in the core's order.
    #[serde(default)]
    pub shapes: Vec<ShapeFile>,
}

/// One shape parameter of an effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShapeFile {
    /// Its name in the effect's formula.
    pub name: String,
    /// Its value.
    pub value: f64,
}

/// The terms of a solution's curve, if the core has one over its variable.
fn curve(solution: &Solution) -> Vec<Term<f64>> {
    let Some((table, over)) = solution
        .structure
        .table
        .as_ref()
        .and_then(|t| Some((t, t.over()?)))
    else {
        return Vec::new();
    };
    let (points, source) = (
        table.points(solution.curve_gains()),
        table.variable.source(),
    );
    let segments = points.windows(2).filter_map(|pair| match *pair {
        [from, to] => Term::curve(over, source, [from, to]).ok(),
        _ => None,
    });
    // Of each pair the segment, and of the first one the offset as well.
    let all = segments.enumerate();
    all.flat_map(|(k, pair)| pair.into_iter().skip(k.min(1)))
        .collect()
}

impl TermFile {
    fn new(data: &Prepared, term: &Term<f64>) -> Self {
        let shapes = term.effect.info().shapes.iter().enumerate();
        Self {
            effect: term.effect.name().to_owned(),
            source: match term.source {
                Source::Input => "input".to_owned(),
                Source::Channel(_) => data
                    .channel(term.source)
                    .map_or_else(String::new, |c| c.name.clone()),
            },
            origin: term.origin,
            gain: term.gain,
            shapes: shapes
                .map(|(i, shape)| ShapeFile {
                    name: shape.name.to_owned(),
                    value: term.effect.shape(i).unwrap_or(0.0),
                })
                .collect(),
        }
    }
}

impl ModelFile {
    /// The fitted model; with separate gains for each record, those of the first one.
    #[must_use]
    pub fn new(data: &Prepared, solution: &Solution) -> Self {
        Self::of_record(data, solution, 0)
    }

    /// The fitted model with the separate gains of one record.
    #[must_use]
    pub fn of_record(data: &Prepared, solution: &Solution, record: usize) -> Self {
        let own = 3 * record.min(solution.structure.own_gains.saturating_sub(1));
        let value = |role| solution.value(role).unwrap_or(0.0);
        let sign = match data.mode {
            Mode::Torque => -1.0,
            Mode::Displacement => 1.0,
        };
        let transmission = solution.structure.hysteresis.then(|| TransmissionFile {
            gain: solution.gains[own],
            kappa_eta: sign * solution.gains[own + 1],
            offset: sign * solution.gains[own + 2],
            rho: value(Role::Rho),
            sigma: value(Role::Sigma),
            n: value(Role::N),
        });
        let terms = solution.structure.terms.iter().enumerate();
        let terms = terms.map(|(index, term)| Term {
            effect: term.effect,
            source: term.source,
            origin: term.origin,
            gain: solution.gain(index),
        });
        let terms = terms.chain(curve(solution));
        Self {
            schema: "bowden.model/1".to_owned(),
            mode: data.mode.name().to_owned(),
            channels: data.channels.iter().map(|c| c.name.clone()).collect(),
            transmission,
            terms: terms.map(|term| TermFile::new(data, &term)).collect(),
            about: None,
        }
    }

    /// As TOML.
    ///
    /// # Errors
    /// If a number is not finite, which does not occur in a fitted model.
    pub fn toml(&self) -> Result<String, toml::ser::Error> {
        let remark = self.about.as_ref().map_or_else(String::new, About::remark);
        Ok(format!("# {remark}\n{}", toml::to_string(self)?))
    }

    /// The core's model.
    ///
    /// # Errors
    /// A message with the part that the core refuses.
    pub fn model<const N: usize>(&self) -> Result<Model<f64, N>, String> {
        self.model_in()
    }

    /// The core's model in either precision, as firmware would run it.
    ///
    /// The core reads the file itself, so it accepts the same files as a user's `toml::from_str`.
    ///
    /// # Errors
    /// A message with the part that the core refuses.
    pub fn model_in<T, const N: usize>(&self) -> Result<Model<T, N>, String>
    where
        T: Real + DeserializeOwned,
    {
        let told = |e: toml::de::Error| e.message().replace('\n', " ");
        let file = toml::Table::try_from(self).map_err(|e| e.to_string())?;
        file.try_into().map_err(told)
    }
}
