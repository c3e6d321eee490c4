//! What each file of a joint fit says by itself.

use crate::joint::bent;
use crate::rig::{on, Files};
use bowden_lab::facts::{across, close, Asked, Close, Facts, Grade, RoundFacts};
use bowden_lab::model::mechanism::Mechanism;
use bowden_synth::{Base, Mode, Planted, Recipe};

fn facts(files: &Files) -> Facts {
    let question = Close::new(Asked::default());
    close(&files.records, &question, &|_| ()).unwrap().facts
}

#[test]
fn what_only_the_joint_fit_supports_is_in_no_file_alone() {
    let facts = facts(&Files::new(&[bent(-20.0, 4), bent(20.0, 5)]));
    let all = across(&facts.lacks, &facts.files_alone);
    assert!(facts.lacks[0].mechanism == Mechanism::Elastic && all[0].is_joint);
    assert_eq!(all[0].files, [("0.csv", None), ("1.csv", None)]);
}

#[test]
fn what_every_file_shows_is_in_each_file_alone() {
    let viscous = |seed| Recipe {
        effects: vec![Planted::with_gain("viscous", -0.8)],
        ..on(Base::CABLE, Mode::Torque, seed)
    };
    let facts = facts(&Files::new(&[viscous(11), viscous(12)]));
    for file in &facts.files_alone {
        let lacks = file.lacks.as_ref().unwrap();
        let own: Vec<_> = lacks.iter().map(|l| (l.mechanism, l.confidence)).collect();
        assert_eq!(own, [(Mechanism::Friction, Grade::High)], "{}", file.path);
    }
    assert_eq!(facts.files_alone.len(), 2);
    let by_file = &facts.rounds[0].by_file;
    assert_eq!(by_file.len(), 2);
    // As much as the friction is larger than the noise, in either file.
    assert!(by_file.iter().all(|file| file.share > 0.5), "{by_file:?}");
}

/// One conduit was dry: the joint term adds to the error of its file. The fourth file is held out.
#[test]
#[ignore = "slow: bash .ci/run identification"]
fn a_file_in_which_a_term_does_not_help_is_told() {
    let with = |gain, seed| Recipe {
        effects: vec![Planted::with_gain("viscous", gain)],
        ..on(Base::CABLE, Mode::Torque, seed)
    };
    let gains = [-0.8, -0.8, 0.0, -0.8];
    let recipes: Vec<Recipe> = gains
        .into_iter()
        .zip(15..)
        .map(|(g, s)| with(g, s))
        .collect();
    let facts = facts(&Files::new(&recipes));
    let of = |round: &RoundFacts| round.by_file.iter().map(|file| file.share).collect();
    let all: Vec<Vec<f64>> = facts.rounds.iter().map(of).collect();
    let [first, second, third] = all[0][..] else {
        panic!("{all:?}");
    };
    assert!(first > 0.0 && second > 0.0 && third < 0.0, "{all:?}");
}
