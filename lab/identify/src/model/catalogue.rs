//! Which effects are tried on a record: every family, on every channel, at a few shapes.
//!
//! The shapes are a coarse grid in units of the record's own ranges. What is found is
//! refitted with its shapes free, so the grid need only be close.

use super::kind::{kind, Kind};
use super::structure::{FitTerm, Structure};
use super::variable::Variable;
use crate::problem::{Channel, Prepared, MOST_RECORDS};
use crate::record::Mode;
use bowden::effect::{Effect, Family, Quantity, CATALOGUE};
use bowden::model::Source;

/// An effect that may be missing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// The effect with a trial shape, and what it reads.
    pub term: FitTerm,
    /// Its family.
    pub family: Family,
}

impl From<FitTerm> for Candidate {
    fn from(term: FitTerm) -> Self {
        let family = term.effect.family();
        Self { term, family }
    }
}

impl Candidate {
    /// What the effect is a function of, or stands for.
    #[must_use]
    pub fn variables(&self) -> Vec<Variable> {
        let source = self.term.source;
        let reads = self.term.effect.info().reads;
        let on = |quantity| reads.contains(&quantity);
        let mut all = match self.family {
            Family::PositionFriction => vec![Variable::DirectedPosition(source)],
            Family::LoadFriction | Family::Direction | Family::Capstan => {
                vec![Variable::DirectedLoad(source)]
            }
            Family::Backlash | Family::Presliding | Family::Creep => Vec::new(),
            _ if on(Quantity::Acceleration) => vec![Variable::Acceleration(source)],
            _ if on(Quantity::Velocity) => vec![Variable::Velocity(source)],
            _ if on(Quantity::Eta) => vec![Variable::Eta],
            _ if on(Quantity::Time) => vec![Variable::Time],
            _ => vec![Variable::Position(source)],
        };
        let local = matches!(
            self.family,
            Family::Backlash
                | Family::Presliding
                | Family::Creep
                | Family::Stribeck
                | Family::Coulomb
                | Family::Asymmetry
                | Family::Delay
                | Family::Lag
                | Family::Rate
                | Family::Pinching
        );
        if local {
            all.extend([
                Variable::ReversalDistance(source),
                Variable::ReversalTime(source),
            ]);
        }
        if self.family == Family::Backlash {
            all.push(Variable::Position(source));
        }
        all
    }

    /// Whether the other is the same effect of the same channel, of whatever shape.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        let name = |one: &Self| (one.term.effect.name(), one.term.source);
        name(self) == name(other)
    }
}

/// From the simplest to the least simple: of two rivals the earlier one is named.
pub const SIMPLICITY: [Family; 28] = [
    Family::Offset,
    Family::Gain,
    Family::Viscous,
    Family::Coulomb,
    Family::Inertia,
    Family::Delay,
    Family::Lag,
    Family::Stiffness,
    Family::Gravity,
    Family::Temperature,
    Family::Drift,
    Family::Pretension,
    Family::Asymmetry,
    Family::Drag,
    Family::LoadFriction,
    Family::Crosstalk,
    Family::PositionFriction,
    Family::Saturation,
    Family::Direction,
    Family::Capstan,
    Family::Rate,
    Family::Stribeck,
    Family::Backlash,
    Family::Presliding,
    Family::Creep,
    Family::Pinching,
    Family::Degradation,
    Family::Ripple,
];

/// Rank: the family's in [`SIMPLICITY`], then the effect's place in the core's catalogue.
#[must_use]
pub fn simplicity(effect: &Effect<f64>) -> (usize, usize) {
    let family = SIMPLICITY
        .iter()
        .position(|&f| f == effect.family())
        .unwrap_or(SIMPLICITY.len());
    let own = CATALOGUE
        .iter()
        .position(|info| info.name == effect.name())
        .unwrap_or(CATALOGUE.len());
    (family, own)
}

/// Value below which the share `q` of the channel's positions lies, from its origin.
fn quantile(sorted: &[f64], q: f64) -> f64 {
    let at = ((sorted.len() - 1) as f64 * q).round() as usize;
    sorted[at]
}

struct Collector<'a> {
    data: &'a Prepared,
    structure: &'a Structure,
    residual: &'a [f64],
    found: Vec<Candidate>,
}

