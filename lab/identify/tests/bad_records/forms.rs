//! Text as other programs write it: what is read, and what would be a guess.

use super::*;
use bowden_lab::record::Options;

/// The plain record with other separators and a decimal comma.
fn comma(text: &str, separator: &str) -> String {
    text.replace(',', separator).replace('.', ",")
}

const COMMAS: &str = "decimal commas were read";

/// Reads the plain record, of which this is said.
fn said(bytes: impl AsRef<[u8]>, notes: &[&str]) {
    same(bytes, &Options::default(), notes);
}

#[test]
fn a_decimal_comma_is_read_behind_semicolons_and_tabs() {
    let plain = plain();
    said(comma(&plain, ";"), &[COMMAS]);
    said(comma(&plain, "\t"), &[COMMAS]);
    // Integers say nothing of the sign.
    said(plain.replace(',', ";").replace("0.00;", "0;"), &[]);
    // Behind commas a comma separates.
    let says = "2: the row has 6 cells, but the header has 3";
    refused(comma(&plain, ","), says);
    let [commas, points] = [comma(&plain, ";"), plain.replace(',', ";")];
    for (text, cell, says) in [
        (&commas, "0.20", "has a decimal point; write a decimal comma, as in line 2"),
        (&points, "0,20", "has a decimal comma; write a decimal point"),
        (&commas, "1.000,20", "is not a number, because bowden does not read thousands separators; remove the separators"),
    ] {
        let row = if text == &commas { "\n0,20;" } else { "\n0.20;" };
        let text = text.replace(row, &format!("\n{cell};"));
        refused(text, &format!("22: column `t`: `{cell}` {says}"));
    }
}

#[test]
fn commas_that_may_separate_thousands_are_refused() {
    let with = |force: &dyn Fn(usize) -> String, time: &dyn Fn(usize) -> String| {
        let row = |i: usize| format!("{};{i},25;{}\n", time(i), force(i));
        format!("t;x;f\n{}", (0..400).map(row).collect::<String>())
    };
    let seconds = |i: usize| format!("{},{:02}", i / 100, i % 100);
    let grouped = |n: usize| match n {
        1000.. => format!("{},{:03}", n / 1000, n % 1000),
        _ => n.to_string(),
    };
    let asks = |column: &str, first: &str| {
        format!(
            "102: column `{column}`: `1,000` may mean 1.000 or 1000, because `{first}` in \
             line 2 has no comma; write thousands without a separator, or the same number of decimals in every cell"
        )
    };
    refused(with(&|i| grouped(900 + i), &seconds), &asks("f", "900"));
    // Time would run backwards at this place.
    let text = with(&|i| format!("{i},5"), &|i| grouped(10 * i));
    refused(text, &asks("t", "0"));
    // Three decimals in every cell, four digits without a comma, another number of decimals.
    let decimals = |i: usize| format!("{},125", 900 + i);
    let four = |i: usize| match i {
        100 => "1,197".to_owned(),
        _ => (900 + i).to_string(),
    };
    let other = |i: usize| match i {
        7 => "1,2".to_owned(),
        _ => grouped(900 + i),
    };
    let forces: [(&dyn Fn(usize) -> String, f64); 3] =
        [(&decimals, 1000.125), (&four, 1.197), (&other, 1.0)];
    for (force, value) in forces {
        let record = accepted(with(force, &seconds));
        assert_eq!(record.output.values[100], value);
        assert_eq!(record.notes, [COMMAS]);
    }
}

