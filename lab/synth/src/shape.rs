//! Effects of position, time and temperature, without memory and independent of the speed.

use super::regressor::{Extent, Regressor, Sense};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

pub(super) fn build(effect: &str, extent: &Extent, rng: &mut ChaCha8Rng) -> Option<Regressor> {
    let either = Sense::Either;
    let (mean, reach, seconds) = (extent.mean, extent.reach, extent.seconds);
    let regressor = match effect {
        "offset" => Regressor::new(either, |_, _| 1.0),
        "gain" | "stiffness-linear" | "stretch-linear" | "crosstalk" => {
            Regressor::new(either, |_, m| m.x)
        }
        "inertia" => Regressor::new(Sense::Loss, |_, m| m.a),
        "stiffness-quadratic" => Regressor::new(either, |_, m| m.x * m.x).with("x_0", mean),
        "stiffness-cubic" | "stretch-cubic" => {
            Regressor::new(either, |_, m| m.x.powi(3)).with("x_0", mean)
        }
        "stiffness-progressive" => Regressor::new(either, |_, m| m.x * m.x.abs()).with("x_0", mean),
        "hinge" => {
            let place = extent.quantile(rng.random_range(0.35..0.7));
            Regressor::new(either, move |_, m| (m.x - place).max(0.0)).with("x_h", mean + place)
        }
        "gravity" => {
            // Hanging down or sticking out: an angle at which the curve bends.
            let psi = rng.random_range(0.7..2.4);
            Regressor::new(either, move |_, m| (m.x + mean + psi).sin()).with("psi", psi)
        }
        "ripple" => {
            let (k, psi) = (
                rng.random_range(7.0..16.0) / reach,
                rng.random_range(0.0..TAU),
            );
            Regressor::new(either, move |_, m| (k * (m.x + mean) + psi).sin())
                .with("k", k)
                .with("psi", psi)
        }
        "dead-zone" => {
            let r = rng.random_range(0.1..0.3) * reach;
            Regressor::new(either, move |_, m| m.x - m.x.clamp(-r, r)).with("r", r)
        }
        "saturation-upper" | "saturation-lower" => {
            let share = rng.random_range(0.78..0.9);
            let side = if effect == "saturation-upper" {
                1.0
            } else {
                -1.0
            };
            let place = extent.quantile(if side > 0.0 { share } else { 1.0 - share });
            Regressor::new(Sense::Less, move |_, m| {
                side * (side * (m.x - place)).max(0.0)
            })
            .with("x_s", mean + place)
        }
        "drift" => Regressor::new(either, |at, _| at.t),
        "pretension" => {
            let t_s = rng.random_range(0.2..0.5) * seconds;
            Regressor::new(either, move |at, _| if at.t < t_s { 0.0 } else { 1.0 }).with("t_s", t_s)
        }
        "temperature" => Regressor::new(either, |_, m| m.x).with("T_ref", mean),
        "tone" => {
            let (f, psi) = (rng.random_range(3.0..7.0), rng.random_range(0.0..TAU));
            Regressor::new(either, move |at, _| (TAU * f * at.t + psi).sin())
                .with("f", f)
                .with("psi", psi)
        }
        _ => return None,
    };
    Some(regressor)
}
