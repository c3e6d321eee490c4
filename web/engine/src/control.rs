//! Controller gains for a model, and controllers with these gains on the simulated rig.

use crate::identify::{headline, plain};
use crate::{command, Answer, File};
use bowden_cli::view::{compare as comparison, design as gains_view, Width};
use bowden_lab::facts::Source;
use bowden_page::{Compare as Page, Provenance};
use bowden_trials::facts::{
    compare as run_trials, design as derive, design_rust, other_configuration, Compared,
    DesignQuestion, Question, RigChanges,
};
use serde::Deserialize;
use std::path::Path;

/// The options of `bowden design`; an absent option has its default.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Wanted {
    /// Sampling rate of the controller \[Hz\].
    pub(crate) rate: f64,
    /// Delay from a command to its effect \[s\].
    pub(crate) delay: f64,
    /// Noise of the measured torque \[N·m rms\].
    pub(crate) noise: Option<f64>,
    /// Torque per command unit \[N·m\].
    pub(crate) drive_gain: Option<f64>,
}

/// The options of `bowden compare`; an absent option has its default.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Trials {
    /// Noise of the torque sensors \[N·m rms\].
    pub(crate) noise: Option<f64>,
    /// Whether the conduit moves.
    pub(crate) varying: bool,
    /// Whether the reference is a gait.
    pub(crate) gait: bool,
    /// Length of a trial \[s\].
    pub(crate) seconds: Option<f64>,
    /// Number of trials.
    pub(crate) seeds: Option<u64>,
    /// The rig.
    pub(crate) rig: RigChanges,
}

/// Gains for a model.
pub(crate) fn design((name, toml): (&str, &[u8]), wanted: &Wanted) -> Result<Answer, String> {
    let question = DesignQuestion {
        rate: wanted.rate,
        delay: wanted.delay,
        noise: wanted.noise.unwrap_or(0.0),
        drive_gain: wanted.drive_gain.unwrap_or(1.0),
    };
    let designed = derive(text_of(name, toml)?, name, &question)?;
    let report = gains_view::json(&designed).map_err(|e| e.to_string())?;
    let shown = plain(&gains_view::text(&designed, Width::of(80), false));
    let mut answer = Answer::default();
    answer.put("headline", headline(&shown));
    answer.put("command", command::design(name, wanted));
    let gains = designed.gains.toml().map_err(|e| e.to_string())?;
    for (name, text) in [
        ("gains.toml", gains),
        ("gains.rs", design_rust(&designed)),
        ("result.json", format!("{report}\n")),
        ("result.txt", shown),
    ] {
        answer.files.push((name.to_owned(), text.into_bytes()));
    }
    Ok(answer)
}

/// Controllers on the simulated rig: with the model, and with gains for it if there are some.
pub(crate) fn compare(
    model: &File,
    gains: Option<&File>,
    trials: &Trials,
    tell: &dyn Fn(&str),
) -> Result<Answer, String> {
    let files: Vec<&File> = std::iter::once(model).chain(gains).collect();
    let in_memory = files
        .iter()
        .map(|file| Ok((Path::new(&file.name), text_of(&file.name, &file.bytes)?)))
        .collect::<Result<Vec<_>, String>>()?;
    let default = Question::default();
    let question = Question {
        setup: Some(Path::new(&model.name)),
        gains: gains.map(|file| Path::new(&file.name)),
        rig: trials.rig,
        noise: trials.noise,
        varying: trials.varying,
        gait: trials.gait,
        seconds: trials.seconds.unwrap_or(default.seconds),
        seeds: trials.seeds.unwrap_or(default.seeds),
        traced: true,
        in_memory: &in_memory,
        ..default
    };
    let begins = |varying| match varying {
        true => tell("with the conduit moved"),
        false => tell("with the conduit at rest"),
    };
    begins(trials.varying);
    let first = run_trials(&question)?;
    begins(!trials.varying);
    let other = other_configuration(&question, &first)?;
    let command = command::compare(&model.name, gains.map(|file| &file.name[..]), trials);
    let sources = files
        .iter()
        .map(|file| Source::of_bytes(&file.name, &file.bytes));
    Ok(compared(&first, other, command, sources.collect()))
}

fn compared(
    first: &Compared,
    other: Option<Compared>,
    command: String,
    sources: Vec<Source>,
) -> Answer {
    let from = Provenance {
        command: command.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        sources,
    };
    let shown = plain(&comparison::text(first, Width::of(80), false));
    let mut answer = Answer::default();
    answer.put("headline", headline(&shown));
    answer.put("command", command);
    let mut both = vec![first.clone()];
    both.extend(other);
    let page = Page { compared: &both };
    for (name, text) in [
        ("report.html", page.page(&from)),
        ("result.json", format!("{}\n", comparison::json(first))),
        ("result.txt", shown),
    ] {
        answer.files.push((name.to_owned(), text.into_bytes()));
    }
    answer
}

/// The text of a model or of gains.
fn text_of<'a>(name: &str, bytes: &'a [u8]) -> Result<&'a str, String> {
    std::str::from_utf8(bytes).map_err(|_| format!("{name}: is not text"))
}
