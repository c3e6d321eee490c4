//! The effects that are tried on a record: every family, on every channel, at a few trial shapes.
//!
//! The shapes are a coarse grid in units of the record's own ranges, from the table of `effects`. A
//! found effect is refitted with free shapes, so the grid only has to be close.

use super::effects::{entry, rank, table, Entry, Place, Trials, Zero};
use super::kind::is_stage;
use super::structure::{FitTerm, Structure};
use super::variable::Variable;
use crate::problem::{Channel, Prepared, MOST_RECORDS};
use crate::record::Mode;
use bowden::effect::{Backlash, Effect, Presliding, Quantity, CATALOGUE};
use bowden::model::Source;
use std::ops::Range;

/// An effect that may be missing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// The effect with a trial shape, and its source.
    pub term: FitTerm,
    /// Its family.
    pub family: &'static str,
}

impl From<FitTerm> for Candidate {
    fn from(term: FitTerm) -> Self {
        let family = term.effect.info().family;
        Self { term, family }
    }
}

impl Candidate {
    /// The effect that is the same function with the opposite sign, for any motion: `play(x) - x`
    /// of a backlash is `-r` times the `(x - play(x))/r` of a presliding.
    #[must_use]
    pub fn twin(term: &FitTerm) -> Option<Self> {
        let r = term.effect.shape(0)?;
        let effect: Effect<f64> = match term.effect.name() {
            "backlash" => Presliding::try_new(r).ok()?.into(),
            "presliding" => Backlash::try_new(r).ok()?.into(),
            _ => return None,
        };
        Some(Self::from(FitTerm { effect, ..*term }))
    }

    /// The variable that the effect is a function of or represents.
    #[must_use]
    pub fn variables(&self) -> Vec<Variable> {
        let effect = &self.term.effect;
        entry(effect.name()).map_or_else(Vec::new, |own| own.variables(effect, self.term.source))
    }

    /// Whether the other is the same effect on the same channel, with any shape.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        let name = |one: &Self| (one.term.effect.name(), one.term.source);
        name(self) == name(other)
    }
}

/// Rank among alternatives; the effect with the lowest rank is named: the rank of the family, then
/// the effect's position in the core's catalogue.
#[must_use]
pub fn simplicity(effect: &Effect<f64>) -> (usize, usize) {
    let own = CATALOGUE
        .iter()
        .position(|info| info.name == effect.name())
        .unwrap_or(CATALOGUE.len());
    (rank(effect.name()), own)
}

/// Value below which the share `q` of the channel's positions lies, from its origin.
fn quantile(sorted: &[f64], q: f64) -> f64 {
    let at = ((sorted.len() - 1) as f64 * q).round() as usize;
    sorted[at]
}

/// A channel on which effects are tried.
struct Site<'a> {
    source: Source,
    channel: &'a Channel,
    /// Whether it represents the model as a whole, which has no zero of position.
    whole: bool,
    /// The positions from their origin, sorted; computed on first use.
    sorted: Option<Vec<f64>>,
}

impl Site<'_> {
    fn origin(&self, entry: &Entry) -> f64 {
        match entry.zero {
            Zero::Channel if !self.whole => self.channel.origin,
            _ => 0.0,
        }
    }

    /// Position, from the origin, below which the channel stays for this share of the time.
    fn quantile(&mut self, share: f64) -> f64 {
        let channel = self.channel;
        let sorted = self
            .sorted
            .get_or_insert_with(|| sorted_positions(channel, channel.origin));
        quantile(sorted, share)
    }
}

struct Collector<'a> {
    data: &'a Prepared,
    structure: &'a Structure,
    residual: &'a [f64],
    found: Vec<Candidate>,
}

