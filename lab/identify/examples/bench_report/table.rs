//! `benches/README.md` as text.

use crate::cases::{Case, PLANTED};
use crate::limits::Limit;
use crate::peers::Peers;
use crate::program::{Instrument, Outcome};
use bowden_lab::model::catalogue;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{read, Options};
use std::fmt::Write as _;
use std::path::Path;

/// Everything that was measured.
pub struct Measured {
    /// Whether only what takes minutes was asked for.
    pub quick: bool,
    pub samples: Vec<(String, Outcome)>,
    /// Angles, columns of the catalogue on them, cost.
    pub angles: Vec<(String, usize, Outcome)>,
    pub names: Vec<(String, Outcome)>,
    pub rows: Vec<(String, Outcome)>,
    /// Measured records that were not run, and why.
    pub missing: Vec<String>,
    pub peers: Peers,
}

/// How many columns of the catalogue are tried on a record of the catalogue series.
pub fn candidates(case: &Case) -> Result<usize, String> {
    let pairs = case.arguments.iter().filter_map(|a| a.split_once('='));
    let options = Options {
        channels: pairs
            .map(|(name, column)| (name.to_owned(), column.to_owned()))
            .collect(),
        ..Options::default()
    };
    let record = read(Path::new(&case.arguments[0]), &options).map_err(|e| e.to_string())?;
    let data = Prepared::new(&record, Preparation::default())?;
    let declared = structure(&["bouc-wen".to_owned()], &data)?;
    Ok(catalogue::candidates(&data, &declared, &data.target).len())
}

fn giga(count: Option<f64>) -> String {
    count.map_or_else(|| "–".to_owned(), |c| format!("{:.2}", c / 1e9))
}

fn names(outcome: &Outcome) -> String {
    match outcome.names.is_empty() {
        true => "–".to_owned(),
        false => outcome.names.join(", "),
    }
}

/// A table in Markdown.
fn table(head: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut text = format!("| {} |\n|{}\n", head.join(" | "), "---|".repeat(head.len()));
    for row in rows {
        let _ = writeln!(text, "| {} |", row.join(" | "));
    }
    text
}

/// The cells that all series have.
fn cost(outcome: &Outcome) -> [String; 6] {
    [
        format!("{:.0}", outcome.evaluations),
        format!("{:.0}", outcome.jacobians),
        format!("{:.0}", outcome.columns),
        format!("{:.0}", outcome.searches),
        giga(outcome.instructions),
        format!("{:.2}", outcome.seconds),
    ]
}

const COST: [&str; 6] = [
    "evaluations",
    "Jacobians",
    "columns filtered",
    "searches",
    "G instructions",
    "s",
];

fn samples(measured: &Measured) -> String {
    let head = [
        &["samples", "named"][..],
        &COST,
        &["instructions per sample", "peak memory [MB]"],
    ]
    .concat();
    let row = |(label, o): &(String, Outcome)| {
        let each = o
            .instructions
            .map_or_else(|| "–".to_owned(), |i| format!("{:.0}", i / o.samples));
        let peak = o
            .peak
            .map_or_else(|| "–".to_owned(), |p| format!("{:.1}", p / 1e6));
        let mut cells = vec![label.clone(), names(o)];
        cells.extend(cost(o));
        cells.extend([each, peak]);
        cells
    };
    table(&head, measured.samples.iter().map(row))
}

fn angles(measured: &Measured) -> String {
    let head = [&["angles", "columns of the catalogue", "named"][..], &COST].concat();
    let row = |(label, columns, o): &(String, usize, Outcome)| {
        let mut cells = vec![label.clone(), columns.to_string(), names(o)];
        cells.extend(cost(o));
        cells
    };
    table(&head, measured.angles.iter().map(row))
}

/// A series by its label, with evaluations for each name.
fn by_name(first: &str, rows: &[(String, Outcome)]) -> String {
    let head = [
        &[first, "samples", "named"][..],
        &COST,
        &["evaluations per term", "share of the search in the time"],
    ]
    .concat();
    let row = |(label, o): &(String, Outcome)| {
        let mut cells = vec![label.clone(), format!("{:.0}", o.samples), names(o)];
        cells.extend(cost(o));
        cells.push(format!("{:.0}", o.evaluations_a_name()));
        cells.push(format!("{:.0} %", 100.0 * o.search_share));
        cells
    };
    table(&head, rows.iter().map(row))
}

