//! What `bowden compare` prints: tables, JSON, traces.

use super::certificates;
use crate::compare::found::{Outcome, Pair};
use crate::compare::table::{Line, Spread};
use crate::compare::undeclared::Undeclared;
use serde_json::{json, Value};
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// What the trials were run under.
#[derive(Debug, Clone, PartialEq)]
pub struct Heading {
    /// White noise of the sensor \[N·m rms\].
    pub noise: f64,
    /// Whether the conduit was moved.
    pub varying: bool,
    /// Length of a trial \[s\].
    pub seconds: f64,
    /// From where errors count \[s\].
    pub from: f64,
    /// Length of the transient \[s\].
    pub transient: f64,
    /// Number of trials.
    pub seeds: usize,
    /// In what `--model` had to be changed to be fed forward, if in anything.
    pub fed_with: Option<String>,
}

impl Heading {
    fn configuration(&self) -> &'static str {
        if self.varying {
            "varying"
        } else {
            "fixed"
        }
    }

    fn json(&self) -> Value {
        json!({
            "noise": self.noise,
            "configuration": self.configuration(),
            "seconds": self.seconds,
            "from": self.from,
            "transient": self.transient,
            "seeds": self.seeds,
            "fed_with": self.fed_with,
        })
    }
}

/// Table 3 of the paper: mean and standard deviation, fixed and varying \[N·m\].
const PAPER: [(&str, [f64; 2], [f64; 2]); 4] = [
    ("pi", [0.5991, 0.0154], [0.6034, 0.0182]),
    ("pid", [0.6093, 0.0164], [0.6139, 0.0153]),
    ("piv", [0.5320, 0.0134], [0.5323, 0.0186]),
    ("adaptive", [0.3027, 0.0081], [0.3195, 0.0120]),
];

fn paper(name: &str, varying: bool) -> Option<[f64; 2]> {
    let row = PAPER.iter().find(|row| row.0 == name)?;
    Some(if varying { row.2 } else { row.1 })
}

fn pair(spread: Spread) -> String {
    format!("{:.4} ± {:.4}", spread.mean, spread.sd)
}

/// "–, ran away at 0.31 s", in place of errors that were summed over a part of the trial;
/// `None` where no trial ran away.
fn ran_away(line: &Line, seeds: usize) -> Option<String> {
    let at = line.ran_away?;
    let share = match seeds {
        1 => String::new(),
        _ => format!(" in {} of {seeds} trials, first", line.diverged),
    };
    Some(format!("–, ran away{share} at {at:.2} s"))
}

/// The comparison for people.
#[must_use]
pub fn text(
    heading: &Heading,
    lines: &[Line],
    certificates: &BTreeMap<String, certificates::Line>,
) -> String {
    let mut out = String::new();
    let _ = writeln!(
        out,
        "bowden compare: {} trials of {} s on the reference rig, noise {} N·m rms, configuration {}\n",
        heading.seeds,
        heading.seconds,
        heading.noise,
        heading.configuration()
    );
    if let Some(changed) = &heading.fed_with {
        let _ = writeln!(
            out,
            "The model has no inverse as it is: fed forward with {changed}.\n"
        );
    }
    let _ = writeln!(
        out,
        "Steady part, from {} s on; errors in N·m",
        heading.from
    );
    let _ = writeln!(
        out,
        "{:<22} {:>17} {:>17} {:>6} {:>7} {:>9} {:>8}  {:<17} certificate",
        "controller",
        "rmse, true",
        "rmse, measured",
        "% max",
        "peak",
        "effort/s",
        "turns/s",
        "paper, Table 3"
    );
    for line in lines {
        let paper = paper(&line.controller, heading.varying).map_or_else(
            || "-".to_owned(),
            |[mean, sd]| format!("{mean:.4} ± {sd:.4}"),
        );
        let certificate = certificates
            .get(&line.controller)
            .and_then(|c| c.value.map(|v| format!("{} {v:.3}", c.kind)))
            .unwrap_or_else(|| "-".to_owned());
        if let Some(when) = ran_away(line, heading.seeds) {
            let _ = writeln!(out, "{:<22} {when}", line.controller);
            continue;
        }
        let _ = writeln!(
            out,
            "{:<22} {:>17} {:>17} {:>6.2} {:>7.3} {:>9.0} {:>8.0}  {paper:<17} {certificate}",
            line.controller,
            pair(line.rmse_true),
            pair(line.rmse_measured),
            100.0 * line.share,
            line.peak,
            line.effort,
            line.reversals,
        );
    }
    let _ = writeln!(out, "\nTransient, the first {} s", heading.transient);
    let _ = writeln!(
        out,
        "{:<22} {:>17} {:>9} {:>14}",
        "controller", "rmse, true", "peak", "most command"
    );
    for line in lines {
        if let Some(when) = ran_away(line, heading.seeds) {
            let _ = writeln!(out, "{:<22} {when}", line.controller);
            continue;
        }
        let _ = writeln!(
            out,
            "{:<22} {:>17} {:>9.2} {:>14.1}",
            line.controller,
            pair(line.transient),
            line.transient_peak,
            line.command
        );
    }
    out.push_str(NOTES);
    out
}

