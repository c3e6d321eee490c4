//! Identified by bowden 0.2.0 from built-in synthetic record (bowden generate --mode torque --effect viscous --seed 7).
//!
//! Input [N·m], output [N·m], torque mode.
//! Channels, in the order of `Sample::channels`: 0 phi_p [rad], 1 phi_d [rad].
//! Fitted to a record sampled at 1000 Hz and low-pass filtered at 7.6 Hz.
//!
//! Error as a share of the output's standard deviation: fit 7.01 %, held-out 10.83 %.
//! Held-out error sample by sample, with the time constant below: 10.74 %.
//! Not identified: gain (fixed at 2·sigma·kappa_eta·rho by --invertible).
//! Not identified: sigma (at its lower bound).
//! Not identified: n (at its lower bound).
//! Feed-forward: yes.
//!
//! Compute the derivatives of each source once per sample, with a `RatesState` for each source:
//! `let motion = Rates::try_new(RATES_TIME_CONSTANT)?.step(&mut state, position, dt).motion;`
//! Feed-forward controller: `Compensator::try_new(&model()?)?.with_ranges(&ranges())?`.

use bowden::control::BenchRange;
use bowden::effect::Motion;
use bowden::effect::Viscous;
use bowden::hysteresis::BoucWen;
use bowden::model::{FixedModel, Model, Source, Term};
use bowden::transmission::Transmission;

/// Time constant [s] of `bowden::signal::Rates` for every source.
#[allow(dead_code)]
pub const RATES_TIME_CONSTANT: f32 = 0.008376576;

/// The terms of the model, with the type of each effect.
#[allow(dead_code)]
pub type Terms = (Term<f32, Viscous>,);

/// The identified model in a type that can hold any effect, for a `Compensator` or a file.
///
/// # Errors
/// None, because the constructors accept the numbers below.
#[allow(dead_code)]
pub fn model() -> Result<Model<f32, 1>, bowden::Error> {
    Ok(fixed_model()?.to_model())
}

/// The identified model. Firmware links only the effects that it names.
///
/// # Errors
/// None, because the constructors accept the numbers below.
#[allow(dead_code, clippy::approx_constant)]
pub fn fixed_model() -> Result<FixedModel<f32, 1, Terms>, bowden::Error> {
    // rho [1/(N·m)], sigma [1], n [1]
    let shape = BoucWen::try_new(0.5462775, 0.5010001, 1.001)?;
    // B [1], kappa_eta [N·m], T0 [N·m]
    let transmission = Transmission::torque(0.9513806, 1.738092, -0.004557163, shape)?;
    let terms = (
        // viscous@phi_p: v
        Term {
            effect: Viscous,
            // phi_p
            source: Source::Channel(0),
            // [rad]
            origin: 0.0,
            // [N·m·s/rad]
            gain: -0.7287999,
        },
    );
    FixedModel::try_new(Some(transmission), terms)
}

/// Recorded range of each source that the model reads, for `Compensator::with_ranges`.
#[allow(dead_code, clippy::approx_constant)]
pub fn ranges() -> [BenchRange<f32>; 2] {
    [
        // input: position [N·m], velocity [N·m/s], acceleration [N·m/s²]
        BenchRange {
            source: Source::Input,
            low: Motion {
                position: -12.495871,
                velocity: -38.818592,
                acceleration: -170.3947,
            },
            high: Motion {
                position: 16.00307,
                velocity: 35.03235,
                acceleration: 142.7363,
            },
        },
        // phi_p: position [rad], velocity [rad/s], acceleration [rad/s²]
        BenchRange {
            source: Source::Channel(0),
            low: Motion {
                position: -0.45185134,
                velocity: -1.5794401,
                acceleration: -5.8742285,
            },
            high: Motion {
                position: 0.5994563,
                velocity: 1.608444,
                acceleration: 4.6569395,
            },
        },
    ]
}
