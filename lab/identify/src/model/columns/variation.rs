//! The slope of an effect's column in one of its own parameters.

use super::{effect_column, effect_on};
use crate::model::structure::{FitTerm, Role, TermId};
use crate::problem::{Prepared, Stretch};

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
    /// What a record began with moves that record alone.
    pub(super) fn slope(
        &self,
        data: &Prepared,
        term: &FitTerm,
        value: f64,
        eta: &[f64],
    ) -> Option<Stretch> {
        let step = self.step(data, term, value)?;
        let own = match *self {
            Self::Start { record } => Some((record, data.pieces.get(record)?.work.clone())),
            Self::Shape { .. } | Self::Origin => None,
        };
        let at = |value: f64| {
            let moved = self.moved(term, value)?;
            match &own {
                Some((record, work)) => effect_on(data, &moved, *record, &eta[work.clone()]),
                None => effect_column(data, &moved, eta),
            }
        };
        let (up, down) = (at(value + step)?, at(value - step)?);
        let pairs = up.iter().zip(&down);
        let slope = pairs.map(|(a, b)| (a - b) / (2.0 * step));
        let start = own.map_or(0, |(_, work)| work.start);
        Some(Stretch::at(start, slope.collect()))
    }
}
