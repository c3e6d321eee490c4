//! A play that the baseline hysteresis has bent towards is found beside it.

use crate::rig::Made;
use bowden_synth::{Mode, Planted, Recipe};

/// Fitted without the play, the hysteresis leaves up to four times the noise, and to first order
/// nothing is gained by one.
#[test]
fn a_play_that_the_hysteresis_imitates_is_named_with_its_width() {
    for seed in [5001, 5003, 5007, 5016] {
        let made = Made::new(&Recipe {
            seed,
            effects: vec![Planted {
                strength: 3.0,
                ..Planted::new("backlash")
            }],
            ..Recipe::new(Mode::Displacement)
        });
        let ledger = made.closed();
        let rounds = ledger.rounds.iter();
        let names: Vec<&str> = rounds.map(|r| r.candidate.term.effect.name()).collect();
        assert_eq!(names, ["backlash"], "{seed}");
        let last = ledger.last();
        // The search itself stops at 1.2 times the floor.
        let left = last.rmse.fit / made.data.noise_floor;
        assert!(left < 1.2, "{seed}: {left}");
        let planted = made.synthetic.truth.effects[0].shapes[0].1;
        let at = last.structure.terms.at(&last.free, &last.values).unwrap();
        let own = at.iter().last().unwrap().effect.shape(0).unwrap();
        // Measured 1.1 % at most.
        assert!(
            (own / planted - 1.0).abs() < 0.03,
            "{seed}: {own} of {planted}"
        );
    }
}
