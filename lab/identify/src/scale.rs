//! The marks that all rooms share. A line that uses a mark says what is compared.

use statrs::distribution::{ContinuousCDF, Normal};

/// A trace: a hundredth.
///
/// A choice: a part of a hundredth is not visible in a plot of the whole.
pub const TRACE: f64 = 0.01;

/// A twentieth.
///
/// A choice: a difference of less is not visible in two digits, and sensors are calibrated to it. An
/// effect that removes less than a twentieth of the SSE is not worth a term. An accepted move may raise
/// the error on the selection segment by as much: if several effects are missing, adding one may expose
/// another.
pub const TWENTIETH: f64 = 0.05;

/// A part: a tenth. All but a part is nearly all.
///
/// A choice: a tenth is visible by eye. Of two sets whose criteria differ by less, the simpler one is
/// taken; an alternative reaches nearly all of a term's reduction of the SSE.
pub const PART: f64 = 0.1;

/// A quarter.
///
/// A choice: half of an error is a quarter of its square. On the selection segment a move must carry
/// over a quarter of its reduction of the SSE; the rule "not worse" alone lets one coloured null in
/// fifty through.
pub const QUARTER: f64 = 0.25;

/// A half.
///
/// A choice: all other causes together are then smaller.
pub const HALF: f64 = 0.5;

/// Maximum RMSE that counts as noise, in noise floors.
///
/// A choice: the floor is estimated from the top of the band and assumes white noise. The verdicts
/// `explained` and `holds` use this multiple. An experiment is proposed if it shows an effect this many
/// times as strongly.
pub const NOISE: f64 = 1.2;

/// Range of noise over a long time, in standard deviations: four to either side. A choice.
pub const SWING: f64 = 8.0;

/// Level of a test, divided by the number of tests: of families × channels in the search, of
/// variables or of bins elsewhere.
///
/// At 1 % the search found no term on any of 120 records without a missing effect (three colours
/// of noise).
pub const LEVEL: f64 = 0.01;

/// Level of a single test: the usual one.
///
/// A model is delivered with fewer terms unless its error on left-out blocks is larger at this level.
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
