//! Every threshold of the search, each with the experiment that set it, or with the words "a
//! choice" if no experiment did.
//!
//! Planted records are those of `examples/operating_characteristics`: 20 s at 1 kHz, with Bouc-Wen
//! as the baseline. SSE is the squared error on the fit segment.

/// Family-wise level of the sign-flip test, which is divided by families × channels.
///
/// At 1 % the search found no term on any of 120 records without a missing effect (three colours
/// of noise).
pub const LEVEL: f64 = 0.01;

/// Minimum reduction of ln SSE by a term.
///
/// A choice: an effect that removes less than a twentieth of the SSE is not worth a term.
pub const LEAST: f64 = 0.05;

/// Range of the minimum reduction of ln SSE if the blocks are too short for a test.
///
/// At the lower end, coloured nulls with few independent values gave no term. The upper end is a
/// choice: an effect that halves the SSE (0.69) is always worth a proposal.
pub const LEAST_UNTESTED: (f64, f64) = (0.105, 0.69);

/// Minimum squared norm of the residual of a unit-norm column after regression on the model.
///
/// A choice: below this value, rounding and the errors of the model determine the coefficient.
pub const EXCITED: f64 = 1e-4;

/// Maximum difference between the criteria of two sets that count as equal: the simpler set is
/// taken.
///
/// A choice: a tenth of the SSE decides between two sets with the same number of terms.
pub const EQUAL: f64 = 0.1;

/// Minimum reduction of the SSE by an alternative, as a share of the reduction by the term.
///
/// A choice: an effect that reaches nine tenths of it cannot be distinguished by eye either.
pub const RIVAL_SHARE: f64 = 0.9;

/// Maximum SSE with an alternative, as a multiple of the SSE with the term.
///
/// A choice. It matters only for a term that removes more than ten elevenths of the SSE.
pub const RIVAL_REST: f64 = 2.0;

/// Minimum relative reduction of the SSE on the selection segment, as a share of that on the fit
/// segment.
///
/// The rule "not worse" alone lets one coloured null in fifty through; a quarter is a choice.
pub const CARRIED: f64 = 0.25;

/// A term that removes at least this share of the SSE only has to be no worse on the selection
/// segment.
///
/// No null has reached this share.
pub const LARGE: f64 = 0.3;

/// [`LARGE`] if the blocks are too short for a test.
///
/// A choice: a residual with a longer memory gives larger shares by chance.
pub const LARGE_UNTESTED: f64 = 0.6;

/// Minimum reduction of ln SSE by an unmodelled curve beyond the best set of terms, while further
/// terms are still found: a factor of 2.
///
/// A choice: a curve of ten hats fits any two terms over one variable, so it must be clearly
/// better. If the residual is more than noise, the same value applies to a power law instead of
/// viscous and Coulomb friction together. On measured records that this pair describes, the power
/// law lowers ln SSE by up to 0.21 more, in every block: by 0.17 on the positioning drive, which has
/// viscous and Coulomb friction, and by 0.21 on a damper, where it transfers worse to other records
/// (`lab/notes/catalogue.md`).
pub const CURVE_AGAINST_NAMES: f64 = core::f64::consts::LN_2;

/// The same once no further term is found: a factor of 1.25, or a share of 20 %.
///
/// With this value all bumps and spikes of three times the noise are found (30 of 30). A mechanism
/// must lower the left-out error by as much, which is a choice.
pub const CURVE_AFTER_NAMES: f64 = 0.2231;

/// Share of a squared error above which a cause counts as the main one.
///
/// A choice: all other causes together are then smaller.
pub const HALF: f64 = 0.5;

/// Maximum RMSE that counts as noise, in noise floors.
///
/// A choice: the floor is estimated from the top of the band and assumes white noise. The verdict
/// `explained` uses the same multiple.
pub const AT_FLOOR: f64 = 1.2;

/// Maximum number of terms in a model.
///
/// On the ten measured records, later terms are not found again in a second record of the rig.
pub const MOST_NAMES: usize = 8;

/// Number of moves that are refitted in one round, the most promising one first.
///
/// A choice: the first-order gains of similar effects differ by less than their errors, so only a
/// refit of several moves decides.
pub const REFITTED: usize = 3;

/// Number of effects over the variable of a curve that are each refitted before the curve is
/// accepted.
///
/// A dead zone whose gap lies between trial shapes has a smaller first-order gain than a curve, and
/// than seven effects that imitate it. The number is a choice.
pub const INSTEAD: usize = 4;

/// Once no further term is found, the best of the moves that reduce the number of terms by at least
/// this many is refitted too, whatever its first-order gain.
///
/// In a planted record (torque, 60 s, seed 30006) three terms imitated a dead zone. The dead zone
/// was added later, and no removal of one or two of these terms was better; the removal of all three
/// is.
pub const MANY: usize = 3;

/// Number of successive rounds without an accepted move after which a phase of the search ends.
///
/// A choice: a second round refits the moves after the best three.
pub const FAILURES: usize = 2;

/// Level of the one-sided sign-flip test that a simpler model has a larger error on left-out
/// blocks than the best one. If the test is not significant, the simpler model is delivered.
///
/// A choice: the usual level. `docs/results/transfer.md` gives the results on pairs of measured
/// records; other levels were not compared.
pub const SHORTER: f64 = 0.05;

/// Number of half-sets of blocks that decide how many terms are delivered.
///
/// A choice: ten complementary pairs, so that each block is left out equally often.
pub const HALVES: usize = 20;

/// Maximum factor by which an accepted move may raise the error on the selection segment.
///
/// A choice: if several effects are missing, adding one may expose another on that segment.
pub const NOT_WORSE: f64 = 1.05;

/// Maximum excess of the criterion after a rough search for which a move is searched further.
///
/// A choice: with this value the ten measured records still reach their goals.
pub const HOPELESS: f64 = 0.5;

/// Maximum SSE after a rough search for which an alternative is searched further, as a multiple of
/// the maximum SSE of an alternative.
///
/// A choice, like [`HOPELESS`].
pub const HOPELESS_RIVAL: f64 = 1.5;

/// The largest SSE at which an effect does as well as the named one, from the SSE without either
/// and the SSE with the named one.
pub(super) fn allowed_to_a_rival(without: f64, named: f64) -> f64 {
    f64::min(
        without - RIVAL_SHARE * (without - named),
        RIVAL_REST * named,
    )
}
