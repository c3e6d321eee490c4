//! The non-linear parameters of a model.

use super::range::Range;
use super::term::TermId;

/// The role of a free parameter.
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
    /// A shape of a term.
    Shape {
        /// Which term.
        term: TermId,
        /// Index of the shape in the effect.
        index: usize,
    },
    /// The origin from which a term measures position.
    Origin {
        /// Which term.
        term: TermId,
    },
    /// The memory of a term from before a record.
    Start {
        /// Which term.
        term: TermId,
        /// Index of the record.
        record: usize,
    },
    /// The gain of an output stage: it acts on all columns, so it is not linear.
    Stage {
        /// Which term.
        term: TermId,
    },
}

impl Role {
    /// The term that the parameter belongs to; `None` for those of the transmission.
    #[must_use]
    pub fn term(self) -> Option<TermId> {
        match self {
            Self::Shape { term, .. }
            | Self::Origin { term }
            | Self::Start { term, .. }
            | Self::Stage { term } => Some(term),
            Self::Rho | Self::Sigma | Self::N | Self::Eta0 { .. } => None,
        }
    }

    /// The same parameter of another term.
    pub(super) fn of(self, term: TermId) -> Self {
        match self {
            Self::Shape { index, .. } => Self::Shape { term, index },
            Self::Origin { .. } => Self::Origin { term },
            Self::Start { record, .. } => Self::Start { term, record },
            Self::Stage { .. } => Self::Stage { term },
            Self::Rho | Self::Sigma | Self::N | Self::Eta0 { .. } => self,
        }
    }
}

/// A non-linear parameter and its range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Free {
    /// The role of the parameter.
    pub role: Role,
    /// Its range.
    pub range: Range,
}
