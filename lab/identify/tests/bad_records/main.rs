//! Every bad record gets one clear line, and no bytes at all make the reader panic.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod expected;
#[path = "../shared/rows.rs"]
mod fine;
mod forms;
mod json;
mod plain;
mod segments;
mod signals;
mod sparse;
mod units;

use bowden_lab::record::{parse, read, Mode, Options, Record};
use fine::{csv, rows, with_line};
use proptest::prelude::*;
use std::fmt::Write as _;

/// The record with another first column.
fn with_time(header: &str, time: impl Fn(usize) -> String) -> String {
    let row =
        |(i, row): (usize, &String)| format!("{},{}", time(i), row.split_once(',').unwrap().1);
    csv(
        header,
        &rows().iter().enumerate().map(row).collect::<Vec<_>>(),
    )
}

/// The record with two columns computed from the time.
fn of(input: impl Fn(f64) -> f64, output: impl Fn(f64) -> f64) -> String {
    let mut text = "t,x,f\n".to_owned();
    for i in 0..2000 {
        let t = f64::from(i) * 0.01;
        writeln!(text, "{t},{},{}", input(t), output(t)).unwrap();
    }
    text
}

fn refusal(bytes: impl AsRef<[u8]>, options: &Options) -> String {
    parse(bytes.as_ref(), "r.csv", options)
        .expect_err("a refusal")
        .to_string()
}

fn refused(bytes: impl AsRef<[u8]>, line: &str) {
    assert_eq!(refusal(bytes, &Options::default()), line);
}

