//! The stretch of a cable is one name, and not two angles; and a delay is one name at every cut-off.

use crate::rig::{families, named, term_names, with_effect, Made};
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::intervals::parameters;
use bowden_lab::fit::fit;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::search::close;
use bowden_synth::{Mode, Planted, Recipe};

#[test]
fn a_planted_stretch_is_named_alone_though_two_angles_span_it() {
    for effect in ["stretch-linear", "stretch-cubic"] {
        let made = Made::new(&with_effect(Mode::Torque, effect, 3.0, 1001));
        let ledger = made.closed();
        let name = format!("{effect}@stretch");
        assert_eq!(term_names(&made.data, &ledger), [name]);
        assert!(families(&ledger)[0].contains(&"stretch"));
    }
}

/// The same record, read with the stretch as a channel: what is an angle's stays an angle's.
#[test]
fn a_stiffness_of_one_angle_is_not_called_a_stretch() {
    let mut recipe = with_effect(
        Mode::Torque,
        "stiffness-linear",
        Planted::new("stiffness-linear").strength,
        1001,
    );
    recipe.effects[0].channel = Some("phi_p".to_owned());
    let made = Made::with_stretch(&recipe);
    let ledger = made.closed();
    let names = term_names(&made.data, &ledger);
    assert_eq!(names, ["stiffness-linear@phi_p"]);
    let families = families(&ledger);
    assert!(!families[0].contains(&"stretch"), "{families:?}");
}

#[test]
fn a_declared_stretch_reads_the_stretch_and_needs_one() {
    let made = Made::new(&with_effect(Mode::Torque, "stretch-linear", 3.0, 1001));
    let told = made.declare(&["bouc-wen", "stretch"]);
    let solution = fit(&made.data, &told, None, 0.0).unwrap();
    let truth = &made.synthetic.truth.effects[0];
    let parameters = made.parameters(&solution);
    let mut own = parameters.iter();
    let own = own.find(|p| p.name.starts_with("stretch")).unwrap();
    let [low, high] = own.ci95.unwrap();
    assert!(low < truth.gain && truth.gain < high, "{own:?}");

    let without = Made::new(&Recipe::new(Mode::Torque));
    let list = ["stretch-linear".to_owned()];
    assert_eq!(
        structure(&list, &without.data).unwrap_err(),
        "--baseline stretch-linear: the record has no stretch channel; --channel stretch=phi_p-phi_d adds one"
    );
}

/// Where f_c is a fifth of the rate nothing is decimated, and a sample is a long time: a delay
/// that took from the amplitude had a lag of -3 beside it, which gave it back.
#[test]
fn a_delay_of_half_a_sample_has_no_lag_beside_it() {
    for seed in [1, 2] {
        let made = Made::new(&Recipe {
            rate: 40.0,
            seconds: 60.0,
            ..with_effect(Mode::Torque, "delay", 3.0, seed)
        });
        let cutoff = Some(8.0);
        let data = Prepared::new(&made.record, Preparation { cutoff }).unwrap();
        let declared = structure(&["bouc-wen".to_owned()], &data).unwrap();
        let ledger = close(&data, &declared, |_| ()).unwrap();
        assert_eq!(term_names(&data, &ledger), ["delay"], "seed {seed}");
        let all = parameters(&data, &FinalFit::new(&data, &ledger).solution);
        let own = named(&all, "delay");
        let [low, high] = own.ci95.unwrap();
        let late = made.synthetic.truth.effects[0].gain;
        assert!(low < late && late < high, "seed {seed}: {late} {own:?}");
    }
}
