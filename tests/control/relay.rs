//! The relay experiment: exact limit cycles, the gains that follow, faults, and that it ends.

mod exact;
mod faults;
mod gains;
mod liveness;
mod measured;
mod plants;
mod settings;

use super::*;
use plants::{Plant, Sampled};

type Settings<T> = RelaySettings<T>;

/// Unit relay about zero, without hysteresis.
fn usual<T: Real>() -> Settings<T> {
    let of = T::from_f64;
    RelaySettings {
        reference: of(0.0),
        centre: of(0.0),
        amplitude: of(1.0),
        hysteresis: of(0.0),
        most_deviation: of(10.0),
        cycles: 3,
        agreement: of(0.01),
        longest_time: of(200.0),
        longest_dt: of(0.5),
        limits: Limits::try_new(of(-3.0), of(5.0)).unwrap(),
        fallback: Fallback::try_new(10, of(0.25)).unwrap(),
    }
}

fn relay<T: Real>(change: impl FnOnce(&mut Settings<T>)) -> Relay<T> {
    Relay::try_new(with(usual(), change)).unwrap()
}

/// Runs the experiment on a plant until it ends.
fn ended<T: Real>(
    settings: Settings<T>,
    plant: &Plant,
    mut sampled: Sampled,
) -> (Output<T>, RelayState<T>) {
    let relay = Relay::try_new(settings).unwrap();
    let (mut state, mut plant) = (RelayState::new(), plant.clone());
    loop {
        let (dt, noise) = sampled.next();
        let measured = T::from_f64(plant.output() + noise);
        let out = relay.step(&mut state, T::from_f64(dt), measured);
        if !state.is_running() {
            return (out, state);
        }
        sampled.dt = sampled.drawn();
        plant.run(out.command.as_f64(), sampled.dt);
    }
}

/// The result of an experiment that succeeds.
fn result<T: Real>(settings: Settings<T>, plant: &Plant, sampled: Sampled) -> Ultimate<f64> {
    let (out, state) = ended(settings, plant, sampled);
    let Some(it) = state.result() else {
        panic!("{:?} after {} cycles", out.status, state.cycles());
    };
    assert_eq!(out.command, settings.centre);
    Ultimate {
        gain: it.gain.as_f64(),
        period: it.period.as_f64(),
        amplitude: it.amplitude.as_f64(),
        duty: it.duty.as_f64(),
    }
}
