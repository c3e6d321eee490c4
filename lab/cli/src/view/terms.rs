//! Definitions of the terms of the output.

/// Output of `bowden help terms`.
pub const TERMS: &str = "\
Terms used in the output of `bowden identify`

baseline      The model that --baseline names (default: bouc-wen).
term          An effect that the search adds to the baseline model. The effect in `effect@channel`
              reads that channel.
noise floor   RMS of the sensor's noise after the filter, in the output's unit. It is estimated
              from the highest frequencies of the output and assumed to be white.
vs noise      Held-out RMSE in multiples of the noise floor. At 1.0 to 1.2 the residual is noise;
              at 10 most of it comes from an effect that the model lacks.
fit           The first 60 % of the record. Parameters are fitted and terms proposed here.
selection     The next 15 %. A term that raises the error here is rejected.
held-out      The last 25 %. Neither the fit nor the selection uses it, so its error is
              the one to expect on the next record of the same motion. `↑` marks a term that
              raises this error. The mark is a warning: the search does not read this segment.
removes       The share of the squared error on the fit segment that a term removes.
confidence    Of a mechanism: high if it leaves at most half of the squared error that any
              other mechanism leaves, on parts of the record that it was not fitted to, or if
              the model is complete and one of its terms has high confidence.
              Of a term: high if the final model's error is noise, the term has no alternative,
              and none of its parameters is at a bound. A term of low confidence is a candidate:
              it describes the mechanism on this record.
mechanism     What the missing output depends on: friction (a velocity), elasticity (a position or
              a load), inertia (an acceleration), contact memory (the travel since the last
              reversal), the shape of the hysteresis, or time.
not delivered The model is as good without the term, on blocks that were left out of the fit.
              --json lists the term under undelivered.
coefficient   Gain of the term in the final model with its 95 % interval (jackknife over sixteen
              blocks). \"present, size unknown\": the interval contains zero, because other terms can
              replace this one.
p             Probability that chance alone explains at least as much (exact sign-flip test over
              sixteen blocks). A term is significant if p is at most 0.01 divided by the number of
              families times channels.
blocks improved
              Number of the sixteen blocks on which the term lowers the error, with its
              coefficients fitted to the other fifteen.
alternatives  Effects that explain this record equally well: each removes at least 90 % of the
              squared error that the term removes, and leaves at most twice the squared error.
              The search reports the simplest one.
redundant     A part of the baseline model whose removal raises the held-out error by less than a
              tenth.
rejected      Terms that were tried, with the reason: not significant (p is too large), on too
              few blocks (fewer than 10 of 16 improve), worse on the selection segment, or
              superseded by later ones.

verdict       explained              the fit and held-out errors are within the noise
              structured-residual    the residual exceeds the noise, and no effect was found in it
              ambiguous              the record cannot separate a term from its alternatives
              unmodelled-dependence  the residual depends on a measured quantity, and no effect in
                                     the catalogue matches it
              under-excited          too few independent stretches for a test: terms are candidates
              not-transferable       the held-out error rises: the model fits only one stretch of
                                     the record
              no-input-dependence    the input explains less than half of the output, or the files
                                     contradict each other
              stopped                the search ended at --max-terms or --time-limit, and the
                                     residual exceeds the noise
              defective-record       a conclusion depends on a defective measurement
";