fn peers((all, notes): &Peers) -> String {
    let head = [
        "the record contains",
        "method",
        "samples",
        "evaluations",
        "G instructions",
        "s",
        "`identify` is faster",
        "reached",
    ];
    let own = |record: &str| {
        let mut close = all.iter().filter(|p| p.method.contains("close"));
        close.find(|p| p.record == record)
    };
    let rows = all.iter().map(|peer| {
        let ratio = own(peer.record).map(|own| match own.instructions.zip(peer.instructions) {
            Some((a, b)) => format!("{:.1} times", b / a),
            None => format!("{:.1} times in wall time", peer.seconds / own.seconds),
        });
        vec![
            peer.record.to_owned(),
            peer.method.to_owned(),
            format!("{:.0}", peer.samples),
            format!("{:.0}", peer.evaluations),
            giga(peer.instructions),
            format!("{:.2}", peer.seconds),
            ratio.unwrap_or_default(),
            peer.reached.clone(),
        ]
    });
    let mut text = table(&head, rows);
    for note in notes {
        let _ = writeln!(text, "\n{note}.");
    }
    text
}

const HEAD: &str = "\
# Cost

`cargo run --release -p bowden-lab --example bench_report` writes this section; do not edit it. With
`--quick` the command takes only minutes.

`bowden identify RECORD --json` prints these counts under `cost`. An **evaluation** computes a model's
columns, its gains and its residual over all samples of a grid. A **Jacobian** contains the derivatives
with respect to all shape parameters. A **search** is one run of Levenberg-Marquardt from one starting
point. The counts are reproducible exactly, the instructions to about 1e-4. The seconds are from one run
with one thread and depend on the machine and its load. All numbers are for the whole process: reading,
preparing, fitting, searching, the final fit and the report.

";

const PEERS: &str = "\
Nguyen et al. (2018) minimise (8) with a genetic algorithm and then with Nelder-Mead, and integrate with
fourth-order Runge-Kutta. The paper does not state the settings. Here the population is 50, and the
simplex has its usual settings; both are small, so the ratio is a lower bound
(`lab/identify/examples/bench_report/paper.rs`, compiled with the same compiler). The instructions are
those of one evaluation times the number of evaluations. SciPy
(`python3 benches/peers/bouc_wen_scipy.py RECORD.csv`) solves for the linear gains and gets means of five
samples; each of its evaluations is for one parameter set. Both fit the six parameters of the baseline
model. Neither looks for a missing term, splits the record, or gives intervals or a verdict; `identify` does.

";

/// The whole file.
pub fn document(measured: &Measured, limits: &[Limit], instrument: Instrument) -> String {
    let mut text = HEAD.to_owned();
    let mut part = |title: &str, words: &str, table: &str| {
        let _ = writeln!(text, "## {title}\n\n{words}{table}");
    };
    let quick = match measured.quick {
        true => {
            " Written with `--quick`: the series are short, and most measured records are omitted."
        }
        false => "",
    };
    let counted = format!("{}{quick}\n\n", instrument.words());
    let rows = limits.iter().map(|l| {
        vec![
            l.what.to_owned(),
            l.limit.clone(),
            l.reached.clone(),
            l.between.clone(),
        ]
    });
    let head = [
        "figure",
        "limit",
        "measured",
        "distance to the limit, and its causes",
    ];
    part("Distance to the limits", &counted, &table(&head, rows));
    let record =
        "`bowden generate --mode torque --effect viscous --seed 7`, with other lengths:\n\n";
    part(
        "Cost over the number of samples",
        record,
        &samples(measured),
    );
    let record = "The same with `--effect asymmetry-eta`, and with other numbers of angles:\n\n";
    part(
        "Cost over the size of the catalogue",
        record,
        &angles(measured),
    );
    let record = format!(
        "Records of 60 s with the first 0 to 4 of these effects, each at twice the noise: {}:\n\n",
        PLANTED.join(", ")
    );
    part(
        "Cost over the number of missing terms",
        &record,
        &by_name("planted", &measured.names),
    );
    let record = "The rows of [docs/results/measured.md](../docs/results/measured.md); the files are not part of the project.\n\n";
    let mut rows = by_name("record", &measured.rows);
    for missing in &measured.missing {
        let _ = writeln!(rows, "\n{missing}.");
    }
    part("Measured records", record, &rows);
    part("Peers", PEERS, &peers(&measured.peers));
    text.truncate(text.trim_end().len());
    text + "\n"
}
