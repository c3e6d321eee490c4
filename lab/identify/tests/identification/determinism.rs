//! The same record gives the same result.

use crate::rig::{with_effect, Made};
use bowden_lab::search::close;
use bowden_synth::{Mode, Planted};

/// The whole ledger as text: every number of it, to the last bit.
fn ledger(made: &Made) -> String {
    let ledger = close(&made.data, &made.declare(&["bouc-wen"]), |_| ()).unwrap();
    assert!(
        ledger.rounds.len() >= 2,
        "three effects are planted, so that the rounds after the first count as well"
    );
    format!("{ledger:?}")
}

fn three_effects() -> Made {
    let mut recipe = with_effect(Mode::Displacement, "inertia", 3.0, 61);
    recipe.effects.push(Planted::new("lag"));
    recipe.effects.push(Planted::new("stiffness-quadratic"));
    Made::new(&recipe)
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn closing_twice_gives_the_same_ledger_to_the_last_bit() {
    let made = three_effects();
    assert_eq!(ledger(&made), ledger(&made));
    // Nor does it hang on anything that reading and preparing left behind.
    assert_eq!(ledger(&made), ledger(&three_effects()));
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn the_number_of_threads_does_not_change_a_bit() {
    let made = three_effects();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| ledger(&made))
    };
    let one = on(1);
    for threads in [2, 5] {
        assert_eq!(one, on(threads), "{threads} threads");
    }
}
