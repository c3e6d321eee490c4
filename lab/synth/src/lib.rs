//! Generates test records with known missing effects.
//!
//! ```text
//! bowden generate --mode torque --effect viscous --seed 7 > my.csv
//! bowden identify my.csv
//! ```
//! writes twenty seconds at 1 kHz of a transmission that follows (5) to (7) of Nguyen et al.
//! (2018), with a viscous term on `phi_p` that the baseline model lacks. The term's rms is three
//! times that of the noise. Several effects may be planted at once; [`effects`] lists their names.
//! The same seed gives the same bytes.
//!
//! **This generator shares no code with the model that it tests.** An error in a common regressor
//! or integrator would be in both the record and the fit, and would cancel unnoticed. The generator
//! therefore integrates the hysteresis as the paper prints it, by fourth-order Runge-Kutta with the
//! analytic rate of the input, on a grid at least twenty times finer than the samples. Delays,
//! lags, creep and plays run on this fine grid too. Friction changes its sign along a different
//! smooth curve than in the fit. The samples are quantised and noisy, as from converters and
//! encoders.
//!
//! ```
//! use bowden_synth::{generate, Mode, Planted, Recipe};
//!
//! let recipe = Recipe { effects: vec![Planted::new("viscous")], seconds: 1.0, ..Recipe::new(Mode::Torque) };
//! let record = generate(&recipe)?;
//! assert!(record.to_csv().starts_with("t [s],tau_i [N·m],tau_o [N·m],phi_p [rad],phi_d [rad]\n"));
//! assert!((record.truth.effects[0].rms - 3.0 * recipe.noise).abs() < 1e-9);
//! # Ok::<(), bowden_synth::RecipeError>(())
//! ```

mod contribution;
mod effect;
mod excitation;
mod friction;
mod hysteresis;
mod memory;
mod outside;
mod plant;
mod recipe;
mod regressor;
mod rig;
mod sensor;
mod shape;
mod stage;
mod stored;

pub use effect::effects;
pub use outside::outsiders;
pub use plant::generate;
pub use recipe::{Base, Mode, Planted, Recipe, RecipeError};
pub use stored::{stored_csv, stored_recipe};

use std::fmt::Write as _;

/// A generated column: name, unit and one value per sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name in the header.
    pub name: &'static str,
    /// Unit in the header.
    pub unit: &'static str,
    /// The values that the sensor reports.
    pub values: Vec<f64>,
}

/// A record and its truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Synthetic {
    /// `t`, input, output, then the channels.
    pub columns: Vec<Column>,
    /// The result of a perfect identification.
    pub truth: Truth,
}

/// The truth of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Parameters of the transmission.
    pub base: Base,
    /// The planted effects, in the order of the recipe.
    pub effects: Vec<PlantedTruth>,
    /// Hysteresis state at each sample.
    pub eta: Vec<f64>,
    /// True input at each sample, before the sensor.
    pub input: Vec<f64>,
    /// Output at each sample, without noise or quantisation.
    pub output: Vec<f64>,
    /// Rms of the noise that was added to the output.
    pub noise_rms: f64,
}

/// One planted effect.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantedTruth {
    /// Its name.
    pub effect: String,
    /// The channel that it reads, if it reads one.
    pub channel: Option<&'static str>,
    /// The factor of the regressor; for a delay or a lag, its time \[s\].
    pub gain: f64,
    /// Shape parameters by name.
    pub shapes: Vec<(&'static str, f64)>,
    /// Rms of its contribution about the mean (of an offset: about zero).
    pub rms: f64,
    /// Contribution to the output at each sample.
    pub contribution: Vec<f64>,
}

impl Synthetic {
    /// The column of that name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// The record as a CSV file: `t [s],tau_i [N·m],tau_o [N·m],…`.
    pub fn to_csv(&self) -> String {
        csv(&self.columns)
    }
}

/// Columns as a CSV file.
fn csv(columns: &[Column]) -> String {
    let names: Vec<_> = columns
        .iter()
        .map(|c| format!("{} [{}]", c.name, c.unit))
        .collect();
    let mut text = names.join(",") + "\n";
    let samples = columns.first().map_or(0, |column| column.values.len());
    for sample in 0..samples {
        for (index, column) in columns.iter().enumerate() {
            let comma = if index == 0 { "" } else { "," };
            // Writing to a String cannot fail.
            let _ = write!(text, "{comma}{}", column.values[sample]);
        }
        text.push('\n');
    }
    text
}
