//! Least and greatest slope, against the shipped step on random paths.

use super::{cable, designed, model, ASKED};
use bowden::hysteresis::BoucWenState;
use bowden_rig::Noise;
use bowden_trials::design::{design, Slopes};

#[test]
fn no_step_of_the_shipped_transmission_has_a_slope_outside_and_both_ends_are_reached() {
    let mut dice = Noise::new(11);
    for _ in 0..60 {
        let mut within = |low: f64, high: f64| low + (high - low) * dice.uniform();
        let sign = if within(0.0, 1.0) < 0.2 { -1.0 } else { 1.0 };
        let numbers = [
            within(0.3, 1.2),
            sign * within(0.1, 8.0),
            0.1,
            within(0.05, 0.6),
            within(0.5, 6.0),
            within(1.0, 5.0),
        ];
        let cable = cable(numbers);
        let slopes = Slopes::of(&cable);
        let mut state = BoucWenState::new();
        let (mut u, mut before) = (0.0, cable.step(&mut state, 0.0));
        let mut seen = [f64::INFINITY, f64::NEG_INFINITY];
        for leg in 0..30 {
            // Every third leg saturates the loop; its first steps are short.
            let to: f64 = if leg % 3 == 0 {
                if u > 0.0 {
                    -400.0
                } else {
                    400.0
                }
            } else {
                within(-30.0, 30.0)
            };
            let towards = (to - u).signum();
            let mut step = 1e-4;
            while (to - u) * towards > 0.0 {
                let next = u + towards * step;
                let y = cable.step(&mut state, next);
                let slope = (y - before) / (next - u);
                // Rounding of y over a step of 1e-4: 400·2^-52/1e-4 = 1e-9.
                assert!(
                    slope > slopes.least - 1e-8 && slope < slopes.greatest + 1e-8,
                    "{numbers:?}: {slope} outside {slopes:?}"
                );
                seen = [seen[0].min(slope), seen[1].max(slope)];
                (u, before) = (next, y);
                step *= 1.3;
            }
        }
        // In 1e-4 N·m the slope changes by up to kappa·(2·sigma·rho)²·n·1e-4 from its ends.
        let width = slopes.greatest - slopes.least;
        assert!(
            seen[0] - slopes.least < 0.02 * width,
            "{numbers:?}: {seen:?} {slopes:?}"
        );
        assert!(
            slopes.greatest - seen[1] < 0.02 * width,
            "{numbers:?}: {seen:?} {slopes:?}"
        );
    }
}

#[test]
fn a_gain_that_reads_the_input_moves_both_slopes_and_a_delay_adds_to_the_delay() {
    let numbers = [0.9, 2.0, 0.0, 0.2, 0.6, 2.0];
    let plain = designed(numbers, &ASKED);
    let term = |effect: &str, gain: f64| {
        format!("[[terms]]\neffect = \"{effect}\"\nsource = \"input\"\ngain = {gain:?}\n")
    };
    let text = model(numbers, &term("gain", 0.05));
    let more = design(&text, "m.toml", &ASKED).unwrap();
    assert!((more.slopes.least - plain.slopes.least - 0.05).abs() < 1e-12);
    assert!((more.slopes.greatest - 0.95).abs() < 1e-12);
    let late = design(&model(numbers, &term("delay", 0.003)), "m.toml", &ASKED).unwrap();
    assert!((late.delay - 0.007).abs() < 1e-12);
    assert!(late.pi.k_i < plain.pi.k_i);
    let text = model(numbers, &term("rate", 0.01));
    let told = design(&text, "m.toml", &ASKED).unwrap();
    assert!(
        told.notes
            .iter()
            .any(|n| n.contains("do not include") && n.contains("rate")),
        "{told:?}"
    );
}
