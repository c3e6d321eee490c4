//! Time that does not run, columns that hold no measurement, options that fit no record.

use super::*;

#[test]
fn time_that_does_not_run_forward_is_refused() {
    refused(
        with_line(57, "0.53,1,2"),
        "r.csv:57: column `t`: the time decreases from 0.54 to 0.53 s; \
         sort the rows by time, or save each record in a separate file",
    );
    refused(
        with_line(57, "0.54,1,2"),
        "r.csv:57: column `t`: the time stamp repeats at 0.54; \
         --rate HZ computes the time from the row number; --drop-bad drops such rows",
    );
    let rounded = with_time("t,x,f", |i| format!("{:.2}", i as f64 / 128.0));
    refused(
        &rounded,
        "r.csv:5: column `t`: the time stamp repeats at 0.02, as in 87 of 400 rows, \
         so the stamps appear to be rounded; --rate HZ computes the time from the row number (about 127.9 Hz); --drop-bad drops such rows",
    );
    let options = Options {
        rate: Some(128.0),
        ..Options::default()
    };
    let record = parse(rounded.as_bytes(), "r.csv", &options).unwrap();
    assert_eq!(record.time[128], 1.0);
    // Stamps that differ as written, but no longer once they are relative.
    let far = with_time("t,x,f", |i| {
        if i == 0 {
            "-1e10".into()
        } else {
            format!("{i}e-12")
        }
    });
    assert!(refusal(far, &Options::default()).contains("the time stamp repeats"));
}

#[test]
fn options_that_cannot_be_followed_are_refused() {
    let text = csv("t,x,f", &rows());
    let refuses = |options: Options, line: &str| assert_eq!(refusal(&text, &options), line);
    let rate = |rate: f64| Options {
        rate: Some(rate),
        ..Options::default()
    };
    refuses(
        rate(0.0),
        "r.csv: --rate 0 is out of range; it must be positive",
    );
    refuses(
        rate(-5.0),
        "r.csv: --rate -5 is out of range; it must be positive",
    );
    refuses(
        rate(f64::NAN),
        "r.csv: --rate NaN is out of range; it must be positive",
    );
    let cut = |skip: f64, until: Option<f64>| Options {
        skip,
        until,
        ..Options::default()
    };
    refuses(
        cut(-1.0, None),
        "r.csv: --start -1 is out of range (0 s or more)",
    );
    refuses(
        cut(f64::NAN, None),
        "r.csv: --start NaN is out of range (0 s or more)",
    );
    refuses(
        cut(2.0, Some(2.0)),
        "r.csv: --end 2 is out of range; it must be above --start 2",
    );
    refuses(
        cut(0.0, Some(f64::NAN)),
        "r.csv: --end NaN is out of range; it must be above --start 0",
    );
    refuses(
        cut(3.0, None),
        "r.csv:401: the record is too short: 100 samples of 400 remain after cutting; \
         the minimum is 200",
    );
}

#[test]
fn an_end_that_stands_still_is_refused() {
    let still = "in every sample, but it must vary";
    refused(
        of(|_| 2.5, f64::sin),
        &format!("r.csv:2: column `x`: the input is 2.5 {still}"),
    );
    refused(
        of(f64::sin, |_| 0.0),
        &format!("r.csv:2: column `f`: the output is 0 {still}"),
    );
}

/// As where a column was exported twice: a perfect model of nothing.
#[test]
fn an_output_that_is_the_input_is_refused() {
    refused(
        of(f64::sin, f64::sin),
        "r.csv:2: column `f`: the output equals the input `x` in every sample, but it must be the resulting force or torque",
    );
}

#[test]
fn a_clipped_sensor_is_recognised() {
    let sine = |t: f64| 10.0 * (2.0 * t).sin();
    refused(
        of(sine, |t| (3.0 * sine(t)).clamp(-24.0, 24.0)),
        "r.csv:49: column `f`: clipped: flat at 24 7 times, 22.5 % of the samples; \
         use a sensor with a wider range",
    );
    refused(
        of(|t| sine(t).min(9.5), |t| 3.0 * sine(t)),
        "r.csv:65: column `x`: clipped: flat at 9.5 7 times, 11.2 % of the samples; \
         use a sensor with a wider range",
    );
    // With noise, and a force that mostly follows the speed: the input does not turn.
    let noise = |t: f64| (7919.0 * t * t).sin();
    let force = |t: f64| (sine(t) + 40.0 * (2.0 * t).cos() + noise(t)).clamp(-30.0, 30.0);
    let line = refusal(of(sine, force), &Options::default());
    assert!(line.contains("column `f`: clipped: flat at 30 "), "{line}");
}