impl Collector<'_> {
    /// One candidate, unless the structure does not allow it.
    fn add(&mut self, entry: &Entry, source: Source, origin: f64, shapes: &[f64]) {
        let name = entry.name;
        let Ok(effect) = Effect::try_from_name(name, shapes) else {
            return;
        };
        let loops = effect.reads_eta() || effect.is_input_stage();
        if loops && !self.structure.hysteresis {
            return;
        }
        if self.structure.no_stages && is_stage(&effect) {
            return;
        }
        let there = self
            .structure
            .terms
            .iter()
            .any(|t| t.source == source && t.effect.name() == name);
        if there && !entry.several {
            return;
        }
        // Only an effect that reads the position has a zero of it.
        let origin = if effect.info().reads.contains(&Quantity::Position) {
            origin
        } else {
            0.0
        };
        let family = effect.info().family;
        self.found.push(Candidate {
            term: FitTerm {
                effect,
                source,
                origin,
                start: [0.0; MOST_RECORDS],
            },
            family,
        });
    }

    /// An effect at all its trial shapes on one channel.
    fn tried(&mut self, entry: &Entry, trials: &Trials, at: &mut Site<'_>) {
        let (source, channel, origin) = (at.source, at.channel, at.origin(entry));
        match trials {
            Trials::At(all) => {
                for trial in *all {
                    let shapes = trial.iter().map(|scale| scale.on(self.data, channel));
                    let shapes: Vec<f64> = shapes.collect();
                    self.add(entry, source, origin, &shapes);
                }
            }
            Trials::Quantiles(shares) => {
                for share in *shares {
                    let position = at.quantile(*share);
                    self.add(entry, source, origin, &[position]);
                }
            }
            Trials::TimeConstants(all) => {
                let free = self.unfilled(channel);
                for tau in all.iter().filter(|tau| free.contains(*tau)) {
                    self.add(entry, source, origin, &[*tau]);
                }
            }
            Trials::Orders => self.orders(entry, source, channel),
            Trials::Moments => {
                for t_s in self.steps() {
                    self.add(entry, source, origin, &[t_s]);
                }
            }
        }
    }

    /// Fifteen positions inside the segment that the fit sees; of several records also
    /// where each begins, as the rig may have been touched before.
    fn steps(&self) -> Vec<f64> {
        let fit = &self.data.split.fit;
        let (Some(&first), Some(&last)) = (fit.first(), fit.last()) else {
            return Vec::new();
        };
        if let [_, next @ ..] = &self.data.pieces[..] {
            if !next.is_empty() {
                let inside = (1..=15).map(|k| self.data.moment(fit[fit.len() * k / 16]));
                let begins = next.iter().filter(|p| p.fitted).map(|p| p.since);
                return inside.chain(begins).collect();
            }
        }
        let place = |k: i32| first as f64 + (last - first) as f64 * f64::from(k) / 16.0;
        (1..=15)
            .map(|k| place(k) * self.data.stride as f64 * self.data.dt)
            .collect()
    }

    /// The strongest lines of the residual's order spectrum, each at its own phase and
    /// at a quarter period from it.
    ///
    /// Orders from two and a half periods over the range (fewer periods are a bent line, not a
    /// ripple) up to the order that is faster than the cut-off at the usual speed.
    fn orders(&mut self, entry: &Entry, source: Source, channel: &Channel) {
        let two_pi = 2.0 * std::f64::consts::PI;
        let range = 2.0 * channel.reach;
        if !(range > 0.0 && channel.speed > 0.0) {
            return;
        }
        let step = two_pi / range / 4.0;
        let highest = (two_pi * self.data.cutoff / channel.speed).min(two_pi / range * 100.0);
        let rows = &self.data.split.fit;
        let mut lines: Vec<(f64, f64, f64)> = Vec::new();
        let mut k = 10.0 * step;
        while k <= highest {
            let (mut s, mut c) = (0.0, 0.0);
            for &row in rows {
                let angle = k * (channel.motion[row * self.data.stride].position - channel.origin);
                s += self.residual[row] * angle.sin();
                c += self.residual[row] * angle.cos();
            }
            lines.push((s * s + c * c, k, c.atan2(s)));
            k += step;
        }
        let peaks: Vec<usize> = (0..lines.len())
            .filter(|&i| {
                (i == 0 || lines[i - 1].0 <= lines[i].0)
                    && (i + 1 == lines.len() || lines[i + 1].0 < lines[i].0)
            })
            .collect();
        let mut peaks: Vec<(f64, f64, f64)> = peaks.into_iter().map(|i| lines[i]).collect();
        peaks.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (_, k, psi) in peaks.into_iter().take(3) {
            for quarter in [0.0, 0.25 * two_pi] {
                self.add(entry, source, channel.origin, &[k, psi + quarter]);
            }
        }
    }

    /// The time constants \[s\] that the motion of a channel does not already cover.
    fn unfilled(&self, channel: &Channel) -> Range<f64> {
        let n = channel.motion.len() as f64;
        let squares = channel.motion.iter();
        let squares = squares.map(|m| (m.position - channel.origin).powi(2));
        let rms = (squares.sum::<f64>() / n).sqrt();
        match channel.speed > 0.0 {
            true => 1.5 * rms / channel.speed..0.5 * n * self.data.dt,
            false => 0.0..0.0,
        }
    }

    /// The effects of the model as a whole.
    fn whole(&mut self) {
        let data = self.data;
        let without = data.mode == Mode::Torque && !self.structure.hysteresis;
        let mut at = Site {
            source: Source::Input,
            channel: &data.input,
            whole: true,
            sorted: None,
        };
        for entry in table() {
            for tried in entry.tried {
                if tried.place == Place::Whole
                    || (tried.place == Place::WholeWithoutTransmission && without)
                {
                    self.tried(entry, &tried.shapes, &mut at);
                }
            }
        }
    }

    /// The effects of one channel.
    fn channel(&mut self, source: Source, channel: &Channel) {
        let mut at = Site {
            source,
            channel,
            whole: false,
            sorted: None,
        };
        for entry in table() {
            for tried in entry.tried {
                if tried.place.is(self.data, source, channel) {
                    self.tried(entry, &tried.shapes, &mut at);
                }
            }
        }
    }
}

fn sorted_positions(channel: &Channel, origin: f64) -> Vec<f64> {
    let mut sorted: Vec<f64> = channel.motion.iter().map(|m| m.position - origin).collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// All candidates for this record, this structure and its residual.
#[must_use]
pub fn candidates(data: &Prepared, structure: &Structure, residual: &[f64]) -> Vec<Candidate> {
    let mut all = Collector {
        data,
        structure,
        residual,
        found: Vec::new(),
    };
    all.whole();
    all.channel(Source::Input, &data.input);
    let channels = data.channels.iter().enumerate();
    for (index, channel) in channels.filter(|(_, channel)| !channel.rests) {
        all.channel(Source::Channel(index as u8), channel);
    }
    all.found
}
