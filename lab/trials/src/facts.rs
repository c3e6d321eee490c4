//! The results of a comparison as plain data.

use super::certificates::named;
use super::found::outcome;
use super::gains::{is_of_design, GainsFile};
use super::heading::{file_name, is_paper, lag_error, with_drive_gain};
use super::lineup::{declared_feed, lineup};
use super::own_rig;
use super::setup::Setup;
use super::table::run_all;
use super::trial::{Conditions, FROM, TRANSIENT};
use bowden::model::Term;
use bowden_rig::{Drift, Reference};
use serde::Serialize;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::path::Path;

pub use super::certificates::Promise;
pub use super::decimal::{above, fixed, places, scientific, Towards};
pub use super::design::{
    design, rust as design_rust, AdaptiveDesign, Certifies, Designed, PidDesign,
    Question as DesignQuestion,
};
pub use super::found::{Outcome, Pair};
pub use super::heading::Heading;
pub use super::limited::AtLimit;
pub use super::lineup::knows;
pub use super::own_rig::RigChanges;
pub use super::proof::{coq, gappa, prove, Proof, Sides};
pub use super::question::Question;
pub use super::table::{smallest_error, told_of_limits, Line, Spread};
pub use super::tolerance::Tolerance;
pub use super::trial::Row;
pub use super::undeclared::Undeclared;
pub use bowden_bound::Named;

/// Gain, leakage and bounds of one estimate of the adaptive law.
pub type Estimate = bowden::control::Estimator<f64>;

/// Noise at which the benefit of a found effect is visible \[N·m rms\].
const QUIET: f64 = 0.02;

/// The result of a comparison.
#[derive(Debug, Clone)]
pub struct Compared {
    /// The conditions of the trials.
    pub heading: Heading,
    /// The results of the trials.
    pub results: Results,
}

/// The results of the trials.
#[derive(Debug, Clone)]
pub enum Results {
    /// The controllers of the paper, and further controllers for a fair comparison.
    Lineup(Lineup),
    /// An undeclared effect that was identified and fed forward.
    Found(Found),
}

/// The controllers on the rig without an undeclared effect.
#[derive(Debug, Clone)]
pub struct Lineup {
    /// One line for each controller.
    pub lines: Vec<Line>,
    /// The certificates of the controllers, by name.
    pub certificates: BTreeMap<String, Promise>,
}

/// The controllers with the baseline model and with the found terms.
#[derive(Debug, Clone)]
pub struct Found {
    /// The effect.
    pub effect: Undeclared,
    /// One outcome for each seed.
    pub outcomes: Vec<Outcome>,
    /// The number of seeds on which each controller improved.
    pub over_seeds: Vec<OverSeeds>,
}

/// The number of seeds on which the found terms reduce a controller's error.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OverSeeds {
    /// Name of the controller.
    pub controller: String,
    /// Seeds with a lower error.
    pub lower: usize,
    /// Seeds with the same error.
    pub same: usize,
    /// Seeds with a higher error.
    pub higher: usize,
}

