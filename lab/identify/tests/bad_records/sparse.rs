//! Channels with a number in a few rows only.

use super::*;
use bowden_lab::record::Options;

/// The record with a temperature in every `every`-th row, from row `first` on; elsewhere `empty`.
fn with_temperature(first: usize, every: usize, empty: &str) -> String {
    changed("t,x,f,temperature", |i, row| {
        match i >= first && (i - first).is_multiple_of(every) {
            true => format!("{row},{}", 20.0 + 0.5 * i as f64),
            false => format!("{row},{empty}"),
        }
    })
}

#[test]
fn a_slow_channel_is_a_line_through_its_readings() {
    let said = "`temperature` has no number in 380 of 400 rows; its 20 readings, one every 0.200 s, were interpolated linearly";
    for empty in ["", "NaN"] {
        for options in [Options::default(), drop_bad()] {
            let record = read(with_temperature(3, 20, empty), &options);
            let values = &record.channels[0].values;
            assert_eq!((values.len(), record.dropped), (400, 0));
            for (i, value) in values.iter().enumerate() {
                // The temperature is linear in the row; before the first and after the last reading it stays.
                let expected = 20.0 + 0.5 * (i.clamp(3, 383) as f64);
                assert!((value - expected).abs() < 1e-9, "{i}: {value}");
            }
            assert!(
                record.notes.iter().any(|note| note == said),
                "{:?}",
                record.notes
            );
        }
    }
}

#[test]
fn cells_that_lack_in_a_channel_that_is_mostly_there_are_faults() {
    let gap = |text: &str| {
        let cell = |i| if (30..33).contains(&i) { text } else { ",21" };
        changed("t,x,f,temperature", |i, row| row.to_owned() + cell(i))
    };
    let record = read(gap(",nan"), &drop_bad());
    assert_eq!((record.samples(), record.dropped), (397, 3));
    assert!(!record.channels[0].values.iter().any(|value| value.is_nan()));
    // The earlier fault is told, also where the later one ends the reading.
    let later = gap(",").replace("3.50,", "3.50,abc");
    assert!(later.contains("abc"));
    for text in [gap(","), later] {
        refused(text, "32: column `temperature`: the cell is empty, but it must be a number; --drop-bad drops such rows");
    }
}

#[test]
fn what_is_no_number_and_an_end_with_few_numbers_are_refused() {
    let text = with_temperature(0, 20, "").replacen(",\n", ",warm\n", 1);
    refused(text, "3: column `temperature`: `warm` is not a number");
    let thin = changed("t,x,f", |i, _| format!("{},{i},", 0.01 * i as f64));
    let line = refusal(thin, &Options::default());
    assert!(
        line.starts_with("r.csv:2: column `f`: the cell is empty"),
        "{line}"
    );
    let few = with_temperature(0, 4, "").replacen("f,temperature", "load,f", 1);
    refused(few, "401: the record is too short: 100 samples of 400 remain at the stamps of the column with the fewest numbers; the minimum is 200");
    let none = wider("t,x,f,temperature", ",");
    let record = accepted(&none);
    assert!(record.channels.is_empty());
    let said = "`temperature` has no number in any row and was excluded";
    assert!(record.notes.iter().any(|note| note == said));
    // What was asked for has to be there.
    let asked = channels(&[("warmth", "temperature")]);
    let says = "1: column `temperature`: there is no number in any row of the record";
    refused_with(none, &asked, says);
}
