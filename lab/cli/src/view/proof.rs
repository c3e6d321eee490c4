//! `bowden certify GAINS.toml`: the proof for the user's own gains.

use super::layout::{block, heading, prose, Width};
use anstyle::AnsiColor;
use bowden_trials::facts::{above, fixed, scientific, Named, Proof, Sides, Towards};

/// Of a proof in which the limit of the command may be met.
const AT_THE_LIMIT: &str = "Within the bounds of the proof, the command may saturate. The error bound still holds, because the saturated command can hold the reference against the disturbance (theorems/Limit.v).";

/// Schema `bowden.certificate/1`.
///
/// # Errors
/// Only errors of serde.
pub fn json(proof: &Proof) -> Result<String, serde_json::Error> {
    serde_json::to_string(proof)
}

/// The text: the bound, or a change that would make it provable.
#[must_use]
pub fn text(proof: &Proof, label: &str, width: Width, verbose: bool) -> String {
    let mut out = String::new();
    let float = proof.float.name();
    let subject = format!("{label}, first-order form in {float}");
    let command = ("bowden certify", subject.as_str());
    let (error, s) = (above(proof.error.high), above(proof.s.high));
    match &proof.refused {
        None => {
            let answer = format!("PROVED in {float}: |e| <= {error} N·m at every sample");
            heading(&mut out, width, command, (AnsiColor::Green, &answer));
            let words = format!(
                "The bound includes every rounding error. The proof also gives |s| <= {s} N·m."
            );
            prose(&mut out, width, &words);
            if proof.may_meet_the_limit {
                prose(&mut out, width, AT_THE_LIMIT);
            }
        }
        Some(refusal) => {
            let answer = format!("NOT PROVED in {float}: {} does not hold", refusal.text);
            heading(&mut out, width, command, (AnsiColor::Red, &answer));
            prose(&mut out, width, &format!("Remedy: {}", refusal.mend));
        }
    }
    out.push('\n');
    let plant = [
        format!(
            "|w| <= {} N·m, rate of change of w at most {} N·m/s",
            above(proof.w.high),
            above(proof.xi.high)
        ),
        format!(
            "g = alpha·beta_hat in [{}, {}]",
            fixed(proof.g[0].low, 3, Towards::Below),
            fixed(proof.g[1].high, 3, Towards::Above)
        ),
    ];
    block(&mut out, width, "Plant", plant);
    // Of the command one of the two ways is enough, and the other is not shown.
    let shown = |sides: &&Sides| !(sides.name == Named::Command && proof.may_meet_the_limit);
    let own = proof.inequalities.iter().filter(shown);
    let at_the_limit = proof.at_the_limit.iter();
    let at_the_limit = at_the_limit.filter(|_| proof.may_meet_the_limit);
    let all: Vec<&Sides> = own.chain(at_the_limit).chain(&proof.slew).collect();
    let listed = all.iter().filter(|sides| verbose || !sides.holds);
    for sides in listed {
        let (left, right) = both(sides.left.high, sides.right.low, sides.holds);
        let holds = if sides.holds { "holds" } else { "FAILS" };
        let line = format!("{left:>12} <= {right:<12}  {}", sides.text);
        block(&mut out, width, holds, [line]);
    }
    let (holding, count) = (all.iter().filter(|sides| sides.holds).count(), all.len());
    if !verbose {
        let line = format!("{holding} of {count} inequalities");
        block(&mut out, width, "Holds", [line]);
    }
    out.push('\n');
    if verbose {
        block(&mut out, width, "Note", [rounding(proof)]);
        out += "\nAssumptions:\n";
        for assumption in &proof.assumptions {
            prose(&mut out, width, &format!("- {assumption}"));
        }
        return out;
    }
    let hint = format!(
        "-v lists the {} assumptions of the proof",
        proof.assumptions.len()
    );
    block(&mut out, width, "Note", [hint]);
    let next = match proof.proved {
        true => "-v · --coq FILE.v and --gappa FILE.g (independent checks) · --json",
        false => "-v · change a gain, a limit or the rate, and certify again · --json",
    };
    block(&mut out, width, "Next", [next]);
    out
}

/// What one step rounds.
fn rounding(proof: &Proof) -> String {
    let rounded = &proof.roundings;
    format!(
        "rounding error per step, at most: s {} N·m, command {}, z {} N·m·s; the last two include {} and {} carried over from the previous step",
        short(rounded.s.high),
        short(rounded.command.high),
        short(rounded.z.high),
        short(rounded.owed_by_command.high),
        short(rounded.carry_error_z.high)
    )
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
