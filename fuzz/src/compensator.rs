//! The compensator.

use crate::numbers::Numbers;
use bowden::control::{BenchRange, Compensator, CompensatorInput, CompensatorState, Status};
use bowden::model::{Model, Source};
use bowden::Real;

const TERMS: usize = 3;

/// Whatever the model and the samples: a finite command, eta within ±1, and a bad sample
/// changes nothing of what follows.
pub fn check(data: &[u8]) {
    let mut from = Numbers::new(data);
    let _ = match from.flag() {
        Some(true) => run::<f32>(&mut from),
        _ => run::<f64>(&mut from),
    };
}

fn run<T: Real>(from: &mut Numbers) -> Option<()> {
    let transmission = from.transmission::<T>()?;
    let mut terms = Vec::new();
    for _ in 0..usize::from(from.byte()?) % (TERMS + 1) {
        terms.push(from.term()?);
    }
    let model = Model::<T, TERMS>::try_new(Some(transmission), &terms).ok()?;
    let (nearest, changed) = Compensator::try_nearest(&model).ok()?;
    if let Ok(exact) = Compensator::try_new(&model) {
        assert!(changed.is_nothing() && exact == nearest);
    }
    assert!(nearest.transmission().inverse().is_ok());
    let mut compensator = nearest;
    if from.flag()? {
        let range = BenchRange {
            source: Source::Input,
            low: from.motion()?,
            high: from.motion()?,
        };
        compensator = compensator.with_ranges(&[range]).unwrap_or(compensator);
    }
    let mut state = CompensatorState::new();
    loop {
        if from.byte()? < 16 {
            compensator.applied(&mut state, from.applied()?);
            assert!(state.eta().abs() <= T::one());
        }
        let channel = [from.motion()?];
        let at = CompensatorInput {
            dt: from.dt()?,
            desired: from.any()?,
            input: from.motion()?,
            load: from.any()?,
            channels: if from.flag()? { &channel } else { &[] },
        };
        let before = state;
        let out = compensator.step(&mut state, &at);
        assert!(out.command.is_finite() && out.command == state.command());
        assert!(out.effects.is_finite());
        assert!(state.eta().abs() <= T::one());
        if out.status == Status::Good {
            assert!(state.consecutive_bad() == 0);
        } else {
            assert!(out.command == before.command() && state.eta() == before.eta());
            let good = CompensatorInput::new(T::from_f64(0.001), T::one());
            let (mut with, mut without) = (state, before);
            let given = compensator.step(&mut with, &good);
            assert!(given == compensator.step(&mut without, &good));
        }
    }
}
