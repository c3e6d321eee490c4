//! The score of bad samples, against one that is counted openly.

use super::*;

/// What happens between two looks at the score.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Event {
    Good,
    Nan,
    Overflow,
    Acknowledged,
}

fn event() -> impl Strategy<Value = Event> {
    prop_oneof![
        6 => Just(Event::Good),
        3 => Just(Event::Nan),
        1 => Just(Event::Overflow),
        1 => Just(Event::Acknowledged),
    ]
}

fn measured(event: Event) -> f64 {
    match event {
        Event::Nan => f64::NAN,
        Event::Overflow => f64::MAX,
        _ => 24.5,
    }
}

/// The score as the docs of `Fallback` have it, without a thought for speed.
struct Open {
    fallback: Fallback<f64>,
    score: u32,
    latched: bool,
}

impl Open {
    fn new(fallback: Fallback<f64>) -> Self {
        Self {
            fallback,
            score: 0,
            latched: false,
        }
    }

    fn take(&mut self, event: Event) {
        match event {
            Event::Acknowledged if self.latched => (self.score, self.latched) = (0, false),
            _ if self.latched => {}
            Event::Acknowledged => {}
            Event::Good => self.score = self.score.saturating_sub(1),
            Event::Nan | Event::Overflow => {
                let most = self.fallback.most();
                self.score = most.min(self.score + self.fallback.weight());
                self.latched = self.score == most;
            }
        }
    }
}

fn any_fallback() -> impl Strategy<Value = Fallback<f64>> {
    (1_u32..12, 1_u32..6).prop_map(|(after, weight)| {
        let fallback = Fallback::try_new(after, 0.0).unwrap();
        fallback.with_weight(weight).unwrap()
    })
}

/// Who resets whenever a sample is bad, against wind-up, must not reset the way to safety.
#[test]
fn a_reset_at_every_bad_sample_does_not_keep_the_safe_command_back() {
    let (pid, mut state) = (pid(|_| ()), PidState::new());
    pid.step(&mut state, &PidInput::new(1e-3, 25.0, 24.0));
    for k in 1..=20 {
        let out = pid.step(&mut state, &PidInput::new(1e-3, 25.0, f64::NAN));
        assert_eq!(out.status == Status::Safe(Fault::Measured), k == 20, "{k}");
        state.reset();
        assert_eq!(state.fault_counter(), 4 * k);
    }
    assert!(state.is_latched());
    assert_eq!(state.command(), 0.0);
}

proptest! {
    #[test]
    fn of_a_pi_is_what_an_open_count_says(
        events in prop::collection::vec(event(), 1..200),
        fallback in any_fallback(),
    ) {
        // A reference of -MAX beside a measurement of MAX: every number is one, their
        // difference is none.
        let pid = pid(|s| s.fallback = fallback);
        let (mut state, mut open) = (PidState::new(), Open::new(fallback));
        for event in events {
            if event == Event::Acknowledged {
                state.acknowledge();
            } else {
                let reference = if event == Event::Overflow { -f64::MAX } else { 25.0 };
                let out = pid.step(&mut state, &PidInput::new(1e-3, reference, measured(event)));
                prop_assert_eq!(out.status == Status::Good, event == Event::Good && !open.latched);
            }
            open.take(event);
            prop_assert_eq!((state.fault_counter(), state.is_latched()), (open.score, open.latched));
        }
    }

    #[test]
    fn of_the_adaptive_law_is_what_an_open_count_says(
        events in prop::collection::vec(event(), 1..200),
        fallback in any_fallback(),
        lag in any::<bool>(),
    ) {
        let law = forms(|s| s.fallback = fallback)[usize::from(lag)];
        let (mut state, mut open) = (AdaptiveState::new(&law), Open::new(fallback));
        for event in events {
            if event == Event::Acknowledged {
                state.acknowledge();
            } else {
                let input = AdaptiveInput::new(1e-3, 25.0, measured(event), [0.2]);
                let out = law.step(&mut state, &input);
                prop_assert_eq!(out.status == Status::Good, event == Event::Good && !open.latched);
            }
            open.take(event);
            prop_assert_eq!((state.fault_counter(), state.is_latched()), (open.score, open.latched));
        }
    }
}
