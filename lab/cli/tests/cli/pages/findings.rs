//! The page of the findings: each code with its severity and its words for one example.

use bowden_lab::facts::{
    Alteration, Defect, Explained, FileApart, Finding, Fitted, Outside, Suspicion, Told,
};
use bowden_lab::ledger::CoarseChannel;
use bowden_lab::record::DefectKind;
use std::collections::BTreeSet;
use std::fmt::Write as _;

const SOURCE: &str = include_str!("../../../../identify/src/conclude/finding.rs");

fn text(name: &str) -> String {
    name.to_owned()
}

fn names(all: &[&str]) -> Vec<String> {
    all.iter().map(|name| text(name)).collect()
}

const SHARES: Explained = Explained {
    input: 0.03,
    channels: 0.12,
    time: 0.0,
};

/// Of records that give no model.
fn of_no_model() -> Vec<Finding> {
    let (input, output) = (text("tau"), text("tau_d"));
    vec![
        Finding::OutputIntegrates {
            input: text("x"),
            output: text("F"),
            may_creep: true,
        },
        Finding::FilesScaled {
            files: vec![FileApart {
                path: text("b.csv"),
                than: text("a.csv"),
                gain: -1.0,
                offset: 0.2,
                before: 1.9,
                after: 0.012,
            }],
            of: 2,
            unit: Some(text("N")),
        },
        Finding::LoggedDifferently(Suspicion {
            alteration: Alteration::Reversed {
                column: text("phi_p"),
            },
            path: Some(text("b.csv")),
            terms: names(&["viscous(phi_p)"]),
            before: 0.1,
            after: 0.008,
        }),
        Finding::RowsShuffled {
            input: input.clone(),
            output: output.clone(),
        },
        Finding::InputAtRest {
            input: input.clone(),
        },
        Finding::ChannelTakesOver {
            input: input.clone(),
            explains: SHARES,
            channels: 1,
            alone: 0.97,
        },
        Finding::NothingExplained {
            input,
            explains: SHARES,
            channels: 1,
        },
    ]
}

/// Of models that do not transfer, and of files that are held out.
fn of_no_transfer() -> Vec<Finding> {
    let terms = names(&["viscous(x)", "presliding(x)"]);
    vec![
        Finding::RigChanged {
            fit: 0.02,
            held_out: 0.31,
            since: Some(32.0),
            output: text("F"),
            terms: terms.clone(),
        },
        Finding::WorseThanConstant {
            before: 1.3,
            after: 1.2,
        },
        Finding::HeldOutRises {
            ratio: 2.0,
            before: 0.04,
            after: 0.08,
            terms,
            falls_up_to: 1,
        },
        Finding::HeldOutFileScaled {
            path: text("c.csv"),
            gain: 2.0,
            offset: 0.1,
            unit: Some(text("N")),
            error: 0.01,
        },
        Finding::HeldOutFileDiffers,
    ]
}

fn outside() -> Outside {
    Outside {
        channel: text("x"),
        quantity: "position",
        unit: Some(text("mm")),
        seen: [-100.0, 100.0],
        here: [-130.0, 130.0],
        share: 0.2,
    }
}

/// Of the measurement.
fn of_record() -> Vec<Finding> {
    let input = text("x");
    let defect = Defect {
        kind: DefectKind::Clipping,
        channel: text("F"),
        ranges: vec![[12, 40]],
        message: String::new(),
        grave: true,
        left_out: true,
        samples: Vec::new(),
    };
    vec![
        Finding::DefectiveMeasurement {
            defects: vec![defect],
        },
        Finding::OneStroke {
            input: input.clone(),
        },
        Finding::InputIsVelocity { input: text("v") },
        Finding::Extrapolation(outside()),
        Finding::MotionUnseen {
            input: input.clone(),
        },
        Finding::CoarseSensor {
            channel: CoarseChannel {
                channel: input,
                step: 0.01,
                counts: 850.0,
                error: 0.2,
                names: names(&["viscous"]),
            },
            unit: Some(text("mm")),
        },
        Finding::OutputLeads { seconds: 0.004 },
        Finding::SegmentsDiffer {
            fit: 9.0,
            held_out: 3.0,
        },
        Finding::FilesOfSeveralRigs {
            together: 0.11,
            own: 0.02,
        },
        Finding::ZeroDiffers {
            path: text("b.csv"),
            may_fit_gains: true,
        },
    ]
}

