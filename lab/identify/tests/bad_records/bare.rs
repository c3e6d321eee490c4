//! Text of programs that know little of tables: blanks between numbers, no names, one name with two
//! units, a file that ends within a line.

use super::*;
use bowden_lab::record::Options;

const BLANKS: &str = "columns are separated by spaces";

#[test]
fn blanks_may_separate_the_columns() {
    let single = plain().replace(',', " ");
    let none = Options::default();
    same(&single, &none, &[BLANKS]);
    same(format!("# {single}"), &none, &[BLANKS]);
    let padded = |_, row: &str| format!("   {}  ", row.replace(',', "    "));
    let text = changed("Time (s)   x [mm]   f (N)", padded);
    let record = same(text, &none, &[BLANKS]);
    assert_eq!(units(&record), [Some("mm"), Some("N")]);
    let text = format!("rig seven\nof the lab\n{single}");
    same(text, &none, &[BLANKS, "lines 1–2 above the names ignored"]);
    let lost = single.replacen("\n0.20 ", "\n", 1);
    refused(lost, "22: the row has 2 cells, but the header has 3");
}

#[test]
fn names_can_be_given_to_a_text_without_them() {
    let lines = rows().join("\n");
    let comma = lines.replace(',', ";").replace('.', ",");
    let preamble = format!("% made by a rig\n% on a day\n{lines}");
    for (text, notes) in [
        (lines.clone(), &[][..]),
        (lines.replace(',', "\t"), &[]),
        (lines.replace(',', "  "), &[BLANKS]),
        (comma, &["decimal commas were read"]),
        (preamble, &["lines 1–2 above the values ignored"]),
    ] {
        let record = same(text, &named(&["t", "x [mm]", "f_N"]), notes);
        assert_eq!(units(&record), [Some("mm"), Some("N")]);
    }
    // An empty name is that of a column which is not read.
    let wide = lines.replace('\n', ",7\n") + ",7";
    let unread = "columns not read: number 4 (without a name)";
    same(wide, &named(&["t", "x", "f", ""]), &[unread]);
}

#[test]
fn names_that_do_not_fit_are_refused() {
    let lines = rows().join("\n");
    let none = "1: the line contains numbers, but it must be a header with column names; for a file without a header, use --names t,x,f";
    let lost =
        "1: column `f`: no such column; the columns are `t`, `x`; --output COL selects another one";
    let both =
        " --names and --header-line cannot be combined: --names is for a file without column names";
    let mut at = named(&["t", "x", "f"]);
    at.header_line = Some(1);
    for (options, says) in [
        (named(&[]), none),
        (
            named(&["t", "x"]),
            "1: the row has 3 cells, but --names lists 2",
        ),
        (named(&["t", "x", "x"]), lost),
        (at, both),
    ] {
        refused_with(&lines, &options, says);
    }
    let says = " --names: no rows of two or more numbers were found";
    refused_with("only\nwords\n", &named(&["t", "x", "f"]), says);
}

#[test]
fn one_name_with_two_units_is_two_columns() {
    let header = "t,Way (V),Way (mm),Force (V),Force (N)";
    let text = changed(header, |_, row| row.replace(',', ",9,"));
    let own = ends("Way (mm)", "Force (N)");
    let record = same(&text, &own, &["columns not read: `Way (V)`, `Force (V)`"]);
    assert_eq!(record.output.name, "Force (N)");
    assert_eq!(units(&record)[1], Some("N"));
    refused_with(
        &text,
        &ends("Way (mm)", "Force"),
        "1: column `Force`: no such column; the columns are `t`, `Way (V)`, `Way (mm)`, `Force (V)`, \
         `Force (N)` (nearest: `Force (V)`, `Force (N)`); --output COL selects another one",
    );
    // One of three is the other's twin: neither of these two can be wanted.
    let twins = text.replacen("Force (V)", "Force (N)", 1);
    let says = "1: column `Force`: named twice, as columns 4 and 5; --names A,B,… gives each column its own name";
    refused_with(twins, &own, says);
}

#[test]
fn a_file_that_ends_within_a_line_loses_that_line() {
    let (whole, none) = (plain(), Options::default());
    let cut = |text: &str| format!("{whole}{text}");
    let note = "the last line, 402, is truncated and was dropped";
    for end in ["4.00,1.5", "4.00,1.5,", "4.00,1.5,-", "4.00,1.5,2.e", "4"] {
        same(cut(end), &none, &[note]);
        // A line that ends is whole, and something else is wrong with it.
        refusal(cut(&format!("{end}\n")), &none);
    }
    let below = "line 402 below the table ignored";
    same(cut("end of file"), &none, &[below]);
    refused(cut("4.00,x,2.0"), "402: column `x`: `x` is not a number");
    // The last line may lack its end, and none above it.
    let lost = whole.replacen("\n0.20,", "\n", 1) + "4.0";
    refused(lost, "22: the row has 2 cells, but the header has 3");
}
