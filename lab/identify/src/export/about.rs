//! The meaning and the accuracy of a model's numbers.

use super::ModelFile;
use crate::conclude::intervals::{gain_unit, parameters, shape_unit, term_name, Parameter};
use crate::fit::{Segments, Solution};
use crate::model::units::Unit;
use crate::problem::{Channel, Prepared};
use bowden::effect::Motion;
use bowden::model::Source;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// The table `about` of a model file, for users and tools; the core does not read it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct About {
    /// The program and its version.
    pub by: String,
    /// Names of the files that were fitted, without folders.
    pub records: Vec<String>,
    /// The verdict of `bowden identify` on the record: with `no-input-dependence` it is not to be used.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub verdict: Option<String>,
    /// The file whose gains this model has, if the files have separate gains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gains_of: Option<String>,
    /// Cut-off of the fit's filter \[Hz\].
    pub cutoff_hz: f64,
    /// Sampling rate of the record \[Hz\].
    pub rate_hz: f64,
    /// Time constant for `bowden::signal::Rates` \[s\].
    pub rates_time_constant_s: f64,
    /// Whether the model was fitted within the range that has an inverse.
    pub fitted_invertible: bool,
    /// `yes`, or `no, because …`: whether a compensator can invert the model.
    pub feed_forward: String,
    /// Error of this model on the held-out segment, in the output's unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub held_out_rmse: Option<f64>,
    /// Errors of this model, as shares of the output's standard deviation.
    pub nrmse: Errors,
    /// Play in front of the hysteresis, if the error with causal rates is large without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub play: Option<PlayBefore>,
    /// Parts of the fitted model that this model does not contain.
    pub excluded_terms: Vec<LeftOut>,
    /// Parameters that the record does not determine.
    pub not_identified: Vec<NotIdentified>,
    /// The unit of each parameter and of each source, by name.
    pub units: BTreeMap<String, String>,
    /// Definitions of channels that are computed from other measured quantities, by name: `stretch
    /// = "phi_p + phi_d"`. Firmware must compute them in the same way.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub definitions: BTreeMap<String, String>,
    /// 95 % intervals of the parameters that the record determines, by their names in the file.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub intervals: BTreeMap<String, [f64; 2]>,
    /// Ranges of each source in the fitted record, by name.
    pub ranges: BTreeMap<String, Span>,
}

/// Errors of the model on the record, as shares of the output's standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Errors {
    /// On the fit segment.
    pub fit: f64,
    /// On the held-out segment, with the rates of the fit's zero-phase filter.
    pub held_out: f64,
    /// The same sample by sample, with the causal rates of firmware.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub held_out_causal: Option<f64>,
    /// On the held-out segment, with the excluded parts.
    pub held_out_as_fitted: f64,
}

/// Play between the measured input and the hysteresis, so that the noise of the input does not
/// reverse the hysteresis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PlayBefore {
    /// Half-width for `bowden::signal::Play`, in the input's unit.
    pub half_width: f64,
    /// The held-out error with this play, sample by sample.
    pub held_out_causal: f64,
}

/// A part of the fitted model that is not exported.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// The name in the report.
    pub effect: String,
    /// Why.
    pub reason: String,
}

/// A parameter that the record does not determine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NotIdentified {
    /// The name in the report.
    pub parameter: String,
    /// Why.
    pub reason: String,
}

/// The range of a source in the fitted record: smallest and largest values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Span {
    /// Position \[unit of the source\].
    pub position: [f64; 2],
    /// Velocity \[unit/s\].
    pub velocity: [f64; 2],
    /// Acceleration \[unit/s²\].
    pub acceleration: [f64; 2],
}

impl Span {
    /// What the fit has seen of a channel: the samples of its segment, on the work grid.
    fn of(data: &Prepared, channel: &Channel) -> Self {
        let seen = || {
            let rows = data.split.fit.iter();
            rows.flat_map(|row| {
                let at = row * data.stride..(row + 1) * data.stride;
                channel.motion.get(at).unwrap_or_default()
            })
        };
        let over = |of: fn(&Motion<f64>) -> f64| {
            let start = [f64::INFINITY, f64::NEG_INFINITY];
            seen()
                .map(of)
                .fold(start, |[low, high], v| [low.min(v), high.max(v)])
        };
        Self {
            position: over(|m| m.position),
            velocity: over(|m| m.velocity),
            acceleration: over(|m| m.acceleration),
        }
    }
}

