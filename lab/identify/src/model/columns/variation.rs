//! The derivative of an effect's column with respect to one of its parameters.

use super::{effect_column, effect_on, STEP};
use crate::model::structure::{FitTerm, Range, Role, TermId};
use crate::problem::{Prepared, Stretch};

/// A parameter of a term that its column depends on.
pub(super) enum Variation {
    Shape { index: usize },
    Start { record: usize },
    Origin,
}

impl Variation {
    /// The part of a term that a free parameter varies; `None` if the parameter belongs to another
    /// term or to the transmission.
    pub(super) fn of(own: TermId, role: Role) -> Option<Self> {
        match role {
            Role::Shape { term, index } if term == own => Some(Self::Shape { index }),
            Role::Start { term, record } if term == own => Some(Self::Start { record }),
            Role::Origin { term } if term == own => Some(Self::Origin),
            _ => None,
        }
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

    /// d column / d parameter by a difference; `column` is the term's own at that value.
    /// What a record began with moves that record alone.
    pub(super) fn slope(
        &self,
        data: &Prepared,
        term: &FitTerm,
        (range, value): (Range, f64),
        (column, eta): (&Stretch, &[f64]),
    ) -> Option<Stretch> {
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
        let samples = own
            .as_ref()
            .map_or(column.range(), |(_, work)| work.clone());
        let difference = |up: &[f64], down: &[f64], step: f64| {
            let pairs = up.iter().zip(down);
            let slope = pairs.map(|(a, b)| (a - b) / step).collect();
            Stretch::at(samples.start, slope)
        };
        let half = match *self {
            // The column is a step in time: by a sample to either side.
            Self::Shape { index } if term.is_moment(index) => data.dt,
            // It has a corner where it starts from, as a play that touches neither flank.
            Self::Start { .. } | Self::Origin => 1e-5 * data.channel(term.source)?.reach,
            Self::Shape { .. } => {
                let step = STEP * range.scale(value);
                return Some(difference(&at(value + step)?, column.on(&samples), step));
            }
        };
        Some(difference(
            &at(value + half)?,
            &at(value - half)?,
            2.0 * half,
        ))
    }
}
