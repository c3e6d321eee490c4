//! States of controllers that were stored: what earlier versions wrote is read.
#![allow(clippy::unwrap_used)]

use bowden::control::{Adaptive, AdaptiveInput, AdaptiveState, Pid, PidInput, PidState};

/// A state that was stored while bad samples were remembered, and one that earlier versions stored
/// as merely closed: a good sample takes one off the score of both.
#[test]
fn a_stored_state_goes_on_with_its_score() {
    let law = Adaptive::<f64, 2>::paper();
    let mut state = AdaptiveState::new(&law);
    let good = AdaptiveInput::new(1e-3, 1.0, 0.5, [0.1, 0.2]);
    law.step(&mut state, &AdaptiveInput { dt: 0.0, ..good });
    let text = serde_json::to_string(&state).unwrap();
    let mut read: AdaptiveState<f64, 2> =
        serde_json::from_str(&text.replace("counting", "closed")).unwrap();
    assert_eq!((read, read.bad_score()), (state, 4));
    law.step(&mut read, &good);
    assert_eq!(read.bad_score(), 3);
    let pid = Pid::paper_pi();
    let mut state = PidState::<f64>::new();
    let at = PidInput::new(1e-3, 1.0, 0.5);
    pid.step(&mut state, &PidInput { dt: 0.0, ..at });
    let stored = serde_json::to_string(&state).unwrap();
    for text in [stored.clone(), stored.replace("counting", "closed")] {
        let mut read: PidState<f64> = serde_json::from_str(&text).unwrap();
        assert_eq!((read, read.bad_score()), (state, 4));
        pid.step(&mut read, &at);
        assert_eq!(read.bad_score(), 3);
    }
}
