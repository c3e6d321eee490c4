//! K13: constructors take any argument, and keep what they promise of the ones they accept.

use super::any::{fallback, limits};
use bowden::control::{Adaptive, AdaptiveSettings, AdaptiveState, Estimator, Form, Leakage};
use bowden::control::{Fallback, Limits, SmoothSign};
use bowden::hysteresis::{BoucWen, Shape};
use bowden::signal::{Derivative, Guard, Play};
use bowden::transmission::Transmission;

fn is_positive(x: f32) -> bool {
    x.is_finite() && x > 0.0
}

/// K13. Signals, limits and fallback: any bit pattern is accepted or refused without a panic,
/// and what is accepted is finite, ordered and of the right sign.
#[kani::proof]
fn signals_of_any_argument() {
    let (a, b): (f32, f32) = (kani::any(), kani::any());
    let range = Limits::try_new(a, b).and_then(|range| range.with_slew(kani::any()));
    kani::cover!(range.is_ok());
    assert!(
        range.is_ok_and(|range| range.low().is_finite()
            && range.low() < range.high()
            && range.high().is_finite()
            && range.slew().is_some_and(is_positive))
            || range.is_err()
    );
    let safe = Fallback::<f32>::try_new(kani::any(), a);
    assert!(safe.is_ok_and(|safe| safe.after() > 0 && safe.command() == Some(a)) || safe.is_err());
    let rate = Derivative::try_new(a);
    assert!(rate.is_ok_and(|rate| rate.time_constant() >= 0.0 && a.is_finite()) || rate.is_err());
    let play = Play::try_new(a);
    assert!(play.is_ok_and(|play| play.half_width() >= 0.0 && a.is_finite()) || play.is_err());
    let guard = Guard::try_new(a);
    assert!(guard.is_ok_and(|guard| guard.limit() > 0.0 && !a.is_nan()) || guard.is_err());
}

/// K13. Shapes, transmissions and inverses: the same, and a state of eta within ±1.
#[kani::proof]
fn transmissions_of_any_argument() {
    let state = BoucWen::<f32>::with_eta(kani::any());
    assert!(state.is_ok_and(|state| state.eta().abs() <= 1.0) || state.is_err());
    let shape = Shape::<f32>::try_new(kani::any(), kani::any(), kani::any());
    if let Ok(shape) = shape {
        assert!(is_positive(shape.rho()) && shape.sigma() >= 0.5 && shape.n() >= 1.0);
        assert!(shape.sigma() <= 1e9 && shape.n() <= 1e9);
        let cable = Transmission::torque(kani::any(), kani::any(), kani::any(), shape);
        if let Ok(cable) = cable {
            kani::cover!(cable.inverse().is_ok() && cable.kappa_eta() > 1.0);
            assert!(cable.gain().is_finite() && cable.offset().is_finite());
            assert!(cable.inverse().is_err() || cable.gain() != 0.0);
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
/// without a panic; a law that is accepted starts from a state that is valid for it.
#[kani::proof]
#[kani::unwind(3)]
fn laws_of_any_settings() {
    let form = if kani::any() {
        Form::Lag {
            step: kani::any(),
            plant_gain: kani::any(),
        }
    } else {
        Form::Literal {
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
        limits: limits(),
        fallback: fallback(),
    });
    if let Ok(law) = law {
        kani::cover!(law.largest_step().is_some());
        kani::cover!(law.largest_step().is_none());
        assert!(law.is_valid(&AdaptiveState::new(&law)));
    }
}
