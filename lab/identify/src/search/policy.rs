//! Every threshold of the search, each with the experiment that set it, or with the reason
//! where no experiment has.
//!
//! Planted records are those of `examples/operating_characteristics`: 20 s at 1 kHz, Bouc-Wen
//! declared.

/// Family-wise level of the sign-flip test, divided by families × channels.
///
/// At 1 % none of 120 records without a missing effect (three colours of noise) gave a name.
pub const LEVEL: f64 = 0.01;

/// Least reduction of ln SSE that an effect has to bring.
///
/// A choice: an effect that takes less than a twentieth of what is left is not worth a name.
pub const LEAST: f64 = 0.05;

/// Range of the least reduction of ln SSE where the blocks are too short for a test.
///
/// At the lower end coloured nulls of few independent values gave no name; an effect that
/// halves the SSE (0.69) is always worth a proposal.
pub const LEAST_UNTESTED: (f64, f64) = (0.105, 0.69);

/// Least squared norm that the model leaves of a column of unit norm.
///
/// Below it the coefficient is set by rounding and by the model's own errors.
pub const EXCITED: f64 = 1e-4;

/// Sets whose criteria differ by less than this are equal: the simplest is taken.
///
/// A choice: a tenth of what is left decides between two sets of as many names.
pub const EQUAL: f64 = 0.1;

/// A rival reaches at least this share of the reduction of the SSE by the named effect …
///
/// A choice: what takes nine tenths of it cannot be told from it by eye either.
pub const RIVAL_SHARE: f64 = 0.9;

/// … and leaves at most this many times the SSE.
pub const RIVAL_REST: f64 = 2.0;

/// Least share of an effect's reduction of the SSE that reappears on the stop-check.
///
/// A mere "not worse" lets one coloured null in fifty through.
pub const CARRIED: f64 = 0.25;

/// A reduction of the SSE by this share need only not be worse on the stop-check: no null
/// was seen to reach it (without a test: a longer memory makes larger shares by chance).
pub const LARGE: f64 = 0.3;

/// [`LARGE`] where the blocks are too short for a test.
pub const LARGE_UNTESTED: f64 = 0.6;

/// ln of the factor by which a curve without a name has to beat the best set of names while
/// names are still found: 2.
///
/// A curve of ten hats bends to any two names over one variable, so it has to be clearly better;
/// that 2 is the right factor is a choice, not a measurement.
pub const CURVE_AGAINST_NAMES: f64 = core::f64::consts::LN_2;

/// The same once no name is found any more: 1.25, a share of 20 %.
///
/// Bumps and knocks of three times the noise are then all found (30 of 30).
pub const CURVE_AFTER_NAMES: f64 = 0.2231;

/// What leaves more than this, in units of the noise floor, leaves more than noise.
///
/// The same multiple as for the verdict `explained`.
pub const MUCH_LEFT: f64 = 1.2;

/// Most names in a model.
///
/// On the ten measured records the later ones do not recur in a second record of the rig.
pub const MOST_NAMES: usize = 8;

/// Sets that are refitted in one round, the best promise first.
///
/// The first-order promises of effects that are alike differ by less than their errors: the
/// best of a few is known after a refit only. Three is a choice, not a measurement.
pub const REFITTED: usize = 3;

/// Rounds in succession without a real reduction after which the search ends.
pub const FAILURES: usize = 2;

/// Half-sets of blocks that decide how many names are delivered.
///
/// Ten complementary pairs, so that each block is left out equally often.
pub const HALVES: usize = 20;

/// Half-sets of blocks on which a name is sought again, in complementary pairs.
pub const RECURRENCES: usize = 100;

/// Largest factor by which a large effect may raise the error on the stop-check.
///
/// Where much is missing at once, one effect removed may uncover another just there.
pub const NOT_WORSE: f64 = 1.05;

/// A rough search of a move that ends so far above the present criterion is not continued.
///
/// A choice: with it the ten measured records still reach their figures.
pub const HOPELESS: f64 = 0.5;

/// A rough search of a rival that ends at so many times the squared error allowed to a rival
/// is not continued.
///
/// A choice, as [`HOPELESS`].
pub const HOPELESS_RIVAL: f64 = 1.5;

/// The largest squared error at which an effect does as well as the named one, from those
/// without either and with the named one.
pub(super) fn allowed_to_a_rival(without: f64, named: f64) -> f64 {
    f64::min(
        without - RIVAL_SHARE * (without - named),
        RIVAL_REST * named,
    )
}
