//! `docs/reference/json.md` lists the fields that the program prints: each name, each type, none more.

use crate::shell::{args, bowden, example, said, text};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::OnceLock;

const PAGE: &str = include_str!("../../../../docs/reference/json.md");

/// Tables whose fields no record below needs to have: what the search finds of rivals, curves and
/// motions may change with it. Where they do occur they are compared like all others.
const SELDOM: [&str; 10] = [
    "experiment",
    "aim",
    "unknown",
    "knot",
    "inconsistent channel",
    "inconsistent file",
    "worse file",
    "excluded term",
    "alternative",
    "redundant",
];

/// Optional fields that no record below needs to have: a fit that fails only without an effect.
const SELDOM_FIELDS: [&str; 2] = ["feed-forward.caution", "found term.not_refitted_without"];

struct Field {
    name: String,
    kind: String,
    optional: bool,
}

/// The tables of the page by their headings.
fn tables() -> BTreeMap<String, Vec<Field>> {
    let mut tables: BTreeMap<String, Vec<Field>> = BTreeMap::new();
    let mut heading = String::new();
    for line in PAGE.lines() {
        if let Some(name) = line.strip_prefix("### ").or(line.strip_prefix("## ")) {
            heading = name.to_owned();
        }
        let Some(row) = line.strip_prefix("| `") else {
            continue;
        };
        let mut cells = row.split(" | ");
        let (name, kind) = (cells.next().unwrap(), cells.next().unwrap());
        let (name, mark) = name.split_once('`').unwrap();
        tables.entry(heading.clone()).or_default().push(Field {
            name: name.to_owned(),
            kind: kind.to_owned(),
            optional: mark.contains("optional"),
        });
    }
    tables
}

/// What has been seen, and what does not agree.
struct Comparison {
    tables: BTreeMap<String, Vec<Field>>,
    seen: BTreeSet<String>,
    wrong: Vec<String>,
}

impl Comparison {
    /// An object with the table of that heading.
    fn object(&mut self, value: &Value, heading: &str) {
        let Some(fields) = self.tables.remove(heading) else {
            self.wrong.push(format!("there is no table {heading}"));
            return;
        };
        let Some(object) = value.as_object() else {
            self.wrong.push(format!("{heading} is no object: {value}"));
            self.tables.insert(heading.to_owned(), fields);
            return;
        };
        for key in object.keys() {
            if fields.iter().all(|field| field.name != *key) {
                self.wrong.push(format!("{heading}: {key} is not listed"));
            }
        }
        let listed: Vec<(String, String, bool)> = fields
            .iter()
            .map(|field| (field.name.clone(), field.kind.clone(), field.optional))
            .collect();
        self.tables.insert(heading.to_owned(), fields);
        for (name, kind, optional) in listed {
            let place = format!("{heading}.{name}");
            match object.get(&name) {
                Some(inner) => {
                    self.seen.insert(place.clone());
                    self.value(inner, &kind, &place);
                }
                None if optional => {}
                None => self.wrong.push(format!("{place} is absent")),
            }
        }
    }

    /// A value of the type that the page states.
    fn value(&mut self, value: &Value, kind: &str, place: &str) {
        if let Some(kind) = kind.strip_suffix(" or null") {
            if !value.is_null() {
                self.value(value, kind, place);
            }
        } else if let Some(kind) = kind.strip_prefix("list of ") {
            match value.as_array() {
                Some(all) => all.iter().for_each(|one| self.value(one, kind, place)),
                None => self.wrong.push(format!("{place} is no list: {value}")),
            }
        } else if let Some(heading) = kind.strip_prefix('*').and_then(|k| k.strip_suffix('*')) {
            self.object(value, heading);
        } else {
            let agrees = match kind {
                "text" => value.is_string(),
                "number" => value.is_number(),
                "true or false" => value.is_boolean(),
                "object" => value.is_object(),
                "exact" => value.as_str().is_some_and(is_exact),
                _ => false,
            };
            if !agrees {
                self.wrong.push(format!("{place} is no {kind}: {value}"));
            }
        }
    }
}

/// `mantissa*2^exponent`
fn is_exact(text: &str) -> bool {
    let whole = |digits: &str| digits.parse::<i128>().is_ok();
    text.split_once("*2^")
        .is_some_and(|(mantissa, exponent)| whole(mantissa) && whole(exponent))
}

/// What a command prints, with any verdict.
fn printed(arguments: &[&str]) -> Value {
    let output = bowden(arguments);
    assert_ne!(output.status.code(), Some(2), "{arguments:?}: {output:?}");
    serde_json::from_str(text(&output.stdout)).unwrap()
}

/// The straight cable with its output changed: `change` of row, position and output.
fn changed(path: &Path, change: impl Fn(usize, f64, f64) -> f64) {
    let mut out = String::new();
    for (row, line) in std::fs::read_to_string(example("straight.csv"))
        .unwrap()
        .lines()
        .enumerate()
    {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if row > 0 {
            let (output, position) = (cells[2].parse().unwrap(), cells[3].parse().unwrap());
            cells[2] = format!("{:.4}", change(row, position, output));
        }
        out += &(cells.join(",") + "\n");
    }
    std::fs::write(path, out).unwrap();
}

