//! Several files of which one has a channel that counts the other way, or two in each other's
//! place: the sentence asks for it.

use crate::sentences::files::{Closed, Rows, PHI_P};
use crate::shell::{args, Folder};

const PHI_D: usize = PHI_P + 1;

/// Two halves of one record with effects of both angles; the second half as `changed` has it.
fn halves(changed: impl Fn(&mut Rows)) -> (Closed, Folder) {
    let whole = Rows::generated(&args(
        "--effect=viscous@phi_p:2 --effect=gravity@phi_d:2 --seed=41 --seconds=40",
    ));
    let folder = Folder::new();
    let middle = whole.rows.len() / 2;
    let half = |rows: &[Vec<f64>]| Rows {
        header: whole.header.clone(),
        rows: rows.to_vec(),
    };
    let (morning, mut evening) = (half(&whole.rows[..middle]), half(&whole.rows[middle..]));
    changed(&mut evening);
    let paths = [
        morning.write(&folder, "morning.csv"),
        evening.write(&folder, "evening.csv"),
    ];
    (
        Closed::of(&[&paths[0], &paths[1], "--mode", "torque"]),
        folder,
    )
}

fn turn(rows: &mut Rows, channel: usize) {
    rows.set(channel, |_, row| -row[channel]);
}

fn asks(closed: &Closed, what: &str, column: &str) {
    assert_eq!(closed.verdict(), "no-input-dependence");
    let suspicion = closed.finding("logged-differently").unwrap();
    assert!(suspicion["path"].as_str().unwrap().ends_with("evening.csv"));
    assert_eq!(
        (&suspicion["what"], &suspicion["column"]),
        (&what.into(), &column.into())
    );
    let error = |name: &str| suspicion[name].as_f64().unwrap();
    assert!(error("after") <= 0.8 * error("before"), "{suspicion}");
    // What the whole record shows: viscous friction of one angle, and what gravity does over a
    // small range of the other.
    let terms = suspicion["terms"].as_array().unwrap();
    assert!(terms.iter().any(|n| n == "viscous@phi_p"), "{suspicion}");
    assert_eq!(terms.len(), 2, "{suspicion}");
    assert_eq!(closed.finding("output-leads"), None);
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn a_channel_that_counts_the_other_way_in_one_file_is_asked_about() {
    let (closed, _folder) = halves(|rows| turn(rows, PHI_P));
    asks(&closed, "reversed", "phi_p");
    let (closed, _folder) = halves(|rows| turn(rows, PHI_D));
    asks(&closed, "reversed", "phi_d");
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn two_channels_in_each_others_place_in_one_file_are_asked_about() {
    let (closed, _folder) = halves(|rows| rows.rows.iter_mut().for_each(|r| r.swap(PHI_P, PHI_D)));
    asks(&closed, "swapped", "phi_p");
    assert_eq!(
        closed.finding("logged-differently").unwrap()["other"],
        "phi_d"
    );
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn files_with_equal_channels_are_asked_about_nothing() {
    let (closed, _folder) = halves(|_| {});
    assert_eq!(closed.finding("logged-differently"), None);
    assert_eq!(closed.names().len(), 2);
}