/// Of what is left.
fn of_residual() -> Vec<Finding> {
    vec![
        Finding::ResidualIsNoise,
        Finding::HeldOutAboveNoise { held_out: 1.6 },
        Finding::ResidualAboveNoise {
            floors: Some([3.1, 4.2]),
            is_white: Some(false),
            terms: 2,
        },
        Finding::NoNameForCurve {
            variable: text("the velocity of x"),
            by_effects: 0.41,
        },
        Finding::TermsConfounded {
            pairs: names(&["presliding from backlash"]),
        },
        Finding::TooFewBlocks { terms: 1 },
        Finding::PoorModel { error: 0.3 },
    ]
}

/// Of the model.
fn of_model() -> Vec<Finding> {
    let channel = text("phi_p");
    vec![
        Finding::PreslidingIsBacklash { sign_tells: false },
        Finding::CreepStartsOutside { output: text("F") },
        Finding::HysteresisLeftOut,
        Finding::HysteresisCancelled { share: 0.004 },
        Finding::TonesOfMotion {
            terms: names(&["tone(2.4 Hz)"]),
        },
        Finding::FrictionWithTension,
        Finding::FrictionWithTemperature {
            channel: text("temperature"),
        },
        Finding::OutputFalls {
            input: text("tau"),
            output: text("tau_d"),
        },
        Finding::LoopReversed {
            kappa_eta: -0.412,
            terms: names(&["coulomb(x)"]),
        },
        Finding::ChannelRepeatsOutput {
            channel: channel.clone(),
        },
        Finding::LoadFollowsChannel {
            channel,
            input: text("tau"),
        },
        Finding::SearchStopped {
            seconds: None,
            terms: Some(2),
        },
        Finding::RoundRaises {
            term: text("ripple(x)"),
            after: 2,
        },
        Finding::FileWorse {
            path: text("b.csv"),
            before: 0.02,
            after: 0.03,
        },
        Finding::ManyTerms { terms: 5 },
    ]
}

/// Of a validation.
fn of_validation() -> Vec<Finding> {
    let unit = || Some(text("N"));
    let gain = Fitted {
        value: 1.3,
        ci95: Some([1.29, 1.31]),
    };
    vec![
        Finding::ErrorAsExpected {
            error: 0.012,
            own: 0.01,
        },
        Finding::ErrorAsExpectedInUnit {
            rmse: [0.21, 0.2],
            unit: unit(),
            error: 0.15,
            holds: true,
        },
        Finding::ErrorIsNoise { error: 0.03 },
        Finding::ErrorTooLarge {
            error: 0.3,
            own: Some(0.01),
            with_line: 0.25,
        },
        Finding::ErrorAtLimit {
            error: 0.11,
            limit: 0.1,
        },
        Finding::ErrorWithoutLimit { error: 0.3 },
        Finding::OutputAtNoise,
        Finding::LineChanged {
            gain: Some(gain),
            offset: 0.2,
            unit: unit(),
            error: 0.015,
            limit: 0.02,
        },
        Finding::OutputUnitDiffers { output: text("F") },
        Finding::ModelInexact { own: 0.06 },
        Finding::ModelNotTransferable,
        Finding::ResidualDependsOn {
            variable: Some(text("the velocity of x")),
            is_tested: true,
        },
        Finding::RangesExceeded {
            ranges: vec![outside()],
        },
        Finding::InputContributesLittle {
            input: text("x"),
            share: 0.04,
        },
    ]
}

/// The page.
pub fn page() -> String {
    let mut page = String::from(
        "# Findings\n\n\
         The list `findings` of `bowden identify --json` and `bowden validate --json` contains \
         observations about the record, the model or the rig, other than the missing mechanisms. Each \
         row shows an example. The numbers and names in the example come from the field `evidence` of \
         the finding.\n\n\
         | code | severity | words |\n|---|---|---|\n",
    );
    let mut codes = BTreeSet::new();
    let parts = [
        of_no_model(),
        of_no_transfer(),
        of_record(),
        of_residual(),
        of_model(),
        of_validation(),
    ];
    for finding in parts.into_iter().flatten() {
        let told = serde_json::to_value(Told::from(finding)).unwrap();
        let [code, severity, words] =
            ["code", "severity", "words"].map(|key| told[key].as_str().unwrap().to_owned());
        writeln!(page, "| `{code}` | {severity} | {words} |").unwrap();
        assert!(codes.insert(code), "one example a code");
    }
    assert_eq!(codes.len(), variants(), "an example for each finding");
    page
}

/// Number of variants in the source: those of an enum begin at four blanks, with a capital.
fn variants() -> usize {
    let (_, after) = SOURCE.split_once("pub enum Finding {").unwrap();
    let (body, _) = after.split_once("\n}\n").unwrap();
    let is_variant = |line: &&str| {
        let own = line.strip_prefix("    ");
        own.is_some_and(|own| own.starts_with(|c: char| c.is_ascii_uppercase()))
    };
    body.lines().filter(is_variant).count()
}
