//! Options that all commands that read a record have in common.

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
    /// Torque (tau_i to tau_o) or displacement (x to f) [default: from the column names].
    #[arg(long, value_enum)]
    pub mode: Option<ModeName>,
    /// Time column [default: `t`, `time`, `timestamp` or a unit such as `ms`]. Any column name may
    /// be followed by a unit, as in 'tick [ms]'.
    #[arg(long, value_name = "COL")]
    pub time: Option<String>,
    /// Input column [default: `tau_i` or `x`].
    #[arg(long, value_name = "COL")]
    pub input: Option<String>,
    /// Output column [default: `tau_o` or `f`].
    #[arg(long, value_name = "COL")]
    pub output: Option<String>,
    /// Add a channel: phi_p or phi_d (angles), temperature, load, or any other name. COL may be the
    /// difference A-B or the sum A+B of two columns.
    #[arg(long, value_name = "NAME=COL")]
    pub channel: Vec<String>,
    /// Discard the samples before this time, in seconds after the first time stamp [default: 0].
    #[arg(long, alias = "skip", value_name = "SECONDS")]
    pub start: Option<f64>,
    /// Discard the samples after this time, in seconds after the first time stamp [default: the
    /// last sample].
    #[arg(long, alias = "until", value_name = "SECONDS")]
    pub end: Option<f64>,
    /// Cut-off frequency of the zero-phase low-pass filter [Hz] [default: from the input's
    /// spectrum; `validate` uses the cut-off of the model file].
    #[arg(long, value_name = "HZ")]
    pub cutoff: Option<f64>,
    /// Compute the time from the row number and this sampling rate [Hz].
    #[arg(long, value_name = "HZ")]
    pub rate: Option<f64>,
    /// Line number of the column names, counted from 1 [default: detected].
    #[arg(long, value_name = "N")]
    pub header_line: Option<usize>,
    /// Read only segment N, counted from 1, of a text file that repeats its column names [default:
    /// all segments as one record if the time continues].
    #[arg(long, value_name = "N")]
    pub segment: Option<usize>,
    /// Sheet of an Excel workbook [default: the first one with a table].
    #[arg(long, value_name = "NAME")]
    pub sheet: Option<String>,
    /// Column names of a text file without a header, such as t,x,f or 't [ms],,x [mm],f [N]'. An
    /// empty name excludes its column.
    #[arg(long, value_delimiter = ',', value_name = "A,B,…")]
    pub names: Vec<String>,
    /// Drop rows with an empty cell, a NaN or a repeated time stamp, and treat each as a gap
    /// [default: such rows are an error].
    #[arg(long)]
    pub drop_bad: bool,
}

#[derive(Args, Default)]
pub struct Reading {
    #[command(flatten)]
    pub columns: Columns,
    /// Parts of the baseline model: bouc-wen and any effects. NAME@CHANNEL reads a channel
    /// [default: bouc-wen].
    #[arg(long, alias = "declare", value_delimiter = ',', value_name = "A,B,…")]
    pub baseline: Vec<String>,
    /// Add at most N terms, 0 to 8. With 0, fit only the baseline model.
    #[arg(long, alias = "rounds", value_name = "N")]
    pub max_terms: Option<usize>,
    /// Stop the search after this time and print the best model so far. The result may then depend
    /// on the speed of the computer.
    #[arg(long, alias = "budget", value_name = "SECONDS")]
    pub time_limit: Option<f64>,
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
                    "`--cutoff {cutoff}` is out of range; it must be positive"
                ));
            }
        }
        let pair = |text: &String| {
            text.split_once('=')
                .map(|(name, column)| (name.to_owned(), column.to_owned()))
                .ok_or_else(|| format!("`--channel {text}` is not of the form NAME=COL"))
        };
        let options = Options {
            mode: self.mode.map(ModeName::mode),
            time: self.time.clone(),
            input: self.input.clone(),
            output: self.output.clone(),
            channels: self.channel.iter().map(pair).collect::<Result<_, _>>()?,
            skip: self.start.unwrap_or(0.0),
            until: self.end,
            rate: self.rate,
            header_line: self.header_line,
            segment: self.segment,
            sheet: self.sheet.clone(),
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
    /// The columns, the filter, the baseline model and the limits of the search.
    pub fn asked(&self) -> Result<Asked, Failure> {
        if let Some(terms) = self.max_terms.filter(|terms| *terms > MOST_NAMES) {
            return Err(format!(
                "`--max-terms {terms}` is out of range (0 to {MOST_NAMES})"
            ));
        }
        if let Some(limit) = self.time_limit.filter(|s| !(s.is_finite() && *s > 0.0)) {
            return Err(format!(
                "`--time-limit {limit}` is out of range; it must be positive"
            ));
        }
        Ok(Asked {
            declare: self.baseline.clone(),
            rounds: self.max_terms,
            budget: self.time_limit,
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
        (self.vectors > 0).then(|| format!("{} excluded from the pattern", vectors(self.vectors)))
    }
}

fn vectors(count: usize) -> String {
    match count {
        1 => "1 test vector of --model-out".to_owned(),
        _ => format!("{count} test vectors of --model-out"),
    }
}

/// The files of arguments that may be patterns (`runs/*.csv`), if the shell has not expanded them.
/// Files of a pattern are sorted by name. A file with exactly the name of the pattern takes
/// precedence. Test vectors, which this program writes next to a model, are not records.
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
                count => format!(" except {}", vectors(count)),
            };
            return Err(format!("{text}: no file matches this pattern{but}"));
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
            "{}: {} files match this pattern; exactly one must match",
            argument.display(),
            several.len()
        )),
    }
}
