//! What the project promises, on one record each, in seconds: an effect that nobody declared is
//! found, and where the search finds no term nothing is named. The same on hundreds of records, with
//! every effect and noise of three colours, is in the modules beside this one, which `.ci/run` runs.

use super::rig::{names, with_effects, Made, MODES};
use bowden_lab::ledger::Ledger;
use bowden_synth::Mode;

/// Closes the loop on a record of Bouc-Wen and, where one is given, an effect at three times
/// the noise; declared is Bouc-Wen alone.
fn closed(mode: Mode, effect: Option<&str>) -> (Made, Ledger) {
    let effects: Vec<_> = effect.map(|name| (name, 3.0)).into_iter().collect();
    let made = Made::new(&with_effects(mode, &effects, 66_300));
    let ledger = made.closed();
    (made, ledger)
}

#[test]
fn an_effect_that_nobody_declared_is_found_by_name_and_taken_away() {
    for (mode, effect) in [
        (Mode::Torque, "viscous"),
        (Mode::Displacement, "drag-quadratic"),
    ] {
        let (made, ledger) = closed(mode, Some(effect));
        assert_eq!(names(&ledger), [effect], "{mode:?}");
        assert!(ledger.unknown.is_none(), "{mode:?} {effect}");
        let (before, after) = (ledger.declared.rmse.held_out, ledger.last().rmse.held_out);
        assert!(
            before > 3.0 * after,
            "{mode:?} {effect}: {before} → {after}"
        );
        // The floor is an estimate of the noise, and the held-out part of one record is short:
        // the verdict takes up to 1.2 times for noise.
        assert!(
            after < 1.2 * made.data.noise_floor,
            "{mode:?} {effect}: {after} of {}",
            made.data.noise_floor
        );
    }
}

#[test]
fn where_nothing_is_missing_nothing_is_named() {
    for mode in MODES {
        let (_, ledger) = closed(mode, None);
        assert!(
            ledger.rounds.is_empty(),
            "{mode:?}: {:?}",
            ledger.rounds[0].candidate
        );
        assert!(ledger.unknown.is_none(), "{mode:?}");
    }
}
