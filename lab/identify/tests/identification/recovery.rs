//! Planted Bouc-Wen parameters come back from the record, and so do their intervals.

use crate::rig::{bare, named, with_effect, Made, MODES};
use bowden_lab::conclude::intervals::Parameter;
use bowden_lab::fit::{fit, Solution};
use bowden_lab::model::structure::Role;
use bowden_synth::{Base, Mode, Recipe};
use rayon::prelude::*;
use std::ops::RangeInclusive;

/// The transmission's parameters by their names in the report, with what was planted
/// and how far from that an estimate may be.
fn planted(mode: Mode, base: &Base, gains: f64, shapes: f64) -> [(&'static str, f64, f64); 6] {
    let names = match mode {
        Mode::Torque => ["B", "kappa_eta", "T0"],
        Mode::Displacement => ["kappa_x", "kappa_eta", "offset"],
    };
    [
        (names[0], base.gain, gains * base.gain),
        (names[1], base.kappa_eta, gains * base.kappa_eta),
        // The constant is small by chance; its error scales with the loop's height.
        (names[2], base.offset, gains * base.kappa_eta),
        ("rho", base.rho, gains * base.rho),
        ("sigma", base.sigma, shapes * base.sigma),
        ("n", base.n, shapes * base.n),
    ]
}

fn told(made: &Made, list: &[&str]) -> Solution {
    fit(&made.data, &made.declare(list), None, 0.0).unwrap()
}

fn in_both_modes(seeds: RangeInclusive<u64>) -> Vec<(Mode, u64)> {
    MODES
        .into_iter()
        .flat_map(|mode| seeds.clone().map(move |seed| (mode, seed)))
        .collect()
}

/// Without noise only the smoothing is left: the record's output goes through it, the
/// loop of the fit is computed from the smoothed input and is a little sharper. That is
/// 5e-4 of a shape. Where the state at the start has no trace after the edge is dropped,
/// the search ends beside the optimum, on records 23 and 24 by up to 4e-3 of a shape and
/// 5e-4 of a gain; hence twice that for gains and 5e-3 for shapes.
#[test]
fn a_clean_record_gives_its_parameters_back() {
    let short: Vec<String> = in_both_modes(21..=24)
        .into_par_iter()
        .flat_map_iter(|(mode, seed)| {
            let made = Made::new(&Recipe {
                noise: 0.0,
                quantisation: 0.0,
                resolution: 0.0,
                ..bare(mode, seed)
            });
            let solution = told(&made, &["bouc-wen"]);
            let found = made.parameters(&solution);
            let base = made.synthetic.truth.base;
            let mut short = Vec::new();
            for (name, value, tolerance) in planted(mode, &base, 1e-3, 5e-3) {
                let error = named(&found, name).value - value;
                if error.abs() > tolerance {
                    short.push(format!("{mode:?} {seed} {name}: {error:.1e} off {value}"));
                }
            }
            // The same smoothing, seen in the output: measured up to 2e-4 of the loop.
            if solution.rmse.held_out > 1e-3 * base.kappa_eta {
                short.push(format!(
                    "{mode:?} {seed}: held out {}",
                    solution.rmse.held_out
                ));
            }
            short
        })
        .collect();
    assert!(short.is_empty(), "{short:#?}");
}

/// Twenty records, six parameters each. The noise behind the filter is 0.006 on a loop
/// 2.5 to 12 high, seen by some two hundred independent samples of the fit segment: 2e-4
/// of the loop's height. Gains get ten times that for what they share with each other,
/// sigma and n, which only bend the loop at its knees, forty times.
#[test]
#[ignore = "slow: bash .ci/run identification"]
fn a_noisy_record_gives_its_parameters_back_within_their_intervals() {
    let all: Vec<(bool, Option<String>)> = in_both_modes(31..=40)
        .into_par_iter()
        .flat_map_iter(|(mode, seed)| {
            let made = Made::new(&bare(mode, seed));
            let found = made.parameters(&told(&made, &["bouc-wen"]));
            planted(mode, &made.synthetic.truth.base, 2e-3, 8e-3).map(|(name, value, tolerance)| {
                let Parameter {
                    value: got, ci95, ..
                } = named(&found, name);
                let [low, high] = ci95.unwrap_or_else(|| panic!("{mode:?} {seed}: no {name}"));
                // An interval that says nothing holds every truth.
                let wide = 0.5 * (high - low) > 3.0 * tolerance;
                let far = (got - value).abs() > tolerance;
                let line = format!("{mode:?} {seed} {name}: {got} in [{low}, {high}] of {value}");
                (low <= value && value <= high, (wide || far).then_some(line))
            })
        })
        .collect();
    let short: Vec<&String> = all.iter().filter_map(|(_, line)| line.as_ref()).collect();
    assert!(short.is_empty(), "{short:#?}");
    let inside = all.iter().filter(|(inside, _)| *inside).count();
    // 95 % of 120 are 114; below 108 a binomial count falls once in a hundred times.
    assert!(
        inside >= 108,
        "{inside} of {} intervals hold the truth",
        all.len()
    );
}

/// Sigma >= 1/2 and n >= 1 are the ends of what is admitted; above the ranges' other ends
/// a record at this sampling cannot tell one value from the next.
#[test]
#[ignore = "slow: bash .ci/run identification"]
fn a_parameter_on_its_bound_is_reported_as_not_identified() {
    for mode in MODES {
        let plain = Base {
            gain: 0.95,
            kappa_eta: 4.0,
            offset: 0.05,
            rho: 5.0 / Recipe::new(mode).amplitude,
            sigma: 1.2,
            n: 1.6,
        };
        let sigma = |sigma: f64| Base { sigma, ..plain };
        let n = |n: f64| Base { n, ..plain };
        for (name, end, role, base) in [
            ("sigma", "lower", Role::Sigma, sigma(0.5)),
            ("sigma", "upper", Role::Sigma, sigma(1e4)),
            ("n", "lower", Role::N, n(1.0)),
            ("n", "upper", Role::N, n(200.0)),
        ] {
            let made = Made::new(&Recipe {
                base: Some(base),
                ..bare(mode, 5)
            });
            let solution = told(&made, &["bouc-wen"]);
            let at = solution.free.iter().position(|f| f.role == role).unwrap();
            assert!(
                solution.on_bound[at],
                "{mode:?} {base:?}: {name} not on its bound"
            );
            let found = made.parameters(&solution);
            let parameter = named(&found, name);
            assert!(
                !parameter.identified && parameter.ci95.is_none(),
                "{parameter:?}"
            );
            let refusal = parameter.not_identified.as_ref().unwrap();
            assert_eq!(refusal.reason, format!("at its {end} bound"));
            assert!(refusal.excitation.contains("strokes"), "{refusal:?}");
            // What does not hang on it is still there: with the true value out of reach
            // the loop's height moves by less than 1 %.
            let height = named(&found, "kappa_eta");
            assert!(
                height.identified && height.not_identified.is_none(),
                "{height:?}"
            );
            assert!(
                (height.value / base.kappa_eta - 1.0).abs() < 0.01,
                "{height:?}"
            );
        }
    }
}

/// Strokes of a tenth of the knee: kappa_eta eta is kappa_eta rho x there, which neither
/// the product's factors nor the line beside it can be told from.
#[test]
fn parameters_that_move_with_each_other_name_each_other() {
    for mode in MODES {
        let amplitude = Recipe::new(mode).amplitude;
        let made = Made::new(&Recipe {
            seed: 5,
            base: Some(Base {
                gain: 0.95,
                kappa_eta: 40.0,
                offset: 0.05,
                rho: 0.1 / amplitude,
                sigma: 1.2,
                n: 1.6,
            }),
            ..Recipe::new(mode)
        });
        let found = made.parameters(&told(&made, &["bouc-wen"]));
        assert!(found
            .iter()
            .all(|p| p.identified == p.not_identified.is_none()));
        let refused: Vec<_> = found
            .iter()
            .filter_map(|p| Some((p.name.as_str(), p.not_identified.as_ref()?)))
            .collect();
        assert!(
            refused
                .iter()
                .any(|(name, r)| ["rho", "kappa_eta"].contains(name)
                    && r.reason.contains("correlated with ")),
            "{refused:#?}"
        );
        for (name, refusal) in refused {
            assert!(!refusal.reason.ends_with(&format!("correlated with {name}")));
            assert!(!refusal.excitation.is_empty());
        }
    }
}

#[test]
fn without_a_loop_in_the_record_its_shapes_are_not_identified() {
    for (mode, seed) in in_both_modes(72..=73) {
        let base = Base {
            gain: 0.95,
            kappa_eta: 0.0,
            offset: 0.05,
            rho: 0.3,
            sigma: 1.2,
            n: 1.6,
        };
        let made = Made::new(&Recipe {
            base: Some(base),
            ..bare(mode, seed)
        });
        let found = made.parameters(&told(&made, &["bouc-wen"]));
        for name in ["rho", "sigma", "n"] {
            let shape = named(&found, name);
            assert!(
                !shape.identified && shape.ci95.is_none(),
                "{mode:?}: {shape:?}"
            );
        }
        let height = named(&found, "kappa_eta").ci95;
        assert!(
            height.is_none_or(|[low, high]| low <= 0.0 && 0.0 <= high),
            "{mode:?} {seed}: a loop of height {height:?} where there is none"
        );
    }
}

/// Effects whose curve is the same in the generator and in the catalogue; each at three
/// times the noise, so that the same two hundred samples know its gain to about 1 %.
#[test]
#[ignore = "slow: bash .ci/run identification"]
fn the_gain_of_a_declared_effect_comes_back_within_its_interval() {
    let effects = [
        "viscous",
        "inertia",
        "stiffness-quadratic",
        "asymmetry-viscous",
    ];
    let mut outside = Vec::new();
    for mode in MODES {
        for effect in effects {
            let made = Made::new(&with_effect(mode, effect, 3.0, 51));
            let truth = &made.synthetic.truth.effects[0];
            let name = format!("{effect}@{}", truth.channel.unwrap());
            let found = made.parameters(&told(&made, &["bouc-wen", &name]));
            let gain = found.iter().find(|p| p.term == Some(0)).unwrap();
            assert!(
                (gain.value / truth.gain - 1.0).abs() < 0.015,
                "{mode:?} {effect}: {} of {}",
                gain.value,
                truth.gain
            );
            let [low, high] = gain.ci95.unwrap();
            if !(low <= truth.gain && truth.gain <= high) {
                outside.push(format!("{mode:?} {effect}: {gain:?} of {}", truth.gain));
            }
        }
    }
    // Of eight intervals at 95 % one may miss: more happen once in seventeen times.
    assert!(outside.len() <= 1, "{outside:#?}");
}
