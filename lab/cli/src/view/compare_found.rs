//! Output of `bowden compare --effect`: identified terms as a feed-forward of the controllers.

use super::compare_rows::{conditions, row, trials};
use super::layout::{block, heading as headline, prose, Columns, Width, LISTED};
use anstyle::AnsiColor;
use bowden_trials::facts::{Found, Heading, Line, Outcome, Pair};
use serde_json::{json, Value};

/// "0.123", or when the loop ran away.
fn error(line: &Line) -> String {
    match line.ran_away {
        None => format!("{:.4}", line.rmse_true.mean),
        Some(at) => format!("diverged at {at:.2} s"),
    }
}

/// Relative change from before to after.
fn change(pair: &Pair) -> String {
    let change = pair.change();
    change.map_or_else(
        || "–".to_owned(),
        |share| format!("{:+.0} %", 100.0 * share),
    )
}

/// For people: the answer first.
pub(super) fn text(heading: &Heading, found: &Found, width: Width, verbose: bool) -> String {
    let (effect, outcomes) = (&found.effect, &found.outcomes);
    let mut out = String::new();
    let (all, count) = (found.over_seeds.len(), outcomes.len());
    let gained = found.over_seeds.iter().filter(|over| over.lower == count);
    let gained = gained.count();
    let colour = match gained {
        0 => AnsiColor::Yellow,
        _ => AnsiColor::Green,
    };
    let answer = format!("THE IDENTIFIED TERMS LOWER THE ERROR OF {gained} OF {all} CONTROLLERS");
    let subject = format!("--effect {}", effect.name);
    let command = ("bowden compare", subject.as_str());
    headline(&mut out, width, command, (colour, &answer));
    let words = format!(
        "The rig includes {1} ({0} N·m rms), which the baseline model lacks. A controller counts only if its error falls in every trial.",
        effect.strength, effect.name
    );
    prose(&mut out, width, &words);
    out.push('\n');
    let data = format!("{} · noise {} N·m rms", trials(heading), heading.noise);
    block(
        &mut out,
        width,
        "Data",
        std::iter::once(data).chain(heading.own()),
    );
    let mut bench: Vec<String> = outcomes.iter().map(on_the_bench).collect();
    if !verbose && bench.len() > LISTED {
        bench.truncate(LISTED);
        bench.push(format!("{} more: -v", count - LISTED));
    }
    block(&mut out, width, "Bench", bench);
    out.push('\n');
    if verbose || count == 1 {
        for outcome in outcomes {
            out += &seed(outcome).text(width);
            out.push('\n');
        }
    }
    if count > 1 {
        out += &over_seeds(found).text(width);
        out.push('\n');
    }
    if verbose {
        block(&mut out, width, "Note", NOTES);
    }
    let next = match verbose {
        true => "--json · --report page.html",
        false => "-v (errors of each seed) · --json · --report page.html",
    };
    block(&mut out, width, "Next", [next]);
    out
}

/// What `identify` found on the bench record of a seed.
fn on_the_bench(outcome: &Outcome) -> String {
    let found = &outcome.identified;
    let names = match found.names.is_empty() {
        true => "nothing".to_owned(),
        false => found.names.join(", "),
    };
    let mut out = format!(
        "seed {}: found {names}, held-out RMSE {:.4} → {:.4} N·m",
        outcome.seed, found.before, found.after
    );
    if !found.left_out.is_empty() {
        out += &format!("; not in the feed-forward: {}", found.left_out.join(", "));
    }
    if let Some(changed) = &outcome.fed_with {
        out += &format!("; the model has no inverse, so the feed-forward inverts {changed}");
    }
    out
}

/// Number of trials in which each controller gains.
fn over_seeds(found: &Found) -> Columns {
    let header = [
        "Trials in which the error is",
        "lower",
        "the same",
        "higher",
    ];
    let mut rows = Columns::new(&header, &[]);
    for over in &found.over_seeds {
        let counts = [over.lower, over.same, over.higher].map(|count| count.to_string());
        let name = format!("  {}", over.controller);
        rows.add(std::iter::once(name).chain(counts));
    }
    rows
}

fn seed(outcome: &Outcome) -> Columns {
    let name = format!("True rms [N·m], seed {}", outcome.seed);
    let header = [&name, "no model", "baseline", "identified", "change"];
    let mut rows = Columns::new(&header, &[1, 4]);
    for pair in &outcome.pairs {
        rows.add([
            format!("  {}", pair.controller),
            error(&pair.plain),
            error(&pair.declared),
            error(&pair.found),
            change(pair),
        ]);
    }
    rows
}

const NOTES: [&str; 4] = [
    "Baseline: the feed-forward inverts only the Bouc-Wen model, fitted to the bench record.",
    "Identified: the feed-forward inverts the Bouc-Wen model with the terms that `identify` adds, refitted together.",
    "Third regressor: the identified terms form a regressor of the adaptive law, with their bench values as priors. The baseline is the adaptive law without these terms.",
    "Quiet: the gains are a fifth of those of Nguyen et al. (2018), so improvements are visible that the full gains hide.",
];

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

/// Three rows for each controller: without a model, with the baseline model, and with the found
/// terms.
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
