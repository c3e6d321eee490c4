//! Sensors with stamps of their own in one table.

use super::*;

fn input(t: f64) -> f64 {
    10.0 * (3.0 * t).sin()
}

fn output(t: f64) -> f64 {
    25.0 * (3.0 * t + 0.2).sin()
}

/// Rows of the input at multiples of `step`, of the output `later` behind multiples of `other`, and of
/// a channel once a second, in the order of their stamps \[ms\].
fn merged(step: usize, later: usize, other: usize) -> String {
    let mut rows = Vec::new();
    for k in 0..8000 {
        let t = k as f64 * 1e-3;
        if k % step == 0 {
            rows.push(format!("{t},{:.6},,", input(t)));
        }
        if k >= later && (k - later).is_multiple_of(other) {
            rows.push(format!("{t},,{:.6},", output(t)));
        }
        if k % 1000 == 500 {
            rows.push(format!("{t},,,{}", 20.0 + t));
        }
    }
    csv("__time,x,f,temperature", &rows)
}

fn both(text: &str) -> [Record; 2] {
    [Options::default(), drop_bad()].map(|options| read(text, &options))
}

#[test]
fn each_column_is_read_at_its_own_stamps() {
    for (step, later, other, readings) in [
        (10, 3, 10, [("f", 800), ("x", 800)]),
        (20, 3, 10, [("x", 400), ("f", 800)]),
        // Some or all stamps are those of both, in rows of their own.
        (10, 0, 15, [("f", 534), ("x", 800)]),
        (10, 0, 10, [("f", 800), ("x", 800)]),
    ] {
        let [(a, of_a), (b, of_b)] = readings;
        let note = format!("`{a}` and `{b}` have separate time stamps ({of_a} and {of_b} readings); `{b}` was interpolated linearly at the stamps of `{a}`");
        for record in both(&merged(step, later, other)) {
            assert!(record.notes.contains(&note), "{:?}", record.notes);
            let start = if step == 20 {
                0.02
            } else {
                later as f64 * 1e-3
            };
            let channel = &record.channel("temperature").unwrap().values;
            for (i, t) in record.time.iter().map(|t| t + start).enumerate() {
                // The square of half a step, times half of the second derivative.
                let square = 0.005 * 0.005;
                assert!(
                    (record.input.values[i] - input(t)).abs() < 90.0 * square,
                    "{t}"
                );
                assert!(
                    (record.output.values[i] - output(t)).abs() < 225.0 * square,
                    "{t}"
                );
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
    let is_first = |row: &&&str| row.split(',').nth(2) == Some("");
    let (first, second): (Vec<&str>, Vec<&str>) = rows.iter().partition(is_first);
    let mut swapped = rows.clone();
    swapped.chunks_exact_mut(2).for_each(<[&str]>::reverse);
    let columns = |own: &Record| {
        let temperature = &own.channel("temperature").unwrap().values;
        [
            &own.time,
            &own.input.values,
            &own.output.values,
            temperature,
        ]
        .map(Vec::clone)
        .concat()
    };
    for rows in [[first, second].concat(), swapped] {
        let text = format!("{names}\n{}\n", rows.join("\n"));
        for (record, plain) in both(&text).iter().zip(&both(&sorted)) {
            assert_eq!(record.samples(), plain.samples());
            let apart = columns(record).into_iter().zip(columns(plain));
            let apart = apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // The stamps count from another first row, with other roundings.
            assert!(apart < 1e-9, "{apart}");
        }
    }
    // A column whose own stamps run backwards is refused.
    let mut spoilt = rows;
    spoilt.swap(40, 44);
    let text = format!("{names}\n{}\n", spoilt.join("\n"));
    let line = refusal(text, &Options::default());
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
    let record = accepted(csv("t,x,f", &(0..4000).map(row).collect::<Vec<_>>()));
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
    let text = changed("t,x,f", |i, row| {
        let cells: Vec<&str> = row.split(',').collect();
        match i % 4 {
            0 => format!("{},{},", cells[0], cells[1]),
            1 => format!("{},,{}", cells[0], cells[2]),
            _ => row.to_owned(),
        }
    });
    refused(
        &text,
        "2: column `f`: the cell is empty, but it must be a number; --drop-bad drops such rows",
    );
    assert_eq!(read(&text, &drop_bad()).samples(), 200);
}