const NOTES: &str = "
The rig's drive gain and noise were picked so that PI and the adaptive law come out as in
Table 3: those two are calibration, not validation. Not reproduced: PIV below PI (here it
is not), and the paper's scatter between trials. matched-pi is a PI with the integral gain
that the adaptive law has in effect (320): what it reaches is gain, not adaptation. The
frozen law starts with beta_hat at 1/alpha and delta_hat as given, and never adapts; the
feed-forward knows the rig's own transmission, or the --model. A certificate bounds an
idealised plant without sensor noise: `bowden certify` lists what each assumes.
";

/// Schema `bowden.compare/1`.
#[must_use]
pub fn json(
    heading: &Heading,
    lines: &[Line],
    certificates: &BTreeMap<String, certificates::Line>,
) -> String {
    let rows: Vec<Value> = lines
        .iter()
        .map(|line| {
            let mut row = row(line);
            row["certificate"] = match certificates.get(&line.controller) {
                Some(c) if c.value.is_some() => json!({ "kind": c.kind, "value": c.value }),
                _ => Value::Null,
            };
            row["paper"] = match paper(&line.controller, heading.varying) {
                Some([mean, sd]) => json!({ "mean": mean, "sd": sd }),
                None => Value::Null,
            };
            row
        })
        .collect();
    json!({ "schema": "bowden.compare/1", "conditions": heading.json(), "rows": rows }).to_string()
}

fn row(line: &Line) -> Value {
    // Of a law that ran away the sums are over a part of a trial: no number says anything.
    let told = line.diverged == 0;
    let number = |value: f64| told.then_some(value);
    let spread = |spread: Spread| json!({ "mean": number(spread.mean), "sd": number(spread.sd) });
    json!({
        "controller": line.controller,
        "rmse_true": spread(line.rmse_true),
        "rmse_measured": spread(line.rmse_measured),
        "percent_of_maximum": number(100.0 * line.share),
        "peak": number(line.peak),
        "effort": number(line.effort),
        "reversals": number(line.reversals),
        "transient": { "rmse_true": spread(line.transient), "peak": number(line.transient_peak) },
        "largest_command": line.command,
        "diverged": line.diverged,
        "ran_away_at": line.ran_away,
        "certificate": Value::Null,
    })
}

/// "0.123", or when the loop ran away.
fn error(line: &Line) -> String {
    match line.ran_away {
        None => format!("{:.4}", line.rmse_true.mean),
        Some(at) => format!("–, {at:.2} s"),
    }
}

/// The mean error; `None` of a law that ran away.
fn mean(line: &Line) -> Option<f64> {
    (line.diverged == 0).then_some(line.rmse_true.mean)
}

/// How much less there is after than before.
fn change(pair: &Pair) -> String {
    let (before, after) = (&pair.declared, &pair.found);
    if before.diverged + after.diverged > 0 {
        return "-".to_owned();
    }
    let change = 100.0 * (after.rmse_true.mean / before.rmse_true.mean - 1.0);
    format!("{change:+.0} %")
}

/// The loop closed through the controller, for people.
#[must_use]
pub fn found_text(heading: &Heading, effect: &Undeclared, outcomes: &[Outcome]) -> String {
    let mut out = String::new();
    let _ = writeln!(
        out,
        "bowden compare --effect {}: {} N·m rms of it on the rig, declared to nobody; noise {} N·m rms, {} s\n",
        effect.name, effect.strength, heading.noise, heading.seconds
    );
    for outcome in outcomes {
        let found = &outcome.identified;
        let names = match found.names.is_empty() {
            true => "nothing".to_owned(),
            false => found.names.join(", "),
        };
        let _ = writeln!(
            out,
            "seed {}: on the bench `close` found {names}; held-out rmse {:.4} -> {:.4} N·m",
            outcome.seed, found.before, found.after
        );
        if !found.left_out.is_empty() {
            let left_out = found.left_out.join(", ");
            let _ = writeln!(out, "  not fed forward: {left_out}");
        }
        if let Some(changed) = &outcome.fed_with {
            let _ = writeln!(out, "  no inverse as fitted; fed forward with {changed}");
        }
        let _ = writeln!(
            out,
            "  {:<40} {:>9} {:>15} {:>12} {:>9}",
            "true rmse [N·m], steady part", "no model", "declared model", "with found", "change"
        );
        for pair in &outcome.pairs {
            let _ = writeln!(
                out,
                "  {:<40} {:>9} {:>15} {:>12} {:>9}",
                pair.controller,
                error(&pair.plain),
                error(&pair.declared),
                error(&pair.found),
                change(pair)
            );
        }
    }
    out.push_str(&over_seeds(outcomes));
    out.push_str(FOUND_NOTES);
    out
}

