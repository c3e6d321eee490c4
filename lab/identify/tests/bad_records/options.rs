//! Headers without the columns that are needed, and options that fit no record.

use super::*;
use bowden_lab::record::{Mode, Options};

/// A header over rows of three numbers and as many more as it has names, and the refusal.
const HEADERS: &str = r"
t,x [mm],x [mm],f|column `x`: named twice, as columns 2 and 3; --names A,B,… gives each column its own name
t,x,off,off|column `f`: no such column; the columns are `t`, `x`, `off`; --output COL selects another one
time,time,off,off|the columns `time`, `off` include neither `tau_i` and `tau_o` nor `x` and `f`; set --mode, and name the columns with --input and --output
tim,x,f|column `t`: no such column; the columns are `tim`, `x`, `f` (nearest: `tim`); --time COL selects another one; --rate HZ computes the time from the row number
t,tau_i,torque|column `tau_o`: no such column; the columns are `t`, `tau_i`, `torque` (nearest: `tau_i`); --output COL selects another one
t,a,b|the columns `t`, `a`, `b` include neither `tau_i` and `tau_o` nor `x` and `f`; set --mode, and name the columns with --input and --output
t,x,f,tau_i,tau_o|the columns fit both modes; set --mode torque or --mode displacement
t [V],x,f|column `t`: `V` is not a unit of time; allowed are s, ms, us, ns, min, h and d, in the file or with --time 't [ms]'
t,X_mm,x_m,f|column `x`: no such column; the columns are `t`, `X_mm`, `x_m`, `f` (nearest: `x_m`, `X_mm`); --input COL selects another one
";

#[test]
fn a_header_without_the_columns_is_refused_and_names_those_that_exist() {
    for row in HEADERS.lines().skip(1) {
        let (header, says) = row.split_once('|').unwrap();
        let more = header.split(',').count() - 3;
        refused(wider(header, &",1".repeat(more)), &format!("1: {says}"));
    }
    // More names than cells.
    let twice = "1: column `load`: named twice, as columns 4 and 5; --names A,B,… gives each column its own name";
    refused(csv("t,x,f,load,load", &rows()), twice);
    // A temperature is no time.
    let line = refusal(csv("T,x,f", &rows()), &Options::default());
    let says = "r.csv:1: column `t`: no such column";
    assert!(line.starts_with(says), "{line}");
}

#[test]
fn options_that_fit_no_record_are_refused() {
    let channel = |pair: (&str, &str)| channels(&[pair]);
    let mode = Some(Mode::Displacement);
    let cut = |skip: f64, until: f64| with(|o| (o.skip, o.until) = (skip, Some(until)));
    for (options, line) in [
        (with(|o| o.rate = Some(0.0)), " --rate 0 is out of range; it must be positive"),
        (with(|o| o.rate = Some(-5.0)), " --rate -5 is out of range; it must be positive"),
        (with(|o| o.rate = Some(f64::NAN)), " --rate NaN is out of range; it must be positive"),
        (with(|o| o.skip = -1.0), " --start -1 is out of range (0 s or more)"),
        (with(|o| o.skip = f64::NAN), " --start NaN is out of range (0 s or more)"),
        (cut(2.0, 2.0), " --end 2 is out of range; it must be above --start 2"),
        (cut(0.0, f64::NAN), " --end NaN is out of range; it must be above --start 0"),
        (with(|o| o.skip = 3.0), "401: the record is too short: 100 samples of 400 remain after cutting; the minimum is 200"),
        (channel(("phi_p", "q")), "1: column `q`: no such column; the columns are `t`, `x`, `f`; --channel NAME=COL selects another one"),
        (with(|o| (o.output, o.mode) = (Some("x".into()), mode)), "1: column `x`: this column cannot be both input and output"),
        (with(|o| (o.input, o.mode) = (Some("t".into()), mode)), "1: column `t`: this column is the time, so it cannot also be input or output"),
        (channel(("load", "f")), "1: column `f`: this column is the output, so it cannot also be channel `load`"),
        (channels(&[("a", "t"), ("a", "x")]), " --channel NAME=COL: channel `a` is given twice"),
        (channel(("x", "x")), " --channel NAME=COL: `x` cannot be the name of a channel"),
    ] {
        refused_with(fine::plain(), &options, line);
    }
    let open = with(|o| (o.input, o.output) = (Some("q".into()), Some("u".into())));
    let says =
        "1: the named columns do not determine the mode; set --mode torque or --mode displacement";
    refused_with(wider("t,q,u,a,b", ",1,2"), &open, says);
}

#[test]
fn cuts_that_leave_nothing_say_from_where_they_count() {
    let text = stamped("t,x,f", |i| {
        format!("{:.2}", 1_772_373_801.0 + 0.01 * i as f64)
    });
    refused_with(
        text,
        &with(|o| o.skip = 1_772_373_805.0),
        "401: the record is too short: 0 samples of 400 remain after cutting; the minimum is 200; \
         --start and --end are in seconds after the first time stamp, and the last time stamp is at 3.990 s",
    );
}
