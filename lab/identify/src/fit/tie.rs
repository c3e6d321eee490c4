//! The bound within which a transmission has an inverse, as a bound on its linear gains.
//!
//! In torque mode `tau_o = B·tau_i − kappa_eta·eta − T0` rises with `tau_i` on every branch if
//! `2·sigma·rho·kappa_eta <= B` ([`Transmission::inverse`]). For a given shape this is a cone over
//! the two gains B and kappa_eta, so the linear solve of each step can keep it exactly: on its edge
//! B is `2·sigma·rho·kappa_eta`, and the columns of the input and of eta are one column. The search
//! then runs over shapes and never leaves the invertible range.
//!
//! [`Transmission::inverse`]: bowden::transmission::Transmission::inverse

use crate::model::structure::{Free, Role, Structure};
use crate::problem::Stretch;
use std::sync::Arc;

/// Relative distance from the bound. Four numbers are rounded to `f32` and three products
/// formed: 7 roundings of 2^-24 each, 4.2e-7 together, so the rounded model keeps its inverse.
const MARGIN: f64 = 1e-6;

/// The bound `|gain| >= ratio·|hysteresis|`, for gain and hysteresis of opposite signs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tie {
    /// Index of the gain B or kappa_x among the linear gains.
    pub(super) gain: usize,
    /// Index of the gain of eta.
    pub(super) hysteresis: usize,
    /// Steepest slope of eta in the input, `2·sigma·rho`, and the margin.
    pub(super) ratio: f64,
}

impl Tie {
    pub(super) fn is_violated(&self, gains: &[f64]) -> bool {
        let (gain, hysteresis) = (gains[self.gain], gains[self.hysteresis]);
        // On the edge itself both sides are the same product.
        gain * hysteresis <= 0.0 && self.ratio * hysteresis.abs() > gain.abs()
    }

    /// The common column of both if the gain is `−ratio` times that of the hysteresis.
    pub(super) fn merged(&self, columns: &[Arc<Stretch>]) -> Stretch {
        let mut merged = Stretch::clone(&columns[self.hysteresis]);
        merged.add(&columns[self.gain], -self.ratio);
        merged
    }
}

/// The bounds of a structure, one for each record with separate gains; none if the structure need
/// not be invertible.
pub(super) fn ties(structure: &Structure, free: &[Free], values: &[f64]) -> Vec<Tie> {
    let value = |role| free.iter().position(|f| f.role == role).map(|i| values[i]);
    let (Some(rho), Some(sigma), true) =
        (value(Role::Rho), value(Role::Sigma), structure.invertible)
    else {
        return Vec::new();
    };
    (0..structure.own_gains.max(1))
        .map(|record| Tie {
            gain: 3 * record,
            hysteresis: 3 * record + 1,
            ratio: 2.0 * sigma * rho * (1.0 + MARGIN),
        })
        .collect()
}

/// d ratio / d parameter.
pub(super) fn slope(free: &[Free], values: &[f64], role: Role) -> f64 {
    let value = |role| {
        let index = free.iter().position(|f| f.role == role);
        index.map_or(0.0, |i| values[i])
    };
    match role {
        Role::Rho => 2.0 * value(Role::Sigma) * (1.0 + MARGIN),
        Role::Sigma => 2.0 * value(Role::Rho) * (1.0 + MARGIN),
        _ => 0.0,
    }
}
