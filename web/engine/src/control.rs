//! Controller gains for a model, and controllers with these gains on the simulated rig.

use crate::identify::{headline, plain};
use crate::{command, Answer, File};
use bowden_cli::view::{compare as comparison, design as gains_view, Width};
use bowden_lab::facts::Source;
use bowden_page::{Compare as Page, Provenance};
use bowden_trials::facts::{
    compare as run_trials, design as derive, design_rust, Compared, DesignQuestion, Question,
    RigChanges,
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
    /// Torque per command unit \[N·m\].
    pub(crate) drive_gain: Option<f64>,
    /// Inertia of motor and proximal pulley \[kg·m²\].
    pub(crate) inertia: Option<f64>,
    /// Viscous friction of motor and proximal pulley \[N·m·s/rad\].
    pub(crate) damping: Option<f64>,
    /// Inertia of the joint \[kg·m²\].
    pub(crate) joint_inertia: Option<f64>,
    /// Damping of the joint \[N·m·s/rad\].
    pub(crate) joint_damping: Option<f64>,
    /// Spring that the joint works against \[N·m/rad\].
    pub(crate) spring: Option<f64>,
    /// Samples between a command and the drive.
    pub(crate) delay: Option<u8>,
    /// Time constant of the drive \[s\].
    pub(crate) drive_lag: Option<f64>,
    /// Time constant of the torque sensors \[s\].
    pub(crate) sensor_lag: Option<f64>,
}

impl Trials {
    /// A message names the option that is out of range; the rig checks its own numbers.
    fn check(&self) -> Result<(), String> {
        let (seconds, seeds) = (self.seconds(), self.seeds());
        if !(8.0..=3600.0).contains(&seconds) {
            return Err(format!("--seconds {seconds} is out of range (8 to 3600)"));
        }
        if !(1..=1000).contains(&seeds) {
            return Err(format!("--seeds {seeds} is out of range (1 to 1000)"));
        }
        match self.delay {
            Some(delay) if delay > 8 => Err(format!("--delay {delay} is out of range (0 to 8)")),
            _ => Ok(()),
        }
    }

    fn seconds(&self) -> f64 {
        self.seconds.unwrap_or(60.0)
    }

    fn seeds(&self) -> u64 {
        self.seeds.unwrap_or(6)
    }

    fn rig(&self) -> RigChanges {
        RigChanges {
            drive_gain: self.drive_gain,
            motor_inertia: self.inertia,
            motor_damping: self.damping,
            joint_inertia: self.joint_inertia,
            joint_damping: self.joint_damping,
            load_stiffness: self.spring,
            drive_lag: self.drive_lag,
            sensor_lag: self.sensor_lag,
            delay: self.delay,
        }
    }
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
    trials.check()?;
    let files: Vec<&File> = std::iter::once(model).chain(gains).collect();
    let in_memory = files
        .iter()
        .map(|file| Ok((Path::new(&file.name), text_of(&file.name, &file.bytes)?)))
        .collect::<Result<Vec<_>, String>>()?;
    let question = Question {
        setup: Some(Path::new(&model.name)),
        gains: gains.map(|file| Path::new(&file.name)),
        rig: trials.rig(),
        noise: trials.noise,
        varying: trials.varying,
        gait: trials.gait,
        seconds: trials.seconds(),
        seeds: trials.seeds(),
        effect: None,
        traced: true,
        in_memory: &in_memory,
    };
    let moved = |varying| match varying {
        true => tell("with the conduit moved"),
        false => tell("with the conduit at rest"),
    };
    moved(trials.varying);
    let mut both = vec![run_trials(&question)?];
    // The report also has the other configuration.
    moved(!trials.varying);
    both.push(run_trials(&Question {
        varying: !trials.varying,
        ..question
    })?);
    let command = command::compare(&model.name, gains.map(|file| &file.name[..]), trials);
    let sources = files
        .iter()
        .map(|file| Source::of_bytes(&file.name, &file.bytes));
    Ok(compared(&both, command, sources.collect()))
}

fn compared(both: &[Compared], command: String, sources: Vec<Source>) -> Answer {
    let mut answer = Answer::default();
    let mut own = |name: &str, text: String| {
        answer.files.push((name.to_owned(), text.into_bytes()));
    };
    let page = Page { compared: both };
    let from = Provenance {
        command: command.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        sources,
    };
    own("report.html", page.page(&from));
    let mut first = Vec::new();
    if let Some(one) = both.first() {
        let shown = plain(&comparison::text(one, Width::of(80), false));
        first = headline(&shown);
        own("result.json", format!("{}\n", comparison::json(one)));
        own("result.txt", shown);
    }
    answer.put("headline", first);
    answer.put("command", command);
    answer
}

/// The text of a model or of gains.
fn text_of<'a>(name: &str, bytes: &'a [u8]) -> Result<&'a str, String> {
    std::str::from_utf8(bytes).map_err(|_| format!("{name}: is not text"))
}
