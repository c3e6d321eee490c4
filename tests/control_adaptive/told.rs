//! A law that is told what the drive did with its command.

use super::*;

/// The plant of a form, one sample later: the lag form's answers within a sample.
fn plant(law: &Adaptive<f64, 1>, y: f64, sent: f64) -> f64 {
    match law.settings().form {
        Form::FirstOrder { .. } => sent,
        Form::AsPublished { .. } => y + 0.001 * (sent - y) / 0.1,
    }
}

/// A drive that is off for two seconds, from a loop that has settled: every command next to what
/// went out before it, and the output.
fn off_for_two_seconds(
    law: &Adaptive<f64, 1>,
    tell: bool,
    mut see: impl FnMut(u32, f64, f64, f64),
) {
    let (mut state, mut y, mut last) = (AdaptiveState::new(law), 0.0, 0.0);
    for k in 0..12_000 {
        let out = law.step(&mut state, &at(20.0, y, 0.0));
        assert_eq!(out.status, Status::Good);
        let is_off = (4000..6000).contains(&k);
        let sent = if is_off { 0.0 } else { out.command };
        if tell {
            state.applied(Applied::Command(sent));
        }
        see(k, out.command, last, y);
        last = sent;
        y = plant(law, y, sent);
    }
    // It comes back to the reference.
    assert!(!tell || (y - 20.0).abs() < 0.05, "{y}");
}

#[test]
fn after_the_drive_was_off_the_slew_rate_counts_from_what_went_out() {
    for settings in both() {
        let law = law(settings, |s| {
            s.limits = range(-60.0, 60.0).with_slew(400.0).unwrap()
        });
        off_for_two_seconds(&law, true, |k, command, last, _| {
            // 400/s for 1 ms, and an ulp of 60.
            assert!((command - last).abs() <= 0.4 + 1e-14, "{k}");
        });
    }
}

#[test]
fn a_drive_that_was_off_does_not_wind_the_law_up() {
    for settings in both() {
        // Limits that are not met hide no wind-up.
        let law = law(settings, |s| s.limits = range(-1e5, 1e5));
        let [told, untold] = [true, false].map(|tell| {
            let mut most = 0.0_f64;
            off_for_two_seconds(&law, tell, |k, _, _, y| {
                most = most.max(if k > 6000 { y - 20.0 } else { 0.0 });
            });
            most
        });
        // Untold, z has grown by 20 N·m for 2 s. Told, the overshoot is that of a start.
        assert!(untold > 100.0 && told < 10.0, "{told} {untold}");
    }
}

fn moved(state: &State, before: &State) -> (bool, bool) {
    let z = state.accumulated_error() != before.accumulated_error();
    let (now, then) = (estimates(state), estimates(before));
    let each = [0, 1, 2].map(|i| now[i] != then[i]);
    assert!(each == [true; 3] || each == [false; 3], "{each:?}");
    (z, each[0])
}

#[test]
fn z_and_the_estimates_wait_only_in_the_drives_direction_and_only_for_one_sample() {
    for settings in both() {
        let law = law(settings, |_| ());
        let mut start = AdaptiveState::new(&law);
        for _ in 0..10 {
            law.step(&mut start, &at(5.0, 5.1, 0.3));
        }
        let out = start.command();
        let all = [
            (Applied::AtUpperLimit, true),
            (Applied::AtLowerLimit, false),
            (Applied::Command(out - 1.0), true),
            (Applied::Command(out + 1.0), false),
        ];
        // e and s have the same sign: z is 0.001.
        let samples = [(true, at(5.0, 4.0, 0.3)), (false, at(5.0, 6.0, 0.3))];
        for ((told, upper), (too_low, at)) in
            all.into_iter().flat_map(|it| samples.map(|at| (it, at)))
        {
            let mut state = start;
            state.applied(told);
            // A bad sample forgets nothing.
            let status = law.step(&mut state, &lost(at)).status;
            assert!(matches!(status, Status::Held(_) | Status::Safe(_)));
            let moves = too_low != upper;
            for expected in [(moves, moves), (true, true)] {
                let before = state;
                assert_eq!(law.step(&mut state, &at).status, Status::Good);
                assert_eq!(moved(&state, &before), expected, "{told:?} {too_low}");
            }
        }
    }
}

#[test]
fn the_lag_continues_from_the_command_that_went_out_less_the_feed_forward() {
    let law = law(lag(), |_| ());
    for (reset, feed_forward) in [(false, 4.0), (true, 0.0)] {
        let mut state = AdaptiveState::new(&law);
        let at = with(at(30.0, 29.0, 0.1), |at| at.feed_forward = feed_forward);
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
        let expected = lagged(-7.0 - feed_forward, &terms);
        near(terms.law, expected, ROUNDING);
        near(state.command(), expected + feed_forward, ROUNDING);
    }
}

#[test]
fn what_is_no_number_or_no_news_changes_nothing() {
    for settings in both() {
        let law = law(settings, |_| ());
        let mut state = AdaptiveState::new(&law);
        law.step(&mut state, &at(5.0, 4.0, 0.3));
        let before = state;
        let commands = [f64::NAN, f64::NEG_INFINITY, before.command()].map(Applied::Command);
        for told in commands.into_iter().chain([Applied::AsCommanded]) {
            state.applied(told);
            assert_eq!(state, before);
        }
    }
}

/// A drive that gives 10 of the 40 that are wanted; then the reference falls below that.
#[test]
fn the_command_of_a_drive_that_limits_itself_falls_with_the_reference() {
    let tolds = [Applied::Command(10.0), Applied::AtUpperLimit];
    for (told, settings) in tolds
        .into_iter()
        .flat_map(|told| both().map(|own| (told, own)))
    {
        let law = law(settings, |s| {
            (s.limits, s.gain) = (range(-60.0, 60.0), 0.1);
            s.delta = Estimator::fixed(0.0);
        });
        let mut state = AdaptiveState::new(&law);
        for _ in 0..5000 {
            if law.step(&mut state, &at(40.0, 10.0, 0.0)).command > 10.0 {
                state.applied(told);
            }
        }
        // z has not grown after the command was above 10: at the first sample of the literal
        // form, where beta_hat·y_r is 36 at least; in the lag form 1/lambda·ln(36/26) later.
        let z = state.accumulated_error();
        assert!(z > -30.0 * 0.05, "{told:?}: {z}");
        // From 40 to 5: below the drive's limit within three times the lag of the form.
        let falls = (0..=375).any(|_| law.step(&mut state, &at(5.0, 10.0, 0.0)).command < 10.0);
        assert!(falls, "{told:?} {}", state.command());
    }
}