fn accepted(bytes: impl AsRef<[u8]>) -> Record {
    parse(bytes.as_ref(), "r.csv", &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_file_that_cannot_be_opened_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("no such.csv");
    let error = read(&missing, &Options::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        format!("{}: no such file", missing.display())
    );
    let error = read(folder.path(), &Options::default()).unwrap_err();
    let line = format!(
        "{}: this is a folder; pass a record file, such as CSV, JSON or .xlsx",
        folder.path().display()
    );
    assert_eq!(error.to_string(), line);
}

#[test]
fn a_file_without_a_record_is_refused() {
    let header = "but a header with column names is needed";
    refused("", &format!("r.csv:1: the file is empty, {header}"));
    refused(
        "\u{feff}\r\n \n",
        &format!("r.csv:1: the file is blank, {header}"),
    );
    let short = "the minimum is 200";
    refused(
        "t,x,f\n",
        &format!("r.csv:1: the record is too short: 0 samples; {short}"),
    );
    refused(
        "t,x,f\n0,1,2\n",
        &format!("r.csv:2: the record is too short: 1 sample; {short}"),
    );
    refused(
        "t,x,f\n0,1,2\n1,2,3\n2,5,4\n",
        &format!("r.csv:4: the record is too short: 3 samples; {short}"),
    );
}

#[test]
fn a_file_that_is_not_text_is_refused() {
    refused(
        b"t,x,f\n0,1,2\n\x00\x01",
        "r.csv:3: byte 12 is NUL, so the file is neither text nor a known binary format; export it as CSV",
    );
    refused(
        b"t,x,f\n0,1\xb5,2\n",
        "r.csv:2: column `x`: `1µ` is not a number",
    );
    refused(
        [b"\xc2\xb5,x,f\n0,1\xb5,2\n".as_slice()].concat(),
        "r.csv:2: byte 10 (0xB5) is not UTF-8, unlike earlier characters; save the file as UTF-8",
    );
    refused(
        b"t,x,f\n0,1\xb5\x02,2\n",
        "r.csv:2: byte 10 (0x02) is invalid in UTF-8 and in Windows-1252; save the file as UTF-8",
    );
    refused(
        b"\xff\xfet\0,\0x\0,\0f\0\n\x000\0,\0a\0,\x001\0",
        "r.csv:2: column `x`: `a` is not a number",
    );
}

#[test]
fn a_header_that_is_none_is_refused() {
    let header = "but a header with column names is needed";
    refused(
        ",,\n1,2,3\n",
        &format!("r.csv:1: the line has no names, {header}"),
    );
    refused(
        rows().join("\n"),
        "r.csv:1: the line contains numbers, but it must be a header with column names; for a file without a header, use --names t,x,f",
    );
    let wide: Vec<String> = rows().iter().map(|row| format!("{row},1")).collect();
    refused(
        csv("t,x [mm],x [mm],f", &wide),
        "r.csv:1: column `x`: named twice, as columns 2 and 3; --names A,B,… gives each column its own name",
    );
    // Where a name is missing, twins of another name do not matter.
    refused(
        csv("t,x,off,off", &wide),
        "r.csv:1: column `f`: no such column; the columns are `t`, `x`, `off`; --output COL selects another one",
    );
    refused(
        csv("time,time,off,off", &wide),
        "r.csv:1: the columns `time`, `off` include neither `tau_i` and `tau_o` nor `x` and `f`; set --mode, and name the columns with --input and --output",
    );
    refused(
        csv("t,x,f,load,load", &rows()),
        "r.csv:1: column `load`: named twice, as columns 4 and 5; --names A,B,… gives each column its own name",
    );
}

#[test]
fn a_missing_column_is_named_with_those_that_exist() {
    refused(
        csv("tim,x,f", &rows()),
        "r.csv:1: column `t`: no such column; the columns are `tim`, `x`, `f` (nearest: `tim`); \
         --time COL selects another one; --rate HZ computes the time from the row number",
    );
    refused(
        csv("t,tau_i,torque", &rows()),
        "r.csv:1: column `tau_o`: no such column; the columns are `t`, `tau_i`, `torque` (nearest: `tau_i`); \
         --output COL selects another one",
    );
    let options = Options {
        channels: vec![("phi_p".into(), "q".into())],
        ..Options::default()
    };
    assert_eq!(
        refusal(csv("t,x,f", &rows()), &options),
        "r.csv:1: column `q`: no such column; the columns are `t`, `x`, `f`; \
         --channel NAME=COL selects another one"
    );
    refused(
        csv("t,a,b", &rows()),
        "r.csv:1: the columns `t`, `a`, `b` include neither `tau_i` and `tau_o` nor `x` and `f`; set --mode, and name the columns with --input and --output",
    );
}

#[test]
fn an_open_mode_is_asked_for() {
    let rows: Vec<_> = rows().iter().map(|row| format!("{row},1,2")).collect();
    refused(
        csv("t,x,f,tau_i,tau_o", &rows),
        "r.csv:1: the columns fit both modes; set --mode torque or --mode displacement",
    );
    let options = Options {
        input: Some("q".into()),
        output: Some("u".into()),
        ..Options::default()
    };
    assert_eq!(
        refusal(csv("t,q,u,a,b", &rows), &options),
        "r.csv:1: the named columns do not determine the mode; \
         set --mode torque or --mode displacement"
    );
}

#[test]
fn one_column_has_one_part() {
    let text = csv("t,x,f", &rows());
    let refuses = |options: Options, line: &str| assert_eq!(refusal(&text, &options), line);
    let mode = Some(Mode::Displacement);
    refuses(
        Options {
            output: Some("x".into()),
            mode,
            ..Options::default()
        },
        "r.csv:1: column `x`: this column cannot be both input and output",
    );
    refuses(
        Options {
            input: Some("t".into()),
            mode,
            ..Options::default()
        },
        "r.csv:1: column `t`: this column is the time, so it cannot also be input or output",
    );
    let channels = |pairs: &[(&str, &str)]| Options {
        channels: pairs
            .iter()
            .map(|(name, col)| ((*name).into(), (*col).into()))
            .collect(),
        ..Options::default()
    };
    refuses(
        channels(&[("load", "f")]),
        "r.csv:1: column `f`: this column is the output, so it cannot also be channel `load`",
    );
    refuses(
        channels(&[("a", "t"), ("a", "x")]),
        "r.csv: --channel NAME=COL: channel `a` is given twice",
    );
    refuses(
        channels(&[("x", "x")]),
        "r.csv: --channel NAME=COL: `x` cannot be the name of a channel",
    );
}

#[test]
fn a_cell_that_is_no_measured_number_is_shown() {
    let refuses = |cell: &str, message: &str| {
        let line = format!("r.csv:57: column `x`: {message}");
        refused(with_line(57, &format!("0.55,{cell},3")), &line);
    };
    let drop = "--drop-bad drops such rows";
    refuses(
        "",
        &format!("the cell is empty, but it must be a number; {drop}"),
    );
    refuses("abc", "`abc` is not a number");
    refuses("NaN", &format!("`NaN` is not a finite number; {drop}"));
    refuses("-inf", "`-inf` is not a finite number");
    refuses("1e999", "`1e999` is not a finite number");
    refuses(
        "1e308",
        "`1e308` is larger than 1e150, the largest allowed value",
    );
    refuses("\u{1b}[2J\u{7}", "`\\u{1b}[2J\\u{7}` is not a number");
    refuses(
        &"7x".repeat(500),
        "`7x7x7x7x7x7x7x7x7x7x7x7x…` is not a number",
    );
    refused(
        with_line(9, "0.07,1,"),
        &format!("r.csv:9: column `f`: the cell is empty, but it must be a number; {drop}"),
    );
    refused(
        with_line(9, "x,1,2"),
        "r.csv:9: column `t`: `x` is not a number",
    );
    refused(
        with_line(9, "0.07,1.5,2")
            .replace(',', ";")
            .replace("1.5;", "1,5;"),
        "r.csv:9: column `x`: `1,5` has a decimal comma; write a decimal point",
    );
}

#[test]
fn a_row_that_does_not_fit_the_header_is_refused() {
    refused(
        with_line(57, "0.55,3"),
        "r.csv:57: the row has 2 cells, but the header has 3",
    );
    refused(
        with_line(57, "0.55,3,4,5"),
        "r.csv:57: the row has 4 cells, but the header has 3",
    );
    refused(
        with_line(57, ""),
        "r.csv:57: the line is blank, although rows follow",
    );
    refused(
        with_line(57, &"1".repeat(5_000_000)),
        "r.csv:57: the line has 5000000 bytes, but at most 65536 are allowed",
    );
}

#[test]
fn a_line_of_any_length_gets_one_short_line() {
    let length = 16 << 20;
    let limit = "but at most 65536 are allowed";
    // As a header, as a row, of one cell, of many, of letters of two bytes, of blanks inside.
    for pattern in ["1", "1,", "é", "\",", "x "] {
        let long = pattern.repeat(length / pattern.len());
        let bytes = long.trim_end().len();
        refused(
            &long,
            &format!("r.csv:1: the line has {bytes} bytes, {limit}"),
        );
        refused(
            format!("t,x,f\n0,1,2\n{long}\n0.02,1,2\n"),
            &format!("r.csv:3: the line has {} bytes, {limit}", long.len()),
        );
    }
}

#[test]
fn a_quote_that_stays_open_is_refused() {
    refused(
        with_line(400, "3.98,1,\"2"),
        "r.csv:400: a quote is not closed before the end of the file",
    );
    // Not read, but it would hide the rows behind it.
    let spare: Vec<_> = rows().iter().map(|row| format!("{row},ok")).collect();
    let text = csv("t,x,f,note", &spare);
    refused(
        text.replace("3.98,", "3.98,1,2,\"see\n3.98,"),
        "r.csv:400: a quote is not closed before the end of the file",
    );
    refused(
        text + "4.00,1,2,\"",
        "r.csv:402: a quote is not closed before the end of the file",
    );
    refused(
        csv("t,x,\"f", &rows()),
        "r.csv:1: a quote is not closed before the end of the file",
    );
    let mut long = with_line(57, "0.55,\"1,2");
    long += &"4.00,1,2\n".repeat(100_000);
    refused(long, "r.csv:57: a quote is not closed within 65536 bytes");
    // Closed by the next stray quote.
    refused(
        with_line(57, "0.55,\"1,2\n0.56,3,4\""),
        "r.csv:57: the row has 2 cells, but the header has 3; a quote extends the row to line 58",
    );
    refused(
        with_line(57, "0.55,\"1,2\n0.56,\"3,4"),
        "r.csv:57: column `x`: `1,2\\n0.56,3` is not a number",
    );
}

/// What a reader owes its caller, whatever the bytes were.
fn holds(bytes: &[u8], options: &Options) {
    match parse(bytes, "r.csv", options) {
        Ok(record) => {
            assert!(record.samples() >= 200 && record.time[0] == 0.0);
            assert!(record.time.windows(2).all(|pair| pair[1] > pair[0]));
            for column in [&record.input, &record.output]
                .into_iter()
                .chain(&record.channels)
            {
                assert_eq!(column.values.len(), record.samples());
                assert!(column.values.iter().all(|value| value.is_finite()));
            }
        }
        Err(error) => {
            let line = error.to_string();
            assert!(
                line.starts_with("r.csv:") && !line.contains(char::is_control),
                "{line:?}"
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn no_bytes_make_the_reader_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        holds(&bytes, &Options::default());
    }

    #[test]
    fn no_text_makes_the_reader_panic(
        text in "(t|x|f|tau_i|[-+0-9.eE,;\t\r\n\"\\[\\] ]|\\PC){0,200}",
    ) {
        holds(text.as_bytes(), &Options::default());
        let options = Options { rate: Some(1.0), ..Options::default() };
        holds(format!("t,x,f\n{text}").as_bytes(), &options);
    }

    #[test]
    fn no_json_makes_the_reader_panic(
        text in "[\\[{]([tx\"]|\"t\":|\"x\":|null|NaN|[-0-9.e,:{}\\[\\] \n]){0,120}",
    ) {
        holds(text.as_bytes(), &Options::default());
        let own = rows().join("],[");
        holds(format!("[[\"t\",\"x\",\"f\"],[{own}],{text}").as_bytes(), &Options::default());
    }

    #[test]
    fn no_damage_makes_the_reader_panic(
        damage in proptest::collection::vec(
            (any::<prop::sample::Index>(), any::<u8>(), 0..3_usize), 1..6),
        skip in -1.0..5.0_f64,
    ) {
        let mut bytes = csv("t,x,f", &rows()).into_bytes();
        for (at, byte, kind) in damage {
            let at = at.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => drop(bytes.remove(at)),
            }
        }
        holds(&bytes, &Options { skip, ..Options::default() });
    }

    #[test]
    fn no_gaps_make_the_reader_panic(
        cells in proptest::collection::vec(
            (0..700_i32, any::<Option<i8>>(), any::<Option<i8>>(), 0..12_u8), 300..700),
        order in 0..3_usize,
        drop_bad in any::<bool>(),
        skip in -1.0..2.0_f64,
    ) {
        let mut cells = cells;
        match order {
            0 => cells.sort_by_key(|(t, ..)| *t),
            1 => cells.sort_by_key(|(t, x, ..)| (x.is_none(), *t)),
            _ => {}
        }
        let cell = |own: Option<i8>| own.map_or_else(String::new, |own| own.to_string());
        let row = |(t, x, f, kind): (i32, Option<i8>, Option<i8>, u8)| match kind {
            0 => "t,x,f".to_owned(),
            1 => format!("# {t}"),
            2 => format!("{t},{},{}", cell(x), cell(f)),
            _ if x.is_some() => format!("{t},{},", cell(x)),
            _ => format!("{t},,{}", cell(f)),
        };
        let rows: Vec<String> = cells.into_iter().map(row).collect();
        let skip = skip.max(0.0);
        let options = Options { drop_bad, skip, ..Options::default() };
        holds(csv("t,x,f", &rows).as_bytes(), &options);
        let options = Options { segment: Some(1), ..options };
        holds(csv("t,x,f", &rows).as_bytes(), &options);
    }

    #[test]
    fn no_numbers_make_the_reader_panic(
        values in proptest::collection::vec((any::<f64>(), any::<f64>(), any::<f64>()), 200..210),
        rate in any::<f64>(),
    ) {
        let rows: Vec<_> = values.iter().map(|(t, x, f)| format!("{t},{x},{f}")).collect();
        holds(csv("t,x,f", &rows).as_bytes(), &Options::default());
        let mild = |(t, x, f): &(f64, f64, f64)| format!("{t},{},{}", x % 1e150, f % 1e150);
        let rows: Vec<_> = values.iter().map(mild).collect();
        let options = Options { rate: Some(rate), ..Options::default() };
        holds(csv("t,x,f", &rows).as_bytes(), &options);
    }
}
