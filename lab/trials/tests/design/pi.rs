//! The shipped PI and PID around the shipped transmission, behind a delay.

use super::{cable, designed, rising, Numbers, ASKED};
use bowden::control::{AntiWindup, Pid, PidInput, PidSettings, PidState};
use bowden::hysteresis::BoucWenState;
use bowden_rig::Noise;
use bowden_trials::design::Question;

/// The errors of a step of the reference from where the loop is at rest \[N·m\].
fn errors(
    numbers: Numbers,
    settings: PidSettings<f64>,
    (asked, delay): (&Question, usize),
    references: &[f64],
) -> Vec<f64> {
    let pid = Pid::try_new(settings).unwrap();
    let (cable, mut cable_state, mut state) =
        (cable(numbers), BoucWenState::new(), PidState::new());
    let mut commands = std::collections::VecDeque::from(vec![0.0; delay]);
    let mut errors = Vec::new();
    for reference in references {
        for _ in 0..150 * (delay + 1) {
            // The command of `delay` samples ago has just been measured.
            let u = commands.pop_front().unwrap();
            let y = cable.step(&mut cable_state, asked.drive_gain * u);
            let at = PidInput::new(1.0 / asked.rate, *reference, y);
            commands.push_back(pid.step(&mut state, &at).command);
            errors.push(y - reference);
        }
    }
    errors
}

/// The settings without limits, times a factor.
fn free(settings: &PidSettings<f64>, factor: f64) -> PidSettings<f64> {
    PidSettings {
        k_p: factor * settings.k_p,
        k_i: factor * settings.k_i,
        k_d: factor * settings.k_d,
        damping: settings.damping,
        derivative_time: settings.derivative_time,
        anti_windup: AntiWindup::Conditional,
        ..PidSettings::unlimited(0.0, 0.0)
    }
}

#[test]
fn a_step_settles_without_much_overshoot_on_cables_of_every_shape_and_delay() {
    let mut dice = Noise::new(5);
    for delay in [0.0, 0.0008, 0.002, 0.0055, 0.012] {
        for _ in 0..6 {
            let numbers = rising(&mut dice);
            let asked = Question {
                delay,
                drive_gain: 0.6,
                ..ASKED
            };
            let own = designed(numbers, &asked);
            let count = own.delay_samples;
            assert!(count as f64 > delay * asked.rate);
            assert!(
                own.pi.margins.gain >= 2.0 && own.pi.margins.phase >= 45.0,
                "{own:?}"
            );
            let steps = [3.0, 9.0, 5.0, -6.0];
            let errors = errors(numbers, free(&own.gains.pi, 1.0), (&asked, count), &steps);
            let length = errors.len() / steps.len();
            for (k, part) in errors.chunks(length).enumerate() {
                let before = if k == 0 { 0.0 } else { steps[k - 1] };
                let step: f64 = steps[k] - before;
                let over = part.iter().map(|e| e * step.signum()).fold(0.0, f64::max);
                // 5 % of a linear step were asked; the slope rises while the loop is under way,
                // by up to five times here, so that the end of a step is faster than its start.
                assert!(
                    over < 0.15 * step.abs(),
                    "{numbers:?} {delay}: {over} of {step}"
                );
                let last = &part[length - 10..];
                let rest = last.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
                assert!(
                    rest < 0.02 * step.abs(),
                    "{numbers:?} {delay}: {rest} of {step}"
                );
            }
        }
    }
}

#[test]
fn gains_beyond_the_margin_make_the_loop_unstable() {
    let mut dice = Noise::new(6);
    for delay in [0.0, 0.0008, 0.0055] {
        for _ in 0..3 {
            let numbers = rising(&mut dice);
            let asked = Question { delay, ..ASKED };
            let own = designed(numbers, &asked);
            // On the slope of the design: a cable without hysteresis.
            let straight = [own.design_slope, 0.0, 0.0, 0.1, 0.6, 2.0];
            let run = |factor: f64| {
                let settings = free(&own.gains.pi, factor);
                let all = errors(straight, settings, (&asked, own.delay_samples), &[1.0]);
                let last = &all[all.len() - 20..];
                last.iter().fold(0.0_f64, |m, e| m.max(e.abs()))
            };
            let margin = own.pi.margins.gain;
            assert!(run(0.97 * margin) < 1.0, "{own:?}");
            assert!(run(1.03 * margin) > 1.0, "{own:?}");
            assert!(run(2.0 * margin) > 1e6, "{own:?}");
            // The cable itself saturates, so that its slope is the greatest: it runs away too.
            let settings = free(&own.gains.pi, 2.0 * margin);
            let all = errors(numbers, settings, (&asked, own.delay_samples), &[5.0]);
            let worst = all.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
            assert!(worst > 1e6, "{numbers:?}: {worst}");
        }
    }
}