/// Adds noise to the input, so that it drives the hysteresis sample by sample.
fn shake(path: &Path) {
    let text = std::fs::read_to_string(path).unwrap();
    let line = |(row, line): (usize, &str)| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if row > 0 {
            let noise = ((row as f64 * 12.9898).sin() * 43758.5453).rem_euclid(1.0) - 0.5;
            cells[1] = (cells[1].parse::<f64>().unwrap() + 0.3 * noise).to_string();
        }
        cells.join(",") + "\n"
    };
    let shaken: String = text.lines().enumerate().map(line).collect();
    std::fs::write(path, shaken).unwrap();
}

/// The later record of the straight cable as it might have been logged: the input in mN·m under the
/// header of N·m, input and output in each other's place, the output five samples late.
fn logged_otherwise(folder: &Path) -> [String; 3] {
    let text = std::fs::read_to_string(example("straight_later.csv")).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    ["milli.csv", "exchanged.csv", "late.csv"].map(|name| {
        let mut out = rows[0].join(",");
        for (k, row) in rows.iter().enumerate().skip(1) {
            let [time, input, output, rest @ ..] = &row[..] else {
                panic!("{row:?}");
            };
            let milli = format!("{input}e3");
            let (input, output) = match name {
                "milli.csv" => (milli.as_str(), *output),
                "exchanged.csv" => (*output, *input),
                _ => (*input, rows[k.saturating_sub(5).max(1)][2]),
            };
            out += &format!("\n{time},{input},{output},{}", rest.join(","));
        }
        let path = folder.join(name);
        std::fs::write(&path, out).unwrap();
        path.to_str().unwrap().to_owned()
    })
}

/// Records of every kind that the schemas tell apart, and what the program says of them, printed once.
fn all() -> &'static [(&'static str, Value)] {
    static ALL: OnceLock<Vec<(&str, Value)>> = OnceLock::new();
    ALL.get_or_init(|| all_in(tempfile::tempdir().unwrap().path()))
}

fn all_in(folder: &Path) -> Vec<(&'static str, Value)> {
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let [straight, later, bent] = ["straight.csv", "straight_later.csv", "bent.csv"].map(example);
    let [stuck, bump, hidden, model] = ["stuck.csv", "bump.csv", "hidden.csv", "m.toml"].map(path);
    changed(Path::new(&stuck), |row, _, output| {
        if (600..1000).contains(&row) {
            1.5
        } else {
            output
        }
    });
    changed(Path::new(&bump), |_, x, output| {
        output + 0.3 * (-((x - 0.07) / 0.05).powi(2)).exp()
    });
    let plant = [
        "generate",
        "--mode",
        "displacement",
        "--effect",
        "presliding:3",
        "--out",
        &hidden,
    ];
    said(&plant);
    said(&["identify", &straight, "--model-out", &model]);
    // Two effects, of which one may be named: which drag it is remains open.
    let both = path("both.csv");
    let drag = args("generate --mode displacement --effect drag-quadratic:6");
    said(&[&drag[..], &["--effect", "bump-position:5", "--out", &both]].concat());
    let shaky = path("shaky.csv");
    said(&["generate", "--mode", "torque", "--out", &shaky]);
    shake(Path::new(&shaky));
    let close = |more: &[&str]| {
        (
            "bowden.identify/1",
            printed(&[&["identify", "--json"], more].concat()),
        )
    };
    let gains = |name: &str| {
        let certified = printed(&["certify", &example(name), "--json"]);
        ("bowden.certificate/1", certified)
    };
    let checked = |record: &str| {
        let check = printed(&["validate", &model, record, "--json"]);
        ("bowden.validate/1", check)
    };
    let otherwise = logged_otherwise(folder);
    let otherwise = otherwise.iter().map(|record| checked(record));
    let mut all: Vec<_> = otherwise.collect();
    all.extend([
        close(&[]),
        close(&[&straight, &bent, "--per-file", "gains"]),
        close(&[&bent, &straight, &later]),
        close(&[
            &straight,
            "--baseline",
            "bouc-wen,viscous@phi_p,coulomb@phi_p",
            "--max-terms",
            "0",
            "--invertible",
        ]),
        close(&[&stuck]),
        close(&[&bump]),
        close(&[&hidden]),
        close(&[&both, "--max-terms", "1"]),
        close(&[&shaky]),
        checked(&later),
        checked(&bent),
        checked(&stuck),
        gains("gains_own.toml"),
        gains("gains_table2.toml"),
        gains("gains_refused.toml"),
    ]);
    all
}

#[test]
fn the_page_lists_every_field_that_is_printed_and_its_type() {
    let (seen, wrong) = (BTreeSet::new(), Vec::new());
    let mut comparison = Comparison {
        tables: tables(),
        seen,
        wrong,
    };
    for (schema, value) in all() {
        assert_eq!(value["schema"], *schema);
        comparison.object(value, schema);
    }
    assert!(comparison.wrong.is_empty(), "{:#?}", comparison.wrong);
    let mut unseen = Vec::new();
    for (heading, fields) in &comparison.tables {
        let places = fields
            .iter()
            .map(|field| format!("{heading}.{}", field.name));
        unseen.extend(places.filter(|place| !comparison.seen.contains(place)));
    }
    unseen.retain(|place| {
        let (heading, _) = place.rsplit_once('.').unwrap();
        !SELDOM.contains(&heading) && !SELDOM_FIELDS.contains(&place.as_str())
    });
    assert!(unseen.is_empty(), "listed, and never printed: {unseen:?}");
}
