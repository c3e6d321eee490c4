//! One planted record through the loop and through the two usual criteria.

use crate::criteria::{self, Chosen};
use crate::rig::Made;
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::fit::fit;
use bowden_lab::ledger::{Ledger, Round};
use bowden_lab::model::catalogue::candidates;
use bowden_lab::model::declared::structure;
use bowden_lab::search::close;
use bowden_synth::Recipe;

/// What one record gave.
pub struct Outcome {
    /// The family of each round and those of its rivals.
    pub rounds: Vec<Vec<&'static str>>,
    /// Held-out error of the last model over what the noise leaves.
    pub reached: f64,
    /// The same of the final model, whose parameters have seen the stop-check as well.
    pub delivered: f64,
    /// As `reached` and `delivered`, of a fit that was told of the planted effects, where
    /// they can be declared.
    pub told: Option<[f64; 2]>,
    /// Columns of the catalogue that were tried.
    pub columns: usize,
    pub bic: Chosen,
    pub err: Chosen,
    /// What the residual depends on without a name, and whose it is.
    pub unknown: Option<(&'static str, String)>,
    /// For a reader who wants to see the single record.
    pub line: String,
}

/// The errors of a fit that is told of the planted effects, where they can be declared:
/// before and after the last fit, over what the noise leaves.
fn told(made: &Made, floor: f64) -> Option<[f64; 2]> {
    let mut list = vec!["bouc-wen".to_owned()];
    list.extend(
        made.synthetic
            .truth
            .effects
            .iter()
            .map(|e| match e.channel {
                Some(channel) => format!("{}@{channel}", e.effect),
                None => e.effect.clone(),
            }),
    );
    let told = structure(&list, &made.data).ok()?;
    let told = fit(&made.data, &told, None, 0.0)?;
    let done = FinalFit::of(&made.data, &told).rmse.held_out;
    Some([told.rmse.held_out / floor, done / floor])
}

/// Generates a record and closes it, as a user would.
pub fn run(recipe: &Recipe) -> Outcome {
    let made = Made::new(recipe);
    let (data, floor) = (&made.data, made.noise_floor());
    let declared = made.declare(&["bouc-wen"]);
    let ledger = close(data, &declared, |_| ()).unwrap();
    let tried = candidates(data, &ledger.declared.structure, &ledger.declared.residual);
    let library = criteria::Library::new(data, &ledger.declared, &tried);
    let families = |round: &Round| round.possible().map(|c| c.family).collect();
    let unknown = ledger.unknown.as_ref().map(|u| {
        let channel = data.channel(u.variable.source()).unwrap();
        (u.variable.name(data), channel.name.clone())
    });
    let reached = ledger.last().rmse.held_out / floor;
    let delivered = FinalFit::new(data, &ledger).rmse.held_out / floor;
    let before = ledger.declared.rmse.held_out / floor;
    Outcome {
        reached,
        delivered,
        told: told(&made, floor),
        columns: tried.len(),
        bic: library.bic(floor),
        err: library.err(floor),
        line: line(
            recipe,
            &ledger,
            unknown.as_ref(),
            [before, reached, delivered],
        ),
        rounds: ledger.rounds.iter().map(families).collect(),
        unknown,
    }
}

/// The single record for a reader; `errors` are before the search, after it, and delivered.
fn line(
    recipe: &Recipe,
    ledger: &Ledger,
    unknown: Option<&(&'static str, String)>,
    [before, reached, delivered]: [f64; 3],
) -> String {
    let planted = recipe.effects.iter();
    let planted: Vec<String> = planted
        .map(|p| format!("{}*{:.2}", p.effect, p.strength))
        .collect();
    let name = |round: &Round| {
        let rivals: Vec<_> = round.rivals.iter().map(|c| c.term.effect.name()).collect();
        format!("{}{rivals:?}", round.candidate.term.effect.name())
    };
    let names: Vec<String> = ledger.rounds.iter().map(name).collect();
    let turned_down = ledger.rejected.iter();
    let turned_down: Vec<String> = turned_down
        .map(|r| format!("{}:{:?}", r.candidate.term.effect.name(), r.gate))
        .collect();
    format!(
        "{:?} {} colour {} planted {planted:?}: {before:.2} -> {reached:.2}, {delivered:.2} ({:?}) {}; unknown {unknown:?} q {:.2} | {}",
        recipe.mode,
        recipe.seed,
        recipe.colour,
        ledger.regime,
        names.join(", "),
        ledger.unknown.as_ref().map_or(f64::NAN, |u| u.q),
        turned_down.join(" ")
    )
}

impl Outcome {
    /// How many of the planted families were named, or stand among the rivals of a name.
    pub fn found(&self, planted: &[&'static str]) -> usize {
        planted
            .iter()
            .filter(|f| self.rounds.iter().any(|round| round.contains(f)))
            .count()
    }

    /// Rounds that name nothing that was planted, rivals included, and an "unknown" where
    /// nothing is.
    pub fn wrong(&self, planted: &[&'static str]) -> usize {
        self.wrong_names(planted) + usize::from(self.unknown.is_some())
    }

    /// Rounds that name nothing that was planted, rivals included.
    pub fn wrong_names(&self, planted: &[&'static str]) -> usize {
        self.rounds
            .iter()
            .filter(|round| planted.iter().all(|f| !round.contains(f)))
            .count()
    }
}