#[test]
fn neither_gain_can_be_raised_to_what_is_called_inadmissible() {
    let own = designed([0.9, 2.0, 0.0, 0.2, 0.6, 2.0], &ASKED);
    assert!(own.pi.k_p < own.admissible.k_p);
    assert!((own.pi.k_i - own.admissible.k_i).abs() < 1e-9 * own.pi.k_i);
    assert!(own.admissible.k_i_alone < own.admissible.k_i);
    // A proportional gain of 1/slope alone is on the border of stability: half of it is told.
    assert!((own.admissible.k_p * own.design_slope - 0.5).abs() < 1e-12);
}

#[test]
fn the_gains_do_not_depend_on_the_unit_of_time_and_go_with_the_drive() {
    let numbers = [0.9, 2.0, 0.0, 0.2, 0.6, 2.0];
    let fast = designed(numbers, &ASKED);
    let slow = Question {
        rate: 100.0,
        delay: 0.04,
        drive_gain: 2.0,
        ..ASKED
    };
    let slow = designed(numbers, &slow);
    assert!((fast.pi.k_p / slow.pi.k_p - 2.0).abs() < 1e-9);
    assert!((fast.pi.k_i / slow.pi.k_i - 20.0).abs() < 1e-9);
    // Behind a long delay the search is that of a shorter one, to within its last samples.
    let long = Question {
        delay: 0.1,
        ..ASKED
    };
    let long = designed(numbers, &long);
    assert_eq!(long.delay_samples, 101);
    let per_delay = |own: &bowden_trials::design::Designed, rate: f64| {
        own.pi.k_i * own.delay_samples as f64 / rate
    };
    assert!((per_delay(&long, 1000.0) / per_delay(&fast, 1000.0) - 1.0).abs() < 0.3);
    assert!(long.pi.margins.gain >= 2.0 && long.pi.overshoot <= 0.05);
}

#[test]
fn the_slew_rate_cuts_no_noise_and_the_limits_are_what_the_record_has_covered() {
    let asked = Question {
        noise: 0.05,
        drive_gain: 0.5,
        ..ASKED
    };
    let own = designed([0.9, 2.0, 0.0, 0.2, 0.6, 2.0], &asked);
    let b = own.bounds;
    assert_eq!((b.low, b.high, b.slew_of_record), (-40.0, 40.0, 80.0));
    // The largest change between two samples is below six times the rms.
    assert!(b.slew_of_noise > 2.0 * own.pi.k_p * 6.0 * asked.noise * asked.rate);
    assert!(b.slew >= b.slew_of_noise && b.slew >= b.slew_of_record);
    assert!((b.reference_rate.unwrap() - own.slopes.least * 40.0).abs() < 1e-9);
    let pid = Pid::try_new(own.gains.pi).unwrap();
    let (mut state, mut dice) = (PidState::new(), Noise::new(3));
    for _ in 0..20_000 {
        let at = PidInput::new(1e-3, 0.0, asked.noise * dice.normal::<f64>());
        pid.step(&mut state, &at);
        assert!(!pid.terms(&state).saturated);
    }
}

#[test]
fn a_loop_at_the_longest_dt_still_settles() {
    let numbers = [0.9, 2.0, 0.0, 0.2, 0.6, 2.0];
    for delay in [0.0, 0.001, 0.004, 0.02] {
        let asked = Question { delay, ..ASKED };
        let own = designed(numbers, &asked);
        let ratio = own.bounds.longest_dt * asked.rate;
        assert!((1.25..=5.0).contains(&ratio), "{ratio}");
        let slow = Question {
            rate: asked.rate / ratio,
            ..asked
        };
        let count = (delay / own.bounds.longest_dt + 1e-9).floor() as usize + 1;
        let all = errors(numbers, free(&own.gains.pi, 1.0), (&slow, count), &[5.0]);
        assert!(all[all.len() - 1].abs() < 0.1, "{delay}: {ratio}");
    }
}

#[test]
fn a_loop_at_the_longest_dt_keeps_its_gain_margin() {
    // Without hysteresis the cable has one slope, for which the margin is stated.
    let numbers = [0.9, 0.0, 0.0, 0.2, 0.6, 2.0];
    for delay in [0.0, 0.0005, 0.001, 0.004, 0.02] {
        let asked = Question { delay, ..ASKED };
        let own = designed(numbers, &asked);
        let slow = Question {
            rate: 1.0 / own.bounds.longest_dt,
            ..asked
        };
        let count = (delay / own.bounds.longest_dt + 1e-9).floor() as usize + 1;
        let all = errors(numbers, free(&own.gains.pi, 1.38), (&slow, count), &[5.0]);
        let last = all.iter().rev().take(10 * count);
        let last = last.fold(0.0, |most: f64, e| most.max(e.abs()));
        assert!(last < 5.0, "{delay}: {last}");
    }
}
