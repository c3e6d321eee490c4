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

/// The score as the docs of `Fallback` have it, without a thought for speed. A stretch of n samples
/// with B bad ones leaves it at (weight + 1)·B - n or more: the docs' latest sample of the safe command
/// follows.
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
                let most = self.fallback.after() * self.fallback.weight();
                self.score = most.min(self.score + self.fallback.weight());
                self.latched = self.score == most;
            }
        }
    }
}

fn any_fallback() -> impl Strategy<Value = Fallback<f64>> {
    (1_u32..12, 1_u32..9).prop_map(|(after, weight)| {
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

fn is_what_an_open_count_says<C: Controller<f64>>(
    law: &C,
    fallback: Fallback<f64>,
    events: &[Event],
    counter: fn(&C::State) -> u32,
) -> Result<(), TestCaseError> {
    let (mut state, mut open) = (law.start(), Open::new(fallback));
    for &event in events {
        // A reference of -MAX beside a measurement of MAX: every number is one, their difference is
        // none.
        let (reference, measured) = match event {
            Event::Nan => (25.0, f64::NAN),
            Event::Overflow => (-f64::MAX, f64::MAX),
            _ => (25.0, 24.5),
        };
        if event == Event::Acknowledged {
            law.acknowledge(&mut state);
        } else {
            let at = with(good(), |at| {
                (at.reference, at.measured) = (reference, measured)
            });
            let is_good = law.step(&mut state, &at).status == Status::Good;
            prop_assert_eq!(is_good, event == Event::Good && !open.latched);
        }
        open.take(event);
        let told = (counter(&state), law.is_latched(&state));
        prop_assert_eq!(told, (open.score, open.latched));
    }
    Ok(())
}

proptest! {
    #[test]
    fn of_a_law_is_what_an_open_count_says(
        events in prop::collection::vec(event(), 1..200),
        fallback in any_fallback(),
    ) {
        let pid = pid(|s| s.fallback = fallback);
        is_what_an_open_count_says(&pid, fallback, &events, |own| own.fault_counter())?;
        for law in forms(|s| s.fallback = fallback) {
            is_what_an_open_count_says(&law, fallback, &events, |own| own.fault_counter())?;
        }
    }
}
