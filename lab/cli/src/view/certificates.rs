//! The table of `bowden certify`, and its JSON.

use bowden_trials::facts::{Certified, Tolerance};
use std::fmt::Write as _;

/// Schema `bowden.certify/1`.
#[must_use]
pub fn json(all: &Certified) -> String {
    let Certified {
        certificates,
        tolerance,
        learning,
    } = all;
    serde_json::json!({
        "schema": "bowden.certify/1",
        "certificates": certificates,
        "tolerance": tolerance,
        "learning": learning,
    })
    .to_string()
}

/// For people.
#[must_use]
pub fn text(all: &Certified) -> String {
    let lines = &all.certificates;
    let mut out =
        String::from("bowden certify: what the tracking error is promised to stay below\n\n");
    let mut told: Vec<&[&str]> = Vec::new();
    for line in lines {
        let what = match (line.value, &line.refused) {
            (Some(value), _) => {
                let note = if line.vacuous {
                    "  (vacuous: more than the reference itself)"
                } else {
                    ""
                };
                format!(
                    "{} <= {value:.4} {}{note}",
                    line.bounds.unwrap_or("|e|"),
                    line.unit
                )
            }
            (None, Some(reason)) => format!("none: {reason}"),
            (None, None) => "none".to_owned(),
        };
        let _ = writeln!(out, "{:<47} {:<17} {what}", line.law, line.kind);
        if let Some(mostly) = &line.mostly {
            let _ = writeln!(
                out,
                "{:<47} {:<17} best free constants; {:.0} % of it is the {}",
                "",
                "",
                100.0 * mostly.share,
                mostly.term
            );
        }
        if !line.assumptions.is_empty() && !told.contains(&line.assumptions) {
            told.push(line.assumptions);
        }
    }
    out += &within(&all.tolerance, "stable");
    out += &within(&all.learning, "converges");
    out.push_str(
        "\nBeta within p %: the box of beta_hat about 1/alpha, alpha = N_A·B of the rig.\n\
         The proofs check the line at rest in f32, with room for rounding: |s| <= 0.43 N·m and\n\
         |e| <= 0.86 N·m with Table 2's gains, if |w| <= 8 N·m and s, z start in their box\n\
         (proofs/README.md).\n",
    );
    for list in told {
        let names: Vec<&str> = lines
            .iter()
            .filter(|l| l.assumptions == list)
            .map(|l| l.kind)
            .fold(Vec::new(), |mut all, kind| {
                if !all.contains(&kind) {
                    all.push(kind);
                }
                all
            });
        let _ = writeln!(out, "\nTo check for {}:", names.join(", "));
        for assumption in list {
            let _ = writeln!(out, "  - {assumption}");
        }
    }
    for tolerance in [&all.tolerance, &all.learning] {
        if tolerance.share.is_some() {
            let _ = writeln!(out, "\nTo check for {}:", tolerance.kind);
            for assumption in tolerance.assumptions {
                let _ = writeln!(out, "  - {assumption}");
            }
        }
    }
    out
}

/// How far the plant may be off until something is no longer so.
fn within(tolerance: &Tolerance, what: &str) -> String {
    let told = match (tolerance.share, &tolerance.refused) {
        (Some(share), _) if share <= 0.0 => {
            format!("{what} with the rig's own plant; nothing is shown of others")
        }
        (Some(share), _) => format!(
            "{what} with every plant within {:.1} % of the rig's\n{:<66}alpha, zeta, c/K and latency and {:.2} % of its wn, all at once",
            100.0 * share,
            "",
            50.0 * share
        ),
        (None, Some(reason)) => format!("none: {reason}"),
        (None, None) => "none".to_owned(),
    };
    format!("{:<47} {:<17} {told}\n", tolerance.law, tolerance.kind)
}
