//! The hysteresis step, the transmission over it, and its inverse.

use crate::{Case, Output, Sample};
use bowden::hysteresis::{BoucWen, BoucWenState};
use bowden::transmission::{Inverse as Inverted, Transmission};
use bowden::Error;
use core::hint::black_box;

/// rho and n of the paper's first set.
const SHAPE: (f32, f32) = (0.09582, 3.871);
/// B, kappa_eta and T0 of the paper's first set.
const GAINS: (f32, f32, f32) = (0.9978, 7.004, 0.05174);

/// The paper's first set, with the sigma that is given.
pub(crate) fn transmission(sigma: f32) -> Result<Transmission<f32>, Error> {
    let (rho, sigma, n) = black_box((SHAPE.0, sigma, SHAPE.1));
    let (b, kappa_eta, t0) = black_box(GAINS);
    Transmission::torque(b, kappa_eta, t0, BoucWen::try_new(rho, sigma, n)?)
}

/// The same with numbers that the compiler knows.
#[inline]
pub(crate) fn fixed(sigma: f32) -> Result<Transmission<f32>, Error> {
    let ((rho, n), (b, kappa_eta, t0)) = (SHAPE, GAINS);
    Transmission::torque(b, kappa_eta, t0, BoucWen::try_new(rho, sigma, n)?)
}

/// sigma as it was identified.
const IDENTIFIED: f32 = 98.36;
/// sigma within what has an inverse, B/(2·kappa_eta·rho) = 0.743.
pub(crate) const INVERTIBLE: f32 = 0.6;

/// The Bouc-Wen step of the paper's first set; the value is eta.
#[derive(Debug)]
pub struct Hysteresis {
    shape: BoucWen<f32>,
    state: BoucWenState<f32>,
}

impl Case for Hysteresis {
    fn try_new() -> Result<Self, Error> {
        Ok(Self {
            shape: *transmission(IDENTIFIED)?.shape(),
            state: BoucWenState::new(),
        })
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        Output::of(self.shape.step(&mut self.state, at.input))
    }
}

/// The transmission of the paper's first set; the value is tau_o.
#[derive(Debug)]
pub struct Forward {
    transmission: Transmission<f32>,
    state: BoucWenState<f32>,
}

impl Case for Forward {
    fn try_new() -> Result<Self, Error> {
        Ok(Self {
            transmission: transmission(IDENTIFIED)?,
            state: BoucWenState::new(),
        })
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        Output::of(self.transmission.step(&mut self.state, at.input))
    }
}

/// The inverse at sigma = 0.6; the value is tau_i.
#[derive(Debug)]
pub struct Inverse {
    inverse: Inverted<f32>,
    state: BoucWenState<f32>,
}

impl Case for Inverse {
    fn try_new() -> Result<Self, Error> {
        Ok(Self {
            inverse: transmission(INVERTIBLE)?.inverse()?,
            state: BoucWenState::new(),
        })
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        Output::of(self.inverse.step(&mut self.state, at.input))
    }
}
