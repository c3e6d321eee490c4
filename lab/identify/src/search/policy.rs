//! Every threshold of the search, each with the experiment that set it, or with the words "a
//! choice" if no experiment did.
//!
//! Planted records are those of `examples/operating_characteristics`: 20 s at 1 kHz, with Bouc-Wen
//! as the baseline. SSE is the squared error on the fit segment.

use crate::scale::{HALF, PART};

/// Range of the minimum reduction of ln SSE if the blocks are too short for a test.
///
/// With the lower end, coloured nulls with few independent values gave no term. The upper end is a
/// choice: an effect that halves the SSE (0.69) is always worth a proposal.
pub const LEAST_UNTESTED: (f64, f64) = (0.105, 0.69);

/// Minimum squared norm of the residual of a unit-norm column after regression on the model.
///
/// The value is a choice: below this value, rounding errors and model errors determine the
/// coefficient.
pub const EXCITED: f64 = 1e-4;

/// If a term removes at least this share of the SSE, its only condition on the selection segment is
/// that it does not raise the error.
///
/// No record without a missing effect has reached this share.
pub const LARGE: f64 = 0.3;

/// The value of [`LARGE`] if the blocks are too short for a test.
///
/// The value is a choice: a residual with a longer memory gives larger shares by chance.
pub const LARGE_UNTESTED: f64 = 0.6;

/// Minimum reduction of ln SSE by an unmodelled curve, compared with the best set of terms, while
/// further terms are still found: a factor of 2.
///
/// The value is a choice: a curve of ten hat functions fits any two terms over one variable, so it
/// must be clearly better. If the residual exceeds the noise, the same value applies to a power law
/// that replaces viscous and Coulomb friction. On measured records that this pair describes, the
/// power law lowers ln SSE by up to 0.21 more, in every block. The difference is 0.17 on the
/// positioning drive, which has viscous and Coulomb friction. It is 0.21 on a damper, where the
/// power law transfers worse to other records (`lab/notes/catalogue.md`).
pub const CURVE_AGAINST_NAMES: f64 = core::f64::consts::LN_2;

/// The same minimum after no further term is found: a factor of 1.25, or a share of 20 %.
///
/// With this value, the search finds all bumps and spikes of three times the noise (30 of 30). A
/// mechanism must lower the left-out error by as much, which is a choice.
pub const CURVE_AFTER_NAMES: f64 = 0.2231;

/// Maximum number of terms in a model.
///
/// On the ten measured records, later terms are not found again in a second record of the same rig.
pub const MOST_NAMES: usize = 8;

/// Number of moves that one round refits, the most promising one first.
///
/// The value is a choice: the first-order estimates for similar effects differ by less than their
/// errors, so only a refit of several moves decides.
pub const REFITTED: usize = 3;

/// Number of effects over the variable of a curve that the search refits before it accepts the
/// curve.
///
/// A dead zone whose width is between two trial shapes has a smaller first-order estimate than a
/// curve and seven effects that reproduce the dead zone. The number is a choice.
pub const INSTEAD: usize = 4;

/// After no further term is found, the search also refits the best of the moves that reduce the
/// number of terms by at least this many, whatever its first-order estimate.
///
/// In a synthetic record (torque, 60 s, seed 30006) three terms reproduced an injected dead zone.
/// After the search added the dead zone, no removal of one or two of these terms was better, but
/// the removal of all three was.
pub const MANY: usize = 3;

/// A phase of the search ends after this number of successive rounds without an accepted move.
///
/// The value is a choice: the second round refits the moves after the best three.
pub const FAILURES: usize = 2;

/// Number of half-sets of blocks that decide how many terms the final model has.
///
/// The value is a choice: ten complementary pairs, so that each block is left out with the same
/// frequency.
pub const HALVES: usize = 20;

/// A move is searched further only if its criterion after a rough search exceeds that of the
/// present model by at most this value.
///
/// The value is a choice: with this value, the ten measured records still reach their goals.
pub const HOPELESS: f64 = 0.5;

/// The largest SSE at which an effect does as well as the named one, from the SSE without either
/// and the SSE with the named one: it reaches nearly all of the reduction, which cannot be distinguished
/// by eye either, and leaves at most twice the SSE.
pub(super) fn allowed_to_a_rival(without: f64, named: f64) -> f64 {
    f64::min(without - (1.0 - PART) * (without - named), named / HALF)
}
