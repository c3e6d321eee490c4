//! Definitions of the terms of the output.

/// Output of `bowden help terms`.
pub const TERMS: &str = "\
Terms used in the output of `bowden identify`

baseline      The model that --baseline names (default: bouc-wen).
term          An effect that the search adds to the baseline model. `effect@channel` is an effect
              that reads this channel.
noise floor   RMS of the sensor noise after the filter, in the output's unit. The estimate uses
              the highest frequencies of the output and assumes white noise.
vs noise      Held-out RMSE in multiples of the noise floor. Up to 1.2, the residual is noise.
fit           The first 60 % of the record. The search fits parameters and proposes terms here.
selection     The next 15 %. The search rejects a term that raises the error here.
held-out      The last 25 %. The search does not use it, so its error is the error to expect on
              the next record of the same motion. `↑` marks a term that raises this error.
final (refitted)
              The final model, fitted to the fit and selection segments together. The first
              sentences quote its held-out error.
removes       The share of the squared error on the fit segment that a term removes.
confidence    High for a term if the residual is noise, the term has no alternative, and none of
              its parameters is at a bound (except a lag's gain of 1). Low if the output leads the
              input, or if the steps of a coarse sensor, or for `tone` the motion itself, explain
              the term. A low-confidence term is a candidate.
              High for a mechanism if one of its terms has high confidence. Also high if, on parts
              of the record that were left out of the fit, the mechanism at least halves the
              squared error, and leaves at most half as much as any other mechanism. This requires
              enough independent blocks. Low if clocks, columns or files appear to be wrong.
mechanism     What the missing output depends on: friction (a velocity), elasticity (a position or
              a load), inertia (an acceleration), contact memory (the travel since the last
              reversal), the shape of the hysteresis, or time.
in brackets   A term that is not in the final model. Without the term, the model is as good on
              blocks that were left out of the fit. --json lists the term under `undelivered`.
coefficient   Gain of the term in the final model with its 95 % interval (jackknife over sixteen
              blocks). \"present, size unknown\" means that the interval contains zero, because
              other terms can replace this one.
p             Probability that chance alone gives an improvement at least this large (exact
              sign-flip test over sixteen blocks). A term is significant if p is at most
              0.01 / (number of effect families x number of channels). A family is a group of
              similar effects, such as drag (drag-quadratic, drag-cubic).
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

verdict       The first of these that applies:
              defective-record       a defective measurement affects a conclusion
              no-input-dependence    the input explains less than half of the output, the output is
                                     the integral of the input, or the files contradict each other
              not-transferable       on held-out data, the model is worse than the baseline model or
                                     a constant, or has many times its error on the fit segment
              unmodelled-dependence  the residual depends on a measured quantity, and no effect in
                                     the catalogue matches it
              under-excited          too few independent blocks for a test, or too few reversals
              ambiguous              the record cannot distinguish a term from an alternative
              explained              the fit and held-out errors are within the noise
              stopped                the search ended at --max-terms or --time-limit
              structured-residual    the residual exceeds the noise; no further effect was found
";
