//! The stretch of a cable is one name, and not two angles.

use crate::rig::{with_effect, Made};
use bowden_lab::conclude::intervals::term_name;
use bowden_lab::fit::fit;
use bowden_lab::model::declared::structure;
use bowden_synth::{Mode, Planted, Recipe};

/// Names of the delivered rounds, and whose families and rivals they are.
fn named(made: &Made) -> (Vec<String>, Vec<Vec<&'static str>>) {
    let ledger = made.closed();
    let families = |round: &bowden_lab::ledger::Round| round.possible().map(|c| c.family).collect();
    let rounds = &ledger.rounds;
    (
        rounds
            .iter()
            .map(|r| term_name(&made.data, &r.candidate.term))
            .collect(),
        rounds.iter().map(families).collect(),
    )
}

#[test]
fn a_planted_stretch_is_named_alone_though_two_angles_span_it() {
    for (effect, name) in [
        ("stretch-linear", "stretch-linear@stretch"),
        ("stretch-cubic", "stretch-cubic@stretch"),
    ] {
        let made = Made::new(&with_effect(Mode::Torque, effect, 3.0, 1001));
        let (names, families) = named(&made);
        assert_eq!(names, [name]);
        assert!(families[0].contains(&"stretch"));
    }
}

/// The same record, read with the stretch as a channel: what is an angle's stays an angle's.
#[test]
fn a_stiffness_of_one_angle_is_not_called_a_stretch() {
    let recipe = Recipe {
        effects: vec![Planted {
            channel: Some("phi_p".to_owned()),
            ..Planted::new("stiffness-linear")
        }],
        seed: 1001,
        ..Recipe::new(Mode::Torque)
    };
    let (names, families) = named(&Made::with_stretch(&recipe));
    assert_eq!(names, ["stiffness-linear@phi_p"]);
    assert!(!families[0].contains(&"stretch"), "{families:?}");
}

#[test]
fn a_declared_stretch_reads_the_stretch_and_needs_one() {
    let made = Made::new(&with_effect(Mode::Torque, "stretch-linear", 3.0, 1001));
    let told = made.declare(&["bouc-wen", "stretch"]);
    let solution = fit(&made.data, &told, None, 0.0).unwrap();
    let truth = &made.synthetic.truth.effects[0];
    let parameters = made.parameters(&solution);
    let own = parameters
        .iter()
        .find(|p| p.name.starts_with("stretch"))
        .unwrap();
    let [low, high] = own.ci95.unwrap();
    assert!(low < truth.gain && truth.gain < high, "{own:?}");

    let without = Made::new(&Recipe::new(Mode::Torque));
    let list = ["stretch-linear".to_owned()];
    let refused = structure(&list, &without.data).unwrap_err();
    assert_eq!(
        refused,
        "--baseline stretch-linear: the record has no stretch channel; --channel stretch=phi_p-phi_d adds one"
    );
}
