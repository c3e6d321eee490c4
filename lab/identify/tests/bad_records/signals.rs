//! Time that does not run, and columns that hold no measurement.

use super::*;
use bowden_lab::record::Options;

#[test]
fn time_that_does_not_run_forward_is_refused() {
    let rounded = stamped("t,x,f", |i| format!("{:.2}", i as f64 / 128.0));
    refused(
        &rounded,
        "5: column `t`: the time stamp repeats at 0.02, as in 87 of 400 rows, \
         so the stamps appear to be rounded; --rate HZ computes the time from the row number (about 127.9 Hz); --drop-bad drops such rows",
    );
    let record = read(&rounded, &with(|o| o.rate = Some(128.0)));
    assert_eq!(record.time[128], 1.0);
    // Stamps that differ as written, but no longer once they are relative.
    let far = stamped("t,x,f", |i| match i {
        0 => "-1e10".into(),
        _ => format!("{i}e-12"),
    });
    assert!(refusal(far, &Options::default()).contains("the time stamp repeats"));
}

/// Of 400 rows 10 have a stamp of their own, or 300, or one.
#[test]
fn rows_are_to_be_left_out_only_where_most_stay() {
    let line = |stamp: fn(usize) -> usize| {
        let text = stamped("t,x,f", |i| stamp(i).to_string());
        refusal(text, &Options::default())
    };
    let few = line(|i| i / 40);
    assert!(
        few.contains("--rate HZ") && few.contains("(about 40.0 Hz)"),
        "{few}"
    );
    let some = line(|i| i - i % 4 / 3);
    assert!(some.ends_with("--drop-bad drops such rows"), "{some}");
    for line in [few, line(|_| 7)] {
        assert!(!line.contains("--drop-bad"), "{line}");
    }
}

#[test]
fn an_end_that_stands_still_or_is_the_other_one_is_refused() {
    let still = "in every sample, but it must vary";
    let text = of(|_| 2.5, f64::sin);
    refused(text, &format!("2: column `x`: the input is 2.5 {still}"));
    let text = of(f64::sin, |_| 0.0);
    refused(text, &format!("2: column `f`: the output is 0 {still}"));
    // As where a column was exported twice: a perfect model of nothing.
    let says = "2: column `f`: the output equals the input `x` in every sample, but it must be the resulting force or torque";
    refused(of(f64::sin, f64::sin), says);
}

#[test]
fn a_clipped_sensor_is_recognised() {
    let sine = |t: f64| 10.0 * (2.0 * t).sin();
    refused(
        of(sine, |t| (3.0 * sine(t)).clamp(-24.0, 24.0)),
        "49: column `f`: clipped: flat at 24 7 times, 22.5 % of the samples; use a sensor with a wider range",
    );
    refused(
        of(|t| sine(t).min(9.5), |t| 3.0 * sine(t)),
        "65: column `x`: clipped: flat at 9.5 7 times, 11.2 % of the samples; use a sensor with a wider range",
    );
    // With noise, and a force that mostly follows the speed: the input does not turn.
    let noise = |t: f64| (7919.0 * t * t).sin();
    let force = |t: f64| (sine(t) + 40.0 * (2.0 * t).cos() + noise(t)).clamp(-30.0, 30.0);
    let line = refusal(of(sine, force), &Options::default());
    assert!(line.contains("column `f`: clipped: flat at 30 "), "{line}");
}
