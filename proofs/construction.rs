//! K13: constructors take any argument, and keep what they promise of the ones they accept.

use super::any::{fallback, limits};
use bowden::control::{Adaptive, AdaptiveSettings, AdaptiveState, Estimator, Form, Leakage};
use bowden::control::{Fallback, Limits, OnMissing, SmoothSign};
use bowden::hysteresis::{BoucWen, BoucWenState};
use bowden::signal::{Derivative, Play};
use bowden::transmission::{Mode, Transmission};

fn is_positive(x: f32) -> bool {
    x.is_finite() && x > 0.0
}

/// K13. Signals, limits and fallback: any bit pattern is accepted exactly as documented, without a
/// panic, and an accepted value reads back unchanged.
#[kani::proof]
fn signals_of_any_argument() {
    let (a, b): (f32, f32) = (kani::any(), kani::any());
    let range = Limits::try_new(a, b);
    kani::cover!(range.is_ok());
    assert!(range.is_ok() == (a.is_finite() && b.is_finite() && a < b));
    assert!(range.is_ok_and(|range| range.contains(a) && range.contains(b)) || range.is_err());
    let slewed = Limits::unlimited().with_slew(a);
    kani::cover!(slewed.is_ok());
    assert!(slewed.is_ok() == is_positive(a));
    assert!(slewed.is_ok_and(|slewed| slewed.slew() == Some(a)) || slewed.is_err());
    let after = kani::any();
    let safe = Fallback::try_new(after, a);
    kani::cover!(safe.is_ok());
    assert!(safe.is_ok() == (after > 0 && a.is_finite()));
    assert!(
        safe.is_ok_and(|safe| safe.after() == after && safe.command() == Some(a)) || safe.is_err()
    );
    let rate = Derivative::try_new(a);
    kani::cover!(rate.is_ok());
    assert!(rate.is_ok() == (a.is_finite() && a >= 0.0));
    let play = Play::try_new(a);
    kani::cover!(play.is_ok());
    assert!(play.is_ok() == (a.is_finite() && a >= 0.0));
}

/// K13. Shapes, transmissions and hysteresis states: the same; an inverse exists only if the gain
/// is not zero, and for some arguments it exists.
#[kani::proof]
fn transmissions_of_any_argument() {
    let start: f32 = kani::any();
    let state = BoucWenState::with_eta(start);
    kani::cover!(state.is_ok());
    assert!(state.is_ok() == (start.abs() <= 1.0));
    let (rho, sigma, n): (f32, f32, f32) = (kani::any(), kani::any(), kani::any());
    let shape = BoucWen::try_new(rho, sigma, n);
    let admitted = (0.5..=1e9).contains(&sigma) && (1.0..=1e9).contains(&n);
    assert!(shape.is_ok() == (is_positive(rho) && admitted));
    if let Ok(shape) = shape {
        let (gain, kappa_eta, offset): (f32, f32, f32) = (kani::any(), kani::any(), kani::any());
        let cable = if kani::any() {
            Transmission::torque(gain, kappa_eta, offset, shape)
        } else {
            Transmission::displacement(gain, kappa_eta, offset, shape)
        };
        kani::cover!(cable.is_ok_and(|cable| cable.mode() == Mode::Torque));
        kani::cover!(cable.is_ok_and(|cable| cable.mode() == Mode::Displacement));
        let finite = gain.is_finite() && kappa_eta.is_finite() && offset.is_finite();
        assert!(cable.is_ok() == finite);
        if let Ok(cable) = cable {
            let inverse = cable.inverse();
            kani::cover!(inverse.is_ok() && cable.kappa_eta() > 1.0);
            assert!(inverse.is_err() || cable.gain() != 0.0);
        }
    }
}

/// Any estimator, with any leakage.
fn estimator() -> Estimator<f32> {
    let rate = kani::any();
    Estimator {
        initial: kani::any(),
        low: kani::any(),
        high: kani::any(),
        gain: kani::any(),
        leakage: match kani::any::<u8>() {
            0 => Leakage::None,
            1 => Leakage::Constant { rate },
            _ => Leakage::Switching {
                rate,
                bound: kani::any(),
            },
        },
        prior: kani::any(),
    }
}

/// K13. The adaptive law in both forms, two regressors: any settings are accepted or refused
/// without a panic, and some settings of either form are accepted; an accepted law starts from a
/// state that is valid for it.
#[kani::proof]
#[kani::unwind(3)]
fn laws_of_any_settings() {
    let form = if kani::any() {
        Form::FirstOrder {
            step: kani::any(),
            plant_gain: kani::any(),
        }
    } else {
        Form::AsPublished {
            time_constant: kani::any(),
        }
    };
    let law = Adaptive::<f32, 2>::try_new(AdaptiveSettings {
        form,
        gain: kani::any(),
        lambda: kani::any(),
        epsilon: kani::any(),
        smooth_sign: SmoothSign::Tanh,
        beta: estimator(),
        delta: estimator(),
        theta: [estimator(), estimator()],
        z_limit: kani::any(),
        frozen: kani::any(),
        missing: [OnMissing::Hold; 2],
        limits: limits(),
        longest_dt: kani::any(),
        fallback: fallback(),
    });
    kani::cover!(law.is_err());
    if let Ok(law) = law {
        kani::cover!(law.settings().largest_step().is_some());
        kani::cover!(law.settings().largest_step().is_none());
        assert!(law.is_valid(&AdaptiveState::new(&law)));
    }
}