/// On how many seeds each controller follows better with what was found.
fn over_seeds(outcomes: &[Outcome]) -> String {
    let mut out = format!("\nover {} seeds: lower, the same, higher\n", outcomes.len());
    let Some(first) = outcomes.first() else {
        return out;
    };
    for (index, pair) in first.pairs.iter().enumerate() {
        let (mut lower, mut same) = (0, 0);
        for pair in outcomes.iter().filter_map(|o| o.pairs.get(index)) {
            match against_before(pair) {
                Ordering::Less => lower += 1,
                Ordering::Equal => same += 1,
                Ordering::Greater => {}
            }
        }
        let higher = outcomes.len() - lower - same;
        let _ = writeln!(
            out,
            "  {:<40} {lower:>9} {same:>15} {higher:>12}",
            pair.controller
        );
    }
    out
}

/// The error with what was found, against the error before; running away is worst.
fn against_before(pair: &Pair) -> Ordering {
    let error = |line: &Line| match line.diverged {
        0 => line.rmse_true.mean,
        _ => f64::INFINITY,
    };
    error(&pair.found).total_cmp(&error(&pair.declared))
}

const FOUND_NOTES: &str = "
declared model: Bouc-Wen alone, fitted to the bench record, as feed-forward; with found:
the same with what `close` added, refitted together. As third regressor the found effects
enter with their bench value as prior; there the column before is the law without it. Loops
called quiet have a fifth of the paper's gains: what a full gain hides, they show. A dash
with a time is a loop that ran away then.
";

/// The same as JSON, schema `bowden.compare/1`.
#[must_use]
pub fn found_json(heading: &Heading, effect: &Undeclared, outcomes: &[Outcome]) -> String {
    let mut rows: Vec<Value> = Vec::new();
    let seeds: Vec<Value> = outcomes
        .iter()
        .map(|outcome| {
            let pairs: Vec<Value> = outcome
                .pairs
                .iter()
                .map(|pair| {
                    for (line, how) in [
                        (&pair.plain, "no model"),
                        (&pair.declared, "declared"),
                        (&pair.found, "found"),
                    ] {
                        let mut row = row(line);
                        row["controller"] = json!(pair.controller);
                        row["model"] = json!(how);
                        row["seed"] = json!(outcome.seed);
                        rows.push(row);
                    }
                    json!({
                        "controller": pair.controller,
                        "no_model": mean(&pair.plain),
                        "declared": mean(&pair.declared),
                        "found": mean(&pair.found),
                        "lower": pair.found.rmse_true.mean < pair.declared.rmse_true.mean
                            && pair.found.diverged == 0,
                    })
                })
                .collect();
            json!({
                "seed": outcome.seed,
                "found": outcome.identified.names,
                "left_out": outcome.identified.left_out,
                "fed_with": outcome.fed_with,
                "held_out": { "before": outcome.identified.before, "after": outcome.identified.after },
                "pairs": pairs,
            })
        })
        .collect();
    json!({
        "schema": "bowden.compare/1",
        "conditions": heading.json(),
        "effect": { "name": effect.name, "strength": effect.strength },
        "rows": rows,
        "seeds": seeds,
    })
    .to_string()
}

/// CSV of the first trial of every controller: the paper's Figures 7 to 10.
#[must_use]
pub fn trace(lines: &[Line]) -> String {
    let mut out = String::from(
        "controller,t [s],y_r [N·m],tau_o [N·m],measured [N·m],e [N·m],tau_i [N·m],u,beta_hat,delta_hat [N·m],theta_hat_1,theta_hat_2,theta_hat_3\n",
    );
    for line in lines {
        for row in &line.first.trace {
            let _ = write!(
                out,
                "{},{:.4},{:.5},{:.5},{:.5},{:.5},{:.5},{:.5}",
                line.controller,
                row.time,
                row.reference,
                row.tau_o,
                row.measured,
                row.tau_o - row.reference,
                row.tau_i,
                row.command
            );
            match row.estimates {
                Some(estimates) => {
                    for value in estimates {
                        let _ = write!(out, ",{value:.6}");
                    }
                }
                None => out.push_str(",,,,,"),
            }
            out.push('\n');
        }
    }
    out
}
