//! `bowden generate`: a generated record as CSV on stdout or in a file.

use super::{outputs, Failure};
use bowden_synth::{generate, Mode, Planted, PlantedTruth, Recipe};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Clone, Copy, ValueEnum)]
enum ModeName {
    Torque,
    Displacement,
}

#[derive(Args)]
pub struct Generate {
    /// Input of the transmission: a torque or a displacement.
    #[arg(long, value_enum, default_value = "torque")]
    mode: ModeName,
    /// Effect that the baseline model lacks. STRENGTH is in multiples of the noise. The option may
    /// be repeated.
    #[arg(long, value_name = "NAME[@CHANNEL][:STRENGTH]")]
    effect: Vec<String>,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Length of the record [s].
    #[arg(long, default_value_t = 20.0)]
    seconds: f64,
    /// Sampling rate [Hz].
    #[arg(long, default_value_t = 1000.0)]
    rate: f64,
    /// RMS noise of the output, in the unit of the output.
    #[arg(long, default_value_t = 0.05)]
    noise: f64,
    /// Lag-one autocorrelation of the noise, 0 to below 1. 0 gives white noise.
    #[arg(long, default_value_t = 0.0)]
    colour: f64,
    /// Half-width of a play in series, between the input and the transmission
    /// [N·m or mm].
    #[arg(long, default_value_t = 0.0)]
    play: f64,
    /// Output file [default: stdout]. With a file, the true gain and shapes of each effect are
    /// printed.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
}

/// "viscous", "viscous:2.5", "viscous@phi_d:2.5".
fn planted(text: &str) -> Result<Planted, Failure> {
    let (what, strength) = match text.split_once(':') {
        None => (text, 3.0),
        Some((what, strength)) => {
            let value: f64 = strength.parse().map_err(|_| {
                format!("--effect {text}: {strength:?} is not a number; write NAME:STRENGTH")
            })?;
            (what, value)
        }
    };
    let (name, channel) = match what.split_once('@') {
        None => (what, None),
        Some((name, channel)) => (name, Some(channel.to_owned())),
    };
    Ok(Planted {
        strength,
        channel,
        ..Planted::new(name)
    })
}

impl Generate {
    pub fn run(self) -> Result<(), Failure> {
        let mode = match self.mode {
            ModeName::Torque => Mode::Torque,
            ModeName::Displacement => Mode::Displacement,
        };
        let effects = self
            .effect
            .iter()
            .map(|e| planted(e))
            .collect::<Result<Vec<_>, _>>()?;
        let reads = |name: &str| effects.iter().any(|e| e.effect == name);
        let recipe = Recipe {
            temperature: reads("temperature"),
            load: mode == Mode::Displacement
                && [
                    "gain",
                    "load-friction",
                    "capstan",
                    "drive-friction",
                    "back-drive-friction",
                ]
                .iter()
                .any(|n| reads(n)),
            seed: self.seed,
            seconds: self.seconds,
            rate: self.rate,
            noise: self.noise,
            colour: self.colour,
            play: self.play,
            effects,
            ..Recipe::new(mode)
        };
        let record = generate(&recipe).map_err(|e| e.to_string())?;
        let csv = record.to_csv();
        match &self.out {
            Some(path) => {
                outputs::write_whole(path, csv.as_bytes())?;
                super::pour(truth(&record.truth.effects).as_bytes())
            }
            None => super::pour(csv.as_bytes()),
        }
    }
}

/// A line for each effect in the record: "viscous@phi_p: gain -0.2638, rms 0.15".
fn truth(effects: &[PlantedTruth]) -> String {
    // Four digits.
    let short = |value: f64| format!("{value:.3e}").parse().unwrap_or(value);
    let mut text = String::new();
    for own in effects {
        let channel = own.channel.map(|name| format!("@{name}"));
        text += &format!("{}{}:", own.effect, channel.unwrap_or_default());
        // The only parameter of a delay and a lag is a time.
        let first = match own.effect.as_str() {
            "delay" | "lag" => "time [s]",
            _ => "gain",
        };
        for (name, value) in std::iter::once(&(first, own.gain)).chain(&own.shapes) {
            text += &format!(" {name} {},", short(*value));
        }
        text += &format!(" rms {}\n", short(own.rms));
    }
    text
}