/// Runs the trials.
///
/// # Errors
/// A message if an option is out of range, the setup cannot be read, a law is rejected, or no model
/// is found.
pub fn compare(question: &Question<'_>) -> Result<Compared, String> {
    question.check()?;
    let (mut setup, gains, is_model) = inputs(question)?;
    let own_setup = match (&gains, is_model) {
        (Some(_), _) => None,
        (None, true) => question.gains,
        (None, false) => question.gains.or(question.setup),
    };
    let is_given = is_model;
    // A model alone is fed forward on the reference rig.
    let is_model = is_model && (question.gains.is_some() || question.rig != RigChanges::default());
    let effect = question.effect.map(Undeclared::parse).transpose()?;
    if effect.is_some() && (is_given || gains.is_some()) {
        return Err(
            "--effect works only on the reference rig with the gains of Nguyen et al. (2018); it cannot be combined with a model or with gains from `bowden design`"
                .to_owned(),
        );
    }
    let own = match is_model {
        true => own(&mut setup, question)?,
        false => None,
    };
    setup.rig = with_drive_gain(question.rig, gains.as_ref()).apply(setup.rig)?;
    let range = own.as_ref().and_then(|own| own.reference);
    let task = match question.gait {
        true => Reference::gait(),
        false => Reference::paper(),
    };
    let conditions = Conditions {
        rig: setup.rig,
        undeclared: own
            .as_ref()
            .map_or_else(Vec::new, |own| own.effects.clone()),
        reference: range.map_or(task, |[low, high]| task.between(low, high)),
        seconds: question.seconds,
        from: FROM,
    };
    let heading = Heading {
        noise: setup.rig.noise,
        varying: setup.rig.drift.is_some(),
        seconds: question.seconds,
        from: FROM,
        transient: TRANSIENT.min(question.seconds),
        seeds: usize::try_from(question.seeds).map_err(|e| e.to_string())?,
        fed_with: match &effect {
            None => declared_feed(&setup)?.changed_words().map(str::to_owned),
            Some(_) => None,
        },
        model: own.as_ref().and(question.setup).map(file_name),
        gains: gains.as_ref().and(question.gains).map(file_name),
        designed_model: gains.as_ref().map(|gains| gains.design.model.clone()),
        designed_drive_gain: gains.as_ref().map(|gains| gains.design.drive_gain),
        setup: own_setup.map(file_name),
        drive_gain: setup.rig.drive_gain,
        rig: question.rig,
        gait: question.gait,
        reference: range,
        lag_error: lag_error(
            &conditions.reference,
            setup.rig.sensor_lag,
            (FROM, question.seconds),
        ),
        is_paper: !question.gait && own.is_none() && gains.is_none() && is_paper(&setup),
    };
    let results = match effect {
        None => Results::Lineup(declared(
            (&setup, is_model),
            gains.as_ref(),
            &conditions,
            question,
        )?),
        Some(effect) => Results::Found(found(&setup, effect, &conditions, question)?),
    };
    Ok(Compared { heading, results })
}

/// The same comparison in the other configuration of the conduit (fixed or moving). The paper tests
/// each law in both configurations (Figures 7 and 8). `None` with an undeclared effect, or if the
/// setup itself moves the conduit.
///
/// # Errors
/// The same as [`compare`].
pub fn other_configuration(
    question: &Question<'_>,
    compared: &Compared,
) -> Result<Option<Compared>, String> {
    if question.effect.is_some() {
        return Ok(None);
    }
    let varying = !compared.heading.varying;
    let other = compare(&Question {
        varying,
        ..*question
    })?;
    Ok((other.heading.varying == varying).then_some(other))
}

/// The parts of the user's own model that the rig uses.
struct Own {
    effects: Vec<Term<f64>>,
    reference: Option<[f64; 2]>,
}

/// Gives the rig the transmission of the model.
fn own(setup: &mut Setup, question: &Question<'_>) -> Result<Option<Own>, String> {
    let (Some(file), Some(path)) = (&setup.model, question.setup) else {
        return Ok(None);
    };
    let told = |e: String| format!("{}: {e}", path.display());
    let cable = own_rig::transmission(file).map_err(told)?;
    let own = Own {
        effects: own_rig::effects(file).map_err(told)?,
        reference: own_rig::reference(file, &cable).map_err(told)?,
    };
    setup.rig = own_rig::with_transmission(&setup.rig, &cable);
    Ok(Some(own))
}

/// Whether a file is a model by itself.
fn is_model(question: &Question<'_>, path: Option<&Path>) -> bool {
    let text = path.and_then(|path| question.text(path).ok());
    let table = text.and_then(|text| toml::from_str::<toml::Table>(&text).ok());
    table.is_some_and(|table| table.contains_key("schema"))
}

fn no_model_is_refused(question: &Question<'_>, path: &Path) -> Result<(), String> {
    match is_model(question, Some(path)) {
        true => Ok(()),
        false => Err(format!(
            "{}: with --gains, pass a model written by `bowden identify --model-out`",
            path.display()
        )),
    }
}

