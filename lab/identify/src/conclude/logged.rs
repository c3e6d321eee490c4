//! Is a record logged differently? Input and output of all files may be swapped, or a channel of
//! one file has the opposite sign or is swapped with another channel.
//!
//! The terms of a model then compensate for the alteration: a common gain of a channel with two
//! signs is near zero, and the search attributes the missing output to other effects. So each
//! alteration is undone, the search runs again, and the alteration is suspected if the model is
//! then much better with no more terms.

use super::final_fit::FinalFit;
use super::signs::runs_backwards;
use crate::alteration::{beyond_noise, Alteration, Suspicion};
use crate::fit::{fit, Segments, Solution};
use crate::ledger::Ledger;
use crate::problem::Prepared;
use crate::record::Record;
use crate::scale::{HALF, NOISE};
use crate::search::left_by_names;

/// Maximum number of channel alterations that are tried. Each costs as much as one linearisation of
/// the baseline model. Four files with two channels have twelve.
const MOST_WAYS: usize = 12;
/// The search runs again for a channel alteration only if terms, to first order, then leave at most
/// this share of the squared error that they leave without it. A choice: it saves a search.
const PROMISED: f64 = 0.8;

/// A run whose records may have been logged differently.
pub(crate) struct Run<'a> {
    /// The records.
    pub records: &'a [Record],
    /// The records on their grids.
    pub data: &'a Prepared,
    /// What the search found in them.
    pub ledger: &'a Ledger,
    /// The delivered model.
    pub done: &'a FinalFit,
    /// Puts altered records on the same grids.
    pub prepare: &'a dyn Fn(&[Record]) -> Option<Prepared>,
    /// Runs the identification on them.
    pub search: &'a dyn Fn(&Prepared) -> Option<Ledger>,
}

/// An alteration of one file, or of all.
type Way = (Option<usize>, Alteration);

impl Run<'_> {
    /// The alteration that undone makes the model much better, if the residual exceeds the noise.
    pub(crate) fn suspicion(&self) -> Option<Suspicion> {
        if self.done.rmse.fit <= NOISE * self.data.noise_floor {
            return None;
        }
        let exchanged = runs_backwards(self.data).then(|| {
            let (column, other) = (&self.data.input.name, &self.data.output_name);
            (None, swapped(column, other))
        });
        let exchanged = exchanged.filter(|way| self.baseline_fits(way) == Some(true));
        let ways = exchanged.into_iter().chain(self.channel());
        ways.filter_map(|way| self.confirmed(way)).next()
    }

    /// Whether the baseline model fits no worse without an alteration. This saves a search.
    fn baseline_fits(&self, way: &Way) -> Option<bool> {
        let (data, declared) = (self.undone(way)?, &self.ledger.declared);
        let relative = |data: &Prepared, solution: &Solution| {
            solution.rmse.fit / Segments::deviation(data, &data.target).fit
        };
        let without = fit(&data, &declared.structure, None, 0.0)?;
        Some(relative(&data, &without) <= relative(self.data, declared))
    }

    /// The channel alteration of one file with which the terms of the catalogue, to first order,
    /// leave the least error; `None` if they leave nearly as much in the records as they are.
    fn channel(&self) -> Option<Way> {
        let ways = self.channels();
        if ways.len() > MOST_WAYS {
            return None;
        }
        let declared = &self.ledger.declared;
        let promise = |way: Way| Some((left_by_names(&self.undone(&way)?, declared)?, way));
        let best = ways.into_iter().filter_map(promise);
        let (least, way) = best.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (least <= PROMISED * left_by_names(self.data, declared)?).then_some(way)
    }

    /// The ways in which a channel of one file may differ. Of two files either one may be meant:
    /// the later one is named.
    fn channels(&self) -> Vec<Way> {
        let names: Vec<&String> = self.data.channels.iter().map(|c| &c.name).collect();
        let reversed = names.iter().map(|name| Alteration::Reversed {
            column: (*name).clone(),
        });
        let pairs = (0..names.len()).flat_map(|i| (i + 1..names.len()).map(move |j| (i, j)));
        let swaps = pairs.map(|(i, j)| swapped(names[i], names[j]));
        let all: Vec<Alteration> = reversed.chain(swaps).collect();
        let files = self.data.pieces.iter().enumerate();
        let fitted: Vec<usize> = files.filter_map(|(k, p)| p.fitted.then_some(k)).collect();
        let files = match fitted.as_slice() {
            [] | [_] => &[],
            [_, second] => std::slice::from_ref(second),
            all => all,
        };
        let of = |&file: &usize| all.iter().map(move |one| (Some(file), one.clone()));
        files.iter().flat_map(of).collect()
    }

    /// The records without an alteration, on their grids.
    fn undone(&self, (file, alteration): &Way) -> Option<Prepared> {
        let records = self.records.iter().enumerate();
        let records = records.map(|(k, record)| match file.is_none_or(|file| file == k) {
            true => alteration.undone(record),
            false => record.clone(),
        });
        (self.prepare)(&records.collect::<Vec<Record>>())
    }

    fn confirmed(&self, way: Way) -> Option<Suspicion> {
        let data = self.undone(&way)?;
        let ledger = (self.search)(&data)?;
        let done = FinalFit::new(&data, &ledger);
        let fit = |data: &Prepared, done: &FinalFit| {
            let deviation = Segments::deviation(data, &data.target).fit;
            let beyond = beyond_noise(done.rmse.fit, data.noise_floor);
            (done.rmse.fit / deviation, beyond / deviation)
        };
        let ((before, far), (after, near)) = (fit(self.data, self.done), fit(&data, &done));
        let has_more = ledger.rounds.len() > self.ledger.rounds.len()
            || (ledger.unknown.is_some() && self.ledger.unknown.is_none());
        let (file, alteration) = way;
        (near <= HALF * far && !has_more).then(|| Suspicion {
            alteration,
            path: file.map(|file| self.data.pieces[file].path.clone()),
            terms: ledger.rounds.iter().map(|r| done.title_of(r)).collect(),
            before,
            after,
        })
    }
}

fn swapped(column: &str, other: &str) -> Alteration {
    Alteration::Swapped {
        column: column.to_owned(),
        other: other.to_owned(),
    }
}
