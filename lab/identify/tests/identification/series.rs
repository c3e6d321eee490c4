//! A play in series with the transmission: no sum of columns stands for it.

use crate::rig::Made;
use bowden_synth::{Mode, Recipe};

/// The input, then the noise: half-widths from a hundredth of the stroke up.
const PLAYS: [(u64, f64); 3] = [(41, 0.1), (42, 0.4), (43, 1.2)];

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn a_play_in_series_is_found_with_its_width_and_leaves_the_noise() {
    for (seed, play) in PLAYS {
        let recipe = Recipe {
            seed,
            play,
            ..Recipe::new(Mode::Displacement)
        };
        let made = Made::new(&recipe);
        let ledger = made.closed();
        let names: Vec<_> = ledger
            .rounds
            .iter()
            .map(|round| round.candidate.term.effect.name())
            .collect();
        assert_eq!(names, ["play-in-series"], "seed {seed}");
        let found = ledger.last().structure.terms[0].effect.shape(0).unwrap();
        // The encoder's step is 0.001, the noise a hundredth of the loop.
        assert!(
            (found - play).abs() < 0.01 * play.max(0.1),
            "{seed}: {found}"
        );
        let declared = ledger.declared.rmse.held_out;
        assert!(ledger.last().rmse.held_out < 0.1 * declared, "seed {seed}");
    }
}

#[test]
fn without_a_play_none_is_named() {
    let recipe = Recipe {
        seed: 44,
        ..Recipe::new(Mode::Displacement)
    };
    let made = Made::new(&recipe);
    let ledger = made.closed();
    assert!(ledger.rounds.is_empty());
}
