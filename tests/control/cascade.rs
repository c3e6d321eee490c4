//! An outer loop is told at which limit the inner one is, however the inner command got there.

use bowden::control::{Applied, Fallback, Limits, Pid, PidInput, PidSettings, PidState};

const DT: f64 = 1e-3;

fn law(k_p: f64, k_i: f64, most: f64) -> Pid<f64> {
    let limits = Limits::try_new(-most, most).unwrap();
    let safe = Fallback::try_new(20, 0.0).unwrap();
    Pid::try_new(PidSettings::new(k_p, k_i, limits, 0.005, safe)).unwrap()
}

#[test]
fn a_law_whose_integral_fills_the_range_says_that_it_is_at_its_limit() {
    // An integral alone, and a proportional term that falls as slowly as the integral may follow.
    for k_p in [0.0, 0.1] {
        let inner = law(k_p, 20.0, 3.0);
        let mut state = PidState::new();
        for (way, at_limit) in [(1.0, Applied::AtUpperLimit), (-1.0, Applied::AtLowerLimit)] {
            let mut samples = 0;
            for k in 0..2000 {
                let measured = way * 1e-3 * f64::from(k);
                let at = PidInput::new(DT, 5.0 * way, measured);
                if inner.step(&mut state, &at).command == 3.0 * way {
                    assert_eq!(inner.saturation(&state), at_limit);
                    samples += 1;
                } else {
                    assert_eq!(inner.saturation(&state), Applied::AsCommanded);
                }
            }
            // From one limit to the other: 6 at 20 times an error of 3 to 5, in 0.1 s at most.
            assert!(samples >= 1900, "{k_p}: {samples}");
        }
    }
}

/// The outer law asks for a speed, the inner one, an integral alone, for a torque that is limited.
fn overshoot(tell: bool) -> f64 {
    let (outer, inner) = (law(1.0, 0.3, 50.0), law(0.0, 20.0, 3.0));
    let (mut out, mut inside) = (PidState::new(), PidState::new());
    let (mut position, mut speed, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..60_000 {
        let at = PidInput::new(DT, 20.0, position);
        let wanted = outer.step(&mut out, &at).command;
        let at = PidInput::new(DT, wanted, speed);
        let torque = inner.step(&mut inside, &at).command;
        if tell {
            outer.applied(&mut out, inner.saturation(&inside));
        }
        speed += DT * (torque - 0.2 * speed);
        position += DT * speed;
        most = most.max(position);
    }
    most - 20.0
}

#[test]
fn an_outer_loop_over_an_integral_law_does_not_wind_up() {
    let (told, untold) = (overshoot(true), overshoot(false));
    assert!(told < 0.5 * untold, "{told} {untold}");
}
