//! `docs/reference/json.md` lists the fields that the program prints: each name, each type, none more.

use crate::sentences::files::{uniform, Rows, PHI_P, TAU_I, TAU_O};
use crate::shell::{bowden, builtin, example, straight, text, Folder};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

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

/// A row of a table: name, type, and whether the field may be absent.
type Field = (&'static str, &'static str, bool);
type Tables = BTreeMap<&'static str, Vec<Field>>;

/// The tables of the page by their headings.
fn tables() -> Tables {
    let (mut tables, mut heading) = (Tables::new(), "");
    for line in PAGE.lines() {
        if let Some(name) = line.strip_prefix("### ").or(line.strip_prefix("## ")) {
            heading = name;
        }
        let Some(row) = line.strip_prefix("| `") else {
            continue;
        };
        let mut cells = row.split(" | ");
        let (name, kind) = (cells.next().unwrap(), cells.next().unwrap());
        let (name, mark) = name.split_once('`').unwrap();
        let row = (name, kind, mark.contains("optional"));
        tables.entry(heading).or_default().push(row);
    }
    tables
}

/// What has been seen, and what does not agree.
struct Comparison {
    tables: Tables,
    seen: BTreeSet<String>,
    wrong: Vec<String>,
}

impl Comparison {
    /// An object with the table of that heading.
    fn object(&mut self, value: &Value, heading: &str) {
        let Some(fields) = self.tables.get(heading).cloned() else {
            self.wrong.push(format!("there is no table {heading}"));
            return;
        };
        let Some(object) = value.as_object() else {
            self.wrong.push(format!("{heading} is no object: {value}"));
            return;
        };
        for key in object.keys() {
            if fields.iter().all(|(name, ..)| name != key) {
                self.wrong.push(format!("{heading}: {key} is not listed"));
            }
        }
        for (name, kind, optional) in fields {
            let place = format!("{heading}.{name}");
            match object.get(name) {
                Some(inner) => {
                    self.value(inner, kind, &place);
                    self.seen.insert(place);
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
fn printed(asked: &str) -> Value {
    let output = bowden(&format!("{asked} --json"));
    assert_ne!(output.status.code(), Some(2), "{asked}: {output:?}");
    serde_json::from_str(text(&output.stdout)).unwrap()
}

/// An example with one column changed: `of` row and values.
fn changed(name: &str, column: usize, of: impl FnMut(usize, &[f64]) -> f64) -> Rows {
    let mut rows = Rows::parsed(&std::fs::read_to_string(example(name)).unwrap());
    rows.set(column, of);
    rows
}

/// Records of every kind that the schemas tell apart, and what the program says of them.
fn all() -> Vec<(&'static str, Value)> {
    let folder = Folder::new();
    let model = straight(&folder);
    let [straight, later, bent] = ["straight.csv", "straight_later.csv", "bent.csv"].map(example);
    let is_stuck = |row: usize| (600..1000).contains(&row);
    let stuck = |row, of: &[f64]| if is_stuck(row) { 1.5 } else { of[TAU_O] };
    let stuck = changed("straight.csv", TAU_O, stuck).write(&folder, "stuck.csv");
    let bump = |x: f64| 0.3 * (-((x - 0.07) / 0.05).powi(2)).exp();
    let bump = changed("straight.csv", TAU_O, |_, of| of[TAU_O] + bump(of[PHI_P]));
    let bump = bump.write(&folder, "bump.csv");
    // The later record as it might have been logged: the input in mN·m under the header of N·m,
    // input and output in each other's place, the output five samples late.
    let later_is = "straight_later.csv";
    let own = changed(later_is, TAU_O, |_, of| of[TAU_O]);
    let milli = changed(later_is, TAU_I, |_, of| 1e3 * of[TAU_I]);
    let late = changed(later_is, TAU_O, |i, _| own.rows[i.saturating_sub(5)][TAU_O]);
    let mut exchanged = own.clone();
    exchanged
        .rows
        .iter_mut()
        .for_each(|row| row.swap(TAU_I, TAU_O));
    // Noise of the input drives the hysteresis sample by sample.
    let mut shaky = Rows::generated("--mode torque");
    shaky.set(TAU_I, |i, row| row[TAU_I] + 0.15 * uniform(i + 1));
    let shaky = shaky.write(&folder, "shaky.csv");
    // Two effects, of which one may be named: which drag it is remains open.
    let both = "--mode displacement --effect drag-quadratic:6 --effect bump-position:5";
    let both = folder.record("both.csv", both);
    let hidden = folder.record("hidden.csv", "--mode displacement --effect presliding:3");

    let baseline = "--baseline bouc-wen,viscous@phi_p,coulomb@phi_p --max-terms 0 --invertible";
    let mut all = vec![("bowden.identify/1", builtin().clone())];
    for asked in [
        format!("{straight} {bent} --per-file gains"),
        format!("{bent} {straight} {later}"),
        format!("{straight} {baseline}"),
        format!("{both} --max-terms 1"),
        stuck.clone(),
        bump,
        hidden,
        shaky,
    ] {
        all.push(("bowden.identify/1", printed(&format!("identify {asked}"))));
    }
    let otherwise = [
        ("milli.csv", milli),
        ("exchanged.csv", exchanged),
        ("late.csv", late),
    ];
    let otherwise = otherwise.map(|(name, rows)| rows.write(&folder, name));
    for record in otherwise.into_iter().chain([later, bent, stuck]) {
        let validate = format!("validate {model} {record}");
        all.push(("bowden.validate/1", printed(&validate)));
    }
    for name in ["gains_own.toml", "gains_table2.toml", "gains_refused.toml"] {
        let certify = format!("certify {}", example(name));
        all.push(("bowden.certificate/1", printed(&certify)));
    }
    all
}

#[test]
fn the_page_lists_every_field_that_is_printed_and_its_type() {
    let mut comparison = Comparison {
        tables: tables(),
        seen: BTreeSet::new(),
        wrong: Vec::new(),
    };
    for (schema, value) in &all() {
        assert_eq!(value["schema"], *schema);
        comparison.object(value, schema);
    }
    let Comparison {
        tables,
        seen,
        wrong,
    } = comparison;
    assert!(wrong.is_empty(), "{wrong:#?}");
    for (heading, fields) in tables.iter().filter(|own| !SELDOM.contains(own.0)) {
        for (name, ..) in fields {
            let place = format!("{heading}.{name}");
            let is_seen = seen.contains(&place) || SELDOM_FIELDS.contains(&&*place);
            assert!(is_seen, "listed, and never printed: {place}");
        }
    }
}
