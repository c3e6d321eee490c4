//! What all commands have in common that read a record.

use super::Failure;
use crate::closing::{close_within, MOST_ROUNDS};
use crate::ledger::Ledger;
use crate::model::declared::structure;
use crate::model::structure::Structure;
use crate::problem::{HeldOut, Preparation, Prepared};
use crate::record::{Mode, Options, Record};
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal as _;
use std::time::Duration;

#[derive(Clone, Copy, ValueEnum)]
pub enum ModeName {
    Torque,
    Displacement,
}

/// How the columns of a record are read and filtered.
#[derive(Args, Default)]
pub struct Columns {
    /// Torque (tau_i to tau_o) or displacement (x to f); from the columns where silent.
    #[arg(long, value_enum)]
    pub mode: Option<ModeName>,
    /// Column of the time [s]; `t` where it is not given.
    #[arg(long, value_name = "COL")]
    pub time: Option<String>,
    /// Column of the input; `tau_i` or `x` where it is not given.
    #[arg(long, value_name = "COL")]
    pub input: Option<String>,
    /// Column of the output; `tau_o` or `f` where it is not given.
    #[arg(long, value_name = "COL")]
    pub output: Option<String>,
    /// A further channel: phi_p, phi_d (angles), temperature, load, or any other name.
    #[arg(long, value_name = "NAME=COL")]
    pub channel: Vec<String>,
    /// Leave out the first seconds.
    #[arg(long, value_name = "SECONDS")]
    pub skip: Option<f64>,
    /// Leave out what comes after this time.
    #[arg(long, value_name = "SECONDS")]
    pub until: Option<f64>,
    /// Cut-off of the one filter [Hz]; from the input's spectrum where it is not given.
    #[arg(long, value_name = "HZ")]
    pub cutoff: Option<f64>,
    /// Take time from the row number, at this rate.
    #[arg(long, value_name = "HZ")]
    pub rate: Option<f64>,
}

#[derive(Args, Default)]
pub struct Reading {
    #[command(flatten)]
    pub columns: Columns,
    /// The model that is declared: bouc-wen and any effects; NAME@CHANNEL reads a channel.
    #[arg(long, value_delimiter = ',', value_name = "A,B,…")]
    pub declare: Vec<String>,
    /// Add at most N effects, 0 to 8; 0 only fits what is declared and looks for nothing.
    #[arg(long, value_name = "N")]
    pub rounds: Option<usize>,
}

impl Columns {
    pub fn options(&self) -> Result<Options, Failure> {
        if let Some(cutoff) = self.cutoff {
            if !(cutoff.is_finite() && cutoff > 0.0) {
                return Err(format!(
                    "--cutoff {cutoff}: a positive frequency in Hz was expected"
                ));
            }
        }
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

impl Reading {
    /// The columns, and what all options of the loop have to be.
    pub fn options(&self) -> Result<Options, Failure> {
        match self.rounds {
            Some(rounds) if rounds > MOST_ROUNDS => Err(format!(
                "--rounds {rounds}: 0 to {MOST_ROUNDS} were expected"
            )),
            _ => self.columns.options(),
        }
    }

    /// Runs the loop with as many rounds as were asked for; `tell` hears what is being done.
    pub fn close(
        &self,
        data: &Prepared,
        structure: &Structure,
        tell: impl FnMut(&str),
    ) -> Result<Ledger, String> {
        let most = self.rounds.unwrap_or(MOST_ROUNDS);
        close_within(data, structure, most, tell)
    }

    /// A record on its grids, and the declared model.
    pub fn prepare(&self, record: &Record) -> Result<(Prepared, Structure), Failure> {
        let named = |message: String| format!("{}: {message}", record.path);
        let cutoff = self.columns.cutoff;
        let data = Prepared::new(record, Preparation { cutoff }).map_err(named)?;
        let structure = self.declared(&data).map_err(named)?;
        Ok((data, structure))
    }

    /// Several records on common grids, and the declared model.
    pub fn prepare_joined(
        &self,
        records: &[Record],
        held_out: HeldOut,
    ) -> Result<(Prepared, Structure), Failure> {
        let cutoff = self.columns.cutoff;
        let data = Prepared::joined(records, Preparation { cutoff }, held_out)?;
        let structure = self.declared(&data)?;
        Ok((data, structure))
    }

    fn declared(&self, data: &Prepared) -> Result<Structure, String> {
        let list = if self.declare.is_empty() {
            vec!["bouc-wen".to_owned()]
        } else {
            self.declare.clone()
        };
        structure(&list, data)
    }
}

/// A spinner on a terminal, nothing elsewhere.
pub fn progress() -> ProgressBar {
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