#[test]
fn a_preamble_and_a_row_of_units_are_found() {
    let values = rows().join("\n");
    let german = |head: &str| format!("{head}{}\n", comma(&values, ";"));
    let preamble = "Prüfstand;3\nDatum;01.02.2026\nKanäle;3\n\nWeg x;Kraft f;Kommentar\n";
    let own = [
        "lines 1–5 above the names ignored",
        "units from line 7",
        COMMAS,
    ];
    let text = german(&format!("{preamble}t;x;f\ns;mm;N\n"));
    let record = same(text, &Options::default(), &own);
    assert_eq!(units(&record), [Some("mm"), Some("N")]);
    // A wider preamble than the table, names in brackets, a line between names and units.
    said(
        german("sep=;\na;b;c;d;e\n1;2\nt [s];x;f\nclock;pot;cell\n[s];(mm);[N]\n"),
        &[
            "lines 1–3 above the names ignored",
            "units from line 6",
            "line 5 between names and values ignored",
            COMMAS,
        ],
    );
    said(csv("t,x,f\ns,mm,N", &rows()), &["units from line 2"]);
    said(csv("# t,x,f", &rows()), &[]);
    // A row of words is none of units.
    let words = csv("t,x,f\nclock,pot,cell", &rows());
    refused(words, "2: column `t`: `clock` is not a number");
    // Names, further rows and units of a trace export, each with its label in the first column.
    let values = format!(";{}", comma(&values, ";").replace('\n', "\n;"));
    let head = "type;experiment\ndate;01.02.2026 10:00\n\npath;a/t;a/x;a/f\nname;t;x;f\ntype;axis;signal;signal\nunit;s;mm;N\ntrace_values";
    let notes = [
        "lines 1–4 above the names ignored",
        "units from line 7",
        "line 6 between names and values ignored",
        "columns not read: `name`",
        COMMAS,
    ];
    let record = same(format!("{head}{values}\n"), &Options::default(), &notes);
    assert_eq!(units(&record)[0], Some("mm"));
}

#[test]
fn the_line_of_the_names_can_be_given() {
    let text = csv("x,t,f\nold,old,old\nt,x,f", &rows());
    let at = |line: usize| with(|o| o.header_line = Some(line));
    same(&text, &at(3), &[]);
    for (line, says) in [
        (2, "2: the columns `old` include neither `tau_i` and `tau_o` nor `x` and `f`; set --mode, and name the columns with --input and --output"),
        (0, " --header-line 0: lines are counted from 1"),
        (404, " --header-line 404: the file has only 403 lines"),
        (9, "9: the line contains numbers, but it must be a header with column names; for a file without a header, use --names t,x,f"),
    ] {
        refused_with(&text, &at(line), says);
    }
    // Below a preamble the refusal names the line that should have the names.
    refused(
        csv("rig,3\nwhen,now\nt,x,force", &rows()),
        "3: column `f`: no such column; the columns are `t`, `x`, `force`; --output COL selects another one",
    );
}

#[test]
fn text_below_and_empty_cells_beside_the_table_are_passed_over() {
    let plain = plain();
    let below = "lines 402–403 below the table ignored";
    said(format!("{plain}\nEnd of record\n"), &[below]);
    said(format!("{plain}Samples,400,\nMean,,\n"), &[below]);
    said(wider("t,x,f", ",,"), &[]);
    said(format!("{plain},,\n,,\n"), &[]);
    let unread = "columns not read: number 4 (without a name), number 5 (without a name)";
    said(wider("t,x,f,,", ",,"), &[unread]);
    said(csv("t,x,f,,", &rows()), &[unread]);
    // A row that was cut short, a spoilt one, and values behind the text are no text.
    for (more, says) in [
        ("4.00,1", "the row has 2 cells, but the header has 3"),
        ("4.00,a,b", "column `x`: `a` is not a number"),
        ("End\n4.00,1,2", "the row has 1 cell, but the header has 3"),
        (
            "NaN,NaN,NaN",
            "column `t`: `NaN` is not a finite number; --drop-bad drops such rows",
        ),
    ] {
        refused(format!("{plain}{more}\n"), &format!("402: {says}"));
    }
}