impl About {
    /// A warning, if the verdict forbids the use of the model.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        let forbids = |v: &&str| {
            matches!(
                *v,
                "no-input-dependence" | "not-transferable" | "defective-record"
            )
        };
        let verdict = self.verdict.as_deref().filter(forbids)?;
        Some(format!(
            "DO NOT USE THIS MODEL: its verdict is `{verdict}`."
        ))
    }

    /// The statements about a solution that follow from its record; the caller adds the others.
    #[must_use]
    pub fn new(data: &Prepared, solution: &Solution) -> Self {
        let parameters = parameters(data, solution);
        let intervals = intervals(&parameters);
        let parameters = parameters.into_iter();
        // What the states were before the record is no part of the model.
        let of_the_model = |name: &str| !name.starts_with("eta0") && !name.contains(".start");
        let refused = parameters
            .filter(|p| of_the_model(&p.name))
            .filter_map(|p| {
                let reason = p.not_identified?.reason;
                let parameter = p.name;
                Some(NotIdentified { parameter, reason })
            });
        Self {
            by: format!("bowden {}", env!("CARGO_PKG_VERSION")),
            records: data.pieces.iter().map(|p| file_name(&p.path)).collect(),
            cutoff_hz: data.cutoff,
            rate_hz: data.rate,
            not_identified: refused.collect(),
            units: units(data, solution),
            definitions: definitions(data),
            intervals,
            ranges: read(solution)
                .filter_map(|source| {
                    let channel = data.channel(source)?;
                    Some((source_name(data, source), Span::of(data, channel)))
                })
                .collect(),
            ..Self::default()
        }
    }

    /// Relative errors of a model.
    #[must_use]
    pub fn with_errors(self, nrmse: &Segments, causal: Option<&Segments>, fitted: f64) -> Self {
        Self {
            nrmse: Errors {
                fit: nrmse.fit,
                held_out: nrmse.held_out,
                held_out_causal: causal.map(|own| own.held_out),
                held_out_as_fitted: fitted,
            },
            ..self
        }
    }

    /// One line with the program, the files and the excluded parts.
    #[must_use]
    pub fn remark(&self) -> String {
        let mut remark = format!("Identified by {} from {}", self.by, self.records.join(", "));
        if let Some(own) = &self.gains_of {
            remark += &format!("; gains of {own}");
        }
        if !self.excluded_terms.is_empty() {
            let names: Vec<&str> = self
                .excluded_terms
                .iter()
                .map(|l| l.effect.as_str())
                .collect();
            remark += &format!(". NOT IN THIS MODEL: {}", names.join(", "));
        }
        remark
    }

    /// The unit of a parameter or a source, `no unit` where the record has none.
    pub(super) fn unit(&self, name: &str) -> &str {
        self.units.get(name).map_or("no unit", String::as_str)
    }

    /// A channel with its unit, and how it is computed where it was not measured.
    pub(super) fn channel(&self, name: &str) -> String {
        let unit = self.unit(name);
        match self.definitions.get(name) {
            Some(definition) => format!("{name} = {definition} [{unit}]"),
            None => format!("{name} [{unit}]"),
        }
    }
}

/// The name without folders: a model file goes to places where the folders mean nothing.
fn file_name(path: &str) -> String {
    // A record that is in no file is named by the command in brackets.
    match Path::new(path).file_name() {
        Some(name) if !path.starts_with('(') => name.to_string_lossy().into_owned(),
        _ => path.to_owned(),
    }
}

/// The 95 % intervals under the names of a model file.
fn intervals(parameters: &[Parameter]) -> BTreeMap<String, [f64; 2]> {
    let named = |parameter: &Parameter| {
        let name = match parameter.name.as_str() {
            "B" | "kappa_x" => "gain",
            "T0" => "offset",
            other => other,
        };
        let of_the_model = !name.starts_with("eta0") && !name.contains(".start");
        let interval = parameter.ci95.filter(|_| of_the_model)?;
        Some((name.to_owned(), interval))
    };
    parameters.iter().filter_map(named).collect()
}

/// The sources that the model reads: the input always.
fn read(solution: &Solution) -> impl Iterator<Item = Source> + '_ {
    let terms = solution.structure.terms.iter().map(|term| term.source);
    let curve = solution.structure.table.iter();
    let sources = terms.chain(curve.map(|curve| curve.variable.source()));
    let mut channels: Vec<u8> = sources
        .filter_map(|source| match source {
            Source::Input => None,
            Source::Channel(index) => Some(index),
        })
        .collect();
    channels.sort_unstable();
    channels.dedup();
    std::iter::once(Source::Input).chain(channels.into_iter().map(Source::Channel))
}

fn source_name(data: &Prepared, source: Source) -> String {
    match source {
        Source::Input => "input".to_owned(),
        Source::Channel(_) => data
            .channel(source)
            .map_or_else(String::new, |c| c.name.clone()),
    }
}

fn definitions(data: &Prepared) -> BTreeMap<String, String> {
    let defined = |c: &Channel| Some((c.name.clone(), c.definition.clone()?));
    data.channels.iter().filter_map(defined).collect()
}

fn units(data: &Prepared, solution: &Solution) -> BTreeMap<String, String> {
    let mut units = BTreeMap::new();
    let mut add = |name: String, unit: Option<String>| {
        if let Some(unit) = unit {
            units.insert(name, unit);
        }
    };
    let (input, output) = (data.input.unit.as_deref(), data.output_unit.as_deref());
    let unit = |unit, power| Unit::one().times(unit, power);
    add("input".to_owned(), unit(input, 1).text());
    add("output".to_owned(), unit(output, 1).text());
    for channel in &data.channels {
        let own = unit(channel.unit.as_deref(), 1).text();
        add(channel.name.clone(), own);
    }
    if solution.structure.hysteresis {
        add("gain".to_owned(), unit(output, 1).times(input, -1).text());
        add("kappa_eta".to_owned(), unit(output, 1).text());
        add("offset".to_owned(), unit(output, 1).text());
        add("rho".to_owned(), unit(input, -1).text());
        add("sigma".to_owned(), Some("1".to_owned()));
        add("n".to_owned(), Some("1".to_owned()));
    }
    for term in &solution.structure.terms {
        let name = term_name(data, term);
        for (index, shape) in term.effect.info().shapes.iter().enumerate() {
            add(
                format!("{name}.{}", shape.name),
                shape_unit(data, term, index),
            );
        }
        add(name, gain_unit(data, term));
    }
    units
}

impl ModelFile {
    /// The model with its table `about`.
    #[must_use]
    pub fn with_about(self, about: About) -> Self {
        Self {
            about: Some(about),
            ..self
        }
    }
}
