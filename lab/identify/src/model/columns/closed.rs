//! Slopes in closed form, where there is one.
//!
//! A central difference takes two more columns for each shape, and for an effect that reads eta
//! two for each parameter of the hysteresis. Their powers and exponentials were most of what a
//! Jacobian cost.

use super::variation::Variation;
use super::{remembered, situations};
use crate::model::structure::FitTerm;
use crate::problem::Prepared;
use bowden::effect::{Effect, Situation};
use bowden::Real;
use std::f64::consts::TAU;

/// `of` at each sample.
fn each(
    data: &Prepared,
    term: &FitTerm,
    eta: &[f64],
    of: impl Fn(&Situation<f64>) -> f64,
) -> Option<Vec<f64>> {
    let mut slope = Vec::with_capacity(eta.len());
    for (_, samples) in situations(data, term, eta)? {
        slope.extend(samples.map(|at| of(&at)));
    }
    Some(slope)
}

/// The slope of an effect's column in eta; `None` where there is no closed form.
pub(super) fn in_eta(data: &Prepared, term: &FitTerm, eta: &[f64]) -> Option<Vec<f64>> {
    match term.effect {
        Effect::Rate => each(data, term, eta, |at| at.motion.velocity),
        Effect::RateSymmetric => each(data, term, eta, |at| at.motion.velocity.abs()),
        Effect::PositionHysteresis => each(data, term, eta, |at| at.motion.position),
        // In the corner the mean of both sides, as by a central difference.
        Effect::AsymmetryEta => each(data, term, eta, |at| match at.eta == 0.0 {
            true => 0.0,
            false => at.eta.signum(),
        }),
        Effect::AsymmetryEtaSquared => each(data, term, eta, |at| 2.0 * at.eta),
        Effect::Pinching(own) => each(data, term, eta, |at| {
            let square = (at.eta / own.w()).powi(2);
            (1.0 - 2.0 * square) * Real::exp(-square)
        }),
        _ => None,
    }
}

/// The slopes of an effect's column.
pub(super) struct Slopes {
    /// In each of its shapes.
    shapes: Vec<Vec<f64>>,
    /// On each record in what the channel had moved just before it.
    start: Vec<f64>,
}

impl Slopes {
    /// `None` where there is no closed form. `column` has the effect's values.
    pub(super) fn of(data: &Prepared, term: &FitTerm, eta: &[f64], column: &[f64]) -> Option<Self> {
        if let Some((shape, start)) = remembered::slopes(data, term, column) {
            let shapes = vec![shape];
            return Some(Self { shapes, start });
        }
        let start = Vec::new();
        let shapes = in_shapes(data, term, eta, column)?;
        Some(Self { shapes, start })
    }

    /// That in one parameter, which can be taken once; `None` where it has no closed form.
    pub(super) fn take(&mut self, data: &Prepared, by: &Variation) -> Option<Vec<f64>> {
        match *by {
            Variation::Shape { index } => self.shapes.get_mut(index).map(std::mem::take),
            Variation::Start { record } => {
                let place = data.pieces.get(record)?.work.clone();
                let own = self.start.get(place.clone())?;
                let mut slope = vec![0.0; self.start.len()];
                slope[place].copy_from_slice(own);
                Some(slope)
            }
            Variation::Origin => None,
        }
    }
}

/// The slopes of an effect without memory in each of its shapes.
fn in_shapes(
    data: &Prepared,
    term: &FitTerm,
    eta: &[f64],
    column: &[f64],
) -> Option<Vec<Vec<f64>>> {
    let all = |of: &dyn Fn(&Situation<f64>, f64) -> [f64; 2], count: usize| {
        let mut slopes = vec![Vec::with_capacity(eta.len()); count];
        let mut values = column.iter();
        for (_, samples) in situations(data, term, eta)? {
            for (at, &value) in samples.zip(values.by_ref()) {
                for (slope, one) in slopes.iter_mut().zip(of(&at, value)) {
                    slope.push(one);
                }
            }
        }
        Some(slopes)
    };
    // factor·tanh(v/v_e): the tangent comes from the value, and nothing from where that is zero.
    let smooth = |v_e: f64, factor: &dyn Fn(&Situation<f64>) -> f64| {
        let of = |at: &Situation<f64>, value: f64| {
            let size = factor(at);
            let slope = (size - value * (value / size)) * -at.motion.velocity / (v_e * v_e);
            [if value == 0.0 { 0.0 } else { slope }, 0.0]
        };
        all(&of, 1)
    };
    match term.effect {
        Effect::Coulomb(own) => smooth(own.v_e(), &|_| 1.0),
        Effect::PositionFriction(own) => smooth(own.v_e(), &|at| at.motion.position),
        Effect::LoadFriction(own) => smooth(own.v_e(), &|at| at.load.abs()),
        Effect::DriveFriction(own) => smooth(own.v_e(), &|at| at.load.abs()),
        Effect::BackDriveFriction(own) => smooth(own.v_e(), &|at| at.load.abs()),
        Effect::Stribeck(own) => {
            let (v_s, a) = (own.v_s(), own.a());
            all(&|at, value| stribeck(at.motion.velocity, v_s, a, value), 2)
        }
        Effect::Pinching(own) => {
            let w = own.w();
            let of = |at: &Situation<f64>, value: f64| {
                [2.0 * value * (at.eta / w) * (at.eta / w) / w, 0.0]
            };
            all(&of, 1)
        }
        Effect::Ripple(own) => {
            let of = |at: &Situation<f64>, _| {
                let x = at.motion.position;
                let cos = Real::cos(own.k() * x + own.psi());
                [x * cos, cos]
            };
            all(&of, 2)
        }
        Effect::Tone(own) => {
            let of = |at: &Situation<f64>, _| {
                let cos = Real::cos(TAU * (own.f() * at.time) + own.psi());
                [TAU * at.time * cos, cos]
            };
            all(&of, 2)
        }
        Effect::Gravity(own) => {
            let of = |at: &Situation<f64>, _| [Real::cos(at.motion.position + own.psi()), 0.0];
            all(&of, 1)
        }
        _ => None,
    }
}

/// `tanh(10 r)·exp(−|r|^a)`, `r = v/v_s`: its slopes in `v_s` and `a`.
fn stribeck(v: f64, v_s: f64, a: f64, value: f64) -> [f64; 2] {
    let size = (v / v_s).abs();
    // At rest, and where the exponential is zero to rounding.
    if value == 0.0 {
        return [0.0; 2];
    }
    let log = Real::ln(size);
    let power = Real::exp(a * log);
    let decay = Real::exp(-power);
    let tangent = value / decay;
    let by_tanh = -(1.0 - tangent * tangent) * 10.0 * v / (v_s * v_s) * decay;
    [value * a * power / v_s + by_tanh, -value * power * log]
}
