//! What was declared and is not in the record is told; what is in it is not.

use crate::rig::{bare, Made, MODES};
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::unneeded::unneeded;
use bowden_lab::search::close;
use bowden_synth::{Base, Mode, Planted, Recipe};

/// Names of the parts that are not needed, once the loop is closed.
fn parts(recipe: &Recipe, declared: &[&str]) -> Vec<String> {
    let made = Made::new(recipe);
    let ledger = close(&made.data, &made.declare(declared), |_| ()).unwrap();
    let done = FinalFit::new(&made.data, &ledger);
    let found = unneeded(&ledger, &done);
    for part in &found {
        assert!(part.held_out_without < 1.1 * done.rmse.held_out);
    }
    found.into_iter().map(|part| part.effect).collect()
}

/// A rig that is a line: its loop has no height.
fn line(mode: Mode) -> Base {
    let (gain, rho) = match mode {
        Mode::Torque => (0.95, 0.4),
        Mode::Displacement => (2.0, 1.0),
    };
    Base {
        gain,
        kappa_eta: 0.0,
        offset: 0.1,
        rho,
        sigma: 2.0,
        n: 1.2,
    }
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn hysteresis_that_is_there_is_needed() {
    for mode in MODES {
        for effects in [Vec::new(), vec![Planted::new("viscous")]] {
            let recipe = Recipe {
                effects,
                ..bare(mode, 3)
            };
            assert_eq!(parts(&recipe, &["bouc-wen"]), Vec::<String>::new());
        }
    }
}

/// With a viscous term the loop is open all the same.
#[test]
#[ignore = "slow: bash .ci/run identification"]
fn a_rig_that_is_a_line_and_viscous_is_not_sold_a_hysteresis() {
    for mode in MODES {
        for effects in [Vec::new(), vec![Planted::new("viscous")]] {
            let recipe = Recipe {
                effects,
                base: Some(line(mode)),
                ..bare(mode, 5)
            };
            assert_eq!(parts(&recipe, &["bouc-wen"]), ["bouc-wen"], "{recipe:?}");
        }
    }
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn a_declared_term_is_needed_where_it_is_in_the_record_and_only_there() {
    for mode in MODES {
        let with = |effects: Vec<Planted>| Recipe {
            effects,
            ..bare(mode, 9)
        };
        // The channel that the generator's term reads.
        let viscous = match mode {
            Mode::Torque => "viscous@phi_p",
            Mode::Displacement => "viscous",
        };
        let declared = ["bouc-wen", viscous];
        assert_eq!(parts(&with(Vec::new()), &declared), [viscous]);
        let there = with(vec![Planted::new("viscous")]);
        assert_eq!(parts(&there, &declared), Vec::<String>::new());
    }
}
