//! JSON that is damaged, and JSON without a table or with several.

use super::{refusal, refused, rows};
use bowden_lab::record::Options;

fn records(change: impl Fn(usize, String) -> String) -> String {
    let of = |(i, row): (usize, String)| {
        let cells: Vec<&str> = row.split(',').collect();
        change(
            i,
            format!(
                "{{\"t\": {}, \"x\": {}, \"f\": {}}}",
                cells[0], cells[1], cells[2]
            ),
        )
    };
    rows()
        .into_iter()
        .enumerate()
        .map(of)
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn a_fault_of_json_is_named_with_its_record() {
    let spoilt = |at: usize, from: &'static str, to: &'static str| {
        records(move |i, own| if i == at { own.replace(from, to) } else { own })
    };
    let drop = "--drop-bad drops such rows";
    let empty = format!("r.csv:57: column `x`: the cell is empty, but it must be a number; {drop}");
    refused(spoilt(56, "\"x\": ", "\"x\": null, \"old\": "), &empty);
    refused(spoilt(56, "\"x\": ", "\"x\": NaN, \"old\": "), &empty);
    refused(
        spoilt(56, "\"x\": ", "\"x\": \"slow\", \"old\": "),
        "r.csv:57: column `x`: `slow` is not a number",
    );
    refused(
        spoilt(56, "\"x\"", "x"),
        "r.csv:57: the file begins as JSON, but the JSON is invalid here: key must be a string",
    );
    refused(
        spoilt(56, "\"x\": ", "\"x\": Infinity"),
        "r.csv:57: the file begins as JSON, but the JSON is invalid here: expected value",
    );
    let options = Options {
        drop_bad: true,
        ..Options::default()
    };
    let text = spoilt(56, "\"x\": ", "\"x\": NaN, \"old\": ");
    let record = bowden_lab::record::parse(text.as_bytes(), "r.csv", &options).unwrap();
    assert_eq!((record.samples(), record.dropped), (399, 1));
}

#[test]
fn json_without_one_table_is_refused() {
    let none = "r.csv: the JSON contains no table; use an array of records, one record per line, or an object of columns";
    for text in ["{\"t\": 1, \"x\": 2}", "{\"a\": {\"b\": []}}"] {
        refused(text, none);
    }
    let list = format!("[{}]", records(|_, own| own).replace('\n', ","));
    refused(
        format!("{{\"first\": {list}, \"second\": {list}}}"),
        "r.csv: the JSON contains several tables (`first`, `second`); write each to a separate file",
    );
    for text in ["[[0, 1, 2], [1, 2, 3]]", "[0, 1, 2]\n[1, 2, 3]"] {
        refused(
            text,
            "r.csv:1: the rows of the JSON have no names; --names t,x,f names their columns",
        );
    }
    refused(
        "[[\"t\", \"x\"], [1, 2, 3]]",
        "r.csv:1: the row has 3 cells, but there are 2 names",
    );
    refused(
        "{\"t\": [0, 1, 2], \"x\": [1, 2], \"f\": [1, 2, 3]}",
        "r.csv: column `x`: the column has 2 values, but it must have 3, as `t` does",
    );
    refused(
        "[{\"t\": 0}, 3]",
        "r.csv:2: this is neither a record nor a row of the JSON",
    );
    let at = |header_line, segment, names: &[&str]| Options {
        header_line,
        segment,
        names: names.iter().map(|name| (*name).to_owned()).collect(),
        ..Options::default()
    };
    for (options, says) in [
        (
            at(Some(2), None, &[]),
            "--header-line 2: the file has no lines",
        ),
        (
            at(None, Some(1), &[]),
            "--segment 1: the file is not text, so it has no segments",
        ),
        (
            at(None, None, &["t", "x", "f"]),
            "--names: the file is not text",
        ),
    ] {
        let line = refusal(&list, &options);
        assert!(line.starts_with(&format!("r.csv: {says}")), "{line}");
    }
}
