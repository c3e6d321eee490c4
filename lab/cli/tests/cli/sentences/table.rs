//! The ledger's words and numbers.

use crate::sentences::files::{Closed, Rows};
use crate::shell::bowden;

#[test]
fn the_terms_of_the_output_are_explained_in_the_help() {
    let text = bowden(&["identify", "--verbose"]).stdout;
    let text = String::from_utf8(text).unwrap();
    let help = bowden(&["help", "terms"]);
    assert!(help.status.success());
    let help = String::from_utf8(help.stdout).unwrap();
    for word in [
        "baseline",
        "vs noise",
        "selection",
        "held-out",
        "confidence",
        "blocks improved",
        "alternatives",
    ] {
        assert!(help.contains(word), "{word}: {help}");
        assert!(text.contains(word), "{word}: {text}");
    }
}

#[test]
fn help_knows_the_subcommands_and_refuses_other_topics() {
    for topic in ["identify", "compare", "power"] {
        let output = bowden(&["help", topic]);
        assert!(output.status.success());
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains("Usage: bowden"), "{text}");
    }
    let output = bowden(&["help", "nonsense"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn the_answer_is_the_first_line_and_the_table_has_the_json_s_numbers() {
    let closed = Closed::of(&[]);
    let text = closed.text();
    let mut lines = text.lines();
    assert!(lines.next().unwrap().starts_with("bowden identify · "));
    let answer: Vec<&str> = lines.skip(1).take(2).collect();
    assert_eq!(
        answer,
        [
            "  MISSING: friction over the velocity of phi_p",
            "  viscous@phi_p -0.2637 ± 0.0028 N·m·s/rad · high confidence"
        ]
    );
    let header = text.lines().find(|l| l.starts_with("RMSE")).unwrap();
    let columns: Vec<&str> = header
        .split("  ")
        .map(str::trim)
        .filter(|c| !c.is_empty())
        .collect();
    assert_eq!(
        columns,
        ["RMSE [N·m]", "fit", "selection", "held-out", "vs noise"]
    );
    let baseline = text.lines().find(|l| l.contains("(baseline)")).unwrap();
    let floor = closed.json["noise_floor"].as_f64().unwrap();
    let multiple = closed.json["baseline"]["rmse"]["held_out"]
        .as_f64()
        .unwrap()
        / floor;
    assert!(
        baseline.ends_with(&format!("{multiple:.1} ×")),
        "{baseline}"
    );
    assert!(text.lines().count() <= 25, "{text}");
}

/// The term's own fit and the final one once gave two numbers of one coefficient.
#[test]
fn a_coefficient_has_one_number() {
    let closed = Closed::of(&[]);
    let text = closed.text();
    let numbers: Vec<&str> = text
        .match_indices("viscous@phi_p")
        .filter_map(|(at, name)| text[at + name.len()..].split_once("N·m").map(|rest| rest.0))
        .filter(|number| number.contains('±') && number.len() < 30)
        .map(|number| number.trim_start_matches(':').trim())
        .collect();
    assert!(!numbers.is_empty(), "{text}");
    assert!(
        numbers.iter().all(|number| *number == numbers[0]),
        "{numbers:?}"
    );
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn tones_are_named_by_their_frequency_and_ripples_by_their_order() {
    let rows = Rows::generated(&["--mode", "torque", "--seed", "41", "--effect", "tone"]);
    let closed = rows.close(&[]);
    assert!(closed.names().contains(&"tone"), "{:?}", closed.names());
    assert!(
        closed.sentence().contains("tone ("),
        "{}",
        closed.sentence()
    );
    assert!(closed.sentence().contains(" Hz)"), "{}", closed.sentence());
    let rows = Rows::generated(&["--mode", "torque", "--seed", "42", "--effect", "ripple"]);
    let closed = rows.close(&[]);
    assert!(closed.names().contains(&"ripple"), "{:?}", closed.names());
    assert!(
        closed.sentence().contains("(order "),
        "{}",
        closed.sentence()
    );
}
