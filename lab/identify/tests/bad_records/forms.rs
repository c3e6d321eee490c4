//! Text as other programs write it: what is read, and what would be a guess.

use super::{accepted, csv, refusal, refused, rows};
use bowden_lab::record::{parse, Mode, Options, Record};

/// The plain record with other separators and a decimal comma.
fn comma(text: &str, separator: &str) -> String {
    text.replace(',', separator).replace('.', ",")
}

fn same(bytes: impl AsRef<[u8]>, options: &Options, notes: &[&str]) -> Record {
    let plain = accepted(csv("t,x,f", &rows()));
    let record = parse(bytes.as_ref(), "r.csv", options).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(record.time, plain.time);
    assert_eq!(record.input.values, plain.input.values);
    assert_eq!(record.output.values, plain.output.values);
    assert_eq!(record.notes, notes);
    record
}

fn read(bytes: impl AsRef<[u8]>, notes: &[&str]) -> Record {
    same(bytes, &Options::default(), notes)
}

#[test]
fn a_decimal_comma_is_read_behind_semicolons_and_tabs() {
    let plain = csv("t,x,f", &rows());
    let note = "decimal commas were read";
    read(comma(&plain, ";"), &[note]);
    read(comma(&plain, "\t"), &[note]);
    // Integers say nothing of the sign.
    read(plain.replace(',', ";").replace("0.00;", "0;"), &[]);
    // Behind commas a comma separates.
    refused(
        comma(&plain, ","),
        "r.csv:2: the row has 6 cells, but the header has 3",
    );
    refused(
        comma(&plain, ";").replace("0,20;", "0.20;"),
        "r.csv:22: column `t`: `0.20` has a decimal point; write a decimal comma, as in line 2",
    );
    refused(
        plain.replace(',', ";").replace("0.20;", "0,20;"),
        "r.csv:22: column `t`: `0,20` has a decimal comma; write a decimal point",
    );
    let thousands = comma(&plain, ";").replace("0,20;", "1.000,20;");
    refused(
        thousands,
        "r.csv:22: column `t`: `1.000,20` is not a number, because bowden does not read thousands separators; remove the separators",
    );
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
    refused(
        with(&|i| grouped(900 + i), &seconds),
        "r.csv:102: column `f`: `1,000` may mean 1.000 or 1000, because `900` in \
         line 2 has no comma; write thousands without a separator, or the same number of decimals in every cell",
    );
    // Time would run backwards at this place.
    refused(
        with(&|i| format!("{i},5"), &|i| grouped(10 * i)),
        "r.csv:102: column `t`: `1,000` may mean 1.000 or 1000, because `0` in \
         line 2 has no comma; write thousands without a separator, or the same number of decimals in every cell",
    );
    // Three decimals in every cell, four digits without a comma, another number of decimals.
    for (force, value) in [
        (
            &(|i: usize| format!("{},125", 900 + i)) as &dyn Fn(usize) -> String,
            1000.125,
        ),
        (
            &|i| {
                if i == 100 {
                    "1,197".into()
                } else {
                    (900 + i).to_string()
                }
            },
            1.197,
        ),
        (
            &|i| {
                if i == 7 {
                    "1,2".into()
                } else {
                    grouped(900 + i)
                }
            },
            1.0,
        ),
    ] {
        let record = accepted(with(force, &seconds));
        assert_eq!(record.output.values[100], value);
        assert_eq!(record.notes, ["decimal commas were read"]);
    }
}

#[test]
fn a_preamble_and_a_row_of_units_are_found() {
    let values = rows().join("\n");
    let preamble = "Prüfstand;3\nDatum;01.02.2026\nKanäle;3\n\nWeg x;Kraft f;Kommentar\n";
    let german = |head: &str| format!("{head}{}\n", comma(&values, ";"));
    let commas = "decimal commas were read";
    let record = read(
        german(&format!("{preamble}t;x;f\ns;mm;N\n")),
        &[
            "lines 1–5 above the names ignored",
            "units from line 7",
            commas,
        ],
    );
    assert_eq!(record.input.unit.as_deref(), Some("mm"));
    assert_eq!(record.output.unit.as_deref(), Some("N"));
    // A wider preamble than the table, names in brackets, a line between names and units.
    read(
        german("sep=;\na;b;c;d;e\n1;2\nt [s];x;f\nclock;pot;cell\n[s];(mm);[N]\n"),
        &[
            "lines 1–3 above the names ignored",
            "units from line 6",
            "line 5 between names and values ignored",
            commas,
        ],
    );
    read(format!("t,x,f\ns,mm,N\n{values}\n"), &["units from line 2"]);
    read(format!("# t,x,f\n{values}\n"), &[]);
    // A row of words is none of units.
    refused(
        format!("t,x,f\nclock,pot,cell\n{values}\n"),
        "r.csv:2: column `t`: `clock` is not a number",
    );
}

