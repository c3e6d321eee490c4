//! An undeclared effect is found, named, and its error taken away.
//!
//! For every effect that the generator can plant, in both modes, once at the strength
//! of the noise and once at three times that: the baseline model is Bouc-Wen alone. Of
//! each record is asked
//! * that the baseline model is at least 1.3 times above the floor, or nothing is shown;
//! * that the family of a round that was accepted, or of one of its rivals, is the
//!   planted one's;
//! * that the final held-out error lies within 10 % of the floor.
//!
//! The floor is the error that the sensor's noise alone leaves behind the filter. It
//! knows no parameters to be estimated and no difference between the planted curve and
//! the catalogue's; where these count, a fit that was told of the effect gives the floor.
//! [`EXCEPTIONS`] says, one by one and with the reason, where something else is asked.

use crate::rig::{with_effect, Made, MODES};
use bowden::effect::CATALOGUE;
use bowden_lab::conclude::intervals::term_name;
use bowden_lab::fit::fit;
use bowden_synth::{effects, Mode, Recipe};
use rayon::prelude::*;
use Expected::{Absorbed, AtTold, Found, FoundAs, Misnamed, Reached};

/// The declared error is at least this many times the floor where one is to be shown.
const SHOWN: f64 = 1.3;
/// The final error is at most this many times the floor.
const DOWN_TO: f64 = 1.10;

/// What is asked of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Expected {
    /// Found and named, down to the noise.
    Found,
    /// The same under another family's name, which in this record is the same column.
    FoundAs(&'static str),
    /// Found and named, down to what a fit reaches that was told of the effect; that
    /// fit itself is within three times the noise.
    AtTold,
    /// Falls short: found and named, but down to that many times the noise only.
    Reached(f64),
    /// Falls short: down to that many times the noise, but another family was named.
    Misnamed(f64),
    /// The baseline model is at the noise already: nothing must be added.
    Absorbed,
}

struct Exception {
    /// Both where it is `None`.
    mode: Option<Mode>,
    effect: &'static str,
    /// Both where it is `None`.
    strength: Option<f64>,
    expected: Expected,
    /// For the reader of a failure.
    reason: &'static str,
}

const TORQUE: Option<Mode> = Some(Mode::Torque);
const DISPLACEMENT: Option<Mode> = Some(Mode::Displacement);

#[rustfmt::skip]
const EXCEPTIONS: &[Exception] = &[
    // What the baseline model can move anyway.
    Exception { mode: None, effect: "offset", strength: None, expected: Absorbed,
        reason: "the transmission's own constant (T0, offset) is the same column" },
    Exception { mode: TORQUE, effect: "gain", strength: None, expected: Absorbed,
        reason: "B is the same column" },
    Exception { mode: DISPLACEMENT, effect: "stiffness-linear", strength: None, expected: Absorbed,
        reason: "kappa_x is the same column" },
    // What is the same column under another name.
    Exception { mode: DISPLACEMENT, effect: "gain", strength: None, expected: FoundAs("crosstalk"),
        reason: "a share of the load channel follows that channel alone: crosstalk" },
    // Where not even a fit that is told of the effect comes down to the noise. The shares
    // are of the noise: told and without any noise on the record, same recipe.
    Exception { mode: TORQUE, effect: "presliding", strength: None, expected: AtTold,
        reason: "three stops in parallel are planted, the catalogue has one: 2.5 of the noise remain at strength 3, 0.7 at strength 1" },
    Exception { mode: TORQUE, effect: "drag-cubic", strength: Some(3.0), expected: AtTold,
        reason: "0.02 remain: it is the noise in the gain of v³, whose few fastest moments are held out" },
    Exception { mode: DISPLACEMENT, effect: "stribeck", strength: Some(3.0), expected: AtTold,
        reason: "the planted sign is rounded off by another curve: 0.36 remain, and three parameters are noisy" },
    Exception { mode: DISPLACEMENT, effect: "drive-friction", strength: Some(3.0), expected: AtTold,
        reason: "the planted sign is rounded off by another curve: 0.39 remain" },
    Exception { mode: None, effect: "degradation", strength: Some(1.0), expected: AtTold,
        reason: "0.1 remain: wear goes on in the held-out quarter, and the noise in its rate is extrapolated" },
    // Where the loop falls short; the numbers say how far it reaches.
    Exception { mode: DISPLACEMENT, effect: "presliding", strength: Some(3.0), expected: Reached(6.0),
        reason: "5.8, no better than the declared 5.5: stops on x are nearly the baseline hysteresis, what is left is local to reversals; 3.5 if told" },
    Exception { mode: DISPLACEMENT, effect: "backlash", strength: Some(3.0), expected: Reached(3.0),
        reason: "named, but the fit segment does not tell its width: 0.7 and 1.9 mm leave the same there, and held out 2.8 and 1.1" },
    Exception { mode: DISPLACEMENT, effect: "creep", strength: Some(1.0), expected: Reached(1.6),
        reason: "1.5: named, but the joint refit stops beside its optimum; 1.0 if told" },
    Exception { mode: DISPLACEMENT, effect: "stiffness-progressive", strength: Some(3.0), expected: Reached(1.5),
        reason: "1.3: hinge and x³ stand for x·|x| beside kappa_x·x, three odd curves that are much alike" },
    Exception { mode: DISPLACEMENT, effect: "dead-zone", strength: Some(1.0), expected: Misnamed(DOWN_TO),
        reason: "an odd curve of x beside kappa_x·x: two ripples of long period are named" },
    Exception { mode: TORQUE, effect: "power-law", strength: Some(1.0), expected: Misnamed(1.15),
        reason: "1.11: coulomb and viscous, which err less on the stop-check; of 20 such records 13 are named (lab/notes/catalogue.md)" },
];

