//! The final model has seen the stop-check segment, and not what is held out.

use crate::rig::{with_effect, Made, MODES};
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::fit::{fit, Segments, Solution};
use bowden_synth::Mode;
use rayon::prelude::*;

/// Mean square on the held-out segment between a model and the output without its noise.
fn distance(made: &Made, solution: &Solution) -> f64 {
    let clean = made.with_output(made.synthetic.truth.output.clone());
    let pairs = solution.prediction.iter().zip(&clean.target);
    let error: Vec<f64> = pairs.map(|(p, c)| p - c).collect();
    Segments::of(&made.data, &error).held_out.powi(2)
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn the_final_model_is_nearer_to_the_truth_than_the_loop_s_last() {
    let records: Vec<(Mode, u64)> = MODES
        .iter()
        .flat_map(|&mode| (66_000..66_020).map(move |seed| (mode, seed)))
        .collect();
    // Over the noise's mean square, before and after.
    let pairs: Vec<[f64; 2]> = records
        .into_par_iter()
        .map(|(mode, seed)| {
            let made = Made::new(&with_effect(mode, "asymmetry-eta", 3.0, seed));
            let told = made.declare(&["bouc-wen", "asymmetry-eta"]);
            let solution = fit(&made.data, &told, None, 0.0).unwrap();
            let done = FinalFit::of(&made.data, &solution);
            assert!(done.refitted, "{mode:?} {seed}");
            [&solution, &done.solution].map(|s| distance(&made, s) / made.noise_floor().powi(2))
        })
        .collect();
    let mean = |of: &dyn Fn(&[f64; 2]) -> f64| -> f64 {
        pairs.iter().map(of).sum::<f64>() / pairs.len() as f64
    };
    let (last, done) = (mean(&|p| p[0]), mean(&|p| p[1]));
    let gained = last - done;
    let spread = mean(&|p| (p[0] - p[1] - gained).powi(2)).sqrt();
    let error = spread / (pairs.len() as f64 - 1.0).sqrt();
    println!("{last:.4} → {done:.4}, gained {gained:.4} ± {error:.4}");
    // A gain that forty records show: by more than twice its standard error.
    assert!(gained > 2.0 * error, "{gained} ± {error}");
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn what_is_held_out_does_not_move_the_final_model_and_the_stop_check_does() {
    let made = Made::new(&with_effect(Mode::Torque, "viscous", 3.0, 66_100));
    let told = made.declare(&["bouc-wen", "viscous@phi_p"]);
    let delivered = |from: usize, to: usize| {
        let mut output = made.record.output.values.clone();
        for (i, value) in output[from..to].iter_mut().enumerate() {
            *value += 0.5 * (0.01 * i as f64).sin();
        }
        let data = made.with_output(output);
        let solution = fit(&data, &told, None, 0.0).unwrap();
        let done = FinalFit::of(&data, &solution);
        (done.solution.values, done.solution.gains)
    };
    let samples = made.record.output.values.len();
    let plain = delivered(0, 0);
    // A second behind the boundary at 75 %: the filter reaches three periods of 8 Hz.
    let held_out = delivered(samples * 3 / 4 + 1000, samples);
    for (a, b) in [(&plain.0, &held_out.0), (&plain.1, &held_out.1)] {
        for (a, b) in a.iter().zip(b) {
            // What a zero-phase filter still passes from a second away.
            assert!((a - b).abs() <= 1e-6 * a.abs().max(1.0), "{a} {b}");
        }
    }
    let stop = delivered(samples * 63 / 100, samples * 72 / 100);
    let moved = plain.1.iter().zip(&stop.1);
    assert!(moved.into_iter().any(|(a, b)| (a - b).abs() > 1e-3));
}

#[test]
fn nothing_about_the_names_changes_with_the_final_fit() {
    let made = Made::new(&with_effect(Mode::Displacement, "viscous", 3.0, 66_200));
    let ledger = made.closed();
    let done = FinalFit::new(&made.data, &ledger);
    let names = |s: &Solution| -> Vec<&str> {
        let terms = s.structure.terms.iter();
        terms.map(|t| t.effect.name()).collect()
    };
    assert_eq!(names(&done.solution), names(ledger.last()));
    assert_eq!(
        done.data.split.fit.len(),
        made.data.split.fit.len() + made.data.split.selection.len()
    );
    assert_eq!(done.data.split.held_out, made.data.split.held_out);
    // Of the same data, by the same columns: what it says of the segments is its residual's.
    assert_eq!(done.rmse, Segments::of(&made.data, &done.solution.residual));
}
