//! A force or a position that is measured with the other sign is the same rig.

use crate::rig::{with_effect, Made};
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::intervals::{parameters, term_name};
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::search::close;
use bowden_synth::Mode;

/// Names and gains of what is found.
fn found(data: &Prepared) -> Vec<(String, f64)> {
    let declared = structure(&["bouc-wen".to_owned()], data).unwrap();
    let ledger = close(data, &declared, |_| ()).unwrap();
    let all = parameters(data, &FinalFit::new(data, &ledger).solution);
    let rounds = ledger.rounds.iter();
    let named = rounds.map(|r| {
        let name = term_name(data, &r.candidate.term);
        let gain = all.iter().find(|p| p.name == name).unwrap().value;
        (name, gain)
    });
    named.collect()
}

/// Friction takes energy out, whichever way the force is counted: only its gain turns.
#[test]
fn friction_is_found_whichever_way_force_and_motion_are_counted() {
    for effect in ["viscous", "coulomb"] {
        let made = Made::new(&with_effect(Mode::Displacement, effect, 3.0, 5));
        let upright = found(&made.data);
        let [(name, gain)] = upright.as_slice() else {
            panic!("{effect}: {upright:?}")
        };
        assert_eq!(name, effect);
        for (input, output) in [(1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let mut record = made.record.clone();
            record.input.values.iter_mut().for_each(|x| *x *= input);
            record.output.values.iter_mut().for_each(|y| *y *= output);
            let cutoff = Some(made.data.cutoff);
            let data = Prepared::new(&record, Preparation { cutoff }).unwrap();
            let is_turned = input * output < 0.0;
            assert_eq!(data.against, is_turned, "{effect} {input} {output}");
            let names = found(&data);
            let [(own, turned)] = names.as_slice() else {
                panic!("{effect} {input} {output}: {names:?}")
            };
            assert_eq!(own, effect, "{input} {output}");
            // Other starts, and so other last digits of a search that ends at 1e-6 of its error.
            let expected = gain * input * output;
            assert!(
                (turned / expected - 1.0).abs() < 0.01,
                "{turned} {expected}"
            );
        }
    }
}