/// The setup, the gains of `bowden design` if there are any, and whether `setup` is a model by
/// itself.
fn inputs(question: &Question<'_>) -> Result<(Setup, Option<GainsFile>, bool), String> {
    let Some(path) = question.gains else {
        let own = setup(question, question.setup)?;
        return Ok((own, None, is_model(question, question.setup)));
    };
    let label = path.display().to_string();
    let text = question.text(path)?;
    let schema = toml::from_str::<toml::Table>(&text)
        .ok()
        .and_then(|table| Some(table.get("schema")?.as_str()?.to_owned()));
    match schema.as_deref() {
        Some("bowden.model/1") if question.setup.is_some() => Err(format!(
            "{label}: this file is a model; with --model, pass gains from `bowden design`"
        )),
        Some("bowden.model/1") | None => {
            let mut gains = setup(question, Some(path))?;
            let Some(model) = question.setup else {
                return Ok((gains, None, false));
            };
            let given = Setup::parse(&question.text(model)?, &model.display().to_string())?;
            no_model_is_refused(question, model)?;
            gains.model = given.model;
            Ok((gains, None, true))
        }
        Some(_) => {
            let gains = GainsFile::parse(&text, &label)?;
            let Some(model) = question.setup else {
                return Err(format!(
                    "{label}: gains from `bowden design` need their model; pass it with --model MODEL.toml"
                ));
            };
            // What the gains were designed for is what they are tried with.
            let noise = question.noise.or(Some(gains.design.noise));
            let own = setup(&Question { noise, ..*question }, Some(model))?;
            no_model_is_refused(question, model)?;
            Ok((own, Some(gains), true))
        }
    }
}

/// The certificates of a setup: for its adaptive law, its PI with an observer, and its PI with
/// learning.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Certified {
    /// For the adaptive law.
    pub certificates: Vec<Promise>,
    /// For the PI with an observer.
    pub tolerance: Tolerance,
    /// For the PI with learning.
    pub learning: Tolerance,
}

/// The certificates of a setup.
///
/// # Errors
/// A message if the setup cannot be read or the core rejects its gains.
pub fn certify(setup: Option<&Path>) -> Result<Certified, String> {
    if let Some(path) = setup {
        let text = std::fs::read_to_string(path).unwrap_or_default();
        if is_of_design(&text) {
            return Err(format!(
                "{}: this file was written by `bowden design`; pass gains and rig in one file, or certify this file with `bowden certify FILE`",
                path.display()
            ));
        }
    }
    let own = setup.map_or_else(|| Ok(Setup::default()), Setup::read)?;
    match (setup, &own.model) {
        (Some(path), Some(_)) => Err(format!(
            "{}: this file is a model; these certificates need a file with gains, and with a [rig] table unless the rig is the reference rig. `bowden design MODEL.toml --rate HZ --delay S` derives gains from a model, with guarantees",
            path.display()
        )),
        _ => Ok(Certified {
            certificates: super::certificates::all(&own)?,
            tolerance: super::tolerance::tolerance(&own)?,
            learning: super::tolerance::convergence(&own)?,
        }),
    }
}

fn setup(question: &Question<'_>, path: Option<&Path>) -> Result<Setup, String> {
    let mut setup = match path {
        Some(path) => Setup::parse(&question.text(path)?, &path.display().to_string())?,
        None => Setup::default(),
    };
    // Through the paper's gains the experiment's noise hides what is gained.
    let quiet = question.effect.is_some() && path.is_none();
    if let Some(noise) = question.noise.or(quiet.then_some(QUIET)) {
        if !(noise.is_finite() && noise >= 0.0) {
            return Err(format!("--noise {noise} is out of range (0 N·m or more)"));
        }
        setup.rig.noise = noise;
        setup.rig.input_noise = noise;
    }
    if question.varying {
        setup.rig.drift = Some(setup.rig.drift.unwrap_or_else(Drift::reference));
    }
    Ok(setup)
}

fn declared(
    (setup, is_model): (&Setup, bool),
    gains: Option<&GainsFile>,
    conditions: &Conditions,
    question: &Question<'_>,
) -> Result<Lineup, String> {
    let seeds: Vec<u64> = (1..=question.seeds).collect();
    let controllers = match gains {
        Some(gains) => own_rig::designed(setup, gains)?,
        None => lineup(setup, conditions.reference.period().is_some())?,
    };
    let lines = run_all(&controllers, conditions, &seeds, question.traced)?;
    // The certificates are of the paper's gains, reference and rig.
    let certificates = match gains.is_some() || is_model || question.gait {
        true => BTreeMap::new(),
        false => named(setup)?,
    };
    Ok(Lineup {
        lines,
        certificates,
    })
}

