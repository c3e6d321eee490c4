//! Every threshold of the search, each with the experiment that set it, or with the words "a
//! choice" if no experiment did.
//!
//! Planted records are those of `examples/operating_characteristics`: 20 s at 1 kHz, Bouc-Wen
//! declared. SSE is the squared error on the fit segment.

/// Family-wise level of the sign-flip test, divided by families × channels.
///
/// At 1 % none of 120 records without a missing effect (three colours of noise) gave a name.
pub const LEVEL: f64 = 0.01;

/// Least reduction of ln SSE by a name.
///
/// A choice: an effect that removes less than a twentieth of the SSE is not worth a name.
pub const LEAST: f64 = 0.05;

/// Range of the least reduction of ln SSE if the blocks are too short for a test.
///
/// At the lower end coloured nulls of few independent values gave no name. The upper end is a
/// choice: an effect that halves the SSE (0.69) is always worth a proposal.
pub const LEAST_UNTESTED: (f64, f64) = (0.105, 0.69);

/// Least squared norm of the residual of a column with unit norm, regressed on the model.
///
/// A choice: below it rounding and the errors of the model determine the coefficient.
pub const EXCITED: f64 = 1e-4;

/// Largest difference of the criterion of two sets that are equal: the simpler one is taken.
///
/// A choice: a tenth of the SSE decides between two sets with the same number of names.
pub const EQUAL: f64 = 0.1;

/// Least reduction of the SSE by a rival, as a share of that by the named effect.
///
/// A choice: an effect that reaches nine tenths of it cannot be told from it by eye either.
pub const RIVAL_SHARE: f64 = 0.9;

/// Largest SSE with a rival, as a multiple of that with the named effect.
///
/// A choice. It matters only for a name that removes more than ten elevenths of the SSE.
pub const RIVAL_REST: f64 = 2.0;

/// Least relative reduction of the SSE on the stop-check, as a share of that on the fit segment.
///
/// The mere rule "not worse" lets one coloured null in fifty through; a quarter is a choice.
pub const CARRIED: f64 = 0.25;

/// Least share of the SSE whose removal need only not be worse on the selection segment.
///
/// No null was seen to reach it.
pub const LARGE: f64 = 0.3;

/// [`LARGE`] if the blocks are too short for a test.
///
/// A choice: a residual with a longer memory gives larger shares by chance.
pub const LARGE_UNTESTED: f64 = 0.6;

/// Least reduction of ln SSE by an unmodelled curve, compared with the best set of names, while
/// names are still found: a factor of 2.
///
/// A choice: a curve of ten hats fits any two names over one variable, so that it has to be
/// clearly better. The same is asked of a power law instead of viscous and Coulomb friction
/// together, where the residual is more than noise: on measured records that are described by the
/// pair it takes up to 0.21 more, in every block: 0.17 on the positioning drive, whose friction is
/// viscous and Coulomb's, and 0.21 on a damper, where it carries over worse
/// (`lab/notes/catalogue.md`).
pub const CURVE_AGAINST_NAMES: f64 = core::f64::consts::LN_2;

/// The same once no further name is found: a factor of 1.25, a share of 20 %.
///
/// With it bumps and spikes of three times the noise are all found (30 of 30). A mechanism must
/// lower its left-out error by as much, which is a choice.
pub const CURVE_AFTER_NAMES: f64 = 0.2231;

/// Share of a squared error from which one of its causes is the main one.
///
/// A choice: the rest is less.
pub const HALF: f64 = 0.5;

/// Largest RMSE that counts as noise, in units of the noise floor.
///
/// A choice: the floor is an estimate from the top of the band and assumes white noise. The
/// verdict `explained` uses the same multiple.
pub const AT_FLOOR: f64 = 1.2;

/// Maximum number of names in a model.
///
/// On the ten measured records later names do not recur in a second record of the rig.
pub const MOST_NAMES: usize = 8;

/// Number of moves that are refitted in one round, the best promise first.
///
/// A choice: the first-order promises of similar effects differ by less than their errors, so
/// that only a refit of several decides.
pub const REFITTED: usize = 3;

/// Number of names over its variable that are refitted one at a time before a curve is taken.
///
/// A dead zone whose gap lies between trial shapes promises less than a curve and less than seven
/// names that imitate it. The number is a choice.
pub const INSTEAD: usize = 4;

/// Of the moves that reduce the number of names by this many or more the best one is refitted
/// too, once no further name is found, whatever it promises.
///
/// In a planted record (torque, 60 s, seed 30006) three names imitated a dead zone; it came in
/// later, and no removal of one or two of them was better. One removal of all three is.
pub const MANY: usize = 3;

/// Number of successive rounds without an accepted move that ends a phase of the search.
///
/// A choice: a second round refits the moves after the best three.
pub const FAILURES: usize = 2;

/// Level of the one-sided sign-flip test that a simpler model errs more on left-out blocks than
/// the best one. Where the test does not say so, the simpler model is delivered.
///
/// A choice: the usual level. What it reaches on pairs of measured records is in
/// `docs/results/transfer.md`; other levels were not compared.
pub const SHORTER: f64 = 0.05;

/// Number of half-sets of blocks that decide how many names are delivered.
///
/// A choice: ten complementary pairs, so that each block is left out equally often.
pub const HALVES: usize = 20;

/// Largest factor by which an accepted move may raise the error on the stop-check.
///
/// A choice: if several effects are missing, adding one may uncover another on that segment.
pub const NOT_WORSE: f64 = 1.05;

/// Largest excess of the criterion after a rough search with which a move is searched further.
///
/// A choice: with it the ten measured records still reach their figures.
pub const HOPELESS: f64 = 0.5;

/// Largest SSE after a rough search with which a rival is searched further, as a multiple of
/// what is allowed to a rival.
///
/// A choice, as [`HOPELESS`].
pub const HOPELESS_RIVAL: f64 = 1.5;

/// The largest SSE at which an effect does as well as the named one, from the SSE without either
/// and the SSE with the named one.
pub(super) fn allowed_to_a_rival(without: f64, named: f64) -> f64 {
    f64::min(
        without - RIVAL_SHARE * (without - named),
        RIVAL_REST * named,
    )
}
