//! A law that is told what the drive did with its command.

use super::{lag, literal};
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Applied, Estimator, Limits, Status,
};

/// Room for the rounding of a few sums and products of numbers up to 100.
const ROUNDING: f64 = 1e-12;

/// The plant of a form, one sample later: the lag form's answers within a sample.
fn plant(is_lag: bool, y: f64, sent: f64) -> f64 {
    if is_lag {
        sent
    } else {
        y + 0.001 * (sent - y) / 0.1
    }
}

fn settings(is_lag: bool) -> AdaptiveSettings<f64, 1> {
    if is_lag {
        lag()
    } else {
        literal()
    }
}

/// A drive that is off for two seconds, from a loop that has settled: every command next to what
/// went out before it, and the output.
fn off_for_two_seconds(
    law: &Adaptive<f64, 1>,
    is_lag: bool,
    tell: bool,
    mut see: impl FnMut(u32, f64, f64, f64),
) {
    let (mut state, mut y, mut last) = (AdaptiveState::new(law), 0.0, 0.0);
    for k in 0..12_000 {
        let out = law.step(&mut state, &AdaptiveInput::new(0.001, 20.0, y, [0.0]));
        assert_eq!(out.status, Status::Good);
        let sent = if (4000..6000).contains(&k) {
            0.0
        } else {
            out.command
        };
        if tell {
            state.applied(Applied::Command(sent));
        }
        see(k, out.command, last, y);
        last = sent;
        y = plant(is_lag, y, sent);
    }
}

#[test]
fn after_the_drive_was_off_the_slew_rate_counts_from_what_went_out() {
    for is_lag in [false, true] {
        let limits = Limits::try_new(-60.0, 60.0).unwrap();
        let law = Adaptive::try_new(AdaptiveSettings {
            limits: limits.with_slew(400.0).unwrap(),
            ..settings(is_lag)
        })
        .unwrap();
        let mut end = 0.0;
        off_for_two_seconds(&law, is_lag, true, |k, command, last, y| {
            // 400/s for 1 ms, and an ulp of 60.
            assert!((command - last).abs() <= 0.4 + 1e-14, "{is_lag} {k}");
            end = y;
        });
        // It comes back to the reference.
        assert!((end - 20.0).abs() < 0.05, "{is_lag}: {end}");
    }
}

#[test]
fn a_drive_that_was_off_does_not_wind_the_law_up() {
    for is_lag in [false, true] {
        // Limits that are not met hide no wind-up.
        let limits = Limits::try_new(-1e5, 1e5).unwrap();
        let law = Adaptive::try_new(AdaptiveSettings {
            limits,
            ..settings(is_lag)
        })
        .unwrap();
        let overshoot = |tell: bool| {
            let (mut most, mut end) = (0.0_f64, 0.0);
            off_for_two_seconds(&law, is_lag, tell, |k, _, _, y| {
                if k > 6000 {
                    most = most.max(y - 20.0);
                }
                end = y;
            });
            (most, end)
        };
        let ((told, end), (untold, _)) = (overshoot(true), overshoot(false));
        assert!((end - 20.0).abs() < 0.05, "{is_lag}: {end}");
        // Untold, z has grown by 20 N·m for 2 s. Told, the overshoot is that of a start.
        assert!(untold > 100.0 && told < 10.0, "{is_lag}: {told} {untold}");
    }
}

fn moved(state: &AdaptiveState<f64, 1>, before: &AdaptiveState<f64, 1>) -> (bool, bool) {
    let z = state.accumulated_error() != before.accumulated_error();
    let each = [
        state.beta_hat() != before.beta_hat(),
        state.delta_hat() != before.delta_hat(),
        state.theta_hat() != before.theta_hat(),
    ];
    assert!(each == [true; 3] || each == [false; 3], "{each:?}");
    (z, each[0])
}

