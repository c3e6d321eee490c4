//! A given model on a record, with nothing fitted.

use super::given::{Given, MOST_TERMS};
use crate::fit::{Segments, Solution};
use crate::model::columns::{raw_columns, weighted};
use crate::model::structure::{FitTerm, Free, Range, Role, Structure, Terms};
use crate::problem::{HeldOut, Preparation, Prepared, Stretch, MOST_RECORDS};
use crate::record::{Mode, Record};
use bowden::effect::Motion;
use bowden::model::{Model, Source};

/// A model that has run on a record.
pub(super) struct Played {
    /// The record; what counts of it is its fit segment.
    pub(super) data: Prepared,
    /// The model on it.
    pub(super) model: Solution,
    /// Rows at the start that do not count.
    pub(super) from: usize,
}

impl Played {
    /// On a record in the model's units, at the model's own cut-off unless another one is given
    /// \[Hz\].
    pub(super) fn of(record: &Record, given: &Given, cutoff: Option<f64>) -> Result<Self, String> {
        let own = given.about.cutoff_hz;
        let preparation = Preparation {
            cutoff: cutoff.or(own),
        };
        let records = std::slice::from_ref(record);
        let prepared = Prepared::joined(records, preparation, HeldOut::Nothing);
        let mut data = prepared.map_err(|message| match (cutoff, own) {
            (None, Some(own)) => message
                .replace("a higher --cutoff", "a --cutoff above the model's")
                .replace(
                    &format!("--cutoff {own} Hz is too high"),
                    &format!(
                        "the model's cut-off of {own} Hz is too high (is the time in seconds?)"
                    ),
                ),
            _ => message,
        })?;
        if !given.file.channels.iter().any(|c| c == "load") {
            // The model was fitted without it: its load is the input.
            data.load = None;
        }
        let model = play(&data, given, 0.0, Before::Rest)?;
        let from = match remembers(&model) {
            true => data.settled(),
            false => 0,
        };
        let data = data.with_rows(|row| row >= from);
        match data.split.fit.len() {
            count @ ..FEWEST => Err(format!("only {count} filtered samples remain without defects and gaps; at least {FEWEST} are needed")),
            _ => Ok(Self { data, model, from }),
        }
    }

    /// Mean of a signal over the rows that count.
    pub(super) fn mean(&self, signal: &[f64]) -> f64 {
        let rows = &self.data.split.fit;
        rows.iter().map(|&i| signal[i]).sum::<f64>() / rows.len() as f64
    }

    /// Standard deviation of the filtered output.
    pub(super) fn deviation(&self) -> f64 {
        rms(&self.data, &self.data.target, self.mean(&self.data.target))
    }
}

/// Rms of a signal about a value, over the rows that count.
pub(super) fn rms(data: &Prepared, signal: &[f64], about: f64) -> f64 {
    let rows = &data.split.fit;
    let squares = rows.iter().map(|&i| (signal[i] - about).powi(2));
    (squares.sum::<f64>() / rows.len() as f64).sqrt()
}

/// Fewest rows on which a model is judged.
const FEWEST: usize = 96;

/// Whether what came before a record matters to a model.
pub(super) fn remembers(model: &Solution) -> bool {
    let Structure {
        hysteresis, terms, ..
    } = &model.structure;
    *hysteresis || terms.iter().any(|t| t.effect.info().memory)
}

/// From where the motion came just before the record, for what keeps its memory until it is moved as far
/// again: a play, and a spring that slips.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Before {
    /// From rest.
    Rest,
    /// From the lower end of the range of the model's record.
    Low,
    /// From the upper end of this range.
    High,
}

impl Before {
    /// By how much the source of a term had moved.
    fn moved(self, data: &Prepared, given: &Given, term: &FitTerm) -> f64 {
        if !term.has_past() || term.effect.info().family == "creep" {
            return 0.0;
        }
        let name = match term.source {
            Source::Input => "input",
            Source::Channel(_) => data.channel(term.source).map_or("", |c| c.name.as_str()),
        };
        let seen = given.about.ranges.get(name).and_then(|seen| seen.position);
        let first = data.channel(term.source).and_then(|c| c.motion.first());
        match (self, seen, first) {
            (Self::Low, Some([low, _]), Some(first)) => first.position - low,
            (Self::High, Some([_, high]), Some(first)) => first.position - high,
            _ => 0.0,
        }
    }
}

