//! A refusal says what was expected, where that can be told from the cell.

use super::{accepted, refused, with_time};

#[test]
fn stamps_without_a_unit_that_cannot_be_seconds_are_refused() {
    let asks = |step: &str, unit: &str, start: &str| {
        format!(
            "r.csv:1: column `t`: states no unit and was read as seconds; its median step is {step} s: \
             is that {unit}? Then call it `t [{unit}]`, or `t [s]` if it is s{start}"
        )
    };
    let since = |first: &str| format!("; the first stamp is {first} s, thousands of years");
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
            record.notes[0].contains("is that ms?"),
            "{:?}",
            record.notes
        );
    }
    // A year a row is no logger's step in any unit, and with its unit any step is right.
    accepted(of(31_557_600_000, 0));
    let stated = of(2_000, 0).replacen("t,", "t [s],", 1);
    assert_eq!(accepted(stated).time[1], 2000.0);
}
