//! Sensors with stamps of their own in one table.

use super::rows;
use bowden_lab::record::{parse, Options, Record};

fn input(t: f64) -> f64 {
    10.0 * (3.0 * t).sin()
}

fn output(t: f64) -> f64 {
    25.0 * (3.0 * t + 0.2).sin()
}

/// Rows of the input at multiples of `step`, of the output `later` behind multiples of `other`, and of
/// a channel once a second, in the order of their stamps \[ms\].
fn merged(step: usize, later: usize, other: usize) -> String {
    let mut rows: Vec<(usize, String)> = Vec::new();
    for k in 0..8000 {
        let t = k as f64 * 1e-3;
        if k % step == 0 {
            rows.push((k, format!("{t},{:.6},,", input(t))));
        }
        if k >= later && (k - later).is_multiple_of(other) {
            rows.push((k, format!("{t},,{:.6},", output(t))));
        }
        if k % 1000 == 500 {
            rows.push((k, format!("{t},,,{}", 20.0 + t)));
        }
    }
    rows.sort_by_key(|(k, _)| *k);
    let rows: Vec<String> = rows.into_iter().map(|(_, row)| row).collect();
    super::csv("__time,x,f,temperature", &rows)
}

fn read(text: &str, drop_bad: bool) -> Record {
    let options = Options {
        drop_bad,
        ..Options::default()
    };
    parse(text.as_bytes(), "r.csv", &options).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn each_column_is_read_at_its_own_stamps() {
    for (step, later, other, note) in [
        (10, 3, 10, "`f` and `x` have separate time stamps (800 and 800 readings); `x` was interpolated linearly at the stamps of `f`"),
        (20, 3, 10, "`x` and `f` have separate time stamps (400 and 800 readings); `f` was interpolated linearly at the stamps of `x`"),
        // Some or all stamps are those of both, in rows of their own.
        (10, 0, 15, "`f` and `x` have separate time stamps (534 and 800 readings); `x` was interpolated linearly at the stamps of `f`"),
        (10, 0, 10, "`f` and `x` have separate time stamps (800 and 800 readings); `x` was interpolated linearly at the stamps of `f`"),
    ] {
        let text = merged(step, later, other);
        for drop_bad in [false, true] {
            let record = read(&text, drop_bad);
            assert!(record.notes.iter().any(|own| own == note), "{:?}", record.notes);
            let start = match step == 20 {
                true => 0.02,
                false => later as f64 * 1e-3,
            };
            let channel = &record.channel("temperature").unwrap_or_else(|| panic!("{:?}", record.notes)).values;
            for (i, t) in record.time.iter().map(|t| t + start).enumerate() {
                // The square of half a step, times half of the second derivative.
                assert!((record.input.values[i] - input(t)).abs() < 90.0 * 0.005 * 0.005, "{t}");
                assert!((record.output.values[i] - output(t)).abs() < 225.0 * 0.005 * 0.005, "{t}");
                let expected = 20.0 + t.clamp(0.5, 7.5);
                assert!((channel[i] - expected).abs() < 1e-9, "{t}");
            }
            assert_eq!(record.dropped, 0);
        }
    }
}

#[test]
fn the_rows_of_such_columns_may_be_in_any_order() {
    let sorted = merged(10, 3, 10);
    let (names, rows) = sorted.split_once('\n').unwrap();
    let rows: Vec<&str> = rows.lines().collect();
    // One topic below the other, and each row of the one before that of the other.
    let empty = |index: usize| move |row: &&&str| row.split(',').nth(index) == Some("");
    let (first, second): (Vec<&str>, Vec<&str>) = rows.iter().partition(|row| empty(2)(row));
    let below = [first, second].concat();
    let mut swapped = rows.clone();
    swapped.chunks_exact_mut(2).for_each(<[&str]>::reverse);
    for drop_bad in [false, true] {
        let plain = read(&sorted, drop_bad);
        for rows in [&below, &swapped] {
            let record = read(&format!("{names}\n{}\n", rows.join("\n")), drop_bad);
            assert_eq!(record.samples(), plain.samples());
            let columns = |own: &Record| {
                let temperature = own.channel("temperature").unwrap().values.clone();
                [
                    own.time.clone(),
                    own.input.values.clone(),
                    own.output.values.clone(),
                    temperature,
                ]
                .concat()
            };
            let apart = columns(&record).into_iter().zip(columns(&plain));
            let apart = apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // The stamps count from another first row, with other roundings.
            assert!(apart < 1e-9, "{apart}");
        }
    }
    // A column whose own stamps run backwards is refused.
    let mut spoilt = rows.clone();
    spoilt.swap(40, 44);
    let text = format!("{names}\n{}\n", spoilt.join("\n"));
    let line = parse(text.as_bytes(), "r.csv", &Options::default())
        .unwrap_err()
        .to_string();
    assert!(line.contains("the time decreases"), "{line}");
}

#[test]
fn an_end_with_a_number_in_few_rows_is_read_at_its_stamps() {
    let row = |k: i32| {
        let t = f64::from(k) * 1e-3;
        match k % 10 {
            0 => format!("{t},{:.6},{:.6}", input(t), output(t)),
            _ => format!("{t},,{:.6}", output(t)),
        }
    };
    let text = super::csv("t,x,f", &(0..4000).map(row).collect::<Vec<_>>());
    let record = read(&text, false);
    assert_eq!(
        record.notes,
        ["`x` and `f` have separate time stamps (400 and 4000 readings); `f` was interpolated linearly at the stamps of `x`"]
    );
    for (i, t) in record.time.iter().enumerate() {
        // What was there is as it was, with six decimals.
        assert!((record.input.values[i] - input(*t)).abs() < 1e-6);
        assert!((record.output.values[i] - output(*t)).abs() < 1e-6);
    }
}

/// Gaps are no stamps of another sensor.
#[test]
fn rows_with_both_numbers_and_a_few_without_one_are_a_record_with_gaps() {
    let spoil = |(i, row): (usize, String)| {
        let cells: Vec<&str> = row.split(',').collect();
        match i % 4 {
            0 => format!("{},{},", cells[0], cells[1]),
            1 => format!("{},,{}", cells[0], cells[2]),
            _ => row,
        }
    };
    let text = super::csv(
        "t,x,f",
        &rows()
            .into_iter()
            .enumerate()
            .map(spoil)
            .collect::<Vec<_>>(),
    );
    let line = parse(text.as_bytes(), "r.csv", &Options::default())
        .unwrap_err()
        .to_string();
    assert_eq!(
        line,
        "r.csv:2: column `f`: the cell is empty, but it must be a number; --drop-bad drops such rows"
    );
    assert_eq!(read(&text, true).samples(), 200);
}
