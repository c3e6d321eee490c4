//! The slope of an effect's column in one of its own parameters.

use super::effect_column;
use crate::model::structure::{FitTerm, Role, TermId};
use crate::problem::Prepared;

/// A parameter of a term that its column depends on.
pub(super) enum Variation {
    Shape { index: usize },
    Start { record: usize },
    Origin,
}

impl Variation {
    /// What a free parameter varies of a term; `None` where it belongs to another one, or to
    /// the transmission.
    pub(super) fn of(own: TermId, role: Role) -> Option<Self> {
        match role {
            Role::Shape { term, index } if term == own => Some(Self::Shape { index }),
            Role::Start { term, record } if term == own => Some(Self::Start { record }),
            Role::Origin { term } if term == own => Some(Self::Origin),
            _ => None,
        }
    }

    /// Step of the central difference at a value.
    fn step(&self, data: &Prepared, term: &FitTerm, value: f64) -> Option<f64> {
        Some(match self {
            Self::Shape { index } if term.is_moment(*index) => data.dt,
            Self::Shape { .. } => 1e-5 * value.abs().max(1e-6),
            Self::Start { .. } | Self::Origin => 1e-5 * data.channel(term.source)?.reach,
        })
    }

    /// The term with another value of the parameter.
    fn moved(&self, term: &FitTerm, value: f64) -> Option<FitTerm> {
        let mut moved = *term;
        match self {
            Self::Shape { index } => moved.effect = term.effect.with_shape(*index, value).ok()?,
            Self::Start { record } => moved.start[*record] = value,
            Self::Origin => moved.origin = value,
        }
        Some(moved)
    }

    /// d column / d parameter by central differences: the effects' shapes are few and smooth.
    pub(super) fn slope(
        &self,
        data: &Prepared,
        term: &FitTerm,
        value: f64,
        eta: &[f64],
    ) -> Option<Vec<f64>> {
        let step = self.step(data, term, value)?;
        let up = effect_column(data, &self.moved(term, value + step)?, eta)?;
        let down = effect_column(data, &self.moved(term, value - step)?, eta)?;
        let pairs = up.iter().zip(&down);
        Some(pairs.map(|(a, b)| (a - b) / (2.0 * step)).collect())
    }
}
