//! Records that others measured: how far the loop comes, and what it names on the way.
//!
//! They are not part of the project. `BOWDEN_SHARED_RECORDS` names their folder, else it
//! is `../../../shared/data` seen from this package; where it or a file is absent a test says so
//! and passes. Figures are the NRMSE of the filtered output on the fit and held-out
//! segments; how far to reach was set by a prototype of the method, plus 15 to 20 %.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use bowden::effect::Family;
use bowden::model::Source;
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::unneeded::unneeded;
use bowden_lab::conclude::verdict::{verdict, Verdict};
use bowden_lab::fit::Segments;
use bowden_lab::ledger::{Grade, Ledger, Round};
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{read, Mode, Options};
use bowden_lab::search::{close, close_within};
use std::path::PathBuf;

/// A record and how it is read.
struct Row {
    file: &'static str,
    mode: Mode,
    columns: (&'static str, &'static str),
    channels: &'static [(&'static str, &'static str)],
    declare: &'static [&'static str],
    skip: f64,
    until: Option<f64>,
    cutoff: f64,
    rate: Option<f64>,
    /// NRMSE to reach on the fit and held-out segments [%].
    reach: (f64, f64),
}

const PLAIN: Row = Row {
    file: "",
    mode: Mode::Displacement,
    columns: ("", ""),
    channels: &[],
    declare: &["bouc-wen"],
    skip: 0.0,
    until: None,
    cutoff: 20.0,
    rate: None,
    reach: (0.0, 0.0),
};

const EMPS: Row = Row {
    file: "emps/emps_estimation.csv",
    columns: ("q_m", "force_N"),
    ..PLAIN
};

const DAVINCI: Row = Row {
    mode: Mode::Torque,
    columns: ("drive_torque_Nm", "jaw_torque_Nm"),
    channels: &[("phi_p", "drive_angle_rad"), ("phi_d", "jaw_angle_rad")],
    skip: 2.5,
    ..PLAIN
};

struct Closed {
    data: Prepared,
    ledger: Ledger,
    done: FinalFit,
}

impl Row {
    /// Closes the loop and checks what is reached; `None` where the file is absent.
    fn close(&self) -> Option<Closed> {
        let folder = std::env::var_os("BOWDEN_SHARED_RECORDS").map_or_else(
            || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")),
            PathBuf::from,
        );
        let path = folder.join(self.file);
        if !path.exists() {
            println!("skipped: {} is not there", path.display());
            return None;
        }
        let own = |(a, b): &(&str, &str)| ((*a).to_owned(), (*b).to_owned());
        let options = Options {
            mode: Some(self.mode),
            time: Some("time_s".to_owned()),
            input: Some(self.columns.0.to_owned()),
            output: Some(self.columns.1.to_owned()),
            channels: self.channels.iter().map(own).collect(),
            skip: self.skip,
            until: self.until,
            rate: self.rate,
        };
        let record = read(&path, &options).unwrap_or_else(|line| panic!("{line}"));
        let grave: Vec<_> = record.defects.iter().filter(|d| d.grave).collect();
        assert!(grave.is_empty(), "{grave:?}");
        let cutoff = Some(self.cutoff);
        let data = Prepared::new(&record, Preparation { cutoff }).unwrap();
        let declare: Vec<String> = self.declare.iter().map(|s| (*s).to_owned()).collect();
        let ledger = close(&data, &structure(&declare, &data).unwrap(), |_| ()).unwrap();
        let done = FinalFit::new(&data, &ledger);
        let closed = Closed { data, ledger, done };
        closed.print();
        // What the loop ended with, and what is delivered.
        closed.assert_reached(&closed.ledger.last().rmse, self.reach);
        closed.assert_reached(&closed.done.rmse, self.reach);
        Some(closed)
    }
}

impl Closed {
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

    fn family(&self, index: usize) -> Family {
        self.round(index).candidate.family
    }

    /// The place of the first round from `from` on that names the family.
    fn place(&self, family: Family, from: usize) -> usize {
        self.ledger
            .rounds
            .iter()
            .skip(from)
            .position(|r| r.candidate.family == family)
            .unwrap_or_else(|| panic!("{family} is not named from round {} on", from + 1))
            + from
    }

    fn assert_first_is_one_of(&self, families: &[Family]) {
        let first = self.family(0);
        assert!(families.contains(&first), "{first} first, not {families:?}");
    }
}

/// A positioning drive whose declared hysteresis is nearly none: mass and friction.
#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn emps_with_nothing_declared_finds_inertia_and_viscous_then_asymmetry_then_dry_friction() {
    let row = Row {
        reach: (5.0, 5.3),
        ..EMPS
    };
    let Some(closed) = row.close() else { return };
    let mut first = [closed.family(0), closed.family(1)];
    first.sort();
    assert_eq!(first, [Family::Viscous, Family::Inertia]);
    let asymmetry = closed.place(Family::Asymmetry, 2);
    // The constant part of the dry friction may be in the declared hysteresis, which is
    // a relay here; its fall with speed is not.
    let dry = |r: &Round| [Family::Coulomb, Family::Stribeck].contains(&r.candidate.family);
    assert!(closed.ledger.rounds[asymmetry + 1..].iter().any(dry));
}

