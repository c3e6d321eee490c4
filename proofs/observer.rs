//! K15: any sample to the disturbance observer, from any state.

use super::*;
use crate::proofs::properties::control::estimates_keep_their_limit;
use crate::signal::Compensated;

/// Any observer that its constructors accept.
fn observer() -> DisturbanceObserver<f32> {
    let plant = NominalPlant::try_new(kani::any(), kani::any(), kani::any());
    let observer = plant.and_then(|plant| {
        DisturbanceObserver::try_new(plant, kani::any(), kani::any(), kani::any())?
            .with_latency(kani::any())
    });
    kani::assume(observer.is_ok());
    match observer {
        Ok(observer) => observer,
        Err(_) => unreachable!(),
    }
}

/// Any bit pattern, none of which a check has seen.
fn any_state() -> ObserverState<f32> {
    let lag = || Compensated {
        value: kani::any(),
        carry: kani::any(),
    };
    let lags = kani::any::<bool>().then(|| Lags {
        sent: [lag(), lag(), lag()],
        measured: [lag(), lag()],
    });
    ObserverState {
        lags,
        estimate: kani::any(),
        gap: kani::any(),
    }
}

/// Any estimate, NaN included: what lags and plant make of a sample is not needed.
fn any_estimate<T: Real>(_: &DisturbanceObserver<T>, _: &Lags<T>, _: T) -> T {
    T::from_f64(kani::any())
}

/// Lags that have moved anywhere, NaN included.
fn any_lags<T: Real>(
    _: &DisturbanceObserver<T>,
    _: &Lags<T>,
    _: &ObserverInput<T>,
    _: T,
) -> Lags<T> {
    let lag = || Compensated {
        value: T::from_f64(kani::any()),
        carry: T::from_f64(kani::any()),
    };
    Lags {
        sent: [lag(), lag(), lag()],
        measured: [lag(), lag()],
    }
}

/// K15. The disturbance observer: for any sample and any state, with NaN in any number, the
/// estimate is finite and within its limit, a bad sample holds it, and the status of every sample
/// is correct.
///
/// Assumes: nothing about observer, sample or state; any movement of the lags, any estimate from
/// them.
#[kani::proof]
#[kani::unwind(6)]
#[kani::stub(DisturbanceObserver::estimate, any_estimate)]
#[kani::stub(DisturbanceObserver::moved, any_lags)]
fn observer_from_any_state() {
    let (observer, state) = (observer(), any_state());
    let at = ObserverInput::<f32> {
        dt: kani::any(),
        sent: kani::any(),
        measured: kani::any(),
    };
    kani::cover!(state.estimate().is_nan());
    kani::cover!(at.measured.is_nan() && state.estimate().abs() < observer.limit());
    assert!(estimates_keep_their_limit(&observer, state, &at));
}
