//! Records that others measured: how far the loop comes, and what it names on the way.
//!
//! Where they are and how far each is to reach stands in `shared`. Figures are the NRMSE of the
//! filtered output on the fit and held-out segments.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[allow(dead_code)]
mod shared;

use bowden::model::Source;
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::mechanisms::mechanisms;
use bowden_lab::conclude::unneeded::unneeded;
use bowden_lab::conclude::verdict::{verdict, Verdict};
use bowden_lab::fit::Segments;
use bowden_lab::ledger::{Grade, Ledger, Round};
use bowden_lab::model::declared::structure;
use bowden_lab::model::mechanism::Mechanism;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::search::{close, close_within};
use shared::{
    Row, DAMPER, DAVINCI_03, DAVINCI_23, EMPS, EMPS_DECLARED, FATIGUE, PIEZO_FULL, PIEZO_VARYING,
    PNEUMATIC, TRIBOMETER,
};

struct Closed {
    data: Prepared,
    ledger: Ledger,
    done: FinalFit,
}

impl Closed {
    /// Closes the loop and checks what is reached; `None` where the file is absent.
    fn new(row: &Row) -> Option<Self> {
        let (path, asked) = (row.path()?, row.asked());
        let record = asked.read(&path).unwrap_or_else(|line| panic!("{line}"));
        let grave: Vec<_> = record.defects.iter().filter(|d| d.grave).collect();
        assert!(grave.is_empty(), "{grave:?}");
        let cutoff = asked.cutoff;
        let data = Prepared::new(&record, Preparation { cutoff }).unwrap();
        let declared = structure(&asked.declare, &data).unwrap();
        let ledger = close(&data, &declared, |_| ()).unwrap();
        let done = FinalFit::new(&data, &ledger);
        let closed = Self { data, ledger, done };
        closed.print();
        // What the loop ended with, and what is delivered.
        closed.assert_reached(&closed.ledger.last().rmse, row.reach);
        closed.assert_reached(&closed.done.rmse, row.reach);
        // A model contains the one before it: one that errs more is fitted badly. A stage's range
        // begins a little above nothing.
        for round in &closed.ledger.rounds {
            assert!(round.after.fit <= 1.01 * round.before.fit, "{round:?}");
        }
        Some(closed)
    }

    /// NRMSE [%] on the fit and held-out segments.
    fn percent(&self, rmse: &Segments) -> (f64, f64) {
        let share = rmse.normalised(&self.data, &self.data.target);
        (100.0 * share.fit, 100.0 * share.held_out)
    }

    fn print(&self) {
        let (fit, held_out) = self.percent(&self.ledger.declared.rmse);
        println!("declared {fit:.2} / {held_out:.2}");
        for round in &self.ledger.rounds {
            let (fit, held_out) = self.percent(&round.after);
            println!(
                "{} {:?} {fit:.2} / {held_out:.2}, p {:?}",
                round.candidate.term.effect.name(),
                round.candidate.term.source,
                round.p
            );
        }
        let (fit, held_out) = self.percent(&self.done.rmse);
        println!(
            "final, refitted {}: {fit:.2} / {held_out:.2}",
            self.done.refitted
        );
    }

    fn assert_reached(&self, rmse: &Segments, reach: (f64, f64)) {
        let (fit, held_out) = self.percent(rmse);
        assert!(
            fit <= reach.0 && held_out <= reach.1,
            "{fit:.2} / {held_out:.2} %, to reach {reach:?}"
        );
    }

    fn round(&self, index: usize) -> &Round {
        let rounds = &self.ledger.rounds;
        rounds
            .get(index)
            .unwrap_or_else(|| panic!("only {} rounds", rounds.len()))
    }

    fn family(&self, index: usize) -> &'static str {
        self.round(index).candidate.family
    }

    fn assert_first_is_one_of(&self, families: &[&'static str]) {
        let first = self.family(0);
        assert!(families.contains(&first), "{first} first, not {families:?}");
    }
}

/// A positioning drive whose baseline hysteresis is nearly none: mass and friction.
#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn emps_with_nothing_declared_lacks_inertia_and_friction() {
    let Some(closed) = Closed::new(&EMPS) else {
        return;
    };
    assert_eq!(closed.family(0), "inertia");
    let all = mechanisms(&closed.data, &closed.ledger, &closed.done);
    let all: Vec<Mechanism> = all.iter().map(|lack| lack.mechanism).collect();
    assert_eq!(all, [Mechanism::Inertia, Mechanism::Friction]);
}

