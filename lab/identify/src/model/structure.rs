//! What is fitted: hysteresis or not, which effects, and which shapes are free.

use super::Table;
use crate::problem::{Channel, Prepared, MOST_RECORDS};
use crate::record::Mode;
use bowden::effect::{Effect, Family};
use bowden::model::Source;

/// One effect in a model under fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitTerm {
    /// The effect with its present shapes.
    pub effect: Effect<f64>,
    /// The motion that it reads.
    pub source: Source,
    /// The origin from which it measures position.
    pub origin: f64,
    /// How far the channel had moved just before each record began: what an effect with
    /// memory remembers of that is unknown and is fitted.
    pub start: [f64; MOST_RECORDS],
}

impl FitTerm {
    /// Whether its gain is one of the linear ones: that of an output stage acts on all
    /// columns, and an input stage has a gain of one.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        !self.effect.is_output_stage() && !self.effect.is_input_stage()
    }

    /// Whether the effect remembers motion from before the record.
    #[must_use]
    pub fn has_past(&self) -> bool {
        matches!(
            self.effect.family(),
            Family::Creep | Family::Presliding | Family::Backlash
        ) && self.effect.has_memory()
    }
}

/// A model under fit: what is in it, not how large it is.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Structure {
    /// Whether a Bouc-Wen transmission is part of it.
    pub hysteresis: bool,
    /// How many records have a gain, kappa_eta and offset of their own; 0 where these are
    /// common to all.
    pub own_gains: usize,
    /// The effects, in the order in which they came.
    pub terms: Vec<FitTerm>,
    /// A curve over one variable, for what has no name.
    pub table: Option<Table>,
    /// Whether output stages and input stages are kept out of the search: a model with one
    /// of them has no inverse.
    pub no_stages: bool,
    /// Whether the gains are confined to those for which the transmission has an inverse,
    /// `sigma <= B/(2·kappa_eta·rho)`.
    pub invertible: bool,
}

/// A free parameter's range, mapped to the whole line so that bounds hold by construction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// Between two positive bounds, logarithmic.
    Log(f64, f64),
    /// Between two bounds.
    Linear(f64, f64),
    /// Lower end plus a positive logarithmic part between two bounds.
    Above(f64, f64, f64),
    /// Not bounded (a phase).
    Free,
}

fn logistic(u: f64) -> f64 {
    1.0 / (1.0 + (-u).exp())
}

fn logit(p: f64) -> f64 {
    let p = p.clamp(1e-6, 1.0 - 1e-6);
    (p / (1.0 - p)).ln()
}

impl Range {
    /// The value at a point of the line.
    #[must_use]
    pub fn decode(self, u: f64) -> f64 {
        match self {
            Self::Log(lo, hi) => lo * (hi / lo).powf(logistic(u)),
            Self::Linear(lo, hi) => lo + (hi - lo) * logistic(u),
            Self::Above(base, lo, hi) => base + lo * (hi / lo).powf(logistic(u)),
            Self::Free => u,
        }
    }

    /// The point of the line for a value; values on a bound land near it.
    #[must_use]
    pub fn encode(self, value: f64) -> f64 {
        let log = |v: f64, lo: f64, hi: f64| logit((v.max(lo) / lo).ln() / (hi / lo).ln());
        match self {
            Self::Log(lo, hi) => log(value, lo, hi),
            Self::Linear(lo, hi) => logit((value - lo) / (hi - lo)),
            Self::Above(base, lo, hi) => log(value - base, lo, hi),
            Self::Free => value,
        }
    }

    /// d value / d u.
    #[must_use]
    pub fn slope(self, u: f64) -> f64 {
        let p = logistic(u);
        match self {
            Self::Log(lo, hi) => self.decode(u) * (hi / lo).ln() * p * (1.0 - p),
            Self::Linear(lo, hi) => (hi - lo) * p * (1.0 - p),
            Self::Above(base, lo, hi) => (self.decode(u) - base) * (hi / lo).ln() * p * (1.0 - p),
            Self::Free => 1.0,
        }
    }

    /// The bound that is nearer to a value, in words.
    #[must_use]
    pub fn nearest(self, value: f64) -> &'static str {
        if self.encode(value) < 0.0 {
            "lower"
        } else {
            "upper"
        }
    }

    /// Whether the point lies within 1 % of the range's width from an end.
    #[must_use]
    pub fn at_bound(self, u: f64) -> bool {
        let p = logistic(u);
        !matches!(self, Self::Free) && !(0.01..=0.99).contains(&p)
    }
}

