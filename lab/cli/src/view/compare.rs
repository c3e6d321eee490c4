//! Output of `bowden compare`: tables, JSON, traces.

use super::compare_found;
use super::compare_rows::{conditions, configuration, own, row};
use bowden_trials::facts::{
    places, told_of_limits, Compared, Heading, Line, Lineup, Promise, Results, Spread,
};
use serde_json::{json, Value};
use std::fmt::Write as _;

/// The comparison for people.
#[must_use]
pub fn text(compared: &Compared) -> String {
    match &compared.results {
        Results::Lineup(lineup) => lineup_text(&compared.heading, lineup),
        Results::Found(found) => compare_found::text(&compared.heading, found),
    }
}

/// The comparison as JSON, schema `bowden.compare/1`.
#[must_use]
pub fn json(compared: &Compared) -> String {
    match &compared.results {
        Results::Lineup(lineup) => lineup_json(&compared.heading, lineup),
        Results::Found(found) => compare_found::json(&compared.heading, found),
    }
}

fn spread(spread: Spread) -> String {
    let places = places(spread.mean, 4);
    format!("{:.places$} ± {:.places$}", spread.mean, spread.sd)
}

/// "–, ran away at 0.31 s", in place of errors that were summed over a part of the trial;
/// `None` if no trial ran away.
fn ran_away(line: &Line, seeds: usize) -> Option<String> {
    let at = line.ran_away?;
    let share = match seeds {
        1 => String::new(),
        _ => format!(" in {} of {seeds} trials, first", line.diverged),
    };
    Some(format!("–, ran away{share} at {at:.2} s"))
}

fn lineup_text(heading: &Heading, lineup: &Lineup) -> String {
    let mut out = format!(
        "bowden compare: {} trials of {} s on the reference rig{}, noise {} N·m rms, configuration {}\n\n",
        heading.seeds,
        heading.seconds,
        match &heading.model {
            Some(model) => format!(" with the transmission of {model}"),
            None => String::new(),
        },
        heading.noise,
        configuration(heading)
    );
    out += &own(heading);
    if let Some(changed) = &heading.fed_with {
        let _ = writeln!(
            out,
            "The model has no inverse as it is: fed forward with {changed}.\n"
        );
    }
    let notes = match (heading.is_paper, &heading.model, heading.gait) {
        (true, ..) => NOTES,
        (false, Some(_), _) => OWN_NOTES,
        (false, None, true) => GAIT_NOTES,
        (false, None, false) => CHANGED_NOTES,
    };
    let at_limits = told_of_limits(&lineup.lines);
    out + &steady(heading, lineup)
        + &at_limits.map_or_else(String::new, |told| format!("{told}\n"))
        + &transient(heading, &lineup.lines)
        + notes
        + without_certificate(heading, lineup)
}

/// Why a row has a dash in the column of the certificates.
fn without_certificate(heading: &Heading, lineup: &Lineup) -> &'static str {
    match (lineup.certificates.is_empty(), &heading.gains) {
        (false, _) => NO_CERTIFICATE,
        (true, Some(_)) => NOT_OF_THESE_GAINS,
        (true, None) if heading.gait && heading.model.is_none() => NOT_OF_A_GAIT,
        (true, None) => NOT_OF_THIS_RIG,
    }
}

fn steady(heading: &Heading, lineup: &Lineup) -> String {
    let mut out = format!(
        "Steady part, from {} s on; errors in N·m\n{:<22} {:>17} {:>17} {:>6} {:>7} {:>9} {:>8}  {:<17} certificate\n",
        heading.from,
        "controller",
        "rmse, true",
        "rmse, measured",
        "% max",
        "peak",
        "effort/s",
        "turns/s",
        "paper, Table 3"
    );
    let certificate = |promise: &Promise| {
        let value = promise.value?;
        Some(format!("{} {value:.*}", promise.kind, places(value, 3)))
    };
    for line in &lineup.lines {
        if let Some(when) = ran_away(line, heading.seeds) {
            let _ = writeln!(out, "{:<22} {when}", line.controller);
            continue;
        }
        let paper = heading.paper(&line.controller);
        let paper = paper.map(|[mean, sd]| format!("{mean:.4} ± {sd:.4}"));
        let own = lineup.certificates.get(&line.controller);
        let _ = writeln!(
            out,
            "{:<22} {:>17} {:>17} {:>6.2} {:>7.*} {:>9.*} {:>8.0}  {:<17} {}",
            line.controller,
            spread(line.rmse_true),
            spread(line.rmse_measured),
            100.0 * line.share,
            places(line.peak, 3),
            line.peak,
            places(line.effort, 0),
            line.effort,
            line.reversals,
            paper.as_deref().unwrap_or("-"),
            own.and_then(certificate).as_deref().unwrap_or("-"),
        );
    }
    out
}

