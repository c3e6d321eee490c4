//! K15: any sample to the relay experiment, from any state.

use super::*;
use crate::control::status::{Held, Latch};
use crate::proofs::any::{fallback, limits};
use crate::proofs::pid::latch;
use crate::proofs::properties::control::a_relay_experiment_is_bounded_and_ends;
use crate::signal::Compensated;

/// Any experiment that its constructor accepts.
fn relay() -> Relay<f32> {
    let relay = Relay::try_new(RelaySettings {
        reference: kani::any(),
        centre: kani::any(),
        amplitude: kani::any(),
        hysteresis: kani::any(),
        most_deviation: kani::any(),
        cycles: kani::any(),
        agreement: kani::any(),
        longest_time: kani::any(),
        longest_dt: kani::any(),
        limits: limits(),
        fallback: fallback(),
    });
    kani::assume(relay.is_ok());
    match relay {
        Ok(relay) => relay,
        Err(_) => unreachable!(),
    }
}

fn any_result() -> Ultimate<f32> {
    Ultimate {
        gain: kani::any(),
        period: kani::any(),
        amplitude: kani::any(),
        duty: kani::any(),
    }
}

/// Any bit pattern, none of which a check has seen.
fn any_state() -> RelayState<f32> {
    let cycle = Cycle {
        time: Compensated {
            value: kani::any(),
            carry: kani::any(),
        },
        upper_time: kani::any(),
        lowest: kani::any(),
        highest: kani::any(),
        samples: kani::any(),
    };
    RelayState {
        held: Held {
            command: kani::any(),
            score: kani::any(),
            latch: latch(),
        },
        remaining: kani::any(),
        upper: kani::any::<bool>().then(|| kani::any()),
        cycle: kani::any::<bool>().then_some(cycle),
        mean: any_mean(),
        cycles: kani::any(),
        result: kani::any::<bool>().then(any_result),
    }
}

fn any_mean() -> Mean<f32> {
    Mean {
        count: kani::any(),
        period: kani::any(),
        amplitude: kani::any(),
        duty: kani::any(),
    }
}

/// Any numbers, NaN included: what a cycle or an average comes to is not needed.
fn garbage_mean<T: Real>() -> Mean<T> {
    Mean {
        count: kani::any(),
        period: T::from_f64(kani::any::<f32>().into()),
        amplitude: T::from_f64(kani::any::<f32>().into()),
        duty: T::from_f64(kani::any::<f32>().into()),
    }
}

fn any_cycle<T: Real>(_: &Cycle<T>) -> Mean<T> {
    garbage_mean()
}

fn any_average<T: Real>(_: &Mean<T>, _: &Mean<T>, _: T) -> Mean<T> {
    garbage_mean()
}

fn any_ultimate<T: Real>(_: &Relay<T>, _: &Mean<T>) -> Ultimate<T> {
    let any = || T::from_f64(kani::any::<f32>().into());
    Ultimate {
        gain: any(),
        period: any(),
        amplitude: any(),
        duty: any(),
    }
}

/// K15. The relay experiment: for any sample and any state, with NaN in any number, the command is
/// within the limits. After a failure the safe command is applied, and after a result the centre,
/// both permanently. Every sample of a running experiment reduces the remaining ticks.
///
/// Assumes: nothing about settings, sample or state; any average of the cycles, any result from it.
#[kani::proof]
#[kani::stub(Mean::of, any_cycle)]
#[kani::stub(Mean::joined_by, any_average)]
#[kani::stub(Relay::ultimate, any_ultimate)]
fn relay_from_any_state() {
    let (relay, mut state) = (relay(), any_state());
    let before = state;
    let (dt, measured) = (kani::any(), kani::any());
    let kept = a_relay_experiment_is_bounded_and_ends(&relay, &mut state, dt, measured);
    kani::cover!(before.is_running() && state.result.is_some());
    kani::cover!(state.is_running() && before.held.command.is_nan());
    kani::cover!(state.held.latch == Latch::Safe(Fault::TimeOut) && before.remaining == 1);
    assert!(kept);
}