/// The published model of the same drive, which its authors mended by an asymmetry.
#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn emps_with_its_published_model_declared_finds_asymmetry_first() {
    let Some(closed) = Closed::new(&EMPS_DECLARED) else {
        return;
    };
    assert_eq!(closed.family(0), "asymmetry");
    for (name, solution) in [
        ("declared", &closed.ledger.declared),
        ("with asymmetry", &closed.round(0).solution),
        ("last", closed.ledger.last()),
        ("final", &closed.done.solution),
    ] {
        // Published: M = 95.11 kg, by least squares on the same file.
        let mass = solution.gain(0);
        assert!((mass / 95.11 - 1.0).abs() < 0.005, "{name}: M = {mass} kg");
    }
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn mr_damper_finds_what_rises_with_speed_first() {
    let Some(closed) = Closed::new(&DAMPER) else {
        return;
    };
    // Four cycles of one sine: its speed is one function of its position and direction.
    closed.assert_first_is_one_of(&["viscous", "drag", "rate"]);
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn piezo_stage_over_its_full_range_finds_the_bend_or_the_rate_first() {
    let Some(closed) = Closed::new(&PIEZO_FULL) else {
        return;
    };
    let first = closed.round(0).candidate.term.effect;
    assert!(
        first.name() == "stiffness-quadratic" || first.info().family == "rate",
        "{} first",
        first.name()
    );
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn piezo_stage_with_varying_amplitude_finds_the_bend_and_something_late_first() {
    let Some(closed) = Closed::new(&PIEZO_VARYING) else {
        return;
    };
    // The bend is what the record of the full range shows first as well.
    assert_eq!(closed.family(0), "stiffness");
    let late = ["delay", "lag", "viscous", "creep"];
    assert!(late.contains(&closed.family(1)), "{}", closed.family(1));
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn pneumatic_cylinder_finds_something_viscous_first() {
    let Some(closed) = Closed::new(&PNEUMATIC) else {
        return;
    };
    // What rises with speed: the damper itself, or what it is confounded with.
    closed.assert_first_is_one_of(&["viscous", "drag", "delay", "lag"]);
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn fatigue_rig_finds_viscous_delay_or_lag_first_and_needs_no_hysteresis() {
    let Some(closed) = Closed::new(&FATIGUE) else {
        return;
    };
    closed.assert_first_is_one_of(&["viscous", "delay", "lag"]);
    // Beside that one effect. Eight leave so little that the hysteresis takes a tenth of it.
    let declared = structure(&["bouc-wen".to_owned()], &closed.data).unwrap();
    let one = close_within(&closed.data, &declared, 1, |_| ()).unwrap();
    let parts = unneeded(&one, &FinalFit::new(&closed.data, &one));
    assert!(parts.iter().any(|p| p.effect == "bouc-wen"), "{parts:?}");
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn davinci_tool_4_23_finds_a_function_of_an_angle_first() {
    let Some(closed) = Closed::new(&DAVINCI_23) else {
        return;
    };
    let source = closed.round(0).candidate.term.source;
    assert!(matches!(source, Source::Channel(_)), "reads {source:?}");
}

/// Two slow strokes of 17 s: many functions of the angles do as well, and no name is to be
/// trusted.
#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn davinci_tool_4_03_gives_weak_names_only_and_says_which_others_do_as_well() {
    let Some(closed) = Closed::new(&DAVINCI_03) else {
        return;
    };
    for round in &closed.ledger.rounds {
        assert_eq!(round.grade, Grade::Low);
        assert!(!round.rivals.is_empty());
    }
    assert_eq!(
        verdict(&closed.data, &closed.ledger, &closed.done),
        Verdict::Ambiguous
    );
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn tribometer_with_gaps_in_time_finds_asymmetry_then_stiffness() {
    let Some(closed) = Closed::new(&TRIBOMETER) else {
        return;
    };
    assert_eq!(closed.family(0), "asymmetry");
    assert_eq!(closed.family(1), "stiffness");
}
