//! Effects with memory, stepped on the fine grid, and effects of eta.

use super::regressor::{Extent, Regressor, Sense};
use rand::Rng;
use rand_chacha::ChaCha8Rng;

pub(super) fn build(
    effect: &str,
    extent: &Extent,
    input: &Extent,
    rng: &mut ChaCha8Rng,
) -> Option<Regressor> {
    let either = Sense::Either;
    let regressor = match effect {
        "asymmetry-eta" => Regressor::new(either, |at, _| at.eta.abs()),
        "asymmetry-eta-squared" => Regressor::new(either, |at, _| at.eta * at.eta),
        "position-hysteresis" => {
            Regressor::new(either, |at, m| at.eta * m.x).with("x_0", extent.mean)
        }
        "rate" => Regressor::new(either, |at, m| at.eta * m.v),
        "rate-symmetric" => Regressor::new(Sense::Loss, |at, m| at.eta * m.v.abs()),
        "degradation" => degradation(rng.random_range(1.5..3.0) * input.path),
        "pinching" => {
            let w = rng.random_range(0.25..0.6);
            let step = move |at: &super::rig::Moment| at.eta * (-(at.eta / w).powi(2)).exp();
            Regressor::new(Sense::Relief, move |at, _| step(at)).with("w", w)
        }
        "backlash" => backlash(rng.random_range(0.05..0.2) * extent.reach),
        "creep" => creep(extent, rng.random_range(1.8..4.0)),
        "presliding" => presliding(rng.random_range(0.25..0.6) * extent.reach),
        _ => return None,
    };
    Some(regressor)
}

/// The loop wears: what has rubbed lowers it, ever more slowly.
fn degradation(wear: f64) -> Regressor {
    let mut work = 0.0;
    Regressor::new(Sense::Relief, move |at, _| {
        if at.t > 0.0 {
            work += at.eta.abs() * at.input.v.abs() * at.dt;
        }
        at.eta * (1.0 - (-work / wear).exp())
    })
    .with("wear", wear)
}

/// What a loose fit lags behind its driver: a pin in a slot of half-width `r`.
fn backlash(r: f64) -> Regressor {
    let mut pin: Option<f64> = None;
    Regressor::new(Sense::Either, move |_, m| {
        let held = pin.unwrap_or(m.x).clamp(m.x - r, m.x + r);
        pin = Some(held);
        held - m.x
    })
    .with("r", r)
}

/// A viscoelastic part that follows with a time constant.
fn creep(extent: &Extent, slowness: f64) -> Regressor {
    let tau = slowness * extent.rms() / extent.speed;
    let mut state: Option<f64> = None;
    Regressor::new(Sense::Either, move |at, m| {
        let last = state.unwrap_or(m.x);
        let next = last + (m.x - last) * (-(-at.dt / tau).exp_m1());
        state = Some(next);
        next
    })
    .with("tau", tau)
}

/// Asperities that bend before they slip: three stops in parallel.
fn presliding(r: f64) -> Regressor {
    let widths = [0.75 * r, r, 1.3 * r];
    let mut stops = [0.0; 3];
    let mut last: Option<f64> = None;
    Regressor::new(Sense::Loss, move |_, m| {
        let change = m.x - last.unwrap_or(m.x);
        last = Some(m.x);
        let mut sum = 0.0;
        for (stop, width) in stops.iter_mut().zip(widths) {
            *stop = (*stop + change).clamp(-width, width);
            sum += *stop / width;
        }
        sum / 3.0
    })
    .with("r", r)
}
