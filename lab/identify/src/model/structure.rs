//! What is fitted: hysteresis or not, which effects, and which shapes are free.

use super::effects::{entry, Entry, FittedZero, Stage};
use super::Table;
use crate::problem::{Prepared, MOST_RECORDS};
use crate::record::Mode;
use bowden::model::Source;

pub use super::parameter::{Free, Role};
pub use super::range::Range;
pub use super::term::{FitTerm, TermId};
pub use super::terms::Terms;

/// The structure of a model under fit: its parts, without their gains.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Structure {
    /// Whether it contains a Bouc-Wen transmission.
    pub hysteresis: bool,
    /// Number of records with their own gain, kappa_eta and offset; 0 if these are common to all
    /// records.
    pub own_gains: usize,
    /// The effects, in the order in which they were added.
    pub terms: Terms,
    /// A curve over one variable, for a dependence that matches no effect.
    pub table: Option<Table>,
    /// Whether the search excludes output stages and input stages: a model with such a stage has no
    /// inverse.
    pub no_stages: bool,
    /// Whether a delay may be negative. No transmission has a lead: only a test of the clocks of a
    /// record allows one.
    pub may_lead: bool,
    /// Whether the gains are confined to those for which the transmission has an inverse,
    /// `sigma <= B/(2·kappa_eta·rho)`.
    pub invertible: bool,
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
        for (term, fit) in self.terms.with_ids() {
            let Some(channel) = data.channel(fit.source) else {
                continue;
            };
            let Some(entry) = entry(fit.effect.name()) else {
                continue;
            };
            if let Some(stage) = entry.stage {
                let most = match stage {
                    Stage::Periods(most) => most / data.cutoff,
                    Stage::Number(most) => most,
                };
                let least = if self.may_lead { -most } else { 0.0 };
                let range = Range::Linear(least, most);
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

    /// Whether the record determines a term's origin of position: moving the origin must differ
    /// from adding terms that the model already has.
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

    /// Whether any part reads the input, or a channel.
    #[must_use]
    pub fn reads(&self, source: Source) -> bool {
        let is_input = self.hysteresis && source == Source::Input;
        is_input || self.terms.iter().any(|t| t.source == source)
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

    /// Number of linear gains of the table, which are the last ones.
    #[must_use]
    pub fn table_gains(&self) -> usize {
        self.table.as_ref().map_or(0, |table| table.shapes.len())
    }

    /// The required sign of each linear gain, 1 or −1; 0 if it may have either sign.
    ///
    /// Only if the input is a displacement and the output a force: then friction dissipates energy.
    /// In torque mode the sign depends on the mounting of the encoder.
    #[must_use]
    pub fn signs(&self, data: &Prepared) -> Vec<f64> {
        let mut signs = vec![0.0; self.base()];
        for term in self.terms.iter().filter(|t| t.is_linear()) {
            signs.push(sign(data, term));
        }
        signs.resize(signs.len() + self.table_gains(), 0.0);
        signs
    }
}

/// The required sign of a term's gain; 0 if it may have either sign.
pub(crate) fn sign(data: &Prepared, term: &FitTerm) -> f64 {
    let friction = entry(term.effect.name()).is_some_and(|entry| entry.takes_energy);
    match (friction && term.source == Source::Input, data.mode) {
        (true, Mode::Displacement) if data.against => -1.0,
        (true, Mode::Displacement) => 1.0,
        _ => 0.0,
    }
}

/// The records that are part of the fit segment: only their initial states can be determined.
fn fitted(data: &Prepared) -> impl Iterator<Item = usize> + '_ {
    let pieces = data.pieces.iter().take(MOST_RECORDS).enumerate();
    pieces.filter(|(_, p)| p.fitted).map(|(record, _)| record)
}
