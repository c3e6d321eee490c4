//! Definitions of the words of the ledger.

/// The legend under the ledger.
pub const LEGEND: [&str; 7] = [
    "grade      how far the name can be trusted, firm or weak; not how large the effect is",
    "explains   share of the squared error on the fit segment that this round removes",
    "× floor    the error to its left in multiples of the sensor's noise behind the filter; 1.0 is noise alone",
    "p          how often chance alone would do as well; blocks better: on how many of sixteen stretches the effect helps",
    "recurs     in how many of 100 half-records the same search finds the effect again",
    "stop       segment that vetoes a round; held out: data that neither fit nor search has seen",
    "rejected   tried and turned down, with the reason; unneeded: declared, but the data do as well without it",
];

/// Output of `bowden help terms`.
pub const TERMS: &str = "\
The words of `bowden close`

noise floor   The sensor's noise that passes the filter, as an RMSE in the output's unit. It is
              estimated from the top of the output's band, and taken as white.
× floor       The error to its left in multiples of the noise floor. At 1.0 to 1.2 nothing but
              noise is left; at 10 most of the residual is something that the model lacks.
fit           The first 60 % of the record: parameters are fitted and effects selected here.
stop          The next 15 %: an effect that makes the error worse here is turned down.
held out      The last 25 %: nothing is fitted to it and nothing is selected by it. This is the
              error to expect on the next record of the same motion. `↑` marks a round that
              raises it: the search does not look, so the mark is a warning, not a rule.
explains      The share of the squared error on the fit segment that a round removes, of what
              the row above leaves.
grade         firm: the name recurs in at least 50 of 100 half-records, helps on at least 8 of 16
              blocks, and nothing does as well in its place. weak: one of several effects that
              would explain this, or one that helps only together with another. The grade is of
              the name. The size of the effect is its coefficient.
recurs        In how many of 100 random halves of the sixteen blocks the same search names this
              effect again.
(n)           A round in brackets was found and is not delivered: on blocks that were left out of
              its fit the model does as well without it. Its model is in --json, under beyond.
coefficient   The effect's gain in the final model with its 95 % interval, from leaving out each
              of sixteen blocks. \"acts, size unknown\": the interval holds zero, since other
              terms can stand in for this one.
p             The probability that chance alone explains as much: exact, by turning the signs
              of sixteen blocks over. Taken as significant below 0.01 over all questions asked.
blocks better On how many of sixteen stretches of equal path the effect lowers the error when its
              coefficients were fitted on the other fifteen.
confounded    Another effect explains the same on this record: it removes at least 90 % of what
              the named one removes, and leaves at most twice the error. The simplest is named.
unneeded      A declared part without which the held-out error grows by less than a tenth.
rejected      What was tried and turned down. not significant: p too large. not on enough
              blocks: it helps on fewer than 10 of 16. worse on the stop-check. superseded by
              later ones.

verdict       explained            fit and held-out error are within what noise leaves
              explained-coloured   the residual is larger, and no effect was found in it
              confounded           the record cannot tell an added effect from its rivals
              unknown              the residual depends on something measured, with no name
              under-excited        too few independent stretches for a test: names are proposals
              does-not-carry-over  the held-out error rises: the model fits this stretch only
              no-model             the input explains less than half of the output, or the files
                                   contradict each other
              stopped              the search ended at --rounds N, and more than noise is left
              data-defect          the measurement is spoilt where a conclusion rests on it
";