#[test]
fn a_column_at_the_end_that_no_row_has_is_passed_over() {
    // As LabVIEW writes it: a name for comments, and no cell for them.
    let note =
        "each row has only 3 cells, but the header has 4; the columns without cells are not read";
    let text = csv("t,x,f,Comment", &rows());
    said(&text, &["columns not read: `Comment`", note]);
    // A row that lost a cell stays a fault, and so does a column that is read.
    let says = "the row has 2 cells, but the header has 4";
    let cut = with_line(9, "0.07,1.0").replacen("f\n", "f,Comment\n", 1);
    refused(cut, &format!("9: {says}"));
    let long = text.replacen("\n0.01", ",start\n0.01", 1);
    refused(long, "3: the row has 3 cells, but the header has 4");
    let lost = changed("t,x,f", |_, row| row[..4].to_owned());
    let line = refusal(lost, &Options::default());
    assert!(line.starts_with("r.csv:2: the row has 1 cell"), "{line}");
}

#[test]
fn names_are_found_in_other_letters_and_with_their_units() {
    for (header, own) in [
        ("t,X,F", [None; 2]),
        ("t_s,x_mm,F_kip", [Some("mm"), Some("kip")]),
        ("T [s],x_in,f (lbf)", [Some("in"), Some("lbf")]),
        ("t,x / mm,f / kN", [Some("mm"), Some("kN")]),
    ] {
        let record = same(csv(header, &rows()), &Options::default(), &[]);
        assert_eq!(units(&record), own, "{header}");
    }
    // Beside an output `_in` is no inch.
    let record = read(csv("t,x_in,f_out", &rows()), &ends("x_in", "f_out"));
    assert_eq!(units(&record), [None; 2]);
}

#[test]
fn times_of_day_are_time_stamps() {
    let plain = accepted(plain());
    let day = |i: usize| format!("23:59:{:02}.{:03}", 50 + i / 100, 10 * (i % 100));
    // Over a change of daylight-saving time the zone counts.
    let zoned = accepted(stamped("t,x,f", |i| match i {
        0..=99 => format!("2026-03-29T01:59:59.{:03}+01:00", 10 * i),
        _ => format!(
            "2026-03-29T03:00:0{}.{:03}+02:00",
            i / 100 - 1,
            10 * (i % 100)
        ),
    }));
    let steps = zoned.time.windows(2).map(|pair| pair[1] - pair[0]);
    assert!(steps.fold(0.0, f64::max) < 0.0101);
    for date in ["", "2026-02-28T", "28.02.2026 "] {
        let record = accepted(stamped("t,x,f", |i| format!("{date}{}", day(i))));
        assert_eq!(record.notes, ["time stamps are times of day"]);
        let apart = record.time.iter().zip(&plain.time);
        // Seconds of decades leave 1e-7 s of the 53 bits.
        let apart = apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 3e-7, "{date}");
    }
    let spoilt = stamped("t,x,f", |i| if i == 7 { "7".to_owned() } else { day(i) });
    let says = "9: column `t`: `7` is not a time of day, unlike the cells above";
    refused(spoilt, says);
}

#[test]
fn times_of_day_over_midnight_ask_for_a_date_and_dates_are_days_of_the_calendar() {
    let over = |before: &str, after: &str| {
        stamped("t,x,f", |i| match i {
            0..=99 => format!("{before}23:59:59.{i:02}"),
            _ => format!("{after}00:00:0{}.{:02}", i / 100 - 1, i % 100),
        })
    };
    refused(
        over("", ""),
        "102: column `t`: the time decreases from 86399.99 to 0 s; if the record spans midnight, add a date",
    );
    let line = refusal(over("2026-03-01 ", "2026-03-01 "), &Options::default());
    let is_said = line.contains("the time decreases") && !line.contains("midnight");
    assert!(is_said, "{line}");
    for (before, after) in [
        ("2026-03-01 ", "2026-03-02 "),
        ("2024-02-29T", "2024-03-01T"),
        ("31.12.2025 ", "1.1.2026 "),
    ] {
        let record = accepted(over(before, after));
        assert!((record.time[399] - 3.99).abs() < 3e-7, "{before}");
    }
    let says =
        "102: column `t`: `2026-02-29 00:00:00.00` is not a time of day, unlike the cells above";
    refused(over("2026-02-28 ", "2026-02-29 "), says);
}

