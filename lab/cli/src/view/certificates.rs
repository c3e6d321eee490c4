//! The bounds of `bowden certify`, as text and as JSON.

use super::layout::{block, heading, prose, Columns, Width};
use anstyle::AnsiColor;
use bowden_trials::facts::{Certified, Promise, Tolerance};
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

/// Kinds of bounds in the order of the text.
const ORDER: [&str; 4] = ["rms", "peak-sampled", "rms-sampled", "peak-continuous"];

/// The text: the bound of the given law first, then the others, vacuous bounds last.
#[must_use]
pub fn text(all: &Certified, label: Option<&str>, width: Width, verbose: bool) -> String {
    let lines = &all.certificates;
    let is_useful = |line: &&Promise| line.value.is_some() && !line.vacuous;
    let mut useful: Vec<&Promise> = lines.iter().filter(is_useful).collect();
    let place = |line: &Promise| ORDER.iter().position(|kind| *kind == line.kind);
    useful.sort_by_key(|line| place(line).unwrap_or(ORDER.len()));
    let mut out = String::new();
    let subject = label.unwrap_or("the gains of Nguyen et al. (2018) on the reference rig");
    let (colour, answer) = match useful.first() {
        Some(first) => (
            AnsiColor::Green,
            format!("BOUND: {} ({})", bound(first), first.law),
        ),
        None => (AnsiColor::Red, "NO USEFUL ERROR BOUND".to_owned()),
    };
    heading(
        &mut out,
        width,
        ("bowden certify", subject),
        (colour, &answer),
    );
    let peaks = useful.iter().filter(|line| line.kind == "peak-sampled");
    let peaks: Vec<f64> = peaks.filter_map(|line| line.value).collect();
    if let (Some(least), Some(greatest)) = (peaks.first(), peaks.last()) {
        let words = format!(
            "The peak bounds of the sampled law range from {least:.4} to {greatest:.4} N·m."
        );
        prose(&mut out, width, &words);
    }
    let mut rows = Columns::new(&["Law", "error", "bound [N·m]", "theorem"], &[3]);
    for line in &useful {
        rows.add([
            format!("  {}", line.law),
            quantity(line.kind).to_owned(),
            line.value
                .map_or_else(String::new, |value| format!("{value:.4}")),
            line.kind.to_owned(),
        ]);
    }
    let _ = writeln!(out, "\n{}", rows.text(width));
    let told = [(&all.tolerance, "stable"), (&all.learning, "converges")];
    let told = told.map(|(tolerance, what)| within(tolerance, what));
    block(&mut out, width, "Range", told);
    let vacuous = lines.iter().filter(|line| line.vacuous);
    let vacuous = vacuous.map(|line| match (&line.mostly, verbose) {
        (Some(mostly), true) => format!(
            "{}; with the best choice of the free constants, {:.0} % of this bound comes from the {}",
            beyond(line),
            100.0 * mostly.share,
            mostly.term
        ),
        _ => beyond(line),
    });
    block(&mut out, width, "Vacuous", vacuous);
    if verbose {
        let refused = lines.iter().filter_map(|line| {
            let reason = line.refused.as_ref()?;
            Some(format!("{}, {}: {reason}", line.law, line.kind))
        });
        block(&mut out, width, "Missing", refused);
        block(&mut out, width, "Note", NOTES);
        assumptions(&mut out, all, width);
        return out;
    }
    let hint = ["-v lists the assumptions about the plant that every bound requires"];
    block(&mut out, width, "Note", hint);
    block(
        &mut out,
        width,
        "Next",
        ["-v · --json · bowden certify GAINS.toml"],
    );
    out
}

/// What a theorem bounds: the rms over a long time, the error at every sample, or its limit
/// superior.
fn quantity(kind: &str) -> &'static str {
    match kind {
        "rms" | "rms-sampled" => "rms",
        "peak-sampled" => "peak",
        _ => "limsup",
    }
}

/// "|e| at every sample <= 0.8339 N·m".
fn bound(line: &Promise) -> String {
    let what = line.bounds.unwrap_or("|e|");
    let value = line.value.unwrap_or(f64::INFINITY);
    format!("{what} <= {value:.4} {}", line.unit)
}

fn beyond(line: &Promise) -> String {
    format!("{}: {}, larger than the reference", line.kind, bound(line))
}

const NOTES: [&str; 3] = [
    "range: alpha, zeta, c/K and the latency of the plant may deviate from the values of the rig by the first percentage, and wn by the second",
    "beta within p %: beta_hat stays within 1/alpha ± p %, where alpha is N_A·B of the rig",
    "`constant |D|` row: for the gains in Table 2 of Nguyen et al. (2018), proofs/README.md also proves |s| <= 0.43 N·m and |e| <= 0.86 N·m for the error recursion in f32, including rounding errors. The proof assumes |w| <= 8 N·m, where w is the disturbance plus the effect of estimation errors, and |s| <= 0.43 N·m and |z| <= 0.43/lambda at the start.",
];

/// The assumptions of each kind of bound.
fn assumptions(out: &mut String, all: &Certified, width: Width) {
    let mut told: Vec<(&[&str], Vec<&str>)> = Vec::new();
    let certificates = all.certificates.iter();
    let certificates = certificates.map(|line| (line.assumptions, line.kind));
    let tolerances = [&all.tolerance, &all.learning];
    let tolerances = tolerances.into_iter().filter(|t| t.share.is_some());
    let tolerances = tolerances.map(|t| (t.assumptions, t.kind));
    for (list, kind) in certificates.chain(tolerances) {
        match told.iter_mut().find(|(own, _)| *own == list) {
            _ if list.is_empty() => (),
            Some((_, kinds)) if kinds.contains(&kind) => (),
            Some((_, kinds)) => kinds.push(kind),
            None => told.push((list, vec![kind])),
        }
    }
    for (list, kinds) in told {
        let _ = writeln!(out, "\nAssumptions of {}:", kinds.join(", "));
        for assumption in list {
            prose(out, width, &format!("- {assumption}"));
        }
    }
}

/// The tolerance of the plant within which a property is proved.
fn within(tolerance: &Tolerance, what: &str) -> String {
    let told = match (tolerance.share, &tolerance.refused) {
        (Some(share), _) if share <= 0.0 => {
            format!("{what} for the rig's own plant, but not proved for other plants")
        }
        (Some(share), _) => format!(
            "{what} for every plant within {:.1} % (wn within {:.2} %)",
            100.0 * share,
            50.0 * share
        ),
        (None, Some(reason)) => format!("nothing is proved: {reason}"),
        (None, None) => "nothing is proved".to_owned(),
    };
    format!("{}: {told}", tolerance.law)
}