/// What a free parameter is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Bouc-Wen rho.
    Rho,
    /// Bouc-Wen sigma.
    Sigma,
    /// Bouc-Wen n.
    N,
    /// The hysteresis state at the first sample of a record.
    Eta0 {
        /// Index of the record.
        record: usize,
    },
    /// Shape `index` of term `term`.
    Shape {
        /// Index of the term.
        term: usize,
        /// Index of the shape in the effect.
        index: usize,
    },
    /// The origin from which term `term` measures position.
    Origin {
        /// Index of the term.
        term: usize,
    },
    /// What term `term` remembers from before a record.
    Start {
        /// Index of the term.
        term: usize,
        /// Index of the record.
        record: usize,
    },
    /// The gain of an output stage: it acts on all columns, so it is not linear.
    Stage {
        /// Index of the term.
        term: usize,
    },
}

/// A non-linear parameter and its range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Free {
    /// What it is.
    pub role: Role,
    /// Where it may lie.
    pub range: Range,
}

/// Ranges of rho in units of one over the input's half-range.
///
/// Below the lower end the loop is a line within 1 %, above the upper end a relay.
const RHO: (f64, f64) = (0.02, 2000.0);
/// Range of sigma − 1/2. There is no physical upper end; on this one the unloading
/// branch is a jump at any usual sampling.
const SIGMA: (f64, f64) = (1e-3, 3000.0);
/// Range of n − 1. Above, the knee is a corner.
const N: (f64, f64) = (1e-3, 30.0);

impl Structure {
    /// The non-linear parameters with their ranges for this record.
    #[must_use]
    pub fn free(&self, data: &Prepared) -> Vec<Free> {
        let mut free = Vec::new();
        if self.hysteresis {
            let x = data.input.reach;
            free.push(Free {
                role: Role::Rho,
                range: Range::Log(RHO.0 / x, RHO.1 / x),
            });
            free.push(Free {
                role: Role::Sigma,
                range: Range::Above(0.5, SIGMA.0, SIGMA.1),
            });
            free.push(Free {
                role: Role::N,
                range: Range::Above(1.0, N.0, N.1),
            });
            free.extend(fitted(data).map(|record| Free {
                role: Role::Eta0 { record },
                range: Range::Linear(-1.0, 1.0),
            }));
        }
        for (term, fit) in self.terms.iter().enumerate() {
            let Some(channel) = data.channel(fit.source) else {
                continue;
            };
            if fit.effect.is_output_stage() {
                let range = match fit.effect.family() {
                    Family::Delay => Range::Linear(-2.0 / data.cutoff, 2.0 / data.cutoff),
                    _ => Range::Linear(-3.0, 3.0),
                };
                free.push(Free {
                    role: Role::Stage { term },
                    range,
                });
            }
            if fit.has_past() {
                let reach = 2.0 * channel.reach;
                free.extend(fitted(data).map(|record| Free {
                    role: Role::Start { term, record },
                    range: Range::Linear(-reach, reach),
                }));
            }
            if self.origin_matters(fit) {
                let (middle, reach) = (channel.middle, channel.reach);
                free.push(Free {
                    role: Role::Origin { term },
                    range: Range::Linear(middle - 1.5 * reach, middle + 1.5 * reach),
                });
            }
            for (index, name) in fit.effect.shape_names().iter().enumerate() {
                let value = fit.effect.shape(index).unwrap_or(0.0);
                if let Some(range) = shape_range(
                    name,
                    value,
                    channel,
                    data,
                    fit.effect.family() == Family::Lag,
                ) {
                    free.push(Free {
                        role: Role::Shape { term, index },
                        range,
                    });
                }
            }
        }
        free
    }

    /// Whether a term's zero of position can be told from the record: moving it must
    /// not be the same as adding what the model has anyway.
    fn origin_matters(&self, term: &FitTerm) -> bool {
        let spanned = |names: &[&str]| {
            names.iter().all(|name| {
                (*name == "stiffness-linear" && self.hysteresis && term.source == Source::Input)
                    || self
                        .terms
                        .iter()
                        .any(|t| t.source == term.source && t.effect.name() == *name)
            })
        };
        match term.effect.name() {
            "stiffness-quadratic" => !spanned(&["stiffness-linear"]),
            "stiffness-cubic" => !spanned(&["stiffness-linear", "stiffness-quadratic"]),
            "position-friction" => !self
                .terms
                .iter()
                .any(|t| t.source == term.source && t.effect.name() == "coulomb"),
            "stiffness-progressive" | "dead-zone" | "capstan" => true,
            _ => false,
        }
    }

