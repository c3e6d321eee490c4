//! Output of `bowden compare`: text, JSON, traces.

use super::compare_found;
use super::compare_rows::{conditions, configuration, row, trials};
use super::layout::{block, heading as headline, prose, Columns, Width, NONE};
use anstyle::AnsiColor;
use bowden_trials::facts::{
    knows, places, smallest_error, told_of_limits, Compared, Heading, Line, Lineup, Results,
};
use serde_json::{json, Value};
use std::fmt::Write as _;

/// The comparison as text: the answer first.
#[must_use]
pub fn text(compared: &Compared, width: Width, verbose: bool) -> String {
    let heading = &compared.heading;
    match &compared.results {
        Results::Lineup(lineup) => lineup_text(heading, lineup, width, verbose),
        Results::Found(found) => compare_found::text(heading, found, width, verbose),
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

/// "ran away at 0.31 s", instead of errors over part of a trial; `None` if no trial diverged.
fn ran_away(line: &Line, seeds: usize) -> Option<String> {
    let at = line.ran_away?;
    let share = match seeds {
        1 => String::new(),
        _ => format!(" in {} of {seeds} trials, first", line.diverged),
    };
    Some(format!("–, diverged{share} at {at:.2} s"))
}

fn lineup_text(heading: &Heading, lineup: &Lineup, width: Width, verbose: bool) -> String {
    let mut out = String::new();
    answer(&mut out, heading, &lineup.lines, width);
    let data = format!(
        "{} · errors after {} s · noise {} N·m rms · conduit {}",
        trials(heading),
        heading.from,
        heading.noise,
        configuration(heading)
    );
    let data = std::iter::once(data).chain(heading.own());
    block(&mut out, width, "Data", data);
    out.push('\n');
    out += &steady(heading, lineup, verbose).text(width);
    if verbose {
        out.push('\n');
        out += &transient(heading, &lineup.lines).text(width);
    }
    out.push('\n');
    block(&mut out, width, "Note", notes(heading, lineup, verbose));
    let verbose = if verbose { "" } else { "-v · " };
    let certify = match &heading.gains {
        Some(gains) => format!("bowden certify {gains}"),
        None => "bowden certify".to_owned(),
    };
    let next = format!("{verbose}--trace trace.csv · --report page.html · {certify}");
    block(&mut out, width, "Next", [next]);
    out
}

/// The controller with the smallest error and its plant model, and the best one without a plant
/// model.
fn answer(out: &mut String, heading: &Heading, lines: &[Line], width: Width) {
    let subject = match &heading.model {
        Some(model) => format!("simulated reference rig with the transmission of {model}"),
        None => "simulated reference rig".to_owned(),
    };
    let command = ("bowden compare", subject.as_str());
    let Some(best) = smallest_error(lines, |_| true) else {
        let answer = (AnsiColor::Red, "EVERY CONTROLLER DIVERGED");
        headline(out, width, command, answer);
        return out.push('\n');
    };
    let size = |line: &Line| {
        let mean = line.rmse_true.mean;
        format!("{mean:.*} N·m rms", places(mean, 4))
    };
    let (name, known) = (&best.controller, knows(&best.controller));
    let knowledge = known.map_or("", |_| " (uses a plant model)");
    let answer = format!("SMALLEST ERROR: {name}{knowledge}, {}", size(best));
    // At a limit the errors say little of the gains.
    let colour = match told_of_limits(lines) {
        None => AnsiColor::Green,
        Some(_) => AnsiColor::Yellow,
    };
    headline(out, width, command, (colour, &answer));
    match known {
        Some(what) => prose(out, width, &format!("{name} uses {what}.")),
        None if heading.gains.is_some() => {
            let origin = "but `bowden design` derived its gains from one";
            prose(
                out,
                width,
                &format!("{name} uses no plant model, {origin}."),
            );
        }
        None => prose(out, width, &format!("{name} uses no plant model.")),
    }
    let other = smallest_error(lines, |name| knows(name).is_none());
    if let Some(other) = other.filter(|_| known.is_some()) {
        let name = &other.controller;
        let words = format!(
            "Smallest error without a plant model: {name}, {}.",
            size(other)
        );
        prose(out, width, &words);
    }
    out.push('\n');
}

fn steady(heading: &Heading, lineup: &Lineup, verbose: bool) -> Columns {
    let mut rows = Columns::new(
        &[
            "Error [N·m]",
            "true rms",
            "± sd",
            "measured",
            "± sd",
            "% max",
            "paper",
            "± sd",
            "peak",
            "effort",
            "reversals/s",
            "bound",
        ],
        &[5, 10, 7, 4, 2, 6, 11, 3, 9, 8],
    );
    let more = |cell: String| if verbose { cell } else { NONE.to_owned() };
    // One trial has no deviation.
    let sd = |sd: String| {
        if heading.seeds > 1 {
            sd
        } else {
            NONE.to_owned()
        }
    };
    let or_none = |cell: Option<String>| cell.unwrap_or_else(|| NONE.to_owned());
    for line in &lineup.lines {
        let name = format!("  {}", line.controller);
        if let Some(when) = ran_away(line, heading.seeds) {
            rows.add([name, when]);
            continue;
        }
        let paper = heading.paper(&line.controller);
        let bound = lineup.certificates.get(&line.controller);
        let bound = bound.and_then(|promise| promise.value);
        let (own, measured) = (line.rmse_true, line.rmse_measured);
        let digits = places(own.mean, 4);
        rows.add([
            name,
            format!("{:.digits$}", own.mean),
            sd(format!("{:.digits$}", own.sd)),
            format!("{:.*}", places(measured.mean, 4), measured.mean),
            more(sd(format!("{:.*}", places(measured.mean, 4), measured.sd))),
            more(format!("{:.2}", 100.0 * line.share)),
            or_none(paper.map(|[mean, _]| format!("{mean:.4}"))),
            more(or_none(paper.map(|[_, sd]| format!("{sd:.4}")))),
            format!("{:.*}", places(line.peak, 3), line.peak),
            format!("{:.*}", places(line.effort, 0), line.effort),
            more(format!("{:.0}", line.reversals)),
            or_none(bound.map(|value| format!("{value:.*}", places(value, 3)))),
        ]);
    }
    rows
}

fn transient(heading: &Heading, lines: &[Line]) -> Columns {
    let name = format!("Transient, the first {} s [N·m]", heading.transient);
    let header = [&name, "true rms", "± sd", "peak", "largest command"];
    let mut rows = Columns::new(&header, &[2, 4, 3]);
    for line in lines {
        let name = format!("  {}", line.controller);
        if let Some(when) = ran_away(line, heading.seeds) {
            rows.add([name, when]);
            continue;
        }
        let digits = places(line.transient.mean, 4);
        let sd = match heading.seeds {
            1 => NONE.to_owned(),
            _ => format!("{:.digits$}", line.transient.sd),
        };
        rows.add([
            name,
            format!("{:.digits$}", line.transient.mean),
            sd,
            format!("{:.*}", places(line.transient_peak, 2), line.transient_peak),
            format!("{:.*}", places(line.command, 1), line.command),
        ]);
    }
    rows
}

/// What the table does not say.
fn notes(heading: &Heading, lineup: &Lineup, verbose: bool) -> Vec<String> {
    let mut notes = Vec::new();
    notes.extend(told_of_limits(&lineup.lines));
    let changed = heading.fed_with.as_ref();
    notes.extend(changed.map(|changed| {
        format!("The model has no inverse. The feed-forward inverts {changed} instead.")
    }));
    let rig = match (heading.is_paper, &heading.model, heading.gait) {
        (true, ..) => &[CALIBRATED, NOT_REPRODUCED][..],
        (false, Some(_), _) => &[OF_THE_REFERENCE_RIG],
        (false, None, true) => &[],
        (false, None, false) => &[CHANGED],
    };
    notes.extend(rig.iter().map(|&note| note.to_owned()));
    let no_bound = match (lineup.certificates.is_empty(), &heading.gains) {
        (false, _) => None,
        (true, Some(_)) => Some(NOT_OF_THESE_GAINS),
        (true, None) if heading.gait && heading.model.is_none() => Some(NOT_OF_A_GAIT),
        (true, None) => Some(NOT_OF_THIS_RIG),
    };
    notes.extend(no_bound.map(str::to_owned));
    if verbose {
        let runs = |name: &str| lineup.lines.iter().any(|line| line.controller == name);
        let own = OF_CONTROLLERS.iter().filter(|(name, _)| runs(name));
        notes.extend(own.map(|(name, note)| format!("{name}: {note}")));
        notes.extend(heading.gains.as_ref().map(|_| RINGING.to_owned()));
        notes.extend(OF_COLUMNS.map(str::to_owned));
    }
    notes
}

const CALIBRATED: &str = "The rig's drive gain and noise were chosen so that PI and the adaptive law match Table 3 of Nguyen et al. (2018). The `pi` and `adaptive` rows are therefore a calibration, not a validation.";

const NOT_REPRODUCED: &str = "Two results of the paper are not reproduced: the advantage of PIV over PI, and the scatter between trials.";

const OF_THE_REFERENCE_RIG: &str = "Rig parameters default to the values of the reference rig.";

const RINGING: &str = "Gains from `bowden design` can cause ringing with a heavy joint, because the design neglects its inertia.";

const CHANGED: &str =
    "Table 3 of Nguyen et al. (2018) does not apply, because the rig or the gains differ from those of the paper.";

const NOT_OF_A_GAIT: &str =
    "No bounds are shown, because they hold only for the reference signal of Nguyen et al. (2018).";

const NOT_OF_THESE_GAINS: &str =
    "`bowden certify GAINS.toml` prints the proved bounds for these gains.";

const NOT_OF_THIS_RIG: &str = "No bounds are shown, because they hold only for the reference rig. `bowden design` derives gains from a model, with a bound for these gains.";

const OF_CONTROLLERS: [(&str, &str); 5] = [
    ("matched-pi", "a PI with the effective integral gain of the adaptive law in Nguyen et al. (2018), which is 320. Its error shows the effect of this gain without adaptation."),
    ("pi-observer", "a PI with lower gains and a disturbance observer, without a friction model. `bowden certify` prints the range of plants for which the loop is proved stable."),
    ("adaptive-frozen", "the adaptive law with fixed estimates. beta_hat is 1/alpha if its given value is 0."),
    ("adaptive-feed-forward", "the adaptive law plus a feed-forward, which is the inverse of the rig's own transmission or of the given model."),
    ("pi-learning", "the PI of Nguyen et al. (2018) plus iterative learning: a correction for each cell of the cycle, computed with the inverse of the nominal plant. It needs the phase of the cycle and takes five to twenty cycles to learn."),
];

const OF_COLUMNS: [&str; 3] = [
    "Columns: `measured` is the rms of the measured error, as in Table 3 of Nguyen et al. (2018). `% max` is this rms as a percentage of the largest reference.",
    "Columns: `effort` is the command's total variation per second [units/s].",
    "Columns: `bound` is the proved bound on the rms error for an idealised plant without sensor noise. `bowden certify` lists its assumptions.",
];

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