impl Collector<'_> {
    fn add(&mut self, source: Source, origin: f64, name: &str, shapes: &[f64]) {
        let Ok(effect) = Effect::try_from_name(name, shapes) else {
            return;
        };
        let loops = effect.reads_eta() || effect.is_input_stage();
        if loops && !self.structure.hysteresis {
            return;
        }
        if self.structure.no_stages && (effect.is_output_stage() || effect.is_input_stage()) {
            return;
        }
        let several = matches!(
            effect.family(),
            Family::Ripple | Family::Presliding | Family::Pretension
        ) || name == "hinge";
        let there = self
            .structure
            .terms
            .iter()
            .any(|t| t.source == source && t.effect.name() == name);
        if there && !several {
            return;
        }
        // Only an effect that reads the position has a zero of it.
        let origin = if effect.info().reads.contains(&Quantity::Position) {
            origin
        } else {
            0.0
        };
        let family = effect.family();
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

    fn motion(&mut self, source: Source, channel: &Channel, loaded: bool) {
        let (o, speed, reach) = (channel.origin, channel.speed, channel.reach);
        self.add(source, o, "viscous", &[]);
        self.add(source, o, "drag-quadratic", &[]);
        self.add(source, o, "drag-cubic", &[]);
        for width in [0.01, 0.08] {
            self.add(source, o, "coulomb", &[width * speed]);
        }
        for v_s in [0.05, 0.15, 0.4] {
            self.add(source, o, "stribeck", &[v_s * speed, 1.0]);
        }
        self.add(source, o, "asymmetry-viscous", &[]);
        self.add(source, o, "asymmetry-drag", &[]);
        self.add(source, o, "inertia", &[]);
        self.stiffness(source, channel);
        if matches!(channel.unit.as_deref(), None | Some("rad"))
            && self.data.mode == Mode::Torque
            && reach > 0.3
        {
            for psi in [0.0, 0.25, 0.5, 0.75] {
                self.add(source, 0.0, "gravity", &[psi * std::f64::consts::PI]);
            }
        }
        for width in [0.01, 0.08] {
            self.add(source, o, "position-friction", &[width * speed]);
        }
        self.add(source, o, "position-hysteresis", &[]);
        if loaded {
            for name in ["load-friction", "drive-friction", "back-drive-friction"] {
                self.add(source, o, name, &[0.05 * speed]);
            }
            self.add(source, o, "capstan", &[0.05 * speed, 0.2 / reach]);
        }
        for r in [0.03, 0.1, 0.3] {
            self.add(source, o, "backlash", &[r * reach]);
        }
        // A torque has no slack: only a motion can be handed on late.
        if source == Source::Input {
            for r in [0.01, 0.03, 0.1, 0.3] {
                self.add(source, o, "play-in-series", &[r * reach]);
            }
        }
        for r in [0.08, 0.16, 0.3, 0.55] {
            self.add(source, o, "dead-zone", &[r * reach]);
        }
        for r in [0.01, 0.03, 0.1, 0.3, 0.8] {
            self.add(source, o, "presliding", &[r * reach]);
            self.add(source, o, "presliding-dahl", &[r * reach]);
        }
        self.creep(source, channel);
        self.ripple(source, channel);
        self.add(source, o, "rate", &[]);
        self.add(source, o, "rate-symmetric", &[]);
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
    /// Orders from two and a half periods over the range (fewer are no ripple but a bent line) up to where the usual speed
    /// makes them faster than the cut-off.
    fn ripple(&mut self, source: Source, channel: &Channel) {
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
                self.add(source, channel.origin, "ripple", &[k, psi + quarter]);
            }
        }
    }

    fn stiffness(&mut self, source: Source, channel: &Channel) {
        let o = channel.origin;
        for name in [
            "stiffness-linear",
            "stiffness-quadratic",
            "stiffness-cubic",
            "stiffness-progressive",
        ] {
            self.add(source, o, name, &[]);
        }
        let sorted = sorted_positions(channel, o);
        for q in [0.25, 0.5, 0.75] {
            self.add(source, o, "hinge", &[quantile(&sorted, q)]);
        }
        for q in [0.8, 0.92] {
            self.add(source, o, "saturation-upper", &[quantile(&sorted, q)]);
            self.add(source, o, "saturation-lower", &[quantile(&sorted, 1.0 - q)]);
        }
    }

    /// Creep needs time constants that the motion does not already fill.
    fn creep(&mut self, source: Source, channel: &Channel) {
        let n = channel.motion.len() as f64;
        let rms = (channel
            .motion
            .iter()
            .map(|m| (m.position - channel.origin).powi(2))
            .sum::<f64>()
            / n)
            .sqrt();
        for tau in [0.1, 1.0, 10.0] {
            if channel.speed > 0.0
                && tau >= 1.5 * rms / channel.speed
                && tau < 0.5 * n * self.data.dt
            {
                self.add(source, channel.origin, "creep", &[tau]);
            }
        }
    }

    fn torque(&mut self, channel: &Channel) {
        let (source, o) = (Source::Input, channel.origin);
        for name in [
            "stiffness-quadratic",
            "stiffness-cubic",
            "stiffness-progressive",
        ] {
            self.add(source, o, name, &[]);
        }
        let sorted = sorted_positions(channel, o);
        for q in [0.8, 0.92] {
            self.add(source, o, "saturation-upper", &[quantile(&sorted, q)]);
            self.add(source, o, "saturation-lower", &[quantile(&sorted, 1.0 - q)]);
        }
        for r in [0.03, 0.1, 0.3] {
            self.add(source, o, "backlash", &[r * channel.reach]);
            self.add(source, o, "dead-zone", &[r * channel.reach]);
        }
        for r in [0.03, 0.1, 0.3, 0.8] {
            self.add(source, o, "presliding", &[r * channel.reach]);
            self.add(source, o, "presliding-dahl", &[r * channel.reach]);
        }
        self.creep(source, channel);
        self.add(source, o, "rate", &[]);
        self.add(source, o, "rate-symmetric", &[]);
    }

    fn whole_model(&mut self) {
        let input = Source::Input;
        self.add(input, 0.0, "offset", &[]);
        if self.data.mode == Mode::Torque && !self.structure.hysteresis {
            self.add(input, 0.0, "gain", &[]);
        }
        self.add(input, 0.0, "delay", &[]);
        for share in [0.02, 0.2, 1.0] {
            self.add(
                input,
                0.0,
                "lag",
                &[share * self.data.input.reach / self.data.input.speed.max(1e-300)],
            );
        }
        self.add(input, 0.0, "asymmetry-eta", &[]);
        self.add(input, 0.0, "asymmetry-eta-squared", &[]);
        let path = self.data.path.last().copied().unwrap_or(1.0);
        for share in [0.1, 1.0] {
            self.add(input, 0.0, "degradation", &[share * path]);
        }
        for w in [0.2, 0.5] {
            self.add(input, 0.0, "pinching", &[w]);
        }
        self.add(input, 0.0, "drift", &[]);
        for t_s in self.steps() {
            self.add(input, 0.0, "pretension", &[t_s]);
        }
    }
}

fn sorted_positions(channel: &Channel, origin: f64) -> Vec<f64> {
    let mut sorted: Vec<f64> = channel.motion.iter().map(|m| m.position - origin).collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// All candidates for this record, this structure and what it leaves.
#[must_use]
pub fn candidates(data: &Prepared, structure: &Structure, residual: &[f64]) -> Vec<Candidate> {
    let mut all = Collector {
        data,
        structure,
        residual,
        found: Vec::new(),
    };
    all.whole_model();
    let loaded = data.mode == Mode::Torque || data.load.is_some();
    let channels = std::iter::once((Source::Input, &data.input)).chain(
        data.channels
            .iter()
            .enumerate()
            .map(|(i, c)| (Source::Channel(i as u8), c)),
    );
    for (source, channel) in channels {
        match kind(data.mode, source, channel) {
            Kind::Motion => all.motion(source, channel, loaded),
            Kind::Torque => all.torque(channel),
            Kind::Temperature => all.add(source, 0.0, "temperature", &[channel.middle]),
            Kind::Load | Kind::Other => all.add(source, channel.origin, "crosstalk", &[]),
        }
    }
    all.found
}
