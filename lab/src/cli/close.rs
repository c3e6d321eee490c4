//! `bowden close`: the main job.

use super::Failure;
use crate::channels::{Preparation, Prepared};
use crate::closing::{close, structure};
use crate::export::ModelFile;
use crate::record::{parse, read, Mode, Options};
use crate::report::{json, text, Report};
use crate::synth::{generate, Planted, Recipe};
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Name of the embedded record: the command that writes the same one to a file.
const EMBEDDED: &str = "(embedded: bowden record --mode torque --effect viscous --seed 7)";

#[derive(Clone, Copy, ValueEnum)]
enum ModeName {
    Torque,
    Displacement,
}

#[derive(Args, Default)]
pub struct Close {
    /// A CSV file with a header; the embedded record where it is not given.
    record: Option<PathBuf>,
    /// Torque (tau_i to tau_o) or displacement (x to f); from the columns where silent.
    #[arg(long, value_enum)]
    mode: Option<ModeName>,
    /// Column of the time [s]; `t` where it is not given.
    #[arg(long, value_name = "COL")]
    time: Option<String>,
    /// Column of the input; `tau_i` or `x` where it is not given.
    #[arg(long, value_name = "COL")]
    input: Option<String>,
    /// Column of the output; `tau_o` or `f` where it is not given.
    #[arg(long, value_name = "COL")]
    output: Option<String>,
    /// A further channel: phi_p, phi_d (angles), temperature, load, or any other name.
    #[arg(long, value_name = "NAME=COL")]
    channel: Vec<String>,
    /// The model that is declared: bouc-wen and any effects; NAME@CHANNEL reads a channel.
    #[arg(long, value_delimiter = ',', value_name = "A,B,…")]
    declare: Vec<String>,
    /// Leave out the first seconds.
    #[arg(long, value_name = "SECONDS")]
    skip: Option<f64>,
    /// Leave out what comes after this time.
    #[arg(long, value_name = "SECONDS")]
    until: Option<f64>,
    /// Cut-off of the one filter [Hz]; from the input's spectrum where it is not given.
    #[arg(long, value_name = "HZ")]
    cutoff: Option<f64>,
    /// Take time from the row number, at this rate.
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
    /// Print one JSON object on stdout instead of tables.
    #[arg(long)]
    json: bool,
    /// Write the final model: .toml for tools, .rs for firmware.
    #[arg(long, value_name = "FILE.toml")]
    model_out: Option<PathBuf>,
}

impl Close {
    pub fn run(self) -> Result<(), Failure> {
        let options = self.options()?;
        if let Some(cutoff) = self.cutoff {
            if !(cutoff.is_finite() && cutoff > 0.0) {
                return Err(format!(
                    "--cutoff {cutoff}: a positive frequency in Hz was expected"
                ));
            }
        }
        if let Some(path) = &self.model_out {
            model_form(path)?;
        }
        let bar = progress();
        bar.set_message("reading");
        let (label, record) = match &self.record {
            Some(path) => {
                let label = path.display().to_string();
                (label, read(path, &options).map_err(|e| e.to_string())?)
            }
            None => {
                let recipe = Recipe {
                    effects: vec![Planted::new("viscous")],
                    seed: 7,
                    ..Recipe::new(crate::synth::Mode::Torque)
                };
                let csv = generate(&recipe).map_err(|e| e.to_string())?.to_csv();
                (
                    EMBEDDED.to_owned(),
                    parse(csv.as_bytes(), EMBEDDED, &options).map_err(|e| e.to_string())?,
                )
            }
        };
        let named = |message: String| format!("{label}: {message}");
        let data = Prepared::new(
            &record,
            Preparation {
                cutoff: self.cutoff,
            },
        )
        .map_err(named)?;
        let list = if self.declare.is_empty() {
            vec!["bouc-wen".to_owned()]
        } else {
            self.declare.clone()
        };
        let structure = structure(&list, &data).map_err(named)?;
        let ledger =
            close(&data, &structure, |what| bar.set_message(what.to_owned())).map_err(named)?;
        bar.finish_and_clear();
        if let Some(path) = &self.model_out {
            let file = ModelFile::new(&data, ledger.last());
            let remark = format!(
                "Identified by bowden {} from {label}",
                env!("CARGO_PKG_VERSION")
            );
            let text = match model_form(path)? {
                Form::Toml => file
                    .toml(&remark)
                    .map_err(|e| format!("{}: {e}", path.display()))?,
                Form::Rust => file.rust(&remark),
            };
            super::write_whole(path, text.as_bytes())?;
        }
        if self.json {
            let text = json(&Report::new(&label, &data, &ledger)).map_err(|e| e.to_string())?;
            super::say(&text)
        } else {
            super::say(text(&label, &data, &ledger, self.cutoff.is_some()).trim_end())
        }
    }

    fn options(&self) -> Result<Options, Failure> {
        let pair = |text: &String| {
            text.split_once('=')
                .map(|(name, column)| (name.to_owned(), column.to_owned()))
                .ok_or_else(|| format!("--channel {text}: NAME=COL was expected"))
        };
        Ok(Options {
            mode: self.mode.map(|m| match m {
                ModeName::Torque => Mode::Torque,
                ModeName::Displacement => Mode::Displacement,
            }),
            time: self.time.clone(),
            input: self.input.clone(),
            output: self.output.clone(),
            channels: self.channel.iter().map(pair).collect::<Result<_, _>>()?,
            skip: self.skip.unwrap_or(0.0),
            until: self.until,
            rate: self.rate,
        })
    }
}

enum Form {
    Toml,
    Rust,
}

fn model_form(path: &Path) -> Result<Form, Failure> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("toml") => Ok(Form::Toml),
        Some("rs") => Ok(Form::Rust),
        _ => Err(format!(
            "--model-out {}: a name that ends in .toml or .rs was expected",
            path.display()
        )),
    }
}

/// A spinner on a terminal, nothing elsewhere.
fn progress() -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {elapsed} {msg}") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}