#[test]
fn bad_rows_are_left_out_where_that_is_asked_for() {
    let spoilt = |lines: &[(usize, &str)]| {
        let row = |i: usize, own: &str| {
            let other = lines.iter().find(|(line, _)| *line == i + 2);
            other.map_or_else(|| own.to_owned(), |(_, text)| (*text).to_owned())
        };
        changed("t,x,f", row)
    };
    let text = spoilt(&[
        (22, "0.20,,1"),
        (23, "0.21,NaN,1"),
        (32, "0.29,1,1"),
        (42, ",1,1"),
    ]);
    let record = read(&text, &drop_bad());
    assert_eq!((record.samples(), record.dropped), (396, 4));
    assert_eq!(
        record.notes,
        ["--drop-bad dropped 4 rows: 2 with an empty cell, 1 with NaN, 1 with a repeated time stamp"]
    );
    assert!(!record.time.contains(&0.20) && record.time.contains(&0.22));
    // Each is a gap, from a time column and from the row number.
    let gaps = |options: &Options| {
        let record = read(&text, options);
        let own = record.defects.iter().find(|d| d.kind.name() == "gap");
        own.map(|d| (d.channel.clone(), d.ranges.clone()))
    };
    let lines = vec![[21, 24], [31, 33], [41, 43]];
    assert_eq!(gaps(&drop_bad()), Some(("t".to_owned(), lines)));
    let rate = with(|o| (o.drop_bad, o.rate) = (true, Some(100.0)));
    assert_eq!(gaps(&rate), Some(("row number".to_owned(), vec![[21, 24]])));
    // Without it the first one is named.
    refused(
        &text,
        "22: column `x`: the cell is empty, but it must be a number; --drop-bad drops such rows",
    );
    // Words and infinities stay refused, and what is left has to be enough.
    let infinite = spoilt(&[(32, "0.30,inf,1")]);
    let says = "32: column `x`: `inf` is not a finite number";
    refused_with(infinite, &drop_bad(), says);
    let empty = changed("t,x,f", |_, _| "0,,".to_owned());
    let says = "401: the record is too short: 0 samples of 400 remain after cutting and --drop-bad; the minimum is 200";
    refused_with(empty, &drop_bad(), says);
}

#[test]
fn a_channel_is_the_difference_or_the_sum_of_two() {
    let text = wider("t,tau_i,tau_o,a [rad],b [mrad]", ",1.5,250");
    let all = [("stretch", "a-b"), ("phi_p", "a"), ("sum", "phi_p + b")];
    let record = read(&text, &channels(&all));
    for (name, value) in [("stretch", 1.25), ("sum", 1.75)] {
        let own = record.channel(name).unwrap();
        assert_eq!(own.unit.as_deref(), Some("rad"));
        // A milliradian is not a binary fraction.
        assert!((own.values[0] - value).abs() < 1e-12);
    }
    for (column, says) in [
        ("a-t", "`t`: the column has no unit, but it must have unit rad, as `a` has, so that the two can be added or subtracted"),
        ("tau_i-tau_o", "`tau_o`: this column is the output, so it cannot also be channel `stretch`"),
        ("a-c", "`c`: no such column"),
        ("q-a", "`q`: no such column"),
    ] {
        let line = refusal(&text, &channels(&[("stretch", column)]));
        let says = format!("r.csv:1: column {says}");
        assert!(line.starts_with(&says), "{line}");
    }
    // A column of that very name comes first.
    let text = text.replace("a [rad],b [mrad]", "a-b,b");
    let record = read(text, &channels(&[("stretch", "a-b")]));
    assert_eq!(record.channel("stretch").unwrap().values[0], 1.5);
}
