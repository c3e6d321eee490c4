//! How the safe command goes out, and how it ends.

use super::*;

fn steps<C: Controller<f64>>(
    law: &C,
    state: &mut C::State,
    at: &LoopSample<f64>,
    n: u32,
) -> (f64, Status) {
    let mut out = (law.command(state), Status::Good);
    for _ in 0..n {
        let step = law.step(state, at);
        out = (step.command, step.status);
    }
    out
}

/// PI, PID and PIV.
fn pids() -> [Pid<f64>; 3] {
    let on_measurement = DerivativeSource::on_measurement();
    [
        pid(|_| ()),
        pid(|s| (s.k_d, s.damping, s.derivative_time) = (0.5, on_measurement, 0.01)),
        pid(|s| (s.k_d, s.damping) = (1.0, DerivativeSource::Velocity)),
    ]
}

/// Every law of a machine, next to how far the first command after the safe one may be from it: a
/// PID and the literal form start from it exactly, the lag moves by a share h·lambda = 0.008 of the
/// way to a command that lies within 100.
macro_rules! every_law {
    ($check:ident) => {
        for pid in pids() {
            $check(&pid, 1e-9);
        }
        for (law, way) in forms(|_| ()).iter().zip([1e-9, 0.8]) {
            $check(law, way);
        }
    };
}

fn is_safe_until_acknowledged<C: Controller<f64>>(law: &C, way: f64) {
    let mut state = law.start();
    let (running, _) = steps(law, &mut state, &good(), 500);
    assert!(running.abs() > 1.0, "{running}");
    let safe = (0.0, Status::Safe(Fault::Measured));
    let held = Status::Held(Fault::Measured);
    assert_eq!(steps(law, &mut state, &bad(), 19).1, held);
    assert_eq!(steps(law, &mut state, &bad(), 1), safe);
    // Good samples do not restart the motor, nor does another start.
    assert_eq!(steps(law, &mut state, &good(), 1000), safe);
    assert_eq!(law.resume_from(&mut state, 30.0, &good()), safe.1);
    assert_eq!(steps(law, &mut state, &good(), 1), safe);
    // It was seen, but the sensor is still dead.
    law.acknowledge(&mut state);
    assert_eq!(steps(law, &mut state, &bad(), 19), (0.0, held));
    assert_eq!(steps(law, &mut state, &bad(), 1), safe);
    law.acknowledge(&mut state);
    let (first, status) = steps(law, &mut state, &good(), 1);
    assert!(first.abs() < way && status == Status::Good, "{first}");
    let (again, _) = steps(law, &mut state, &good(), 2000);
    assert!(again.abs() > 1.0, "{again}");
}

#[test]
fn the_safe_command_stays_until_it_is_acknowledged() {
    every_law!(is_safe_until_acknowledged);
}

/// What somebody may do to a state between two samples.
type Call<'a, S> = &'a dyn Fn(&mut S);

/// From any state that is latched, one acknowledgement and one good sample close the loop, whatever
/// else was called in between.
fn one_good_sample_closes<C: Controller<f64>>(law: &C, reset: impl Fn(&C, &mut C::State)) {
    let restore = |state: &mut C::State| law.restore(state);
    let told = |state: &mut C::State| law.applied(state, Applied::Command(-3.0));
    let unknown = |state: &mut C::State| law.applied(state, Applied::AtUpperLimit);
    let bad = |state: &mut C::State| {
        for _ in 0..19 {
            law.step(state, &bad());
        }
    };
    let reset = |state: &mut C::State| reset(law, state);
    let nothing = |_: &mut C::State| {};
    let calls: [Call<C::State>; 6] = [&nothing, &restore, &told, &unknown, &bad, &reset];
    for before in calls {
        for after in calls {
            let mut state = law.start();
            steps(law, &mut state, &good(), 500);
            steps(law, &mut state, &super::bad(), 20);
            assert!(law.is_latched(&state));
            before(&mut state);
            let status = law.step(&mut state, &good()).status;
            assert!(matches!(status, Status::Safe(_)));
            law.acknowledge(&mut state);
            after(&mut state);
            assert_eq!(law.step(&mut state, &good()).status, Status::Good);
            // It stays closed, and works.
            let (command, status) = steps(law, &mut state, &good(), 2000);
            assert!(command.abs() > 1.0 && status == Status::Good, "{command}");
        }
    }
    // The same where nothing was latched.
    for call in calls {
        let mut state = law.start();
        steps(law, &mut state, &good(), 500);
        call(&mut state);
        assert_eq!(law.step(&mut state, &good()).status, Status::Good);
    }
}

