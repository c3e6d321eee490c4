//! `bowden certify GAINS.toml`: what is proved of one's own gains.

use bowden_trials::facts::Proof;
use std::fmt::Write as _;

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
            let (error, s) = (above(proof.error.value), above(proof.s.value));
            let _ = writeln!(
                out,
                "PROVED in {float}, every rounding included: |e| <= {error:.4} N·m, |s| <= {s:.4} N·m at every sample\n"
            );
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
        "|w| <= {:.4} N·m, which moves by at most {:.4} N·m/s; g = alpha·beta_hat in [{:.3}, {:.3}]",
        proof.w.value, proof.xi.value, proof.g[0].value, proof.g[1].value
    );
    let rounded = &proof.roundings;
    let _ = writeln!(
        out,
        "rounding a step: s {:.1e} N·m, command {:.1e}, z {:.1e} N·m·s, of which owed from the step before {:.1e} and {:.1e}\n",
        rounded.s.value,
        rounded.command.value,
        rounded.z.value,
        rounded.owed_by_command.value,
        rounded.owed_by_z.value
    );
    for sides in &proof.inequalities {
        let _ = writeln!(
            out,
            "{}  {:>12.6e} <= {:<12.6e}  {}",
            if sides.holds { "holds" } else { "FAILS" },
            sides.left.value,
            sides.right.value,
            sides.text
        );
    }
    out.push_str("\nTo check:\n");
    for assumption in proof.assumptions {
        let _ = writeln!(out, "  - {assumption}");
    }
    out
}

/// Four decimals that are not below the number.
fn above(x: f64) -> f64 {
    (x * 1e4).ceil() / 1e4
}