#[test]
fn labelled_rows_of_a_trace_export_are_read() {
    // Names, further rows and units, each with its label in the first column.
    let values: Vec<_> = rows()
        .iter()
        .map(|row| format!(";{}", comma(row, ";")))
        .collect();
    let head = "type;experiment\ndate;01.02.2026 10:00\n\npath;a/t;a/x;a/f\nname;t;x;f\ntype;axis;signal;signal\nunit;s;mm;N\ntrace_values";
    let record = read(
        format!("{head}{}\n", values.join("\n")),
        &[
            "lines 1–4 above the names ignored",
            "units from line 7",
            "line 6 between names and values ignored",
            "columns not read: `name`",
            "decimal commas were read",
        ],
    );
    assert_eq!(record.input.unit.as_deref(), Some("mm"));
}

#[test]
fn the_line_of_the_names_can_be_given() {
    let text = format!("x,t,f\nold,old,old\nt,x,f\n{}", rows().join("\n"));
    let at = |line: usize| Options {
        header_line: Some(line),
        ..Options::default()
    };
    same(&text, &at(3), &[]);
    assert_eq!(
        refusal(&text, &at(2)),
        "r.csv:2: the columns `old` include neither `tau_i` and `tau_o` nor `x` and `f`; set --mode, and name the columns with --input and --output"
    );
    assert_eq!(
        refusal(&text, &at(0)),
        "r.csv: --header-line 0: lines are counted from 1"
    );
    assert_eq!(
        refusal(&text, &at(404)),
        "r.csv: --header-line 404: the file has only 403 lines"
    );
    assert_eq!(
        refusal(&text, &at(9)),
        "r.csv:9: the line contains numbers, but it must be a header with column names; for a file without a header, use --names t,x,f"
    );
}

#[test]
fn a_preamble_without_the_names_is_refused_at_the_line_that_should_have_them() {
    refused(
        format!("rig,3\nwhen,now\nt,x,force\n{}", rows().join("\n")),
        "r.csv:3: column `f`: no such column; the columns are `t`, `x`, `force`; \
         --output COL selects another one",
    );
}

#[test]
fn text_below_and_empty_cells_beside_the_table_are_passed_over() {
    let plain = csv("t,x,f", &rows());
    let note = |lines: &str| format!("{lines} below the table ignored");
    read(
        format!("{plain}\nEnd of record\n"),
        &[&note("lines 402–403")],
    );
    read(
        format!("{plain}Samples,400,\nMean,,\n"),
        &[&note("lines 402–403")],
    );
    let wide: Vec<_> = rows().iter().map(|row| format!("{row},,")).collect();
    read(csv("t,x,f", &wide), &[]);
    read(
        csv("t,x,f,,", &wide),
        &["columns not read: number 4 (without a name), number 5 (without a name)"],
    );
    read(
        csv("t,x,f,,", &rows()),
        &["columns not read: number 4 (without a name), number 5 (without a name)"],
    );
    read(format!("{plain},,\n,,\n"), &[]);
    // A row that was cut short, a spoilt one, and values behind the text are no text.
    refused(
        format!("{plain}4.00,1\n"),
        "r.csv:402: the row has 2 cells, but the header has 3",
    );
    refused(
        format!("{plain}4.00,a,b\n"),
        "r.csv:402: column `x`: `a` is not a number",
    );
    refused(
        format!("{plain}End\n4.00,1,2\n"),
        "r.csv:402: the row has 1 cell, but the header has 3",
    );
    refused(
        format!("{plain}NaN,NaN,NaN\n"),
        "r.csv:402: column `t`: `NaN` is not a finite number; \
         --drop-bad drops such rows",
    );
}

#[test]
fn a_column_at_the_end_that_no_row_has_is_passed_over() {
    // As LabVIEW writes it: a name for comments, and no cell for them.
    let note =
        "each row has only 3 cells, but the header has 4; the columns without cells are not read";
    let text = csv("t,x,f,Comment", &rows());
    same(
        &text,
        &Options::default(),
        &["columns not read: `Comment`", note],
    );
    // A row that lost a cell stays a fault, and so does a column that is read.
    let mut cut = rows();
    cut[7] = "0.07,1.0".to_owned();
    refused(
        csv("t,x,f,Comment", &cut),
        "r.csv:9: the row has 2 cells, but the header has 4",
    );
    let mut long = rows();
    long[0] += ",start";
    refused(
        csv("t,x,f,Comment", &long),
        "r.csv:3: the row has 3 cells, but the header has 4",
    );
    let lost: Vec<String> = rows().iter().map(|row| row[..4].to_owned()).collect();
    let line = refusal(csv("t,x,f", &lost), &Options::default());
    assert!(line.starts_with("r.csv:2: the row has 1 cell"), "{line}");
}