fn exception(mode: Mode, effect: &str, strength: f64) -> Option<&'static Exception> {
    EXCEPTIONS.iter().find(|e| {
        e.effect == effect
            && e.mode.is_none_or(|m| m == mode)
            && e.strength.is_none_or(|s| s == strength)
    })
}

fn expected(mode: Mode, effect: &str, strength: f64) -> Expected {
    exception(mode, effect, strength).map_or(Found, |e| e.expected)
}

fn family_of(effect: &str) -> &'static str {
    CATALOGUE
        .iter()
        .find(|info| info.name == effect)
        .unwrap_or_else(|| panic!("{effect} is not in the catalogue"))
        .family
}

fn recipe(mode: Mode, effect: &str, strength: f64, seed: u64) -> Recipe {
    Recipe {
        // What loads the friction has to be on record where the effect reads it.
        load: mode == Mode::Displacement
            && [
                "load-friction",
                "capstan",
                "drive-friction",
                "back-drive-friction",
                "gain",
            ]
            .contains(&effect),
        ..with_effect(mode, effect, strength, seed)
    }
}

/// What came out for one record.
struct Outcome {
    effect: &'static str,
    floor: f64,
    declared: f64,
    last: f64,
    /// Families of the accepted rounds, rivals included.
    families: Vec<&'static str>,
    /// Whether something was said to have no name.
    unknown: bool,
    /// For the reader of a failure.
    found: String,
    made: Made,
}

impl Outcome {
    fn new(mode: Mode, effect: &'static str, strength: f64, seed: u64) -> Self {
        let made = Made::new(&recipe(mode, effect, strength, seed));
        let ledger = made.closed();
        let mut families = Vec::new();
        let mut found = Vec::new();
        // What is found and not delivered is a name all the same.
        for round in ledger.rounds.iter().chain(&ledger.beyond) {
            families.extend(round.possible().map(|c| c.family));
            let rivals: Vec<_> = round.rivals.iter().map(|c| c.family).collect();
            found.push(format!(
                "{} {rivals:?}",
                term_name(&made.data, &round.candidate.term)
            ));
        }
        Self {
            effect,
            floor: made.noise_floor(),
            declared: ledger.declared.rmse.held_out,
            last: ledger.last().rmse.held_out,
            families,
            unknown: ledger.unknown.is_some(),
            found: found.join(", "),
            made,
        }
    }

