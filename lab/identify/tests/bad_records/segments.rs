//! Names that come again where the rows below them may be another record.

use super::{csv, refusal, refused, rows};
use bowden_lab::record::Options;

#[test]
fn a_time_that_restarts_below_the_names_is_refused_as_two_records() {
    let once = csv("t,x,f", &rows());
    refused(
        [once.as_str(), &once].concat(),
        "r.csv:402: column `t`: the file contains two records: the column names are repeated, and the time jumps back from 3.99 to 0 s; --segment N reads one of 2 segments (segment 2 begins here)",
    );
    let line = refusal([once.as_str(), &once, &once].concat(), &Options::default());
    assert!(
        line.contains("several records") && line.contains("one of 3 segments"),
        "{line}"
    );
    // A clock that restarts without names is no segment.
    let line = refusal(
        [once.as_str(), &rows().join("\n")].concat(),
        &Options::default(),
    );
    assert_eq!(
        line,
        "r.csv:402: column `t`: the time decreases from 3.99 to 0 s; \
         sort the rows by time, or save each record in a separate file"
    );
    let rate = Options {
        rate: Some(100.0),
        ..Options::default()
    };
    assert_eq!(
        refusal([once.as_str(), &once].concat(), &rate),
        "r.csv:402: the column names are repeated, and without a time column bowden cannot tell whether the record continues; --segment N reads one of 2 segments (segment 2 begins here)"
    );
}

#[test]
fn a_segment_that_is_not_there_or_not_alike_is_refused() {
    let at = |segment: usize| Options {
        segment: Some(segment),
        ..Options::default()
    };
    let once = csv("t,x,f", &rows());
    let twice = [once.as_str(), &once].concat();
    for number in [0, 3] {
        assert_eq!(
            refusal(&twice, &at(number)),
            format!("r.csv: --segment {number} is out of range (1 to 2)")
        );
    }
    let other = [once.as_str(), &csv("t,x,f\ns,in,N", &rows())].concat();
    let message = "r.csv:402: the column names are repeated, but the lines below them differ from the lines below the first names; write the records to separate files";
    refused(&other, message);
    assert_eq!(refusal(&other, &at(2)), message);
    assert!(bowden_lab::record::parse(other.as_bytes(), "r.csv", &at(1)).is_ok());
    // A fault keeps its line, and no later segment is passed over.
    let spoilt = twice.replacen("\n3.00,", "\n3.00,a,1\n3.00,", 2);
    assert_eq!(
        refusal(&spoilt, &at(2)),
        "r.csv:704: column `x`: `a` is not a number"
    );
    refused(
        once.clone() + "End\n" + &once,
        "r.csv:403: column `t`: the file contains two records: the column names are repeated, and the time jumps back from 3.99 to 0 s; --segment N reads one of 2 segments (segment 2 begins here)",
    );
}
