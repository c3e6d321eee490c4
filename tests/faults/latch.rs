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

/// Every law of a machine: one trait over all of them; the lag form last.
fn every_law() -> Vec<Box<dyn Runs>> {
    let pids = pids().map(|pid| Box::new(Running::new(pid)) as Box<dyn Runs>);
    let forms = forms(|_| ()).map(|law| Box::new(Running::new(law)) as Box<dyn Runs>);
    pids.into_iter().chain(forms).collect()
}

/// A law with its state.
struct Running<C: Controller<f64>> {
    law: C,
    state: C::State,
}

impl<C: Controller<f64>> Running<C> {
    fn new(law: C) -> Self {
        let state = law.start();
        Self { law, state }
    }
}

trait Runs {
    fn run(&mut self, at: &LoopSample<f64>, n: u32) -> (f64, Status);
    fn acknowledge(&mut self);
    fn resume(&mut self, output: f64) -> Status;
}

impl<C: Controller<f64>> Runs for Running<C> {
    fn run(&mut self, at: &LoopSample<f64>, n: u32) -> (f64, Status) {
        steps(&self.law, &mut self.state, at, n)
    }
    fn acknowledge(&mut self) {
        self.law.acknowledge(&mut self.state);
    }
    fn resume(&mut self, output: f64) -> Status {
        self.law.resume_from(&mut self.state, output, &good())
    }
}

#[test]
fn the_safe_command_stays_until_it_is_acknowledged() {
    for (kind, mut law) in every_law().into_iter().enumerate() {
        let (running, _) = law.run(&good(), 500);
        assert!(running.abs() > 1.0, "{kind}: {running}");
        let safe = (0.0, Status::Safe(Fault::Measured));
        let held = Status::Held(Fault::Measured);
        assert_eq!(law.run(&bad(), 19).1, held);
        assert_eq!(law.run(&bad(), 1), safe);
        // Good samples do not restart the motor, nor does another start.
        assert_eq!(law.run(&good(), 1000), safe, "{kind}");
        assert_eq!(law.resume(30.0), safe.1);
        assert_eq!(law.run(&good(), 1), safe);
        // It was seen, but the sensor is still dead.
        law.acknowledge();
        assert_eq!(law.run(&bad(), 19), (0.0, held));
        assert_eq!(law.run(&bad(), 1), safe);
        law.acknowledge();
        let (first, status) = law.run(&good(), 1);
        assert_eq!(status, Status::Good);
        // From the safe command on: a PID and the literal form exactly, the lag by a share
        // h·lambda = 0.008 of the way to a command that lies within 100.
        let way = if kind == 4 { 0.8 } else { 1e-9 };
        assert!(first.abs() < way, "{kind}: {first}");
        let (again, _) = law.run(&good(), 2000);
        assert!(again.abs() > 1.0, "{kind}: {again}");
    }
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
            assert!(matches!(
                law.step(&mut state, &good()).status,
                Status::Safe(_)
            ));
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

#[test]
fn nine_bad_samples_of_ten_are_too_many_and_one_in_a_hundred_is_no_reason_to_stop() {
    let latched_at = |law: &mut Box<dyn Runs>, most: u32, is_bad: fn(u32) -> bool| {
        (1..=most).find(|&k| {
            let at = if is_bad(k - 1) { bad() } else { good() };
            matches!(law.run(&at, 1).1, Status::Safe(_))
        })
    };
    for mut law in every_law() {
        assert_eq!(latched_at(&mut law, 20_000, |k| k % 100 == 0), None);
        // Score 4·9 - 1 in ten samples: 80 is reached within the third ten.
        let late = latched_at(&mut law, 1000, |k| k % 10 != 9);
        assert!(late.is_some_and(|k| (20..=30).contains(&k)), "{late:?}");
    }
}

#[test]
fn a_wrapped_counter_is_no_sample_and_the_longest_dt_that_was_stated_is_one() {
    for mut law in every_law() {
        let (before, _) = law.run(&good(), 1);
        let wrapped = law.run(&with(good(), |at| at.dt = 4295.0), 1);
        assert_eq!(wrapped, (before, Status::Held(Fault::DtTooLong)));
    }
    let mut law = Running::new(pid(|_| ()));
    let late = with(good(), |at| at.dt = LONGEST);
    assert_eq!(law.run(&late, 1).1, Status::Good);
}

#[test]
fn without_an_integral_gain_no_old_command_stays_in_the_sum() {
    let mut law = Running::new(pid(|s| s.k_i = 0.0));
    let (before, _) = law.run(&good(), 10);
    law.run(&bad(), 20);
    law.acknowledge();
    // From the safe command on; what it differs by is gone to the last bit after 40 time constants
    // of 1 s: e^-40 is below half an ulp of 1.
    assert_eq!(law.run(&good(), 1), (0.0, Status::Good));
    let samples = (40.0 / DT) as u32;
    assert_eq!(law.run(&good(), samples), (before, Status::Good));
}

#[test]
fn a_loop_without_a_safe_command_holds_for_ever_and_says_so_by_its_name() {
    let mut law = Running::new(pid(|s| s.fallback = Fallback::hold_indefinitely()));
    let (before, _) = law.run(&good(), 500);
    let held = (before, Status::Held(Fault::Measured));
    assert_eq!(law.run(&bad(), 100_000), held);
    assert_eq!(law.run(&good(), 1).1, Status::Good);
}

proptest! {
    /// The promise in the docs of `Fallback`: whatever the order of good and bad samples, the
    /// safe command is out when a stretch of n of them has held B bad ones with
    /// (weight + 1)·B - n >= after·weight, and a sum over every stretch says when that is.
    #[test]
    fn the_safe_command_is_out_no_later_than_stated(
        samples in prop::collection::vec(any::<bool>(), 1..400),
        after in 1_u32..12,
        weight in 1_u32..9,
    ) {
        let fallback = Fallback::try_new(after, 0.0).unwrap().with_weight(weight).unwrap();
        let mut law = Running::new(pid(|s| s.fallback = fallback));
        let mut latched = false;
        for (end, &is_bad) in samples.iter().enumerate() {
            let at = if is_bad { bad() } else { good() };
            latched |= matches!(law.run(&at, 1).1, Status::Safe(_));
            let late = (0..=end).any(|begin| {
                let stretch = &samples[begin..=end];
                let bad = stretch.iter().filter(|bad| **bad).count() as i64;
                i64::from(weight + 1) * bad - stretch.len() as i64 >= i64::from(after * weight)
            });
            prop_assert!(latched || !late);
        }
    }
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
