//! Effects of speed: they dissipate energy, depending on the position.

use super::regressor::{Extent, Regressor, Sense};
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// The sign of the speed, rounded off within `width`: an algebraic curve.
fn smooth_sign(v: f64, width: f64) -> f64 {
    v / v.hypot(width)
}

pub(super) fn build(effect: &str, extent: &Extent, rng: &mut ChaCha8Rng) -> Option<Regressor> {
    let width = rng.random_range(0.02..0.06) * extent.speed;
    let loss = Sense::Loss;
    let mean = extent.mean;
    let regressor = match effect {
        "viscous" => Regressor::new(loss, |_, m| m.v),
        "drag-quadratic" => Regressor::new(loss, |_, m| m.v * m.v.abs()),
        "drag-cubic" => Regressor::new(loss, |_, m| m.v.powi(3)),
        "power-law" => {
            let power = rng.random_range(0.25..0.7);
            Regressor::new(loss, move |_, m| m.v.abs().powf(power).copysign(m.v)).with("a", power)
        }
        "coulomb" => Regressor::new(loss, move |_, m| smooth_sign(m.v, width)).with("v_e", width),
        "stribeck" => {
            let v_s = rng.random_range(0.15..0.4) * extent.speed;
            let power = rng.random_range(1.0..2.0);
            Regressor::new(loss, move |_, m| {
                smooth_sign(m.v, 0.05 * v_s) * (-(m.v / v_s).abs().powf(power)).exp()
            })
            .with("v_s", v_s)
            .with("a", power)
        }
        // c+ above the mean coefficient for v > 0, as much below it for v < 0.
        "asymmetry-viscous" => Regressor::new(Sense::Either, |_, m| m.v.abs()),
        "asymmetry-drag" => Regressor::new(Sense::Either, |_, m| m.v * m.v),
        "load-friction" => {
            Regressor::new(loss, move |at, m| at.load.x.abs() * smooth_sign(m.v, width))
                .with("v_e", width)
        }
        "capstan" => {
            // Tension over a wrap that grows with the position: Euler's
            // exponential, whose constant part is plain load friction.
            let wrap = rng.random_range(0.2..0.4) / extent.reach;
            Regressor::new(Sense::Either, move |at, m| {
                at.load.x * ((wrap * m.x).exp() - 1.0) / wrap * smooth_sign(m.v, width)
            })
            .with("wrap", wrap)
            .with("v_e", width)
        }
        "drive-friction" | "back-drive-friction" => {
            let side = if effect == "drive-friction" {
                1.0
            } else {
                -1.0
            };
            Regressor::new(loss, move |at, m| {
                let driven = at.load.x * m.v * side > 0.0;
                if driven {
                    at.load.x.abs() * smooth_sign(m.v, width)
                } else {
                    0.0
                }
            })
            .with("v_e", width)
        }
        "position-friction" => {
            Regressor::new(Sense::Either, move |_, m| m.x * smooth_sign(m.v, width))
                .with("x_0", mean)
                .with("v_e", width)
        }
        _ => return None,
    };
    Some(regressor)
}
