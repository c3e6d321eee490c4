//! Names that come again where the rows below them may be another record.

use super::*;
use bowden_lab::record::Options;

fn at(segment: usize) -> Options {
    with(|o| o.segment = Some(segment))
}

#[test]
fn a_time_that_restarts_below_the_names_is_refused_as_two_records() {
    let once = plain();
    let two = "column `t`: the file contains two records: the column names are repeated, and the time jumps back from 3.99 to 0 s; --segment N reads one of 2 segments (segment 2 begins here)";
    refused(once.repeat(2), &format!("402: {two}"));
    refused(format!("{once}End\n{once}"), &format!("403: {two}"));
    let line = refusal(once.repeat(3), &Options::default());
    let is_said = line.contains("several records") && line.contains("one of 3 segments");
    assert!(is_said, "{line}");
    // A clock that restarts without names is no segment.
    refused(
        once.clone() + &rows().join("\n"),
        "402: column `t`: the time decreases from 3.99 to 0 s; \
         sort the rows by time, or save each record in a separate file",
    );
    let says = "402: the column names are repeated, and without a time column bowden cannot tell whether the record continues; --segment N reads one of 2 segments (segment 2 begins here)";
    refused_with(once.repeat(2), &with(|o| o.rate = Some(100.0)), says);
}

#[test]
fn a_segment_that_is_not_there_or_not_alike_is_refused() {
    let twice = plain().repeat(2);
    for number in [0, 3] {
        let says = format!(" --segment {number} is out of range (1 to 2)");
        refused_with(&twice, &at(number), &says);
    }
    let other = plain() + &csv("t,x,f\ns,in,N", &rows());
    let message = "402: the column names are repeated, but the lines below them differ from the lines below the first names; write the records to separate files";
    refused(&other, message);
    refused_with(&other, &at(2), message);
    read(&other, &at(1));
    // A fault keeps its line, and no later segment is passed over.
    let spoilt = twice.replacen("\n3.00,", "\n3.00,a,1\n3.00,", 2);
    refused_with(spoilt, &at(2), "704: column `x`: `a` is not a number");
}
