//! Several seeds of one controller: mean and standard deviation.

use super::limited::AtLimit;
use super::trial::{run, Conditions, Controller, Trial};
use rayon::prelude::*;
use serde::Serialize;

/// Mean and standard deviation over seeds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation of a trial; 0 with a single one.
    pub sd: f64,
}

impl Spread {
    fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let n = values.clone().count().max(1) as f64;
        let mean = values.clone().sum::<f64>() / n;
        let square = values.map(|v| (v - mean).powi(2)).sum::<f64>();
        Self {
            mean,
            sd: (square / (n - 1.0).max(1.0)).sqrt(),
        }
    }
}

/// One controller over all seeds.
#[derive(Debug, Clone)]
pub struct Line {
    /// Name of the controller.
    pub controller: String,
    /// Rms of the true error, steady part \[N·m\].
    pub rmse_true: Spread,
    /// Rms of the measured error, steady part \[N·m\].
    pub rmse_measured: Spread,
    /// Mean measured error as a fraction of the largest reference.
    pub share: f64,
    /// Largest true error of any trial, steady part \[N·m\].
    pub peak: f64,
    /// Total variation of the command per second, mean \[units/s\].
    pub effort: f64,
    /// Reversals of the command, mean \[1/s\].
    pub reversals: f64,
    /// Fraction of the steady part in which the command is at a limit, mean.
    pub at_limit: AtLimit,
    /// Rms of the true error in the first 12 s \[N·m\].
    pub transient: Spread,
    /// Largest true error in the first 12 s \[N·m\].
    pub transient_peak: f64,
    /// Largest command of any trial \[units\].
    pub command: f64,
    /// Number of trials that diverged.
    pub diverged: usize,
    /// Time at which the first of these trials diverged \[s\]; `None` if none diverged.
    pub ran_away: Option<f64>,
    /// The trial of the first seed, with its trace if requested.
    pub first: Trial,
    /// Rms of the true error of each seed \[N·m\].
    pub each: Vec<f64>,
}

impl Line {
    /// Mean rms of the true error, steady part \[N·m\]; `None` if the law diverged.
    #[must_use]
    pub fn mean_error(&self) -> Option<f64> {
        (self.diverged == 0).then_some(self.rmse_true.mean)
    }
}

/// Runs every controller with every seed, on all cores. The results are in the order of the list.
///
/// # Errors
/// The error of the core for an invalid parameter of the rig.
pub fn run_all(
    controllers: &[Controller],
    conditions: &Conditions,
    seeds: &[u64],
    traced: bool,
) -> Result<Vec<Line>, String> {
    let jobs: Vec<(usize, usize)> = (0..controllers.len())
        .flat_map(|c| (0..seeds.len()).map(move |s| (c, s)))
        .collect();
    let trials: Vec<Trial> = jobs
        .par_iter()
        .map(|&(c, s)| run(&controllers[c], conditions, seeds[s], traced && s == 0))
        .collect::<Result<_, _>>()
        .map_err(|e| format!("the rig: {e}"))?;
    let lines = controllers
        .iter()
        .zip(trials.chunks(seeds.len().max(1)))
        .map(|(controller, own)| line(&controller.name, own, conditions))
        .collect();
    Ok(lines)
}

fn line(name: &str, trials: &[Trial], conditions: &Conditions) -> Line {
    let spread = |of: fn(&Trial) -> f64| Spread::of(trials.iter().map(of));
    let most = |of: fn(&Trial) -> f64| trials.iter().map(of).fold(0.0, f64::max);
    let rmse_measured = spread(|t| t.steady.rmse_measured);
    Line {
        controller: name.to_owned(),
        rmse_true: spread(|t| t.steady.rmse_true),
        rmse_measured,
        share: rmse_measured.mean / conditions.reference.magnitude(),
        peak: most(|t| t.steady.peak),
        effort: spread(|t| t.effort).mean,
        reversals: spread(|t| t.reversals).mean,
        at_limit: AtLimit {
            range: spread(|t| t.at_limit.range).mean,
            slew: spread(|t| t.at_limit.slew).mean,
        },
        transient: spread(|t| t.transient.rmse_true),
        transient_peak: most(|t| t.transient.peak),
        command: most(|t| t.command),
        diverged: trials.iter().filter(|t| t.ran_away.is_some()).count(),
        ran_away: trials
            .iter()
            .filter_map(|t| t.ran_away)
            .min_by(f64::total_cmp),
        first: trials.first().cloned().unwrap_or_default(),
        each: trials.iter().map(|t| t.steady.rmse_true).collect(),
    }
}

/// The controller with the smallest mean true error among those that `among` admits; `None` if all
/// of them diverged.
pub fn smallest_error(lines: &[Line], among: impl Fn(&str) -> bool) -> Option<&Line> {
    let lines = lines.iter().filter(|line| among(&line.controller));
    let finished = lines.filter_map(|line| Some((line.mean_error()?, line)));
    let least = finished.min_by(|(a, _), (b, _)| a.total_cmp(b));
    least.map(|(_, line)| line)
}

/// A note on the controllers whose command is at a limit for much of the steady part; `None` if
/// there are none.
#[must_use]
pub fn told_of_limits(lines: &[Line]) -> Option<String> {
    let lines = lines.iter().filter(|line| line.diverged == 0);
    let own =
        lines.filter_map(|line| Some(format!("{} {}", line.controller, line.at_limit.words()?)));
    let all: Vec<String> = own.collect();
    (!all.is_empty()).then(|| {
        format!(
            "The command saturates: {}. Such a row shows the effect of the limit, not of the gains.",
            all.join("; ")
        )
    })
}
