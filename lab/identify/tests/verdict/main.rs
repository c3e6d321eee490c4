//! The verdict: what has no name is said to have none, and a tone is a tone.
//!
//! The records come from [`bowden_synth`], which shares no code with the fit; the
//! seeds are none that the method was developed on. The baseline model is Bouc-Wen alone.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod unexpected;

use bowden_lab::conclude::curve::curve;
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::intervals::term_name;
use bowden_lab::conclude::verdict::{verdict, Verdict};
use bowden_lab::ledger::Ledger;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{parse, Options};
use bowden_lab::search::close;
use bowden_synth::{generate, Mode, Planted, Recipe, Synthetic};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Records of each kind in each mode.
const SEEDS: std::ops::Range<u64> = 61_000..61_006;
const MODES: [Mode; 2] = [Mode::Torque, Mode::Displacement];

struct Closed {
    made: Synthetic,
    data: Prepared,
    ledger: Ledger,
}

impl Closed {
    fn new(mode: Mode, planted: &[(&str, f64)], colour: f64, seed: u64) -> Self {
        Self::with_line(mode, planted, colour, seed, |_| 0.0)
    }

    /// With a further signal on the output, a function of the time \[s\].
    fn with_line(
        mode: Mode,
        planted: &[(&str, f64)],
        colour: f64,
        seed: u64,
        line: impl Fn(f64) -> f64,
    ) -> Self {
        let effects = planted.iter().map(|&(effect, strength)| Planted {
            strength,
            ..Planted::new(effect)
        });
        let recipe = Recipe {
            seed,
            colour,
            effects: effects.collect(),
            load: mode == Mode::Displacement && planted.iter().any(|(e, _)| e.contains("load")),
            ..Recipe::new(mode)
        };
        let made = generate(&recipe).unwrap();
        let mut record = parse(made.to_csv().as_bytes(), "made.csv", &Options::default()).unwrap();
        for (i, value) in record.output.values.iter_mut().enumerate() {
            *value += line(i as f64 / 1000.0);
        }
        let data = Prepared::new(&record, Preparation::default()).unwrap();
        let declared = structure(&["bouc-wen".to_owned()], &data).unwrap();
        let ledger = close(&data, &declared, |_| ()).unwrap();
        Self { made, data, ledger }
    }

    fn done(&self) -> FinalFit {
        FinalFit::new(&self.data, &self.ledger)
    }

    /// On what the residual depends, and whose that is.
    fn unknown(&self) -> Option<(&'static str, &str)> {
        let variable = self.ledger.unknown.as_ref()?.variable;
        let channel = self.data.channel(variable.source()).unwrap();
        Some((variable.name(&self.data), channel.name.as_str()))
    }

    fn names(&self) -> Vec<String> {
        let rounds = self.ledger.rounds.iter();
        rounds
            .map(|r| term_name(&self.data, &r.candidate.term))
            .collect()
    }

    fn verdict(&self) -> Verdict {
        verdict(&self.data, &self.ledger, &self.done())
    }

    fn line(&self) -> String {
        format!(
            "names {:?}, unknown {:?}: {:?}",
            self.names(),
            self.unknown(),
            self.verdict()
        )
    }
}

/// All records of a kind, both modes, in the order of modes and seeds.
fn records(planted: &[(&str, f64)], colour: f64) -> Vec<Closed> {
    let all: Vec<(Mode, u64)> = MODES
        .into_iter()
        .flat_map(|mode| SEEDS.map(move |seed| (mode, seed)))
        .collect();
    all.into_par_iter()
        .map(|(mode, seed)| Closed::new(mode, planted, colour, seed))
        .collect()
}

/// Of twelve records at most one may miss: the rate that is claimed is nine in ten.
fn mostly(all: &[Closed], holds: impl Fn(&Closed) -> bool) {
    let missed: Vec<String> = all.iter().filter(|c| !holds(c)).map(Closed::line).collect();
    assert!(missed.len() <= 1, "{missed:#?}");
}