fn transient(heading: &Heading, lines: &[Line]) -> String {
    let mut out = format!(
        "\nTransient, the first {} s\n{:<22} {:>17} {:>9} {:>14}\n",
        heading.transient, "controller", "rmse, true", "peak", "most command"
    );
    for line in lines {
        if let Some(when) = ran_away(line, heading.seeds) {
            let _ = writeln!(out, "{:<22} {when}", line.controller);
            continue;
        }
        let _ = writeln!(
            out,
            "{:<22} {:>17} {:>9.*} {:>14.*}",
            line.controller,
            spread(line.transient),
            places(line.transient_peak, 2),
            line.transient_peak,
            places(line.command, 1),
            line.command
        );
    }
    out
}

const NOTES: &str = "
The rig's drive gain and noise were picked so that PI and the adaptive law come out as in
Table 3: those two are calibration, not validation. Not reproduced: PIV below PI (here it
is not), and the paper's scatter between trials. matched-pi is a PI with the integral gain
that the adaptive law has in effect (320): what it reaches is gain, not adaptation.
pi-observer is a softer PI with a disturbance observer: it knows the rig's drive gain, inertia,
damping and stiffness, and nothing of the friction. The frozen law starts with beta_hat at
1/alpha and delta_hat as given, and never adapts; the feed-forward knows the rig's own
transmission, or the --model. A certificate bounds an idealised plant without sensor noise:
`bowden certify` lists what each assumes.
";

const OWN_NOTES: &str = "
Inertias, spring, damping, lags and delay of the rig are those of the reference rig unless they
are given. The transmission and the effects are the model's, which the feed-forward inverts as far
as that can be. Gains of `bowden design` are for a plant that answers after the stated delay: a
heavy joint that swings may ring with them.
";

const CHANGED_NOTES: &str = "
Rig or gains are not the paper's: Table 3 does not compare with them. What is not given is the
paper's or the reference rig's; matched-pi then has the integral gain that the paper's adaptive
law has in effect (320). pi-observer knows the rig's drive gain, inertia, damping and stiffness, and
nothing of the friction. The frozen law starts with beta_hat at 1/alpha and delta_hat as given,
and never adapts; the feed-forward knows the rig's own transmission, or the model that is given.
A certificate bounds an idealised plant without sensor noise: `bowden certify` lists what each
assumes.
";

const GAIT_NOTES: &str = "
pi-learning is the paper's PI with what the steps before have lacked, a number for each cell of the
cycle, and with its nominal plant turned round along the reference; it needs the phase of the cycle,
and five to twenty cycles. What else differs from the paper's table: `bowden compare` without --gait
says so. matched-pi has the integral gain that the adaptive law has in effect (320); pi-observer
knows the rig's drive gain, inertia, damping and stiffness, and nothing of the friction; the
feed-forward of adaptive-feed-forward knows the rig's own transmission, or the model that is given.
";

const NOT_OF_A_GAIT: &str = "\
certificate -: the table has those of the paper's reference alone.
";

const NO_CERTIFICATE: &str = "\
certificate -: no bound of its error is known. `bowden certify` says for which plants the loop of
pi-observer is stable.
";

const NOT_OF_THESE_GAINS: &str = "\
certificate -: the table has those of the reference rig alone. `bowden certify GAINS.toml` says what
is proved of the adaptive law of these gains, on the plant that their file states in [plant].
";

const NOT_OF_THIS_RIG: &str = "\
certificate -: the table has those of the reference rig alone. `bowden design` derives gains from a
model, with what is promised of them.
";

fn lineup_json(heading: &Heading, lineup: &Lineup) -> String {
    let rows = lineup.lines.iter().map(|line| {
        let mut row = row(line);
        row["certificate"] = match lineup.certificates.get(&line.controller) {
            Some(c) if c.value.is_some() => json!({ "kind": c.kind, "value": c.value }),
            _ => Value::Null,
        };
        row["paper"] = match heading.paper(&line.controller) {
            Some([mean, sd]) => json!({ "mean": mean, "sd": sd }),
            None => Value::Null,
        };
        row
    });
    let rows: Vec<Value> = rows.collect();
    json!({ "schema": "bowden.compare/1", "conditions": conditions(heading), "rows": rows })
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
