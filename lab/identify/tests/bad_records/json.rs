//! JSON that is damaged, and JSON without a table or with several.

use super::*;
use bowden_lab::record::Options;

/// One record a line, each changed.
fn records(change: impl Fn(usize, String) -> String) -> String {
    let of = |(i, row): (usize, String)| {
        let cells: Vec<&str> = row.split(',').collect();
        let [t, x, f] = cells[..] else {
            panic!("{row}")
        };
        change(i, format!("{{\"t\": {t}, \"x\": {x}, \"f\": {f}}}"))
    };
    let all: Vec<String> = rows().into_iter().enumerate().map(of).collect();
    all.join("\n")
}

#[test]
fn a_fault_of_json_is_named_with_its_record() {
    let spoilt = |from: &'static str, to: &'static str| {
        records(move |i, own| if i == 56 { own.replace(from, to) } else { own })
    };
    let empty =
        "column `x`: the cell is empty, but it must be a number; --drop-bad drops such rows";
    let invalid = "the file begins as JSON, but the JSON is invalid here:";
    for (from, to, says) in [
        ("\"x\": ", "\"x\": null, \"old\": ", empty),
        ("\"x\": ", "\"x\": NaN, \"old\": ", empty),
        (
            "\"x\": ",
            "\"x\": \"slow\", \"old\": ",
            "column `x`: `slow` is not a number",
        ),
        ("\"x\"", "x", &format!("{invalid} key must be a string")),
        (
            "\"x\": ",
            "\"x\": Infinity",
            &format!("{invalid} expected value"),
        ),
    ] {
        refused(spoilt(from, to), &format!("57: {says}"));
    }
    let record = read(spoilt("\"x\": ", "\"x\": NaN, \"old\": "), &drop_bad());
    assert_eq!((record.samples(), record.dropped), (399, 1));
}

/// A text and its refusal.
const NO_TABLE: &str = r#"
{"t": 1, "x": 2}| the JSON contains no table; use an array of records, one record per line, or an object of columns
{"a": {"b": []}}| the JSON contains no table; use an array of records, one record per line, or an object of columns
[[0, 1, 2], [1, 2, 3]]|1: the rows of the JSON have no names; --names t,x,f names their columns
[["t", "x"], [1, 2, 3]]|1: the row has 3 cells, but there are 2 names
{"t": [0, 1, 2], "x": [1, 2], "f": [1, 2, 3]}| column `x`: the column has 2 values, but it must have 3, as `t` does
[{"t": 0}, 3]|2: this is neither a record nor a row of the JSON
"#;

#[test]
fn json_without_one_table_is_refused() {
    for row in NO_TABLE.lines().skip(1) {
        let (text, says) = row.split_once('|').unwrap();
        refused(text, says);
    }
    let says = "1: the rows of the JSON have no names; --names t,x,f names their columns";
    refused("[0, 1, 2]\n[1, 2, 3]", says);
    let list = format!("[{}]", records(|_, own| own).replace('\n', ","));
    let two = format!("{{\"first\": {list}, \"second\": {list}}}");
    let says =
        " the JSON contains several tables (`first`, `second`); write each to a separate file";
    refused(two, says);
    let at = |set: fn(&mut Options)| with(set);
    for (options, says) in [
        (
            at(|o| o.header_line = Some(2)),
            "--header-line 2: the file has no lines",
        ),
        (
            at(|o| o.segment = Some(1)),
            "--segment 1: the file is not text, so it has no segments",
        ),
        (named(&["t", "x", "f"]), "--names: the file is not text"),
    ] {
        let line = refusal(&list, &options);
        assert!(line.starts_with(&format!("r.csv: {says}")), "{line}");
    }
}
