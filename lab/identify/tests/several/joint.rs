//! What one model of several records finds, and what it leaves to each.

use crate::rig::{added, closed, declared, on, Files};
use crate::shared::DAMPER;
use bowden_lab::conclude::intervals::parameters;
use bowden_lab::fit::{fit, Solution};
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{HeldOut, Preparation, Prepared};
use bowden_lab::search::close;
use bowden_synth::{Base, Mode, Planted, Recipe};

/// A stiffness that is bent, seen from two places: over the stroke of either file it is
/// a straight line, of another slope in the other file.
pub fn bent(bias: f64, seed: u64) -> Recipe {
    let base = Base {
        gain: 2.0,
        rho: 1.2,
        ..Base::CABLE
    };
    let spring = Planted {
        origin: Some(0.0),
        ..Planted::with_gain("stiffness-quadratic", 6e-4)
    };
    Recipe {
        bias,
        amplitude: 3.0,
        effects: vec![spring],
        ..on(base, Mode::Displacement, seed)
    }
}

#[test]
fn a_bend_that_neither_file_shows_alone_is_found_in_both_together() {
    let files = Files::new(&[bent(-20.0, 4), bent(20.0, 5)]);
    for record in &files.records {
        let alone = Prepared::new(record, Preparation::default()).unwrap();
        assert!(added(&closed(&alone)).is_empty(), "found in one alone");
    }
    let data = files.joined(HeldOut::Trailing);
    let ledger = closed(&data);
    let first = &ledger.rounds[0];
    assert_eq!(first.candidate.family, "stiffness");
    // What is left is the noise of the sensors: the floor is an estimate, see the verdict.
    let last = ledger.last().rmse;
    assert!(last.fit < 1.2 * data.noise_floor, "{last:?}");
    assert!(ledger.declared.rmse.held_out > 2.0 * last.held_out);
}

/// Two configurations: the conduit was bent more sharply for the second.
const CONFIGURATIONS: [Base; 2] = [
    Base::CABLE,
    Base {
        gain: 0.88,
        kappa_eta: 5.5,
        offset: 0.4,
        ..Base::CABLE
    },
];

fn configurations() -> Files {
    let viscous = Planted::with_gain("viscous", -0.8);
    let recipe = |base, seed| Recipe {
        effects: vec![viscous.clone()],
        ..on(base, Mode::Torque, seed)
    };
    Files::new(&[recipe(CONFIGURATIONS[0], 11), recipe(CONFIGURATIONS[1], 12)])
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn with_gains_of_their_own_two_configurations_share_shapes_and_effects() {
    let files = configurations();
    let data = files.joined(HeldOut::Trailing);
    let common = close(&data, &declared(&data), |_| ()).unwrap();
    let mut structure = declared(&data);
    structure.own_gains = 2;
    let own = close(&data, &structure, |_| ()).unwrap();
    assert_eq!(added(&own), ["viscous"]);
    let floor = data.noise_floor;
    // As for a single record: the floor is an estimate from the top of the band.
    assert!(own.last().rmse.held_out < 1.3 * floor);
    assert!(common.last().rmse.held_out > 3.0 * own.last().rmse.held_out);

    let all = parameters(&data, own.last());
    let named = |name: &str| all.iter().find(|p| p.name == name).unwrap();
    for (record, base) in CONFIGURATIONS.iter().enumerate() {
        for (name, truth) in [
            ("B", base.gain),
            ("kappa_eta", base.kappa_eta),
            ("T0", base.offset),
        ] {
            let found = named(&format!("{name}.{}", record + 1));
            let [low, high] = found.ci95.unwrap();
            // Eleven parameters at 95 % each: half a width more covers all of them.
            let slack = 0.5 * (high - low);
            assert!(
                (low - slack..=high + slack).contains(&truth),
                "{} {found:?} {truth}",
                found.name
            );
            // Half of the smallest difference between the two configurations.
            assert!(high - low < 0.1 * base.kappa_eta.min(1.0), "{found:?}");
        }
    }
    for (name, truth) in [
        ("rho", Base::CABLE.rho),
        ("sigma", Base::CABLE.sigma),
        ("n", Base::CABLE.n),
    ] {
        let found = named(name);
        assert!((found.value / truth - 1.0).abs() < 0.05, "{found:?}");
    }
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn a_file_that_the_fit_never_saw_is_predicted_down_to_its_noise() {
    let recipe = |seed, rate| Recipe {
        rate,
        effects: vec![Planted::with_gain("viscous", -0.8)],
        ..on(Base::CABLE, Mode::Torque, seed)
    };
    let files = Files::new(&[recipe(21, 1000.0), recipe(22, 500.0), recipe(23, 1000.0)]);
    let data = files.joined(HeldOut::LastRecord);
    let ledger = closed(&data);
    assert_eq!(added(&ledger), ["viscous"]);
    let rmse = ledger.last().rmse;
    // Noise of the same sensor: the third file's error is that of the others, within the
    // scatter of an rms over a few hundred independent values and what fitting leaves.
    assert!(rmse.held_out < 1.3 * rmse.fit, "{rmse:?}");
    assert!(ledger.declared.rmse.held_out > 3.0 * rmse.held_out);
}

/// The current through the coil sets how much a damper grips: kappa_eta, and little else.
#[test]
fn a_damper_at_two_currents_has_one_loop_shape_and_two_kappa_eta() {
    let files = [DAMPER.file, "mr_damper_utfsm/sine_25mm0x25Hz0A.csv"];
    let paths = files.iter().map(|file| DAMPER.of_file(file).path());
    let Some(paths) = paths.collect::<Option<Vec<_>>>() else {
        return;
    };
    let records = DAMPER.asked().read_together(&paths);
    let records = records.unwrap_or_else(|line| panic!("{line}"));
    let cutoff = Some(DAMPER.cutoff);
    let data = Prepared::joined(&records, Preparation { cutoff }, HeldOut::Trailing).unwrap();
    let mut declared = structure(&["bouc-wen".to_owned(), "viscous".to_owned()], &data).unwrap();
    let common = fit(&data, &declared, None, 0.0).unwrap();
    declared.own_gains = records.len();
    let own = fit(&data, &declared, None, 0.0).unwrap();
    let percent = |s: &Solution| {
        let share = s.rmse.normalised(&data, &data.target);
        (100.0 * share.fit, 100.0 * share.held_out)
    };
    println!("common {:?}, own {:?}", percent(&common), percent(&own));
    assert!(3.0 * own.rmse.fit < common.rmse.fit);
    assert!(3.0 * own.rmse.held_out < common.rmse.held_out);
    let all = parameters(&data, &own);
    let kappa = |name: &str| all.iter().find(|p| p.name == name).unwrap();
    let (on, off) = (kappa("kappa_eta.1"), kappa("kappa_eta.2"));
    println!("{on:?}\n{off:?}");
    assert!(on.value.abs() > 2.0 * off.value.abs(), "{on:?} {off:?}");
}