    /// Held-out error of a fit that was told of the planted effect.
    fn told(&self) -> f64 {
        let truth = &self.made.synthetic.truth.effects[0];
        let name = match truth.channel {
            Some(channel) => format!("{}@{channel}", truth.effect),
            None => truth.effect.clone(),
        };
        let structure = self.made.declare(&["bouc-wen", &name]);
        let told = fit(&self.made.data, &structure, None, 0.0).unwrap();
        told.rmse.held_out
    }

    /// What falls short of the expected, if anything does.
    fn shortfalls(&self, expected: Expected) -> Vec<String> {
        let mut short = Vec::new();
        let mut ask = |holds: bool, what: String| {
            if !holds {
                short.push(what);
            }
        };
        let own = family_of(self.effect);
        let names = |family: &'static str| self.families.contains(&family);
        let floor = match expected {
            AtTold => {
                let told = self.told();
                ask(
                    told <= 3.0 * self.floor,
                    "told of it the fit is no use either".to_owned(),
                );
                self.floor.max(told)
            }
            _ => self.floor,
        };
        if expected != Absorbed {
            ask(
                self.declared >= SHOWN * floor,
                "the baseline model is at the floor already".to_owned(),
            );
        }
        match expected {
            Found | AtTold | Reached(_) => ask(names(own), format!("{own} not named")),
            FoundAs(other) => ask(names(other), format!("{other} not named")),
            Misnamed(_) => {}
            Absorbed => ask(
                self.families.iter().all(|f| *f == own),
                "another name was given".to_owned(),
            ),
        }
        ask(!self.unknown, "said to have no name".to_owned());
        let reach = match expected {
            Found | FoundAs(_) | AtTold | Absorbed => DOWN_TO * floor,
            Reached(times) | Misnamed(times) => times * floor,
        };
        ask(
            self.last <= reach,
            format!("held out at {:.2} of what is asked", self.last / reach),
        );
        short
    }

    fn line(&self) -> String {
        format!(
            "{:22} {:6.2} -> {:5.2} times the floor; {}",
            self.effect,
            self.declared / self.floor,
            self.last / self.floor,
            self.found
        )
    }
}

fn every_effect(mode: Mode, strength: f64, seed: u64) {
    let outcomes: Vec<(&str, String, Vec<String>)> = effects(mode)
        .par_iter()
        .map(|effect| {
            let outcome = Outcome::new(mode, effect, strength, seed);
            let asked = expected(mode, effect, strength);
            (*effect, outcome.line(), outcome.shortfalls(asked))
        })
        .collect();
    let mut short = Vec::new();
    for (effect, line, shortfalls) in &outcomes {
        println!("{mode:?} {strength} × noise: {line}");
        if !shortfalls.is_empty() {
            let asked = expected(mode, effect, strength);
            let reason = exception(mode, effect, strength).map_or("", |e| e.reason);
            let what = shortfalls.join("; ");
            short.push(format!("{line}: {what} ({asked:?}; {reason})"));
        }
    }
    assert!(
        short.is_empty(),
        "{mode:?}, {strength} × noise, seed {seed}: {short:#?}"
    );
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn every_effect_at_three_times_the_noise_is_found_and_taken_away() {
    for mode in MODES {
        every_effect(mode, 3.0, 1001);
    }
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn every_effect_as_strong_as_the_noise_is_found_and_taken_away() {
    for mode in MODES {
        every_effect(mode, 1.0, 1002);
    }
}

/// The table above must not quietly take a whole family out of the test.
#[test]
fn no_family_but_offset_and_gain_is_left_out_by_the_exceptions() {
    let exempt = [
        // Part of what is declared: the transmission's own constant and gain.
        "offset",
        "gain",
        // Declared, not searched: `hardening` has its own tests.
        "hardening",
        // A search fits a curve as a `Table`; only an exported model has its segments as effects.
        "curve",
    ];
    let families = CATALOGUE.iter().map(|info| info.family);
    for family in families.filter(|f| !exempt.contains(f)) {
        let found = MODES.into_iter().any(|mode| {
            let own = effects(mode).iter().filter(|e| family_of(e) == family);
            own.flat_map(|effect| [1.0, 3.0].map(|s| expected(mode, effect, s)))
                .any(|e| matches!(e, Found | AtTold))
        });
        assert!(found, "{family}");
    }
}