    /// Number of the transmission's linear gains: three, or three of each record.
    #[must_use]
    pub fn base(&self) -> usize {
        match self.hysteresis {
            true => 3 * self.own_gains.max(1),
            false => 0,
        }
    }

    /// Number of linear gains.
    #[must_use]
    pub fn linear(&self) -> usize {
        self.base() + self.terms.iter().filter(|t| t.is_linear()).count() + self.table_gains()
    }

    /// How many of the linear gains, the last ones, are those of the table.
    #[must_use]
    pub fn table_gains(&self) -> usize {
        self.table.as_ref().map_or(0, |table| table.shapes.len())
    }

    /// Whether a gain must not be negative.
    ///
    /// Only where the input is a displacement and the output a force: there friction
    /// takes energy out. In torque mode the sign follows the encoder's mounting.
    #[must_use]
    pub fn sign_kept(&self, mode: Mode) -> Vec<bool> {
        let mut kept = vec![false; self.base()];
        for term in self.terms.iter().filter(|t| t.is_linear()) {
            let friction = matches!(term.effect.family(), Family::Viscous | Family::Coulomb);
            kept.push(friction && mode == Mode::Displacement && term.source == Source::Input);
        }
        kept.resize(kept.len() + self.table_gains(), false);
        kept
    }
}

/// The records of which the fit sees something: only their states at the start can be told.
fn fitted(data: &Prepared) -> impl Iterator<Item = usize> + '_ {
    let pieces = data.pieces.iter().take(MOST_RECORDS).enumerate();
    pieces.filter(|(_, p)| p.fitted).map(|(record, _)| record)
}

/// The range over which a shape is fitted; `None` where it stays as it was set.
fn shape_range(
    name: &str,
    value: f64,
    channel: &Channel,
    data: &Prepared,
    lag: bool,
) -> Option<Range> {
    let (reach, speed) = (channel.reach, channel.speed);
    if !(reach > 0.0 && speed > 0.0) {
        return None;
    }
    let seconds = data.work_len() as f64 * data.dt;
    Some(match name {
        // Wider than this it is no dry friction any more but a bent viscous term.
        "v_e" => Range::Log(1e-3 * speed, 0.15 * speed),
        // Stribeck friction is a matter of low speed.
        "v_s" => Range::Log(1e-2 * speed, 0.5 * speed),
        "a" => Range::Linear(0.5, 3.0),
        "t_s" => {
            let at = |row: Option<&usize>| row.map_or(0.0, |&r| data.moment(r));
            Range::Linear(at(data.split.fit.first()), at(data.split.fit.last()))
        }
        "x_h" | "x_s" => Range::Linear(-reach, reach),
        "psi" => Range::Free,
        "k" => Range::Log(0.8 * value, 1.25 * value),
        "r" => Range::Log(2e-3 * reach, 1.9 * reach),
        // A lag slower than the motion is creep or drift under another name.
        "tau" if lag => Range::Log(0.2 * data.dt, 3.0 * reach / speed),
        "tau" => Range::Log(0.5 * data.dt, 0.5 * seconds),
        "w" => Range::Log(0.03, 3.0),
        "mu" => Range::Log(1e-3 / reach, 3.0 / reach),
        "w_c" => {
            let path = data.path.last().copied().unwrap_or(1.0);
            Range::Log(0.01 * path, 30.0 * path)
        }
        "f" => Range::Log(0.97 * value, 1.03 * value),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn ranges_map_there_and_back_and_their_slopes_are_derivatives() {
        for range in [
            Range::Log(1e-3, 50.0),
            Range::Linear(-2.0, 5.0),
            Range::Above(0.5, 1e-3, 1e3),
            Range::Free,
        ] {
            for u in [-3.0, -0.2, 0.0, 1.7, 4.0] {
                let value = range.decode(u);
                assert_relative_eq!(range.encode(value), u, epsilon = 1e-6);
                let h = 1e-6;
                let numeric = (range.decode(u + h) - range.decode(u - h)) / (2.0 * h);
                // Central differences of a smooth function: relative error about h².
                assert_relative_eq!(range.slope(u), numeric, max_relative = 1e-6);
            }
        }
    }
}
