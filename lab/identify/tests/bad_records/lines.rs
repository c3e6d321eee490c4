//! Lines, cells and quotes that are none of a record.

use super::*;
use bowden_lab::record::{read, Options};

#[test]
fn a_file_that_cannot_be_opened_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("no such.csv");
    for (path, says) in [
        (missing.as_path(), "no such file"),
        (
            folder.path(),
            "this is a folder; pass a record file, such as CSV, JSON or .xlsx",
        ),
    ] {
        let line = read(path, &Options::default()).unwrap_err().to_string();
        assert_eq!(line, format!("{}: {says}", path.display()));
    }
}

/// A text, with `\n` for its line ends, and its refusal.
const WHOLE: &str = r"
|1: the file is empty, but a header with column names is needed
\n \n|1: the file is blank, but a header with column names is needed
,,\n1,2,3\n|1: the line has no names, but a header with column names is needed
t,x,f\n|1: the record is too short: 0 samples; the minimum is 200
t,x,f\n0,1,2\n|2: the record is too short: 1 sample; the minimum is 200
t,x,f\n0,1,2\n1,2,3\n2,5,4\n|4: the record is too short: 3 samples; the minimum is 200
";

#[test]
fn a_file_without_a_record_is_refused() {
    for row in WHOLE.trim_start_matches('\n').lines() {
        let (text, line) = row.split_once('|').unwrap();
        refused(text.replace("\\n", "\n"), line);
    }
    let header = "but a header with column names is needed";
    refused(
        "\u{feff}\r\n \n",
        &format!("1: the file is blank, {header}"),
    );
}

#[test]
fn a_file_that_is_not_text_is_refused() {
    let bytes: [(&[u8], &str); 5] = [
        (
            b"t,x,f\n0,1,2\n\x00\x01",
            "3: byte 12 is NUL, so the file is neither text nor a known binary format; export it as CSV",
        ),
        (b"t,x,f\n0,1\xb5,2\n", "2: column `x`: `1µ` is not a number"),
        (
            b"\xc2\xb5,x,f\n0,1\xb5,2\n",
            "2: byte 10 (0xB5) is not UTF-8, unlike earlier characters; save the file as UTF-8",
        ),
        (
            b"t,x,f\n0,1\xb5\x02,2\n",
            "2: byte 10 (0x02) is invalid in UTF-8 and in Windows-1252; save the file as UTF-8",
        ),
        (
            b"\xff\xfet\0,\0x\0,\0f\0\n\x000\0,\0a\0,\x001\0",
            "2: column `x`: `a` is not a number",
        ),
    ];
    for (bytes, line) in bytes {
        refused(bytes, line);
    }
}

/// A line of the plain record, what is written there, and the refusal.
const SPOILT: &str = r#"
57|0.55,,3|column `x`: the cell is empty, but it must be a number; --drop-bad drops such rows
57|0.55,abc,3|column `x`: `abc` is not a number
57|0.55,NaN,3|column `x`: `NaN` is not a finite number; --drop-bad drops such rows
57|0.55,-inf,3|column `x`: `-inf` is not a finite number
57|0.55,1e999,3|column `x`: `1e999` is not a finite number
57|0.55,1e308,3|column `x`: `1e308` is larger than 1e150, the largest allowed value
9|0.07,1,|column `f`: the cell is empty, but it must be a number; --drop-bad drops such rows
9|x,1,2|column `t`: `x` is not a number
9|0.07,1.3.2026,2|column `x`: `1.3.2026` is not a number
57|0.55,3|the row has 2 cells, but the header has 3
57|0.55,3,4,5|the row has 4 cells, but the header has 3
57||the line is blank, although rows follow
57|0.53,1,2|column `t`: the time decreases from 0.54 to 0.53 s; sort the rows by time, or save each record in a separate file
57|0.54,1,2|column `t`: the time stamp repeats at 0.54; --rate HZ computes the time from the row number; --drop-bad drops such rows
400|3.98,1,"2|a quote is not closed before the end of the file
2|3/1/2026 23:59:50.000,1,2|column `t`: `3/1/2026 23:59:50.000` is neither a number nor a time in a known format; 1/2/2026 is ambiguous; write 2026-02-01T23:59:50.250 (ISO 8601) or 1.2.2026 23:59:50.250
2|11:59:50.000 PM,1,2|column `t`: `11:59:50.000 PM` is neither a number nor a time in a known format; write hours from 0 to 23 without AM or PM, as in 23:59:50.250
2|2026-03-01,1,2|column `t`: `2026-03-01` is neither a number nor a time in a known format; write seconds, 23:59:50.250, 2026-02-01T23:59:50.250 (ISO 8601) or 1.2.2026 23:59:50.250
"#;

