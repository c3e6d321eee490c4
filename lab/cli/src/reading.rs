//! What all commands have in common that read a record.

use super::{pattern, Failure};
use bowden_lab::facts::{Asked, Mode, Options, MOST_NAMES};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

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
    /// Column of the time [s]; `t`, `time` or `timestamp` where it is not given.
    #[arg(long, value_name = "COL")]
    pub time: Option<String>,
    /// Column of the input; `tau_i` or `x` where it is not given.
    #[arg(long, value_name = "COL")]
    pub input: Option<String>,
    /// Column of the output; `tau_o` or `f` where it is not given.
    #[arg(long, value_name = "COL")]
    pub output: Option<String>,
    /// A further channel: phi_p, phi_d (angles), temperature, load, or any other name; COL may
    /// be A-B or A+B of two columns.
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
    /// Line of the column names, from 1; found by itself where it is not given.
    #[arg(long, value_name = "N")]
    pub header_line: Option<usize>,
    /// Names of the columns of a text that has none: t,x,f or 't [ms],,x [mm],f [N]'; an empty
    /// name is that of a column which is not read.
    #[arg(long, value_delimiter = ',', value_name = "A,B,…")]
    pub names: Vec<String>,
    /// Leave out rows with an empty cell, a NaN or a time stamp that repeats: each becomes a
    /// gap. Without it such a record is refused.
    #[arg(long)]
    pub drop_bad: bool,
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
    /// Stop looking after so many seconds and give the best so far; what is found then depends
    /// on the machine.
    #[arg(long, value_name = "SECONDS")]
    pub budget: Option<f64>,
}

impl ModeName {
    pub fn mode(self) -> Mode {
        match self {
            Self::Torque => Mode::Torque,
            Self::Displacement => Mode::Displacement,
        }
    }
}

impl Columns {
    /// The columns and the filter; the model is `bouc-wen` and the search as long as it takes.
    pub fn asked(&self) -> Result<Asked, Failure> {
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
        let options = Options {
            mode: self.mode.map(ModeName::mode),
            time: self.time.clone(),
            input: self.input.clone(),
            output: self.output.clone(),
            channels: self.channel.iter().map(pair).collect::<Result<_, _>>()?,
            skip: self.skip.unwrap_or(0.0),
            until: self.until,
            rate: self.rate,
            header_line: self.header_line,
            names: self.names.clone(),
            drop_bad: self.drop_bad,
        };
        Ok(Asked {
            options,
            cutoff: self.cutoff,
            ..Asked::default()
        })
    }
}

impl Reading {
    /// The columns, the filter, the declared model and the length of the search.
    pub fn asked(&self) -> Result<Asked, Failure> {
        if let Some(rounds) = self.rounds.filter(|rounds| *rounds > MOST_NAMES) {
            return Err(format!(
                "--rounds {rounds}: 0 to {MOST_NAMES} were expected"
            ));
        }
        if let Some(budget) = self.budget.filter(|b| !(b.is_finite() && *b > 0.0)) {
            return Err(format!(
                "--budget {budget}: a positive number of seconds was expected"
            ));
        }
        Ok(Asked {
            declare: self.declare.clone(),
            rounds: self.rounds,
            budget: self.budget,
            ..self.columns.asked()?
        })
    }
}

/// The files of arguments.
#[derive(Default)]
pub struct Files {
    pub paths: Vec<PathBuf>,
    /// How many test vectors their patterns have matched besides.
    vectors: usize,
}

impl Files {
    /// What a pattern has left out.
    pub fn note(&self) -> Option<String> {
        (self.vectors > 0).then(|| format!("{} left out of the pattern", vectors(self.vectors)))
    }
}

fn vectors(count: usize) -> String {
    match count {
        1 => "1 test vector of --model-out".to_owned(),
        _ => format!("{count} test vectors of --model-out"),
    }
}

/// The files of arguments that may be patterns (`runs/*.csv`), where the shell has not put
/// files in their place: those of a pattern by name. A file of that very name comes first. Of the
/// files of a pattern test vectors, which this program writes beside a model, are no records.
pub fn files(arguments: &[PathBuf]) -> Result<Files, Failure> {
    let mut files = Files::default();
    for argument in arguments {
        let text = argument.to_string_lossy();
        if !text.contains(['*', '?', '[']) || argument.exists() {
            files.paths.push(argument.clone());
            continue;
        }
        let found = pattern::files(argument)?;
        let (left_out, found): (Vec<_>, Vec<_>) =
            found.into_iter().partition(|path| pattern::is_vector(path));
        if found.is_empty() {
            let but = match left_out.len() {
                0 => String::new(),
                count => format!(" but {}", vectors(count)),
            };
            return Err(format!("{text}: no file has such a name{but}"));
        }
        files.vectors += left_out.len();
        files.paths.extend(found);
    }
    Ok(files)
}

/// The one file of an argument that may be a pattern.
pub fn file(argument: &Path) -> Result<PathBuf, Failure> {
    let files = files(&[argument.to_owned()])?.paths;
    match <[PathBuf; 1]>::try_from(files) {
        Ok([one]) => Ok(one),
        Err(several) => Err(format!(
            "{}: {} files have such a name, one was expected",
            argument.display(),
            several.len()
        )),
    }
}