#[test]
fn names_are_found_in_other_letters_and_with_their_units() {
    let units = |header: &str| {
        let record = read(csv(header, &rows()), &[]);
        (record.input.unit, record.output.unit)
    };
    let of = |a: &str, b: &str| (Some(a.to_owned()), Some(b.to_owned()));
    assert_eq!(units("t,X,F"), (None, None));
    assert_eq!(units("t_s,x_mm,F_kip"), of("mm", "kip"));
    assert_eq!(units("T [s],x_in,f (lbf)"), of("in", "lbf"));
    assert_eq!(units("t,x / mm,f / kN"), of("mm", "kN"));
    // Beside an output `_in` is no inch.
    let named = Options {
        mode: Some(Mode::Displacement),
        input: Some("x_in".to_owned()),
        output: Some("f_out".to_owned()),
        ..Options::default()
    };
    let record = parse(csv("t,x_in,f_out", &rows()).as_bytes(), "r.csv", &named).unwrap();
    assert_eq!((record.input.unit, record.output.unit), (None, None));
    // Two that could be meant, or a temperature, are none.
    refused(
        csv("t,X_mm,x_m,f", &rows().iter().map(|r| format!("{r},1")).collect::<Vec<_>>()),
        "r.csv:1: column `x`: no such column; the columns are `t`, `X_mm`, `x_m`, `f` (nearest: `x_m`, `X_mm`); \
         --input COL selects another one",
    );
    let line = refusal(csv("T,x,f", &rows()), &Options::default());
    assert!(
        line.starts_with("r.csv:1: column `t`: no such column"),
        "{line}"
    );
}