#[test]
fn a_line_that_is_no_row_of_numbers_is_shown() {
    for row in SPOILT.lines().skip(1) {
        let [line, text, says] = row.splitn(3, '|').collect::<Vec<_>>()[..] else {
            panic!("{row}");
        };
        refused(
            with_line(line.parse().unwrap(), text),
            &format!("{line}: {says}"),
        );
    }
    for (cell, shown) in [
        ("\u{1b}[2J\u{7}", "\\u{1b}[2J\\u{7}"),
        (&"7x".repeat(500), "7x7x7x7x7x7x7x7x7x7x7x7x…"),
    ] {
        let text = with_line(57, &format!("0.55,{cell},3"));
        refused(text, &format!("57: column `x`: `{shown}` is not a number"));
    }
    for mark in ["OVL", "OL", "-OL", "ovl", "#N/A", "#NUM!", "N/A", "---"] {
        let says =
            "is a placeholder, not a number; clear the cell, and use --drop-bad to drop the row";
        let text = with_line(9, &format!("0.07,{mark},2"));
        refused(text, &format!("9: column `x`: `{mark}` {says}"));
    }
    for cell in ["3.763,8", "-1,234.5", "1,234,567", "12'345.5", "1 234"] {
        let says = "is not a number, because bowden does not read thousands separators; remove the separators";
        let text = with_line(9, "0.07,CELL,2").replace(',', "\t");
        refused(
            text.replace("CELL", cell),
            &format!("9: column `x`: `{cell}` {says}"),
        );
    }
}

#[test]
fn a_line_of_any_length_gets_one_short_line() {
    let length = 16 << 20;
    let limit = "but at most 65536 are allowed";
    // As a header, as a row, of one cell, of many, of letters of two bytes, of blanks inside.
    for pattern in ["1", "1,", "é", "\",", "x "] {
        let long = pattern.repeat(length / pattern.len());
        let bytes = long.trim_end().len();
        refused(&long, &format!("1: the line has {bytes} bytes, {limit}"));
        let text = format!("t,x,f\n0,1,2\n{long}\n0.02,1,2\n");
        refused(
            text,
            &format!("3: the line has {} bytes, {limit}", long.len()),
        );
    }
}

#[test]
fn a_quote_that_stays_open_is_refused() {
    let open = "a quote is not closed before the end of the file";
    // Not read, but it would hide the rows behind it.
    let text = wider("t,x,f,note", ",ok");
    refused(
        text.replace("3.98,", "3.98,1,2,\"see\n3.98,"),
        &format!("400: {open}"),
    );
    refused(text + "4.00,1,2,\"", &format!("402: {open}"));
    refused(csv("t,x,\"f", &rows()), &format!("1: {open}"));
    let long = with_line(57, "0.55,\"1,2") + &"4.00,1,2\n".repeat(100_000);
    refused(long, "57: a quote is not closed within 65536 bytes");
    // Closed by the next stray quote.
    let spans = "57: the row has 2 cells, but the header has 3; a quote extends the row to line 58";
    refused(with_line(57, "0.55,\"1,2\n0.56,3,4\""), spans);
    let shown = "57: column `x`: `1,2\\n0.56,3` is not a number";
    refused(with_line(57, "0.55,\"1,2\n0.56,\"3,4"), shown);
}