#[test]
fn z_and_the_estimates_wait_only_in_the_drives_direction_and_only_for_one_sample() {
    for is_lag in [false, true] {
        let law = Adaptive::try_new(settings(is_lag)).unwrap();
        let mut state = AdaptiveState::new(&law);
        for _ in 0..10 {
            law.step(&mut state, &AdaptiveInput::new(0.001, 5.0, 5.1, [0.3]));
        }
        let out = state.command();
        for (told, upper) in [
            (Applied::AtUpperLimit, true),
            (Applied::AtLowerLimit, false),
            (Applied::Command(out - 1.0), true),
            (Applied::Command(out + 1.0), false),
        ] {
            for too_low in [true, false] {
                let mut state = state;
                state.applied(told);
                // e and s have the same sign: z is 0.001.
                let measured = if too_low { 4.0 } else { 6.0 };
                let at = AdaptiveInput::new(0.001, 5.0, measured, [0.3]);
                // A bad sample forgets nothing.
                let bad = AdaptiveInput {
                    measured: f64::NAN,
                    ..at
                };
                let status = law.step(&mut state, &bad).status;
                assert!(matches!(status, Status::Held(_) | Status::Safe(_)));
                let before = state;
                assert_eq!(law.step(&mut state, &at).status, Status::Good);
                let waits = too_low == upper;
                assert_eq!(
                    moved(&state, &before),
                    (!waits, !waits),
                    "{told:?} {too_low}"
                );
                let before = state;
                law.step(&mut state, &at);
                assert_eq!(moved(&state, &before), (true, true), "{told:?} {too_low}");
            }
        }
    }
}

#[test]
fn the_lag_continues_from_the_command_that_went_out_less_the_feed_forward() {
    let law = Adaptive::try_new(lag()).unwrap();
    for reset in [false, true] {
        let mut state = AdaptiveState::new(&law);
        let feed_forward = if reset { 0.0 } else { 4.0 };
        let at = AdaptiveInput {
            feed_forward,
            ..AdaptiveInput::new(0.001, 30.0, 29.0, [0.1])
        };
        for _ in 0..300 {
            law.step(&mut state, &at);
        }
        if reset {
            state.reset(&law);
        }
        assert!(state.command() > 5.0);
        for told in [30.0, -7.0] {
            state.applied(Applied::Command(told));
            assert_eq!(state.command(), told);
        }
        let terms = law.step_with_terms(&mut state, &at).terms;
        let start = -7.0 - feed_forward;
        let expected = start + 0.008 * (terms.beta_hat * terms.virtual_command - start);
        assert!((terms.law - expected).abs() < ROUNDING, "{terms:?}");
        assert!((state.command() - expected - feed_forward).abs() < ROUNDING);
    }
}

#[test]
fn what_is_no_number_or_no_news_changes_nothing() {
    for is_lag in [false, true] {
        let law = Adaptive::try_new(settings(is_lag)).unwrap();
        let mut state = AdaptiveState::new(&law);
        law.step(&mut state, &AdaptiveInput::new(0.001, 5.0, 4.0, [0.3]));
        let before = state;
        for told in [
            Applied::AsCommanded,
            Applied::Command(f64::NAN),
            Applied::Command(f64::NEG_INFINITY),
            Applied::Command(state.command()),
        ] {
            state.applied(told);
            assert_eq!(state, before);
        }
    }
}

/// A drive that gives 10 of the 40 that are wanted; then the reference falls below that.
#[test]
fn the_command_of_a_drive_that_limits_itself_falls_with_the_reference() {
    for told in [Applied::Command(10.0), Applied::AtUpperLimit] {
        for is_lag in [false, true] {
            let limits = Limits::try_new(-60.0, 60.0).unwrap();
            let fixed = |e: Estimator<f64>| Estimator { gain: 0.0, ..e };
            let settings = settings(is_lag);
            let law = Adaptive::try_new(AdaptiveSettings {
                limits,
                gain: 0.1,
                delta: fixed(Estimator::fixed(0.0)),
                ..settings
            })
            .unwrap();
            let mut state = AdaptiveState::new(&law);
            for _ in 0..5000 {
                let out = law.step(&mut state, &AdaptiveInput::new(0.001, 40.0, 10.0, [0.0]));
                if out.command > 10.0 {
                    state.applied(told);
                }
            }
            // z has not grown after the command was above 10: at the first sample of the literal
            // form, where beta_hat·y_r is 36 at least; in the lag form 1/lambda·ln(36/26) later.
            let z = state.accumulated_error();
            assert!(z > -30.0 * 0.05, "{told:?} {is_lag}: {z}");
            // From 40 to 5: below the drive's limit within three times the lag of the form.
            let mut samples = 0;
            while law
                .step(&mut state, &AdaptiveInput::new(0.001, 5.0, 10.0, [0.0]))
                .command
                >= 10.0
            {
                samples += 1;
                assert!(samples <= 375, "{told:?} {is_lag} {}", state.command());
            }
        }
    }
}
