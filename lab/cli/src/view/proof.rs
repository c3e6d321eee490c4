//! `bowden certify GAINS.toml`: what is proved of one's own gains.

use bowden_trials::facts::{above, fixed, scientific, Named, Proof, Sides, Towards};
use std::fmt::Write as _;

/// Of a proof in which the limit of the command may be met.
const AT_THE_LIMIT: &str = "The box needs commands beyond the limit; the limit may be met, and the box holds all the same\n(theorems/Limit.v: it holds the reference against the load).\n\n";

/// Schema `bowden.certificate/1`.
///
/// # Errors
/// None that serde does not have.
pub fn json(proof: &Proof) -> Result<String, serde_json::Error> {
    serde_json::to_string(proof)
}

/// For people.
#[must_use]
pub fn text(proof: &Proof, label: &str) -> String {
    let mut out = format!("bowden certify {label}: the step of the lag form as it is computed\n\n");
    let float = proof.float.name();
    match &proof.refused {
        None => {
            let (error, s) = (above(proof.error.high), above(proof.s.high));
            let _ = writeln!(
                out,
                "PROVED in {float}, every rounding included: |e| <= {error} N·m, |s| <= {s} N·m at every sample\n"
            );
            if proof.may_meet_the_limit {
                out.push_str(AT_THE_LIMIT);
            }
        }
        Some(refusal) => {
            let _ = writeln!(
                out,
                "NOT PROVED in {float}: {} does not hold\nmended by {}\n",
                refusal.text, refusal.mend
            );
        }
    }
    let _ = writeln!(
        out,
        "|w| <= {} N·m, which moves by at most {} N·m/s; g = alpha·beta_hat in [{}, {}]",
        above(proof.w.high),
        above(proof.xi.high),
        fixed(proof.g[0].low, 3, Towards::Below),
        fixed(proof.g[1].high, 3, Towards::Above)
    );
    let rounded = &proof.roundings;
    let _ = writeln!(
        out,
        "rounding a step: s {} N·m, command {}, z {} N·m·s, of which owed from the step before {} and {}\n",
        short(rounded.s.high),
        short(rounded.command.high),
        short(rounded.z.high),
        short(rounded.owed_by_command.high),
        short(rounded.owed_by_z.high)
    );
    // Of the command one of the two ways is enough, and the other is not shown.
    let shown = |sides: &&Sides| !(sides.name == Named::Command && proof.may_meet_the_limit);
    let own = proof.inequalities.iter().filter(shown);
    let at_the_limit = proof.at_the_limit.iter();
    let at_the_limit = at_the_limit.filter(|_| proof.may_meet_the_limit);
    for sides in own.chain(at_the_limit).chain(&proof.slew) {
        let (left, right) = both(sides.left.high, sides.right.low, sides.holds);
        let holds = if sides.holds { "holds" } else { "FAILS" };
        let _ = writeln!(out, "{holds}  {left:>12} <= {right:<12}  {}", sides.text);
    }
    out.push_str("\nTo check:\n");
    for assumption in &proof.assumptions {
        let _ = writeln!(out, "  - {assumption}");
    }
    out
}

/// Two digits that are not below the number.
fn short(x: f64) -> String {
    scientific(x, 1, Towards::Above)
}

/// Decimals that are enough for any two different `f64`.
const MOST_DECIMALS: usize = 17;

/// Both sides rounded against the inequality, with as many decimals as show whether it holds.
fn both(left: f64, right: f64, holds: bool) -> (String, String) {
    let with = |places: usize| {
        (
            scientific(left, places, Towards::Above),
            scientific(right, places, Towards::Below),
        )
    };
    let shows = |(left, right): &(String, String)| {
        let number = |text: &str| text.parse().unwrap_or(f64::NAN);
        (number(left) <= number(right)) == holds
    };
    let mut tried = (6..MOST_DECIMALS).map(with);
    tried.find(shows).unwrap_or_else(|| with(MOST_DECIMALS))
}