#[test]
fn after_an_acknowledgement_the_first_good_sample_closes_the_loop() {
    for pid in pids() {
        one_good_sample_closes(&pid, |_, state| state.reset());
    }
    for own in forms(|_| ()) {
        one_good_sample_closes(&own, |law, state| state.reset(law));
    }
}

/// In which sample the safe command is out, of so many.
fn latched_at<C: Controller<f64>>(law: &C, most: u32, is_bad: fn(u32) -> bool) -> Option<u32> {
    let mut state = law.start();
    (1..=most).find(|&k| {
        let at = if is_bad(k - 1) { bad() } else { good() };
        matches!(law.step(&mut state, &at).status, Status::Safe(_))
    })
}

fn tells_how_many_are_too_many<C: Controller<f64>>(law: &C, _: f64) {
    assert_eq!(latched_at(law, 20_000, |k| k % 100 == 0), None);
    // Score 4·9 - 1 in ten samples: 80 is reached within the third ten.
    let late = latched_at(law, 1000, |k| k % 10 != 9);
    assert!(late.is_some_and(|k| (20..=30).contains(&k)), "{late:?}");
}

#[test]
fn nine_bad_samples_of_ten_are_too_many_and_one_in_a_hundred_is_no_reason_to_stop() {
    every_law!(tells_how_many_are_too_many);
}

fn refuses_a_wrapped_counter<C: Controller<f64>>(law: &C, _: f64) {
    let mut state = law.start();
    let (before, _) = steps(law, &mut state, &good(), 1);
    let wrapped = law.step(&mut state, &with(good(), |at| at.dt = 4295.0));
    let held = Status::Held(Fault::DtTooLong);
    assert_eq!((wrapped.command, wrapped.status), (before, held));
}

#[test]
fn a_wrapped_counter_is_no_sample_and_the_longest_dt_that_was_stated_is_one() {
    every_law!(refuses_a_wrapped_counter);
    let late = with(good(), |at| at.dt = LONGEST);
    assert_eq!(
        Controller::step(&pid(|_| ()), &mut PidState::new(), &late).status,
        Status::Good
    );
}

#[test]
fn without_an_integral_gain_no_old_command_stays_in_the_sum() {
    let (law, mut state) = (pid(|s| s.k_i = 0.0), PidState::new());
    let (before, _) = steps(&law, &mut state, &good(), 10);
    steps(&law, &mut state, &bad(), 20);
    state.acknowledge();
    // From the safe command on; what it differs by is gone to the last bit after 40 time constants
    // of 1 s: e^-40 is below half an ulp of 1.
    assert_eq!(steps(&law, &mut state, &good(), 1), (0.0, Status::Good));
    let samples = (40.0 / DT) as u32;
    let end = steps(&law, &mut state, &good(), samples);
    assert_eq!(end, (before, Status::Good));
}

#[test]
fn a_loop_without_a_safe_command_holds_for_ever_and_says_so_by_its_name() {
    let law = pid(|s| s.fallback = Fallback::hold_indefinitely());
    let mut state = PidState::new();
    let (before, _) = steps(&law, &mut state, &good(), 500);
    let held = (before, Status::Held(Fault::Measured));
    assert_eq!(steps(&law, &mut state, &bad(), 100_000), held);
    assert_eq!(steps(&law, &mut state, &good(), 1).1, Status::Good);
}

/// What the output did before the fault says nothing of what it does after it.
#[test]
fn after_a_fault_a_pd_starts_without_the_rate_from_before_it() {
    let pid = pid(|s| {
        (s.k_p, s.k_i, s.k_d) = (1.0, 0.0, 0.1);
        (s.damping, s.derivative_time) = (DerivativeSource::on_measurement(), 0.02);
    });
    let mut state = PidState::new();
    for k in 0..200 {
        // 300 a second, ahead of which the reference stays.
        let y = 0.3 * f64::from(k);
        pid.step(&mut state, &PidInput::new(DT, y, y));
    }
    for _ in 0..10_000 {
        pid.step(&mut state, &PidInput::new(DT, 0.0, f64::NAN));
    }
    assert!(state.is_latched());
    state.acknowledge();
    for _ in 0..2 {
        let out = pid.step(&mut state, &PidInput::new(DT, 0.0, 0.0));
        assert_eq!((out.status, out.command), (Status::Good, 0.0));
    }
}
