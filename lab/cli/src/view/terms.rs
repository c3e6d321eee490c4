//! Definitions of the terms of the output.

/// Output of `bowden help terms`.
pub const TERMS: &str = "\
Terms used in the output of `bowden identify`

baseline      The model that --baseline names (default: bouc-wen).
term          An effect that the search adds to the baseline model. `effect@channel` is an effect
              that reads this channel.
noise floor   RMS of the sensor noise after the filter, in the output's unit. The estimate uses
              the highest frequencies of the output and assumes white noise.
vs noise      Held-out RMSE in multiples of the noise floor. At 1.0 to 1.2 the residual is noise.
              At 10 most of it comes from an effect that the model lacks.
fit           The first 60 % of the record. The search fits parameters and proposes terms here.
selection     The next 15 %. The search rejects a term that raises the error here.
held-out      The last 25 %. Neither the fit nor the selection uses it, so its error is the error
              to expect on the next record of the same motion. `↑` marks a term that raises this
              error. The mark is only a warning, because the search does not use this segment.
removes       The share of the squared error on the fit segment that a term removes.
confidence    High for a mechanism if, on parts of the record that it was not fitted to, it leaves
              at most half of the squared error that any other mechanism leaves. Also high if the
              model is complete and one of the mechanism's terms has high confidence.
              High for a term if the residual of the final model is noise, the term has no
              alternative, and none of its parameters is at a bound. A low-confidence term is a
              candidate: it describes the mechanism on this record.
mechanism     What the missing output depends on: friction (a velocity), elasticity (a position or
              a load), inertia (an acceleration), contact memory (the travel since the last
              reversal), the shape of the hysteresis, or time.
in brackets   A term that is not in the final model. Without it, the model is as good on blocks
              that were left out of the fit. --json lists the term under `undelivered`.
coefficient   Gain of the term in the final model with its 95 % interval (jackknife over sixteen
              blocks). \"present, size unknown\" means that the interval contains zero, because
              other terms can replace this one.
p             Probability that chance alone explains at least as much (exact sign-flip test over
              sixteen blocks). A term is significant if p is at most
              0.01 / (number of effect families x number of channels).
blocks improved
              Number of the sixteen blocks on which the term lowers the error, with its
              coefficients fitted to the other fifteen.
alternatives  Effects that explain this record equally well: each removes at least 90 % of the
              squared error that the term removes, and leaves at most twice the squared error.
              The search reports the simplest one.
redundant     A part of the baseline model whose removal raises the held-out error by less than a
              tenth.
rejected      Terms that were tried, with the reason: not significant (p is too large), too few
              blocks improve (fewer than 10 of 16), worse on the selection segment, or
              superseded by later terms.

verdict       explained              the fit and held-out errors are within the noise
              structured-residual    the residual exceeds the noise, and no effect was found in it
              ambiguous              the record cannot separate a term from its alternatives
              unmodelled-dependence  the residual depends on a measured quantity, and no effect in
                                     the catalogue matches it
              under-excited          too few independent blocks for a test: terms are candidates
              not-transferable       the held-out error rises: the model fits only part of the
                                     record
              no-input-dependence    the input explains less than half of the output, or the files
                                     contradict each other
              stopped                the search ended at --max-terms or --time-limit, and the
                                     residual exceeds the noise
              defective-record       a conclusion depends on a defective measurement
";
