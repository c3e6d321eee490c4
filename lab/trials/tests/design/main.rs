//! From a model to gains: what is designed holds on the shipped controller and transmission.
//!
//! * [`slopes`]: the slopes are those of the shipped step, and are reached.
//! * [`pi`]: margins, overshoot and settling in closed loop.
//! * [`adaptive`]: what its constructor and its certificate admit.
//! * [`file`]: the gains as a file, and what it refuses.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod adaptive;
mod file;
mod pi;
mod slopes;

use bowden::hysteresis::BoucWen;
use bowden::transmission::Transmission;
use bowden_rig::Noise;
use bowden_trials::design::{design, Designed, Question};

/// B, kappa_eta, T0, rho, sigma and n.
type Numbers = [f64; 6];

fn cable([b, kappa_eta, t0, rho, sigma, n]: Numbers) -> Transmission<f64> {
    Transmission::torque(b, kappa_eta, t0, BoucWen::try_new(rho, sigma, n).unwrap()).unwrap()
}

/// The text of a model file whose record has covered ±20 N·m.
fn model([gain, kappa_eta, offset, rho, sigma, n]: Numbers, more: &str) -> String {
    format!(
        "schema = \"bowden.model/1\"\nmode = \"torque\"\nchannels = [\"phi_p\"]\n[transmission]\n\
         gain = {gain:?}\nkappa_eta = {kappa_eta:?}\noffset = {offset:?}\nrho = {rho:?}\n\
         sigma = {sigma:?}\nn = {n:?}\n{more}[about]\ncutoff_hz = 8.0\n[about.ranges.input]\n\
         position = [-20.0, 20.0]\nvelocity = [-40.0, 40.0]\nacceleration = [-170.0, 170.0]\n"
    )
}

/// A cable whose output rises with its input everywhere.
fn rising(dice: &mut Noise) -> Numbers {
    let within = |low: f64, high: f64, u: f64| low + (high - low) * u;
    let b = within(0.5, 1.0, dice.uniform());
    let sigma = within(0.5, 2.0, dice.uniform());
    let rho = within(0.05, 0.5, dice.uniform());
    // The least slope is between a fifth and four fifths of B.
    let kappa_eta = within(0.2, 0.8, dice.uniform()) * b / (2.0 * sigma * rho);
    [
        b,
        kappa_eta,
        0.05,
        rho,
        sigma,
        within(1.0, 4.0, dice.uniform()),
    ]
}

const ASKED: Question = Question {
    rate: 1000.0,
    delay: 0.004,
    noise: 0.0,
    drive_gain: 1.0,
};

/// Without a delay, so that it can be certified.
const QUICK: Question = Question {
    delay: 0.0,
    ..ASKED
};

fn designed(numbers: Numbers, asked: &Question) -> Designed {
    design(&model(numbers, ""), "model.toml", asked).unwrap()
}
