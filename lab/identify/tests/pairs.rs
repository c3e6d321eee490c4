//! What a search finds on one record, on another record of the same rig: the goals of the names
//! that carry over, on rigs that others measured.
//!
//! Where the records are stands in `shared`; a rig with a file that is absent is skipped.
//! `--nocapture` prints the tables, which are those of the example `carry_over`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[allow(dead_code)]
#[path = "../examples/carry_over/pair.rs"]
mod pair;
#[allow(dead_code)]
mod shared;

use bowden_lab::check::Verdict;
use bowden_lab::ledger::Grade;
use pair::{known, print_agreement, Carried, Closed, Identity, Name, Rig, Share};
use shared::{disturbed, Row, DAMPER, DAVINCI_03, DAVINCI_23, EMPS, PIEZO_FULL, PIEZO_VARYING};
use std::sync::LazyLock;

/// Records of one rig, all read as its row says.
struct Pair {
    name: &'static str,
    row: Row,
    files: &'static [&'static str],
}

/// The damper at 0.5 A: another current is another damper.
const PAIRS: [Pair; 4] = [
    Pair {
        name: "magnetorheological damper, 0.5 A",
        row: DAMPER,
        files: &[
            "mr_damper_utfsm/sine_25mm0x25Hz0x5A.csv",
            "mr_damper_utfsm/sine_25mm0x5Hz0x5A.csv",
            "mr_damper_utfsm/sine_5mm3Hz0x5A.csv",
        ],
    },
    Pair {
        name: "piezo stack",
        row: PIEZO_FULL,
        files: &[PIEZO_FULL.file, PIEZO_VARYING.file],
    },
    Pair {
        name: "da Vinci tool 4",
        row: DAVINCI_03,
        files: &[DAVINCI_03.file, DAVINCI_23.file],
    },
    Pair {
        name: "positioning drive",
        row: EMPS,
        files: &[EMPS.file, "emps/emps_validation_pulses.csv"],
    },
];

/// Copies of each record, with other last digits.
const COPIES: u64 = 4;

impl Pair {
    /// The rig measured, from the records as they are (0) or from a copy of each; `None` where a
    /// file is absent.
    fn rig(&self, copy: u64) -> Option<Rig> {
        let asked = self.row.asked();
        let mut closed = Vec::new();
        for file in self.files {
            let path = self.row.of_file(file).path()?;
            let record = asked.read(&path).unwrap_or_else(|line| panic!("{line}"));
            let record = match copy {
                0 => record,
                seed => disturbed(&record, seed),
            };
            let one = Closed::of(&asked, record, &path);
            closed.push(one.unwrap_or_else(|line| panic!("{line}")));
        }
        let rig = Rig::new(self.name, closed).unwrap_or_else(|line| panic!("{line}"));
        if copy == 0 {
            rig.print();
        }
        Some(rig)
    }
}

/// Each record is closed once, for all tests.
static RIGS: LazyLock<Vec<Rig>> = LazyLock::new(|| drawn(0));
/// The same of each copy.
static DRAWS: LazyLock<Vec<Vec<Rig>>> = LazyLock::new(|| (1..=COPIES).map(drawn).collect());

fn drawn(copy: u64) -> Vec<Rig> {
    PAIRS.iter().filter_map(|pair| pair.rig(copy)).collect()
}

/// The error on the other record, with gain and offset refitted, over the own held-out error:
/// the goal.
const CARRIED: f64 = 2.5;

/// Pairs that miss the goal, and what they reach: model of, on, ratio. Both records that these
/// models are of show a sine of one amplitude; the other records show five times the stroke, or
/// all strokes. No number of the names found on them meets the goal, and the check says of each
/// that the model does not hold. Of the damper 6 was reached with a lag of negative gain, a lead
/// that no rig has; within physical stages the model of the short stroke has a stiffness of the
/// wrong sign, which five times the stroke shows.
const MISSED: [(&str, &str, f64); 3] = [
    ("sine_5mm3Hz0x5A", "sine_25mm0x25Hz0x5A", 29.0),
    ("sine_5mm3Hz0x5A", "sine_25mm0x5Hz0x5A", 29.0),
    ("sine_1Hz_full_range", "sine_1Hz_varying_amplitude", 9.0),
];

