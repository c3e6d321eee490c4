//! How often a 95 % interval holds the truth.
//!
//! The fit is told which effects there are: what is asked is whether its intervals are
//! honest, not whether the effect is found. Only curves that are the same in generator
//! and catalogue are planted, so that there is a true value.

use crate::planting::recipe;
use bowden_lab::conclude::intervals::parameters;
use bowden_lab::fit::fit;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{parse, Options};
use bowden_synth::{generate, Mode};
use std::collections::BTreeMap;

const EFFECTS: [&str; 4] = [
    "viscous",
    "inertia",
    "asymmetry-viscous",
    "stiffness-quadratic",
];

/// By parameter: intervals, those that hold the truth, and those below and above it.
#[derive(Default, Clone, Copy)]
pub struct Count {
    pub all: u32,
    pub inside: u32,
    pub refused: u32,
}

pub type Counts = BTreeMap<String, Count>;

pub fn merge(mut sum: Counts, other: Counts) -> Counts {
    for (name, count) in other {
        let slot = sum.entry(name).or_default();
        slot.all += count.all;
        slot.inside += count.inside;
        slot.refused += count.refused;
    }
    sum
}

/// One record: each identified parameter against its true value.
pub fn of(mode: Mode, seed: u64, colour: f64) -> Counts {
    let effect = EFFECTS[(seed / 2 % 4) as usize];
    let made = generate(&recipe(mode, &[(effect, 3.0)], colour, seed)).unwrap();
    let record = parse(made.to_csv().as_bytes(), "planted", &Options::default()).unwrap();
    let data = Prepared::new(&record, Preparation::default()).unwrap();
    let planted = &made.truth.effects[0];
    let declared = [
        "bouc-wen".to_owned(),
        format!("{effect}@{}", planted.channel.unwrap()),
    ];
    let solution = fit(&data, &structure(&declared, &data).unwrap(), None, 0.0).unwrap();
    let base = made.truth.base;
    let mut counts = Counts::new();
    for parameter in parameters(&data, &solution) {
        let truth = match parameter.name.as_str() {
            "B" | "kappa_x" => base.gain,
            "kappa_eta" => base.kappa_eta,
            "rho" => base.rho,
            "sigma" => base.sigma,
            "n" => base.n,
            // The constant: a quadratic about another zero moves it, and the zero is told
            // from the record's range.
            "T0" | "offset" if effect != "stiffness-quadratic" => base.offset,
            _ if parameter.term == Some(0)
                && parameter.name.starts_with(effect)
                && !parameter.name.contains('.') =>
            {
                planted.gain
            }
            _ => continue,
        };
        let name = match parameter.term {
            Some(_) => "gain of the effect".to_owned(),
            None => parameter.name.clone(),
        };
        // A quadratic about another zero is a linear term as well.
        if effect == "stiffness-quadratic" && matches!(name.as_str(), "kappa_x") {
            continue;
        }
        let slot = counts.entry(name).or_default();
        match parameter.ci95 {
            Some([low, high]) => {
                slot.all += 1;
                slot.inside += u32::from(low <= truth && truth <= high);
            }
            None => slot.refused += 1,
        }
    }
    counts
}
