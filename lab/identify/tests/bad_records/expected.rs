//! A refusal says what is needed, where that can be told from the cell.

use super::{accepted, refusal, refused, with_line, with_time};
use bowden_lab::record::Options;

#[test]
fn stamps_without_a_unit_that_cannot_be_seconds_are_refused() {
    let asks = |step: &str, unit: &str, start: &str| {
        format!(
            "r.csv:1: column `t`: the time has no unit and was read as seconds, with a median step of {step} s; \
             set --time 't [{unit}]' if the unit is {unit}, or 't [s]' for seconds{start}"
        )
    };
    let since = |first: &str| {
        format!("; in s, the first time stamp of {first} would be thousands of years")
    };
    let of =
        |step: u64, first: u64| with_time("t,x,f", move |i| (first + step * i as u64).to_string());
    refused(of(2_000, 0), &asks("2000", "µs", ""));
    refused(of(2_000_000, 0), &asks("2000000", "ns", ""));
    // Since 1970.
    refused(
        of(2, 1_772_373_801_000),
        &asks("2", "ms", &since("1.772e12")),
    );
    refused(
        of(2_000, 1_772_373_801_000_000),
        &asks("2000", "µs", &since("1.772e15")),
    );
    // A double counts nanoseconds since 1970 by 256.
    refused(
        of(2_048_000, 1_772_373_801_000_000_000 / 256 * 256),
        &asks("2048000", "ns", &since("1.772e18")),
    );
    // What may be seconds is read, and asked about.
    for text in [of(1, 0), of(2, 0), of(100, 0), of(2, 1_772_373_801)] {
        let record = accepted(text);
        assert!(
            record.notes[0].contains("set --time 't [ms]' if the unit is ms"),
            "{:?}",
            record.notes
        );
    }
    // A year a row is no logger's step in any unit, and with its unit any step is right.
    accepted(of(31_557_600_000, 0));
    let stated = of(2_000, 0).replacen("t,", "t [s],", 1);
    assert_eq!(accepted(stated).time[1], 2000.0);
}

#[test]
fn a_stamp_of_another_form_says_which_forms_are_read() {
    let cell = |cell: &str, expected: &str| {
        refused(
            with_line(2, &format!("{cell},1,2")),
            &format!(
                "r.csv:2: column `t`: `{cell}` is neither a number nor a time in a known format; {expected}"
            ),
        );
    };
    cell(
        "3/1/2026 23:59:50.000",
        "1/2/2026 is ambiguous; write 2026-02-01T23:59:50.250 (ISO 8601) or 1.2.2026 23:59:50.250",
    );
    cell(
        "11:59:50.000 PM",
        "write hours from 0 to 23 without AM or PM, as in 23:59:50.250",
    );
    cell(
        "2026-03-01",
        "write seconds, 23:59:50.250, 2026-02-01T23:59:50.250 (ISO 8601) or 1.2.2026 23:59:50.250",
    );
}

#[test]
fn marks_and_separators_of_thousands_are_told_from_other_words() {
    for mark in ["OVL", "OL", "-OL", "ovl", "#N/A", "#NUM!", "N/A", "---"] {
        refused(
            with_line(9, &format!("0.07,{mark},2")),
            &format!(
                "r.csv:9: column `x`: `{mark}` is a placeholder, not a number; clear the cell, and use --drop-bad to drop the row"
            ),
        );
    }
    for cell in ["3.763,8", "-1,234.5", "1,234,567", "12'345.5", "1 234"] {
        refused(
            with_line(9, &format!("0.07,{cell},2").replace(cell, "CELL"))
                .replace(',', "\t")
                .replace("CELL", cell),
            &format!(
                "r.csv:9: column `x`: `{cell}` is not a number, because bowden does not read thousands separators; remove the separators"
            ),
        );
    }
    // A date is none.
    refused(
        with_line(9, "0.07,1.3.2026,2"),
        "r.csv:9: column `x`: `1.3.2026` is not a number",
    );
}

#[test]
fn cuts_that_leave_nothing_say_from_where_they_count() {
    let options = Options {
        skip: 1_772_373_805.0,
        ..Options::default()
    };
    let text = with_time("t,x,f", |i| {
        format!("{:.2}", 1_772_373_801.0 + 0.01 * i as f64)
    });
    assert_eq!(
        refusal(text, &options),
        "r.csv:401: the record is too short: 0 samples of 400 remain after cutting; the minimum is 200; \
         --start and --end are in seconds after the first time stamp, and the last time stamp is at 3.990 s"
    );
}

/// Of 400 rows 10 have a stamp of their own, or 300.
#[test]
fn rows_are_to_be_left_out_only_where_most_stay() {
    let of = |rows: usize| with_time("t,x,f", move |i| (i / rows).to_string());
    let line = refusal(of(40), &Options::default());
    assert!(line.contains("--rate HZ"), "{line}");
    assert!(!line.contains("--drop-bad"), "{line}");
    let some = with_time("t,x,f", |i| (i - i % 4 / 3).to_string());
    let line = refusal(some, &Options::default());
    assert!(line.ends_with("--drop-bad drops such rows"), "{line}");
    let line = refusal(with_time("t,x,f", |_| "7".to_owned()), &Options::default());
    assert!(!line.contains("--drop-bad"), "{line}");
}