/// The published model of the same drive, which its authors mended by an asymmetry.
#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn emps_with_its_published_model_declared_finds_asymmetry_first() {
    let row = Row {
        declare: &["inertia", "viscous", "coulomb", "offset"],
        reach: (2.9, 3.0),
        ..EMPS
    };
    let Some(closed) = row.close() else { return };
    assert_eq!(closed.family(0), Family::Asymmetry);
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
    let row = Row {
        file: "mr_damper_utfsm/sine_25mm0x25Hz0x5A.csv",
        columns: ("displacement_mm", "force_N"),
        reach: (7.3, 9.3),
        ..PLAIN
    };
    let Some(closed) = row.close() else { return };
    // Four cycles of one sine: its speed is one function of its position and direction.
    closed.assert_first_is_one_of(&[Family::Viscous, Family::Drag, Family::Rate]);
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn piezo_stage_over_its_full_range_finds_the_bend_or_the_rate_first() {
    let row = Row {
        file: "piezo_stage/sine_1Hz_full_range.csv",
        columns: ("control_V", "displacement_um"),
        skip: 2.0,
        cutoff: 40.0,
        reach: (0.6, 0.9),
        ..PLAIN
    };
    let Some(closed) = row.close() else { return };
    let first = closed.round(0).candidate.term.effect;
    assert!(
        first.name() == "stiffness-quadratic" || first.family() == Family::Rate,
        "{} first",
        first.name()
    );
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn piezo_stage_with_varying_amplitude_finds_something_late_first() {
    let row = Row {
        file: "piezo_stage/sine_1Hz_varying_amplitude.csv",
        columns: ("control_V", "displacement_um"),
        skip: 2.0,
        cutoff: 40.0,
        reach: (1.6, 2.4),
        ..PLAIN
    };
    let Some(closed) = row.close() else { return };
    closed.assert_first_is_one_of(&[Family::Delay, Family::Lag, Family::Viscous, Family::Creep]);
    // This one is to be reached after three effects.
    closed.assert_reached(&closed.round(2).after, row.reach);
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn pneumatic_cylinder_finds_something_viscous_first() {
    let row = Row {
        file: "pneumatic_cylinder/kdn_3bar.csv",
        columns: ("position_mm", "force_N"),
        skip: 8.0,
        cutoff: 8.0,
        reach: (6.1, 6.8),
        ..PLAIN
    };
    let Some(closed) = row.close() else { return };
    // What rises with speed: the damper itself, or what it is confounded with.
    closed.assert_first_is_one_of(&[Family::Viscous, Family::Drag, Family::Delay, Family::Lag]);
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn fatigue_rig_finds_viscous_delay_or_lag_first_and_needs_no_hysteresis() {
    let row = Row {
        file: "faster_fatigue_rig/faster.csv",
        columns: ("displacement_mm", "force_norm"),
        cutoff: 25.0,
        // Its time column is rounded.
        rate: Some(128.0),
        reach: (2.4, 2.2),
        ..PLAIN
    };
    let Some(closed) = row.close() else { return };
    closed.assert_first_is_one_of(&[Family::Viscous, Family::Delay, Family::Lag]);
    // Beside that one effect. Eight leave so little that the hysteresis takes a tenth of it.
    let declared = structure(&["bouc-wen".to_owned()], &closed.data).unwrap();
    let one = close_within(&closed.data, &declared, 1, |_| ()).unwrap();
    let parts = unneeded(&one, &FinalFit::new(&closed.data, &one));
    assert!(parts.iter().any(|p| p.effect == "bouc-wen"), "{parts:?}");
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn davinci_tool_4_23_finds_a_function_of_an_angle_first() {
    let row = Row {
        file: "davinci_cable_tool/tool4_l_4_23.csv",
        reach: (13.0, 13.5),
        ..DAVINCI
    };
    let Some(closed) = row.close() else { return };
    let source = closed.round(0).candidate.term.source;
    assert!(matches!(source, Source::Channel(_)), "reads {source:?}");
}

/// Two slow strokes of 17 s: many functions of the angles do as well, and no name is to be
/// trusted.
#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn davinci_tool_4_03_gives_weak_names_only_and_says_which_others_do_as_well() {
    let row = Row {
        file: "davinci_cable_tool/tool4_l_4_03.csv",
        reach: (12.0, 15.0),
        ..DAVINCI
    };
    let Some(closed) = row.close() else { return };
    for round in &closed.ledger.rounds {
        assert_eq!(round.grade, Grade::Weak);
        assert!(!round.rivals.is_empty());
    }
    assert_eq!(
        verdict(&closed.data, &closed.ledger, &closed.done),
        Verdict::Confounded
    );
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn tribometer_with_gaps_in_time_finds_asymmetry_then_stiffness() {
    let row = Row {
        file: "tribometer_friction/reciprocating_friction.csv",
        columns: ("position_mm", "friction_N"),
        skip: 20.0,
        until: Some(209.0),
        reach: (2.4, 3.8),
        ..PLAIN
    };
    let Some(closed) = row.close() else { return };
    assert_eq!(closed.family(0), Family::Asymmetry);
    assert_eq!(closed.family(1), Family::Stiffness);
}
