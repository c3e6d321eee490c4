//! A delay is a delay at every cut-off.

use crate::rig::{with_effect, Made};
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::intervals::{parameters, term_name};
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::search::close;
use bowden_synth::{Mode, Recipe};

/// Where f_c is a fifth of the rate nothing is decimated, and a sample is a long time: a delay
/// that took from the amplitude had a lag of -3 beside it, which gave it back.
#[test]
fn a_delay_of_half_a_sample_has_no_lag_beside_it() {
    for seed in [1, 2] {
        let recipe = Recipe {
            rate: 40.0,
            seconds: 60.0,
            ..with_effect(Mode::Torque, "delay", 3.0, seed)
        };
        let made = Made::new(&recipe);
        let cutoff = Some(8.0);
        let data = Prepared::new(&made.record, Preparation { cutoff }).unwrap();
        let declared = structure(&["bouc-wen".to_owned()], &data).unwrap();
        let ledger = close(&data, &declared, |_| ()).unwrap();
        let names: Vec<_> = ledger
            .rounds
            .iter()
            .map(|r| term_name(&data, &r.candidate.term))
            .collect();
        assert_eq!(names, ["delay"], "seed {seed}");
        let done = FinalFit::new(&data, &ledger);
        let all = parameters(&data, &done.solution);
        let own = all.iter().find(|p| p.name == "delay").unwrap();
        let [low, high] = own.ci95.unwrap();
        let late = made.synthetic.truth.effects[0].gain;
        assert!(low < late && late < high, "seed {seed}: {late} {own:?}");
    }
}