fn is_unknown(closed: &Closed, variables: &[&str], channels: &[&str]) -> bool {
    closed.verdict() == Verdict::UnmodelledDependence
        && closed
            .unknown()
            .is_some_and(|(v, c)| variables.contains(&v) && channels.contains(&c))
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn a_bump_over_position_is_unknown_and_no_name_is_given() {
    let all = records(&[("bump-position", 3.0)], 0.0);
    mostly(&all, |c| is_unknown(c, &["position"], &["phi_p", "x"]));
    mostly(&all, |c| c.names().is_empty());
    // The curve peaks where the bump is: within a width and the distance of two knots.
    mostly(&all, |c| {
        let truth = &c.made.truth.effects[0];
        let shape = |name: &str| truth.shapes.iter().find(|(n, _)| *n == name).unwrap().1;
        let knots = curve(&c.data, c.ledger.last());
        let peak = knots
            .iter()
            .max_by(|a, b| a.value.abs().total_cmp(&b.value.abs()));
        peak.is_some_and(|k| {
            (k.at - shape("place")).abs() <= 2.0 * shape("width")
                && k.value.signum() == truth.gain.signum()
                && k.ci95.is_some_and(|[low, high]| low * high > 0.0)
        })
    });
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn a_bump_over_the_load_and_a_spike_after_reversals_are_unknown_and_no_name_is_given() {
    let local = ["reversal-distance", "reversal-time"];
    for (effect, variables, channels) in [
        ("bump-load", &["load"][..], ["tau_i", "load"]),
        ("reversal-spike", &local, ["tau_i", "x"]),
    ] {
        let all = records(&[(effect, 3.0)], 0.0);
        mostly(&all, |c| is_unknown(c, variables, &channels));
        mostly(&all, |c| c.names().is_empty());
    }
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn a_tone_as_strong_as_the_noise_is_named_with_its_frequency() {
    let all = records(&[("tone", 1.0)], 0.0);
    mostly(&all, |c| {
        let truth = c.made.truth.effects[0].shapes[0].1;
        let tone = c
            .ledger
            .rounds
            .iter()
            .find(|r| r.candidate.family == "tone");
        // A twentieth of one over the length of the segment that is fitted, 12 s.
        tone.and_then(|r| r.solution.structure.terms.last())
            .and_then(|term| term.effect.shape(0))
            .is_some_and(|f| (f - truth).abs() < 0.05 / 12.0)
            && c.ledger.unknown.is_none()
    });
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn where_nothing_is_missing_nothing_is_unknown_and_there_is_no_tone() {
    for colour in [0.0, 0.9, 0.99] {
        for closed in records(&[], colour) {
            let tone = closed
                .ledger
                .rounds
                .iter()
                .any(|r| r.candidate.family == "tone");
            assert!(
                closed.ledger.unknown.is_none() && !tone,
                "colour {colour}: {}",
                closed.line()
            );
        }
    }
}

/// A tone above the cut-off passes the filter in part.
#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn a_tone_above_the_cut_off_is_named_with_its_frequency() {
    let planted = [("backlash", 2.03), ("stribeck", 2.24)];
    let (cutoff, seed) = (7.1, 350_013);
    for frequency in [0.97 * cutoff, 1.05 * cutoff, 1.25 * cutoff] {
        let line = |t: f64| 0.5 * (TAU * frequency * t).sin();
        let closed = Closed::with_line(Mode::Torque, &planted, 0.0, seed, line);
        assert!((closed.data.cutoff - cutoff).abs() < 0.1);
        let rounds = closed.ledger.rounds.iter();
        let tone = rounds
            .clone()
            .find(|r| r.candidate.family == "tone")
            .and_then(|r| r.term().effect.shape(0));
        // A twentieth of one over the length of the segment that is fitted, 12 s.
        assert!(
            tone.is_some_and(|f| (f - frequency).abs() < 0.05 / 12.0),
            "{frequency}: {}",
            closed.line()
        );
    }
}

/// At 1.5 times the cut-off the filter leaves 4 % of a line, and none is sought there. It decays
/// as fast as noise does.
#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn a_line_that_is_left_and_has_no_name_is_not_taken_for_noise() {
    let planted = [("rate", 2.66), ("asymmetry-eta-squared", 1.90)];
    let line = |t: f64| 4.0 * (TAU * 1.5 * 7.1 * t).sin();
    let closed = Closed::with_line(Mode::Torque, &planted, 0.0, 350_013, line);
    assert!((closed.data.cutoff - 7.1).abs() < 0.1);
    assert!(closed.names().iter().all(|name| name != "tone"));
    assert!(closed.ledger.last().rmse.fit > 10.0 * closed.data.noise_floor);
    assert_eq!(closed.verdict(), Verdict::StructuredResidual);
}
