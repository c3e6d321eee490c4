//! States of controllers that were stored: what earlier versions wrote is read.

use super::*;

/// A state that was stored while bad samples were remembered, and one that earlier versions stored
/// as merely closed: a good sample takes one off the score of both.
#[test]
fn a_stored_state_goes_on_with_its_score() {
    fn goes_on<S>(state: S, counter: fn(&S) -> u32, step: impl Fn(&mut S))
    where
        S: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug,
    {
        let stored = serde_json::to_string(&state).unwrap();
        for text in [stored.clone(), stored.replace("counting", "closed")] {
            let mut read: S = serde_json::from_str(&text).unwrap();
            assert_eq!((&read, counter(&read)), (&state, 4));
            step(&mut read);
            assert_eq!(counter(&read), 3);
        }
    }
    let law = Adaptive::<f64, 2>::paper();
    let mut state = AdaptiveState::new(&law);
    let good = AdaptiveInput::new(1e-3, 1.0, 0.5, [0.1, 0.2]);
    law.step(&mut state, &with(good, |at| at.dt = 0.0));
    goes_on(
        state,
        |own| own.fault_counter(),
        |own| {
            law.step(own, &good);
        },
    );
    let (pid, mut state) = (Pid::paper_pi(), PidState::<f64>::new());
    let good = PidInput::new(1e-3, 1.0, 0.5);
    pid.step(&mut state, &with(good, |at| at.dt = 0.0));
    goes_on(
        state,
        |own| own.fault_counter(),
        |own| {
            pid.step(own, &good);
        },
    );
}

#[test]
fn learning_that_was_stored_in_the_middle_of_a_cycle_learns_on_as_if_it_had_not_been() {
    let own = IterativeLearning::try_new(4.0, 1e6, 2, 2).unwrap();
    let mut state = own.start(vec![0.0; 40], vec![0.0; 40]).unwrap();
    let at = |k: u32| {
        let phase = f64::from(k % 400) / 400.0;
        IterativeLearningInput::new(phase, (f64::from(k) * 0.05).sin(), 0.0)
    };
    for k in 0..573 {
        own.step(&mut state, &at(k));
    }
    let text = serde_json::to_string(&state).unwrap();
    let mut stored: IterativeLearningState<f64, Vec<f64>> = serde_json::from_str(&text).unwrap();
    assert_eq!(stored, state);
    for k in 573..1400 {
        assert_eq!(own.step(&mut stored, &at(k)), own.step(&mut state, &at(k)));
    }
    assert_eq!(stored, state);
}

/// What the drive did counts for one good sample, also where the state is stored before or after it.
#[test]
fn an_adaptive_law_that_was_stored_steps_as_if_it_had_not_been_after_the_drive_was_told_of() {
    let law = Adaptive::<f64, 2>::paper();
    let mut state = AdaptiveState::new(&law);
    let good = AdaptiveInput::new(1e-3, 1.0, 0.5, [0.1, 0.2]);
    law.step(&mut state, &good);
    state.applied(Applied::AtUpperLimit);
    for samples in 0..3 {
        let text = serde_json::to_string(&state).unwrap();
        let mut read: AdaptiveState<f64, 2> = serde_json::from_str(&text).unwrap();
        assert_eq!(law.step(&mut read, &good), law.step(&mut state, &good));
        assert_eq!(read, state, "{samples}");
        // The drive's limit keeps z for the first sample, and for no other.
        assert_eq!(state.accumulated_error() == -0.5e-3, samples == 0);
    }
}
