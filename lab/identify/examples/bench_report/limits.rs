//! What the figures are to be, and what stands between.

use crate::program::Outcome;
use crate::table::Measured;

/// A figure beside its limit.
pub struct Limit {
    pub what: &'static str,
    pub limit: String,
    pub reached: String,
    /// How far it is, and what makes it up.
    pub between: String,
}

const G: f64 = 1e9;

/// At most so many instructions for a record, and what they go into.
fn instructions(what: &'static str, limit: f64, outcome: Option<&Outcome>) -> Limit {
    let counted = outcome.and_then(|o| o.instructions.map(|i| (o, i)));
    let (reached, between) = match counted {
        None => ("not measured".to_owned(), "–".to_owned()),
        Some((o, count)) => {
            let whole = format!(
                "{:.0} evaluations, {:.1} M instructions each, in total; {:.0} % of the time is the search",
                o.evaluations,
                count / o.evaluations.max(1.0) / 1e6,
                100.0 * o.search_share
            );
            (
                format!("{:.2} G", count / G),
                distance(count / limit, &whole),
            )
        }
    };
    Limit {
        what,
        limit: format!("≤ {:.1} G", limit / G),
        reached,
        between,
    }
}

/// "met", or by how much not; a ratio of one is the limit.
fn distance(ratio: f64, what: &str) -> String {
    match ratio <= 1.0 {
        true => format!("met ({:.0} % of the limit): {what}", 100.0 * ratio),
        false => format!("**{ratio:.1} times the limit**: {what}"),
    }
}

fn row<'a>(rows: &'a [(String, Outcome)], label: &str) -> Option<&'a Outcome> {
    rows.iter().find(|(own, _)| own == label).map(|(_, o)| o)
}

/// All measured rows together: only where none is missing.
fn all_rows(measured: &Measured) -> Limit {
    let limit = 150.0 * G;
    let counts: Option<Vec<f64>> = measured.rows.iter().map(|(_, o)| o.instructions).collect();
    let counts = counts.filter(|_| measured.missing.is_empty());
    let largest = |counts: &[f64]| {
        let each = measured.rows.iter().zip(counts);
        let largest = each.max_by(|a, b| a.1.total_cmp(b.1));
        largest.map_or_else(String::new, |((label, _), count)| {
            format!("{label} alone takes {:.1} G", count / G)
        })
    };
    let (reached, between) = match counts {
        None => ("not measured".to_owned(), "–".to_owned()),
        Some(counts) => {
            let sum: f64 = counts.iter().sum();
            (
                format!("{:.1} G", sum / G),
                distance(sum / limit, &largest(&counts)),
            )
        }
    };
    Limit {
        what: "the ten measured records together",
        limit: format!("≤ {:.0} G", limit / G),
        reached,
        between,
    }
}

/// Evaluations for each name, on the worst record of all that have a name.
fn evaluations_a_name(measured: &Measured) -> Limit {
    let series = [
        (&measured.rows, ""),
        (&measured.names, " effects planted in 60 s"),
        (&measured.samples, " samples"),
    ];
    let all = series.iter().flat_map(|(rows, what)| {
        let named = rows.iter().filter(|(_, o)| !o.names.is_empty());
        named.map(move |(label, o)| (format!("{label}{what}"), o))
    });
    let worst = all.max_by(|a, b| {
        let each = [a.1, b.1].map(Outcome::evaluations_a_name);
        each[0].total_cmp(&each[1])
    });
    let (reached, between) = match worst {
        None => ("not measured".to_owned(), "–".to_owned()),
        Some((label, o)) => (
            format!("{:.0}", o.evaluations_a_name()),
            distance(
                o.evaluations_a_name() / 100.0,
                &format!(
                    "{label}: {:.0} evaluations in {:.0} local searches for {} terms",
                    o.evaluations,
                    o.searches,
                    o.names.len()
                ),
            ),
        ),
    };
    Limit {
        what: "evaluations per term, on the record with the most",
        limit: "≤ 100".to_owned(),
        reached,
        between,
    }
}

/// The paper's method over `identify`, on the record with an undeclared effect.
fn over_the_paper(measured: &Measured) -> Limit {
    let of = |method: &str| measured.peers.0.iter().find(|p| p.method.contains(method));
    let (reached, between) = match (of("close"), of("paper")) {
        (Some(own), Some(paper)) => {
            let by_instructions = own.instructions.zip(paper.instructions).map(|(a, b)| b / a);
            let ratio = by_instructions.unwrap_or(paper.seconds / own.seconds);
            let what = format!(
                "{:.0} evaluations by the paper's method, {:.0} by `identify`; {:.1} times faster in wall time",
                paper.evaluations,
                own.evaluations,
                paper.seconds / own.seconds
            );
            (format!("{ratio:.0} times"), distance(150.0 / ratio, &what))
        }
        _ => ("not measured".to_owned(), "–".to_owned()),
    };
    Limit {
        what: "faster than the paper's method (whole process)",
        limit: "≥ 150 times".to_owned(),
        reached,
        between,
    }
}

/// Instructions a sample of the longest record over those of 100 000 samples.
fn is_linear(measured: &Measured) -> Limit {
    let each = |o: &Outcome| o.instructions.map(|i| i / o.samples);
    let base = row(&measured.samples, "100000").and_then(each);
    let long = measured.samples.last().filter(|(_, o)| o.samples > 1e5);
    let ratio = base
        .zip(long.and_then(|(_, o)| each(o)))
        .map(|(a, b)| b / a);
    Limit {
        what: "linear in time: instructions per sample, ratio of the longest record to 100 000 samples",
        limit: "≤ 1.1, with 10 000 000 samples".to_owned(),
        reached: ratio.map_or_else(|| "not measured".to_owned(), |r| format!("{r:.2}")),
        between: match (ratio, long) {
            (Some(ratio), Some((label, _))) => distance(ratio / 1.1, &format!("{label} samples")),
            _ => "–".to_owned(),
        },
    }
}

/// Resident memory that one more row costs, between the two longest records.
fn bytes_a_row(measured: &Measured) -> Limit {
    let slope = match &measured.samples[..] {
        [.., (_, a), (_, b)] => {
            let peaks = a.peak.zip(b.peak);
            peaks.map(|(low, high)| (high - low) / (b.samples - a.samples))
        }
        _ => None,
    };
    Limit {
        what: "memory per row, between the two longest records",
        limit: "≤ 80 B".to_owned(),
        reached: slope.map_or_else(|| "not measured".to_owned(), |s| format!("{s:.0} B")),
        between: slope.map_or_else(
            || "–".to_owned(),
            |s| {
                distance(
                    s / 80.0,
                    "the text of the file, its columns, their grids, and the data that the fit keeps",
                )
            },
        ),
    }
}

/// All limits, in the order in which they were set.
pub fn limits(measured: &Measured) -> Vec<Limit> {
    let rows = &measured.rows;
    vec![
        instructions(
            "a planted effect, 20 000 samples",
            0.6 * G,
            row(&measured.samples, "20000"),
        ),
        instructions("emps plain", 15.0 * G, row(rows, "emps plain")),
        instructions("tribometer", 25.0 * G, row(rows, "tribometer")),
        all_rows(measured),
        evaluations_a_name(measured),
        over_the_paper(measured),
        is_linear(measured),
        bytes_a_row(measured),
    ]
}