fn found(
    setup: &Setup,
    effect: Undeclared,
    conditions: &Conditions,
    question: &Question<'_>,
) -> Result<Found, String> {
    let mut outcomes = Vec::new();
    for seed in 1..=question.seeds {
        let traced = question.traced && outcomes.is_empty();
        outcomes.push(outcome(setup, &effect, conditions, seed, traced)?);
    }
    Ok(Found {
        over_seeds: over_seeds(&outcomes),
        effect,
        outcomes,
    })
}

fn over_seeds(outcomes: &[Outcome]) -> Vec<OverSeeds> {
    let Some(first) = outcomes.first() else {
        return Vec::new();
    };
    let count = |(index, pair): (usize, &Pair)| {
        let (mut lower, mut same, mut higher) = (0, 0, 0);
        for pair in outcomes.iter().filter_map(|o| o.pairs.get(index)) {
            match pair.against_before() {
                Ordering::Less => lower += 1,
                Ordering::Equal => same += 1,
                Ordering::Greater => higher += 1,
            }
        }
        OverSeeds {
            controller: pair.controller.clone(),
            lower,
            same,
            higher,
        }
    };
    first.pairs.iter().enumerate().map(count).collect()
}

impl Compared {
    /// The result in one or two sentences.
    #[must_use]
    pub fn sentence(&self) -> String {
        match &self.results {
            Results::Lineup(lineup) => best(&lineup.lines),
            Results::Found(found) => first_gain(found),
        }
    }

    /// The controllers whose first trial was traced. With an undeclared effect, their names include
    /// the feed-forward.
    #[must_use]
    pub fn traced(&self) -> Vec<Line> {
        let found = match &self.results {
            Results::Lineup(lineup) => return lineup.lines.clone(),
            Results::Found(found) => found,
        };
        let pairs = found.outcomes.first().into_iter().flat_map(|o| &o.pairs);
        let lines = pairs.flat_map(|pair| {
            let named = |line: &Line, how: &str| Line {
                controller: format!("{} {how}", pair.controller),
                ..line.clone()
            };
            [
                named(&pair.plain, "plain"),
                named(&pair.declared, "declared"),
                named(&pair.found, "found"),
            ]
        });
        lines.collect()
    }
}

/// The controller with the smallest error, and the error of the PI.
fn best(lines: &[Line]) -> String {
    let good = lines
        .iter()
        .filter_map(|line| Some((line, line.mean_error()?)));
    let Some((best, error)) = good.min_by(|a, b| a.1.total_cmp(&b.1)) else {
        return "Every controller diverged.".to_owned();
    };
    let mut text = format!(
        "Of {} controllers, {} has the smallest true error: {error:.4} N·m rms",
        lines.len(),
        best.controller
    );
    let pi = lines.iter().find(|line| line.controller == "pi");
    if let Some(pi) = pi.and_then(Line::mean_error).filter(|pi| *pi > error) {
        text.push_str(&format!(", compared with {pi:.4} N·m rms for the PI"));
    }
    text + "."
}

/// The terms found on the first seed, and the improvement of the first controller.
fn first_gain(found: &Found) -> String {
    let Some(outcome) = found.outcomes.first() else {
        return "No trial was run.".to_owned();
    };
    let names = match outcome.identified.names.is_empty() {
        true => "nothing".to_owned(),
        false => outcome.identified.names.join(", "),
    };
    let mut text = format!(
        "The rig had {}, which the baseline model lacks. Identification found {names}.",
        found.effect.name
    );
    let errors = outcome.pairs.first().and_then(|pair| {
        let (before, after) = (pair.declared.mean_error()?, pair.found.mean_error()?);
        Some((&pair.controller, before, after))
    });
    if let Some((controller, before, after)) = errors {
        text.push_str(&format!(
            " With a feed-forward from the identified model, the true error of {controller} changes from {before:.4} to {after:.4} N·m rms."
        ));
    }
    text
}
