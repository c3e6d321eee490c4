//! Output of `bowden compare --effect`: the loop closed through the controllers.

use super::compare_rows::{conditions, own, row};
use bowden_trials::facts::{Found, Heading, Line, Outcome, OverSeeds, Pair};
use serde_json::{json, Value};
use std::fmt::Write as _;

/// "0.123", or when the loop ran away.
fn error(line: &Line) -> String {
    match line.ran_away {
        None => format!("{:.4}", line.rmse_true.mean),
        Some(at) => format!("–, {at:.2} s"),
    }
}

/// Relative reduction from before to after.
fn change(pair: &Pair) -> String {
    let change = pair.change();
    change.map_or_else(
        || "-".to_owned(),
        |share| format!("{:+.0} %", 100.0 * share),
    )
}

/// For people.
pub(super) fn text(heading: &Heading, found: &Found) -> String {
    let Found {
        effect, outcomes, ..
    } = found;
    let mut out = format!(
        "bowden compare --effect {}: {} N·m rms of it on the rig, declared to nobody; noise {} N·m rms, {} s\n\n",
        effect.name, effect.strength, heading.noise, heading.seconds
    );
    out.push_str(&own(heading));
    for outcome in outcomes {
        out.push_str(&seed(outcome));
    }
    let _ = writeln!(
        out,
        "\nover {} seeds: lower, the same, higher",
        outcomes.len()
    );
    for over in &found.over_seeds {
        let OverSeeds {
            controller,
            lower,
            same,
            higher,
        } = over;
        let _ = writeln!(out, "  {controller:<40} {lower:>9} {same:>15} {higher:>12}");
    }
    out.push_str(NOTES);
    out
}

fn seed(outcome: &Outcome) -> String {
    let found = &outcome.identified;
    let names = match found.names.is_empty() {
        true => "nothing".to_owned(),
        false => found.names.join(", "),
    };
    let mut out = format!(
        "seed {}: on the bench `close` found {names}; held-out rmse {:.4} -> {:.4} N·m\n",
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
    out
}

const NOTES: &str = "
declared model: Bouc-Wen alone, fitted to the bench record, as feed-forward; with found:
the same with what `close` added, refitted together. As third regressor the found effects
enter with their bench value as prior; there the column before is the law without it. Loops
called quiet have a fifth of the paper's gains: what a full gain hides, they show. A dash
with a time is a loop that ran away then.
";

/// Schema `bowden.compare/1`.
pub(super) fn json(heading: &Heading, found: &Found) -> String {
    let rows: Vec<Value> = found.outcomes.iter().flat_map(rows).collect();
    let seeds: Vec<Value> = found.outcomes.iter().map(seed_json).collect();
    json!({
        "schema": "bowden.compare/1",
        "conditions": conditions(heading),
        "effect": { "name": found.effect.name, "strength": found.effect.strength },
        "rows": rows,
        "seeds": seeds,
    })
    .to_string()
}

/// Three rows a controller: without a model, with the declared one, with what was found.
fn rows(outcome: &Outcome) -> impl Iterator<Item = Value> + '_ {
    outcome.pairs.iter().flat_map(|pair| {
        let named = |line: &Line, how: &str| {
            let mut row = row(line);
            row["controller"] = json!(pair.controller);
            row["model"] = json!(how);
            row["seed"] = json!(outcome.seed);
            row
        };
        [
            named(&pair.plain, "no model"),
            named(&pair.declared, "declared"),
            named(&pair.found, "found"),
        ]
    })
}

fn seed_json(outcome: &Outcome) -> Value {
    let pairs = outcome.pairs.iter().map(|pair| {
        json!({
            "controller": pair.controller,
            "no_model": pair.plain.mean_error(),
            "declared": pair.declared.mean_error(),
            "found": pair.found.mean_error(),
            "lower": pair.found.rmse_true.mean < pair.declared.rmse_true.mean
                && pair.found.diverged == 0,
        })
    });
    let identified = &outcome.identified;
    json!({
        "seed": outcome.seed,
        "found": identified.names,
        "left_out": identified.left_out,
        "fed_with": outcome.fed_with,
        "held_out": { "before": identified.before, "after": identified.after },
        "pairs": pairs.collect::<Vec<Value>>(),
    })
}
