//! The marks that all rooms share. A line that uses a mark says what is compared.

use statrs::distribution::{ContinuousCDF, Normal};

/// A hundredth: a negligible share.
///
/// The value is a choice: a hundredth of a signal is not visible in a plot of the whole signal.
pub const TRACE: f64 = 0.01;

/// A twentieth.
///
/// The value is a choice: smaller differences are not visible in two digits, and sensors are
/// calibrated to about this accuracy. An effect that removes less than a twentieth of the SSE is
/// not worth a term. An accepted move may raise the error on the selection segment by a twentieth,
/// because adding one of several missing effects may expose another.
pub const TWENTIETH: f64 = 0.05;

/// A tenth: a notable share.
///
/// The value is a choice: a tenth is visible by eye. If the criteria of two sets differ by less,
/// the search takes the simpler set. An alternative must reach nine tenths of a term's reduction of
/// the SSE.
pub const PART: f64 = 0.1;

/// A quarter.
///
/// The value is a choice: half of the error is a quarter of the squared error. On the selection
/// segment, a move must reach a quarter of its reduction of the SSE. The rule "not worse" by itself
/// accepts one coloured null in fifty.
pub const QUARTER: f64 = 0.25;

/// A half.
///
/// The value is a choice: all other causes together are then smaller than this one.
pub const HALF: f64 = 0.5;

/// Maximum RMSE that counts as noise, in multiples of the noise floor.
///
/// The value is a choice: the noise floor is estimated from the top of the band, assuming white
/// noise. The verdicts `explained` and `holds` use this multiple. An experiment is proposed if it
/// shows an effect at least this many times as strongly.
pub const NOISE: f64 = 1.2;

/// Range of noise over a long time, in standard deviations: four on either side. The value is a
/// choice.
pub const SWING: f64 = 8.0;

/// Significance level, divided by the number of tests: families × channels in the search, variables or
/// bins elsewhere.
///
/// At 1 % the search found no term on any of 120 records without a missing effect (three colours
/// of noise).
pub const LEVEL: f64 = 0.01;

/// Significance level of a single test: the usual value.
///
/// The final model has fewer terms unless the error on left-out blocks is larger at this level.
/// `docs/results/transfer.md` gives the results on pairs of measured records.
pub const LEVEL_OF_ONE: f64 = 0.05;

/// The normal quantile that noise exceeds with this probability.
pub(crate) fn quantile(level: f64) -> f64 {
    Normal::standard().inverse_cdf(1.0 - level)
}

/// Whether an error is larger than another by more than a twentieth.
pub(crate) fn is_raised(error: f64, other: f64) -> bool {
    error > (1.0 + TWENTIETH) * other
}
