//! What the harness of the relay experiment proves of one step, asked of many.

use super::any_float;
use super::properties::control;
use bowden::control::*;
use proptest::prelude::*;

proptest! {
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
            limits: Limits::try_new(-3.0, 3.0).unwrap(),
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