/// The share over all rigs; `None` where no rig is there.
fn over_all(what: &str, of: fn(&Rig) -> Share) -> Option<Share> {
    let all: Share = RIGS.iter().map(of).sum();
    println!("{what}: {all}");
    (!RIGS.is_empty()).then_some(all)
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn a_model_errs_on_the_other_record_at_most_2_5_times_as_much_as_held_out_at_home() {
    for one in RIGS.iter().flat_map(|rig| &rig.carried) {
        let missed = MISSED.iter().find(|m| (m.0, m.1) == (&one.from, &one.to));
        match missed {
            None => assert!(one.ratio() <= CARRIED, "{one:?}"),
            // One that meets the goal has no place in the list.
            Some((.., reached)) => {
                assert!(one.ratio() > CARRIED && one.ratio() <= *reached, "{one:?}");
                assert_eq!(one.verdict, Verdict::DoesNotHold, "{one:?}");
            }
        }
    }
}

#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn at_most_one_in_twenty_of_the_delivered_rounds_raises_the_held_out_error() {
    let raising = over_all("rounds that raise", Rig::raising);
    let Some(raising) = raising else { return };
    assert!(20 * raising.count <= raising.of, "{raising}");
}

/// Some of these records hang on their last digit: one draw says little, and the goals are asked of
/// the record and its copies together too. Of the ratios the middle one counts.
#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn the_goals_hold_over_copies_with_other_last_digits() {
    let draws = || std::iter::once(&*RIGS).chain(&*DRAWS);
    if RIGS.is_empty() {
        return;
    }
    let sum = |of: fn(&Rig) -> Share| -> Share { draws().flatten().map(of).sum() };
    let (raising, known) = (sum(Rig::raising), sum(Rig::agreement));
    println!(
        "over {} draws: rounds that raise {raising}, firm names that are known {known}",
        1 + COPIES
    );
    assert!(20 * raising.count <= raising.of, "{raising}");
    assert!(10 * known.count >= 7 * known.of, "{known}");
    for one in RIGS.iter().flat_map(|rig| &rig.carried) {
        let same = |other: &&Carried| (&other.from, &other.to) == (&one.from, &one.to);
        let all = draws().flatten().flat_map(|rig| &rig.carried).filter(same);
        let mut ratios: Vec<f64> = all.map(Carried::ratio).collect();
        ratios.sort_by(f64::total_cmp);
        println!("{} on {}: {ratios:.2?}", one.from, one.to);
        let is_missed = MISSED.iter().any(|m| (m.0, m.1) == (&one.from, &one.to));
        let middle = ratios[ratios.len() / 2];
        assert!(
            is_missed || middle <= CARRIED,
            "{} on {}: {ratios:?}",
            one.from,
            one.to
        );
    }
}

/// A firm name agrees where the other record names it too, or has it as a rival of one of its
/// names, firm or weak; a name is a family and the channel that it reads. Each pair counts from
/// both sides: (known of A + known of B) over (firm of A + firm of B).
#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn seven_of_ten_firm_names_are_known_to_the_other_record() {
    let known = over_all("firm names that are known", Rig::agreement);
    let Some(known) = known else { return };
    assert!(known.of > 0, "no firm name at all");
    assert!(10 * known.count >= 7 * known.of, "{known}");
}

/// Each record and its copies with other last digits.
#[test]
#[ignore = "slow: bash .ci/run measured-records"]
fn the_main_mechanism_of_a_record_is_that_of_the_other_records_of_its_rig() {
    let draws = || std::iter::once(&*RIGS).chain(&*DRAWS);
    if RIGS.is_empty() {
        return;
    }
    let sum = |which: usize| -> Share { draws().flatten().map(|r| r.mechanisms()[which]).sum() };
    let (all, high) = (sum(0), sum(1));
    print_agreement(&RIGS);
    println!(
        "over {} draws: pairs with one main mechanism: {all}; of high confidence in both: {high}",
        1 + COPIES
    );
    assert!(10 * all.count >= 9 * all.of, "{all}");
    assert!(high.of > 0 && high.count == high.of, "{high}");
}

fn name(family: &'static str, grade: Grade, rivals: &[&'static str]) -> Name {
    let identity = |family| Identity {
        family,
        channel: None,
    };
    Name {
        identity: identity(family),
        grade,
        rivals: rivals.iter().map(|rival| identity(rival)).collect(),
        raises: false,
    }
}

#[test]
fn a_firm_name_is_known_where_it_is_named_or_is_a_rival_of_a_name() {
    let of = ["viscous", "coulomb", "lag"].map(|family| name(family, Grade::High, &[]));
    let by = [
        name("viscous", Grade::Low, &[]),
        name("rate", Grade::Low, &["coulomb"]),
    ];
    assert_eq!(known(&of, &by), Share { count: 2, of: 3 });
    // Weak names are not asked for.
    assert_eq!(known(&by, &of), Share { count: 0, of: 0 });
}

#[test]
fn two_firm_rounds_of_one_family_on_one_channel_are_one_name() {
    let of = ["stiffness", "stiffness"].map(|family| name(family, Grade::High, &[]));
    assert_eq!(known(&of, &of), Share { count: 1, of: 1 });
}
