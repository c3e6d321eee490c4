//! What is fitted: hysteresis or not, which effects, and which shapes are free.

use super::effects::{entry, Entry, FittedZero, Stage};
use super::Table;
use crate::problem::{Prepared, MOST_RECORDS};
use crate::record::Mode;
use bowden::effect::Effect;
use bowden::model::Source;

pub use super::range::Range;

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
        entry(self.effect.name()).is_some_and(|entry| entry.past)
    }

    /// Whether a shape is a moment of the record, which moves by whole samples.
    pub(crate) fn is_moment(&self, shape: usize) -> bool {
        entry(self.effect.name()).is_some_and(|entry| entry.is_moment(shape))
    }

    /// Whether the effect happens at a moment of the record.
    pub(crate) fn has_moment(&self) -> bool {
        (0..self.effect.shape_names().len()).any(|shape| self.is_moment(shape))
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
            let Some(entry) = entry(fit.effect.name()) else {
                continue;
            };
            if let Some(stage) = entry.stage {
                let range = match stage {
                    Stage::Periods(most) => Range::Linear(-most / data.cutoff, most / data.cutoff),
                    Stage::Number(most) => Range::Linear(-most, most),
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
            if self.origin_matters(entry, fit) {
                let (middle, reach) = (channel.middle, channel.reach);
                free.push(Free {
                    role: Role::Origin { term },
                    range: Range::Linear(middle - 1.5 * reach, middle + 1.5 * reach),
                });
            }
            for (index, bounds) in entry.bounds.iter().enumerate() {
                let value = fit.effect.shape(index).unwrap_or(0.0);
                if let Some(range) = bounds.on(data, channel, value) {
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
    fn origin_matters(&self, entry: &Entry, term: &FitTerm) -> bool {
        let spanned = |names: &[&str]| {
            names.iter().all(|name| {
                (*name == "stiffness-linear" && self.hysteresis && term.source == Source::Input)
                    || self
                        .terms
                        .iter()
                        .any(|t| t.source == term.source && t.effect.name() == *name)
            })
        };
        match entry.fitted_zero {
            FittedZero::Never => false,
            FittedZero::Always => true,
            FittedZero::Unless(names) => !spanned(names),
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
            let friction = entry(term.effect.name()).is_some_and(|entry| entry.takes_energy);
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
