//! The ledger's words and numbers.

use crate::files::{Closed, Rows};
use crate::shell::bowden;

#[test]
fn each_word_of_the_tables_is_explained_under_them_and_in_the_help() {
    let closed = Closed::of(&[]);
    let text = closed.text();
    let help = bowden(&["help", "terms"]);
    assert!(help.status.success());
    let help = String::from_utf8(help.stdout).unwrap();
    for word in [
        "grade",
        "× floor",
        "explains",
        "stop",
        "blocks better",
        "recurs",
        "p ",
        "unneeded",
        "rejected",
    ] {
        assert!(help.contains(word), "{word}");
        let in_legend = |line: &&str| line.starts_with(word) || line.contains(&format!("; {word}"));
        let after = text.split_once("confounded with").unwrap().1;
        assert!(after.lines().any(|l| in_legend(&l)), "{word}: {text}");
    }
}

#[test]
fn help_knows_the_subcommands_and_refuses_other_topics() {
    for topic in ["close", "compare", "power"] {
        let output = bowden(&["help", topic]);
        assert!(output.status.success());
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains("Usage: bowden"), "{text}");
    }
    let output = bowden(&["help", "nonsense"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn the_floor_stands_beside_the_error_that_it_is_of() {
    let closed = Closed::of(&[]);
    let text = closed.text();
    let header = text.lines().find(|l| l.contains("explains")).unwrap();
    let columns: Vec<&str> = header
        .split("  ")
        .map(str::trim)
        .filter(|c| !c.is_empty())
        .collect();
    assert_eq!(
        columns,
        ["effect", "grade", "explains", "fit", "× floor", "stop", "held out", "× floor"]
    );
    let declared = text.lines().find(|l| l.contains("as declared")).unwrap();
    let floor = closed.json["noise_floor"].as_f64().unwrap();
    for segment in ["fit", "held_out"] {
        let multiple = closed.json["declared"]["rmse"][segment].as_f64().unwrap() / floor;
        assert!(declared.contains(&format!("{multiple:.1}")), "{declared}");
    }
}

/// The round's own fit and the final one once gave two numbers of one coefficient.
#[test]
fn a_coefficient_has_one_number() {
    let closed = Closed::of(&[]);
    let text = closed.text();
    let lines: Vec<&str> = text
        .lines()
        .filter(|l| l.contains("viscous@phi_p") && l.contains('±'))
        .collect();
    assert_eq!(lines.len(), 2, "{lines:?}");
    let number = |line: &str| {
        let from = line.find("viscous@phi_p").unwrap() + "viscous@phi_p".len();
        line[from..]
            .trim()
            .split("N·m")
            .next()
            .unwrap()
            .trim()
            .to_owned()
    };
    assert_eq!(number(lines[0]), number(lines[1]));
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
