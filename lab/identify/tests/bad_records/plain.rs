//! Text of programs that know little of tables: blanks between numbers, no names, one name with two
//! units, a file that ends within a line.

use super::{accepted, csv, refusal, refused, rows};
use bowden_lab::record::{parse, Options, Record};

fn named(names: &[&str]) -> Options {
    Options {
        names: names.iter().map(|name| (*name).to_owned()).collect(),
        ..Options::default()
    }
}

fn read(text: &str, options: &Options) -> Record {
    parse(text.as_bytes(), "r.csv", options).unwrap_or_else(|e| panic!("{e}"))
}

/// Reads a text that has the numbers of the plain record.
fn same(text: &str, options: &Options, notes: &[&str]) -> Record {
    let plain = accepted(csv("t,x,f", &rows()));
    let record = read(text, options);
    assert_eq!(record.time, plain.time);
    assert_eq!(record.input.values, plain.input.values);
    assert_eq!(record.output.values, plain.output.values);
    assert_eq!(record.notes, notes);
    record
}

const BLANKS: &str = "columns are separated by spaces";

#[test]
fn blanks_may_separate_the_columns() {
    let padded = |row: &String| format!("   {}  ", row.replace(',', "    "));
    let padded: Vec<String> = rows().iter().map(padded).collect();
    let single = csv("t,x,f", &rows()).replace(',', " ");
    let none = Options::default();
    same(&single, &none, &[BLANKS]);
    same(&format!("# {single}"), &none, &[BLANKS]);
    let text = csv("Time (s)   x [mm]   f (N)", &padded);
    let record = same(&text, &none, &[BLANKS]);
    assert_eq!(record.input.unit.as_deref(), Some("mm"));
    assert_eq!(record.output.unit.as_deref(), Some("N"));
    let above = "lines 1–2 above the names ignored";
    same(
        &format!("rig seven\nof the lab\n{single}"),
        &none,
        &[BLANKS, above],
    );
    refused(
        single.replacen("\n0.20 ", "\n", 1),
        "r.csv:22: the row has 2 cells, but the header has 3",
    );
}

#[test]
fn names_can_be_given_to_a_text_without_them() {
    let (t, x, f) = ("t", "x [mm]", "f_N");
    let lines = rows().join("\n");
    let record = same(&lines, &named(&[t, x, f]), &[]);
    assert_eq!(record.input.unit.as_deref(), Some("mm"));
    assert_eq!(record.output.unit.as_deref(), Some("N"));
    same(&lines.replace(',', "\t"), &named(&[t, x, f]), &[]);
    same(&lines.replace(',', "  "), &named(&[t, x, f]), &[BLANKS]);
    let comma = lines.replace(',', ";").replace('.', ",");
    let decimal = "decimal commas were read";
    same(&comma, &named(&[t, x, f]), &[decimal]);
    let preamble = format!("% made by a rig\n% on a day\n{lines}");
    let above = "lines 1–2 above the values ignored";
    same(&preamble, &named(&[t, x, f]), &[above]);
    // An empty name is that of a column which is not read.
    let wide = lines.replace('\n', ",7\n") + ",7";
    let unread = "columns not read: number 4 (without a name)";
    same(&wide, &named(&[t, x, f, ""]), &[unread]);
}

#[test]
fn names_that_do_not_fit_are_refused() {
    let lines = rows().join("\n");
    assert_eq!(
        refusal(&lines, &Options::default()),
        "r.csv:1: the line contains numbers, but it must be a header with column names; for a file without a header, use --names t,x,f"
    );
    assert_eq!(
        refusal(&lines, &named(&["t", "x"])),
        "r.csv:1: the row has 3 cells, but --names lists 2"
    );
    assert_eq!(
        refusal(&lines, &named(&["t", "x", "x"])),
        "r.csv:1: column `f`: no such column; the columns are `t`, `x`; --output COL selects another one"
    );
    assert_eq!(
        refusal("only\nwords\n", &named(&["t", "x", "f"])),
        "r.csv: --names: no rows of two or more numbers were found"
    );
    let both = Options {
        header_line: Some(1),
        ..named(&["t", "x", "f"])
    };
    assert_eq!(
        refusal(&lines, &both),
        "r.csv: --names and --header-line cannot be combined: --names is for a file without column names"
    );
}

#[test]
fn one_name_with_two_units_is_two_columns() {
    let volts = |row: &String| {
        let (t, values) = row.split_once(',').unwrap();
        let (x, f) = values.split_once(',').unwrap();
        format!("{t},9,{x},9,{f}")
    };
    let rows: Vec<String> = rows().iter().map(volts).collect();
    let text = csv("t,Way (V),Way (mm),Force (V),Force (N)", &rows);
    let ends = |input: &str, output: &str| Options {
        mode: Some(bowden_lab::record::Mode::Displacement),
        input: Some(input.to_owned()),
        output: Some(output.to_owned()),
        ..Options::default()
    };
    let unread = "columns not read: `Way (V)`, `Force (V)`";
    let record = same(&text, &ends("Way (mm)", "Force (N)"), &[unread]);
    assert_eq!(record.output.name, "Force (N)");
    assert_eq!(record.output.unit.as_deref(), Some("N"));
    assert_eq!(
        refusal(&text, &ends("Way (mm)", "Force")),
        "r.csv:1: column `Force`: no such column; the columns are `t`, `Way (V)`, `Way (mm)`, `Force (V)`, \
         `Force (N)` (nearest: `Force (V)`, `Force (N)`); --output COL selects another one"
    );
    // One of three is the other's twin: neither of these two can be wanted.
    let twins = text.replacen("Force (V)", "Force (N)", 1);
    assert_eq!(
        refusal(&twins, &ends("Way (mm)", "Force (N)")),
        "r.csv:1: column `Force`: named twice, as columns 4 and 5; --names A,B,… gives each column its own name"
    );
}

#[test]
fn a_file_that_ends_within_a_line_loses_that_line() {
    let whole = csv("t,x,f", &rows());
    let cut = |text: &str| format!("{whole}{text}");
    let note = "the last line, 402, is truncated and was dropped";
    for end in ["4.00,1.5", "4.00,1.5,", "4.00,1.5,-", "4.00,1.5,2.e", "4"] {
        same(&cut(end), &Options::default(), &[note]);
        // A line that ends is whole, and something else is wrong with it.
        refusal(cut(&format!("{end}\n")), &Options::default());
    }
    same(
        &cut("end of file"),
        &Options::default(),
        &["line 402 below the table ignored"],
    );
    refused(
        cut("4.00,x,2.0"),
        "r.csv:402: column `x`: `x` is not a number",
    );
    // The last line may lack its end, and none above it.
    refused(
        whole.replacen("\n0.20,", "\n", 1) + "4.0",
        "r.csv:22: the row has 2 cells, but the header has 3",
    );
}
