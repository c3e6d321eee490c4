//! What the harnesses of the observer, of learning and of the relay experiment prove of one step, asked
//! of many.

use super::properties::control;
use super::*;

proptest! {
    #[test]
    fn an_observer_keeps_its_limit(
        plant in (0.01..100.0_f32, 0.1..1000.0_f32, 0.0..3.0_f32),
        numbers in (1e-4..1.0_f32, 0.1..1e3_f32, 0.0..0.1_f32),
        samples in prop::collection::vec((any_float(), any_float(), any_float(), any::<bool>()), 1..200),
    ) {
        let plant = NominalPlant::try_new(plant.0, plant.1, plant.2).unwrap();
        let (time_constant, limit, latency) = numbers;
        let observer = DisturbanceObserver::try_new(plant, time_constant, limit, 0.005).unwrap();
        let observer = observer.with_latency(latency).unwrap();
        let mut state = ObserverState::new();
        for (dt, sent, measured, usual) in samples {
            let dt = if usual { 0.001 } else { dt };
            let at = ObserverInput { dt, sent, measured };
            prop_assert!(control::estimates_keep_their_limit(&observer, state, &at));
            observer.step(&mut state, &at);
        }
    }

    #[test]
    fn learning_keeps_its_limit(
        shape in (0..4_u16, 0..4_u16, 1e-3..1e3_f32, -1e3..1e3_f32, 0.0..1.0_f32),
        stored in prop::collection::vec(any_float(), 30),
        samples in prop::collection::vec(
            (any_float(), any_float(), any_float(), any::<bool>(), 0.0..0.1_f32),
            1..200,
        ),
    ) {
        let (lead, half_width, limit, gain, forgetting) = shape;
        prop_assume!(gain != 0.0);
        let learning = IterativeLearning::try_new(gain, limit, lead, half_width).unwrap();
        let learning = learning.with_forgetting(forgetting).unwrap();
        let mut before = [0.0; 30];
        let mut state = learning.resume(stored, vec![0.0; 30]).unwrap();
        let mut phase = 0.0;
        for (any_phase, reference, measured, usual, on) in samples {
            phase = (phase + on) % 1.0;
            let at = IterativeLearningInput {
                phase: if usual { phase } else { any_phase },
                reference,
                measured,
                learns: on < 0.09,
            };
            prop_assert!(control::learning_keeps_its_limit(&learning, &mut state, &at, &mut before));
            prop_assert!(state.learned().iter().all(|x| x.abs() <= limit));
        }
    }

    #[test]
    fn a_relay_experiment_is_bounded_and_ends(
        levels in (-1.0..1.0_f32, 0.1..2.0_f32, any::<bool>()),
        numbers in (0.0..0.5_f32, 1.0..200.0_f32, 0.01..0.9_f32, 2..5_u32),
        longest_time in 0.01..2.0_f32,
        samples in prop::collection::vec((any_float(), any_float(), 0..8_u8), 1..300),
        acknowledges: bool,
    ) {
        let (centre, amplitude, negative) = levels;
        let (hysteresis, most_deviation, agreement, cycles) = numbers;
        let relay = Relay::try_new(RelaySettings {
            reference: 0.0,
            centre,
            amplitude: if negative { -amplitude } else { amplitude },
            hysteresis,
            most_deviation,
            cycles,
            agreement,
            longest_time,
            longest_dt: 0.01,
            limits: range(-3.0, 3.0),
            fallback: Fallback::try_new(5, 0.75).unwrap(),
        }).unwrap();
        let mut state = RelayState::new();
        for (dt, measured, kind) in samples {
            // Most of the time a usual clock; half of the time an output near the reference.
            let dt = if kind > 0 { 0.001 } else { dt };
            let measured = if kind % 2 == 1 { (measured % 2.0) * 0.5 } else { measured };
            let kept = control::a_relay_experiment_is_bounded_and_ends(
                &relay, &mut state, dt, measured,
            );
            prop_assert!(kept, "{:?}", state);
            if acknowledges && kind == 7 {
                state.acknowledge();
            }
        }
    }
}
