//! A play in series with the transmission, for which no sum of columns stands, is found with its
//! width; and so is a play that the baseline hysteresis has bent towards.

use crate::rig::{bare, names, with_effect, Made};
use bowden_synth::{Mode, Recipe};

/// The seed, then half-widths from a hundredth of the stroke up.
const PLAYS: [(u64, f64); 3] = [(41, 0.1), (42, 0.4), (43, 1.2)];

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn a_play_in_series_is_found_with_its_width_and_leaves_the_noise() {
    for (seed, play) in PLAYS {
        let made = Made::new(&Recipe {
            play,
            ..bare(Mode::Displacement, seed)
        });
        let ledger = made.closed();
        assert_eq!(names(&ledger), ["play-in-series"], "seed {seed}");
        let found = ledger.last().structure.terms[0].effect.shape(0).unwrap();
        // The encoder's step is 0.001, the noise a hundredth of the loop.
        let off = (found - play).abs();
        assert!(off < 0.01 * play.max(0.1), "{seed}: {found}");
        let declared = ledger.declared.rmse.held_out;
        assert!(ledger.last().rmse.held_out < 0.1 * declared, "seed {seed}");
    }
}

/// Fitted without the play, the hysteresis leaves up to four times the noise, and to first order
/// nothing is gained by one.
#[test]
fn a_play_that_the_hysteresis_imitates_is_named_with_its_width() {
    for seed in [5001, 5003, 5007, 5016] {
        let made = Made::new(&with_effect(Mode::Displacement, "backlash", 3.0, seed));
        let ledger = made.closed();
        assert_eq!(names(&ledger), ["backlash"], "{seed}");
        let last = ledger.last();
        // The search itself stops at 1.2 times the floor.
        let left = last.rmse.fit / made.data.noise_floor;
        assert!(left < 1.2, "{seed}: {left}");
        let planted = made.synthetic.truth.effects[0].shapes[0].1;
        let at = last.structure.terms.at(&last.free, &last.values).unwrap();
        let own = at.iter().last().unwrap().effect.shape(0).unwrap();
        // Measured 1.1 % at most.
        let off = (own / planted - 1.0).abs();
        assert!(off < 0.03, "{seed}: {own} of {planted}");
    }
}