#[test]
fn times_of_day_are_time_stamps() {
    let stamped = |stamp: &dyn Fn(usize) -> String| super::with_time("t,x,f", stamp);
    let plain = accepted(csv("t,x,f", &rows()));
    let day = |i: usize| format!("23:59:{:02}.{:03}", 50 + i / 100, 10 * (i % 100));
    // Over a change of daylight-saving time the zone counts.
    let zoned = accepted(stamped(&|i| match i {
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
        let record = accepted(stamped(&|i| format!("{date}{}", day(i))));
        assert_eq!(record.notes, ["time stamps are times of day"]);
        let apart = record
            .time
            .iter()
            .zip(&plain.time)
            .map(|(a, b)| (a - b).abs());
        // Seconds of decades leave 1e-7 s of the 53 bits.
        assert!(apart.fold(0.0, f64::max) < 3e-7, "{date}");
    }
    refused(
        stamped(&|i| if i == 7 { "7".to_owned() } else { day(i) }),
        "r.csv:9: column `t`: `7` is not a time of day, unlike the cells above",
    );
    let line = refusal(
        stamped(&|i| day(i).replace("23:59:51", "00:00:01")),
        &Options::default(),
    );
    assert!(line.contains("the time decreases"), "{line}");
}

#[test]
fn times_of_day_over_midnight_ask_for_a_date_and_dates_are_days_of_the_calendar() {
    let over = |before: &str, after: &str| {
        let stamp = |i: usize| match i {
            0..=99 => format!("{before}23:59:59.{:02}", i),
            _ => format!("{after}00:00:0{}.{:02}", i / 100 - 1, i % 100),
        };
        super::with_time("t,x,f", stamp)
    };
    refused(
        over("", ""),
        "r.csv:102: column `t`: the time decreases from 86399.99 to 0 s; if the record spans midnight, add a date",
    );
    let line = refusal(over("2026-03-01 ", "2026-03-01 "), &Options::default());
    assert!(
        line.contains("the time decreases") && !line.contains("midnight"),
        "{line}"
    );
    for (before, after) in [
        ("2026-03-01 ", "2026-03-02 "),
        ("2024-02-29T", "2024-03-01T"),
        ("31.12.2025 ", "1.1.2026 "),
    ] {
        let record = accepted(over(before, after));
        assert!((record.time[399] - 3.99).abs() < 3e-7, "{before}");
    }
    refused(
        over("2026-02-28 ", "2026-02-29 "),
        "r.csv:102: column `t`: `2026-02-29 00:00:00.00` is not a time of day, unlike the cells above",
    );
}

#[test]
fn bad_rows_are_left_out_where_that_is_asked_for() {
    let drop = Options {
        drop_bad: true,
        ..Options::default()
    };
    let mut spoilt = rows();
    spoilt[20] = "0.20,,1".to_owned();
    spoilt[21] = "0.21,NaN,1".to_owned();
    spoilt[30] = "0.29,1,1".to_owned();
    spoilt[40] = ",1,1".to_owned();
    let text = csv("t,x,f", &spoilt);
    let record = parse(text.as_bytes(), "r.csv", &drop).unwrap();
    assert_eq!((record.samples(), record.dropped), (396, 4));
    assert_eq!(
        record.notes,
        ["--drop-bad dropped 4 rows: 2 with an empty cell, 1 with NaN, 1 with a repeated time stamp"]
    );
    assert!(!record.time.contains(&0.20) && record.time.contains(&0.22));
    // Each is a gap, from a time column and from the row number.
    let gaps = |options: &Options| {
        let record = parse(text.as_bytes(), "r.csv", options).unwrap();
        let own = record.defects.iter().find(|d| d.kind.name() == "gap");
        own.map(|d| (d.channel.clone(), d.ranges.clone()))
    };
    let lines = vec![[21, 24], [31, 33], [41, 43]];
    assert_eq!(gaps(&drop), Some(("t".to_owned(), lines)));
    let rate = Options {
        rate: Some(100.0),
        ..drop.clone()
    };
    assert_eq!(gaps(&rate), Some(("row number".to_owned(), vec![[21, 24]])));
    // Without it the first one is named.
    refused(
        &text,
        "r.csv:22: column `x`: the cell is empty, but it must be a number; --drop-bad drops such rows",
    );
    spoilt = rows();
    spoilt[30] = "0.29,1,1".to_owned();
    refused(
        csv("t,x,f", &spoilt),
        "r.csv:32: column `t`: the time stamp repeats at 0.29; --rate HZ computes the time from the row number; --drop-bad drops such rows",
    );
    // Words and infinities stay refused, and what is left has to be enough.
    spoilt[30] = "0.30,inf,1".to_owned();
    assert_eq!(
        refusal(csv("t,x,f", &spoilt), &drop),
        "r.csv:32: column `x`: `inf` is not a finite number"
    );
    let empty: Vec<_> = rows().iter().map(|_| "0,,".to_owned()).collect();
    assert_eq!(
        refusal(csv("t,x,f", &empty), &drop),
        "r.csv:401: the record is too short: 0 samples of 400 remain after cutting and --drop-bad; the minimum is 200"
    );
}

#[test]
fn a_channel_is_the_difference_or_the_sum_of_two() {
    let rows: Vec<_> = rows().iter().map(|row| format!("{row},1.5,250")).collect();
    let text = csv("t,tau_i,tau_o,a [rad],b [mrad]", &rows);
    let of = |channels: &[(&str, &str)]| {
        let options = Options {
            channels: channels
                .iter()
                .map(|(name, column)| ((*name).to_owned(), (*column).to_owned()))
                .collect(),
            ..Options::default()
        };
        parse(text.as_bytes(), "r.csv", &options).map_err(|e| e.to_string())
    };
    let record = of(&[("stretch", "a-b"), ("phi_p", "a"), ("sum", "phi_p + b")]).unwrap();
    let first = |name: &str| record.channel(name).map(|c| (c.values[0], c.unit.clone()));
    let rad = Some("rad".to_owned());
    // A milliradian is not a binary fraction.
    let (stretch, sum) = (first("stretch").unwrap(), first("sum").unwrap());
    assert!((stretch.0 - 1.25).abs() < 1e-12 && (sum.0 - 1.75).abs() < 1e-12);
    assert_eq!((stretch.1, sum.1), (rad.clone(), rad));
    let line = |column: &str| of(&[("stretch", column)]).unwrap_err();
    assert_eq!(
        line("a-t"),
        "r.csv:1: column `t`: the column has no unit, but it must have unit rad, as `a` has, so that the two can be added or subtracted"
    );
    assert_eq!(
        line("tau_i-tau_o"),
        "r.csv:1: column `tau_o`: this column is the output, so it cannot also be channel `stretch`"
    );
    assert!(line("a-c").starts_with("r.csv:1: column `c`: no such column"));
    assert!(line("q-a").starts_with("r.csv:1: column `q`: no such column"));
    // A column of that very name comes first.
    let text = text.replace("a [rad],b [mrad]", "a-b,b");
    let options = Options {
        channels: vec![("stretch".into(), "a-b".into())],
        ..Options::default()
    };
    let record = parse(text.as_bytes(), "r.csv", &options).unwrap();
    assert_eq!(record.channel("stretch").unwrap().values[0], 1.5);
}