/// The model on the record, from that hysteresis state at the first sample and that motion before it.
///
/// # Errors
/// A message if the record lacks a channel that the model reads.
pub(super) fn play(
    data: &Prepared,
    given: &Given,
    eta0: f64,
    before: Before,
) -> Result<Solution, String> {
    let model: Model<f64, MOST_TERMS> = given.file.model()?;
    let terms = model
        .terms()
        .iter()
        .map(|term| {
            let mut own = FitTerm {
                effect: term.effect,
                source: source(data, given, term.source)?,
                origin: term.origin,
                start: [0.0; MOST_RECORDS],
            };
            own.start[0] = before.moved(data, given, &own);
            Ok(own)
        })
        .collect::<Result<Terms, String>>()?;
    let structure = Structure {
        hysteresis: model.transmission().is_some(),
        terms,
        ..Structure::default()
    };
    let (mut gains, mut known) = (Vec::new(), Vec::new());
    if let Some(t) = model.transmission() {
        let sign = match data.mode {
            Mode::Torque => -1.0,
            Mode::Displacement => 1.0,
        };
        gains.extend([t.gain(), sign * t.kappa_eta(), sign * t.offset()]);
        let shape = t.shape();
        known.extend([
            (Role::Rho, shape.rho()),
            (Role::Sigma, shape.sigma()),
            (Role::N, shape.n()),
            (Role::Eta0 { record: 0 }, eta0),
        ]);
    }
    for ((id, term), own) in structure.terms.with_ids().zip(model.terms()) {
        if term.effect.is_output_stage() {
            known.push((Role::Stage { term: id }, own.gain));
        } else if term.is_linear() {
            gains.push(own.gain);
        }
    }
    let nothing = || "the model's output is not finite on this record".to_owned();
    // Given, not searched: none of them has a bound.
    let free: Vec<Free> = known
        .iter()
        .map(|&(role, _)| Free {
            role,
            range: Range::Free,
        })
        .collect();
    let values: Vec<f64> = known.iter().map(|&(_, value)| value).collect();
    let raw = raw_columns(data, &structure, &free, &values).ok_or_else(nothing)?;
    let columns: Vec<&Stretch> = raw.columns.iter().map(|c| &**c).collect();
    let columns = data.filtered_stretches(&columns);
    let prediction = weighted(&columns, &gains, data.target.len());
    if !prediction.iter().all(|p| p.is_finite()) {
        return Err("the model diverges on this record".to_owned());
    }
    let pairs = data.target.iter().zip(&prediction);
    let residual: Vec<f64> = pairs.map(|(y, p)| y - p).collect();
    Ok(Solution {
        rmse: Segments::of(data, &residual),
        on_bound: vec![false; free.len()],
        tangents: Vec::new(),
        unfiltered: raw.output(&gains),
        eta: raw.eta,
        structure,
        free,
        values,
        gains,
        columns,
        prediction,
        residual,
    })
}

/// The part of the prediction that depends on the input: the standard deviation of its change if
/// the input is held at its mean; `None` if the prediction has no value there.
pub(super) fn made_of_input(data: &Prepared, given: &Given, prediction: &[f64]) -> Option<f64> {
    let mut held = data.clone();
    let motion = &mut held.input.motion;
    let mean = motion.iter().map(|m| m.position).sum::<f64>() / motion.len() as f64;
    motion.fill(Motion {
        position: mean,
        velocity: 0.0,
        acceleration: 0.0,
    });
    let without = play(&held, given, 0.0, Before::Rest).ok()?;
    let pairs = prediction.iter().zip(&without.prediction);
    let difference: Vec<f64> = pairs.map(|(with, without)| with - without).collect();
    let rows = &data.split.fit;
    let mean = rows.iter().map(|&i| difference[i]).sum::<f64>() / rows.len() as f64;
    Some(rms(data, &difference, mean))
}

/// What a term reads, by its name in the record.
fn source(data: &Prepared, given: &Given, own: Source) -> Result<Source, String> {
    let Source::Channel(index) = own else {
        return Ok(own);
    };
    let names = &given.file.channels;
    let name = names.get(usize::from(index)).map_or("", String::as_str);
    let place = data.channels.iter().position(|c| c.name == name);
    let place = place.and_then(|place| u8::try_from(place).ok());
    place
        .map(Source::Channel)
        .ok_or_else(|| missing(given, name))
}

/// What is said where a channel is not there.
pub(super) fn missing(given: &Given, name: &str) -> String {
    let fitted = given.about.definitions.get(name);
    let fitted = fitted.map_or_else(String::new, |own| format!(" (fitted as {own})"));
    format!(
        "the model reads channel `{name}`{fitted}, but the record has no such channel; pass its column with --channel {name}=COL"
    )
}
