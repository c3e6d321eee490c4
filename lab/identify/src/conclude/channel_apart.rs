//! A channel that was logged differently in one of several files: it has the opposite sign there,
//! or two channels are swapped.
//!
//! An effect of that channel then has another sign, or another channel, in that file. A common gain
//! for all files is near zero, and the search attributes the missing output to other effects.

use super::final_fit::FinalFit;
use crate::fit::Segments;
use crate::ledger::{ChannelApart, Ledger};
use crate::problem::{Alteration, Prepared};
use crate::search::left_by_names;
use crate::search::policy::AT_FLOOR;

/// Maximum number of alterations that are tried. Each costs as much as one linearisation of the
/// baseline model. Four files with two channels have twelve.
const MOST_WAYS: usize = 12;
/// A search with an alteration is run only if names, to first order, then leave at most this share
/// of the squared error that they leave without it.
const PROMISED: f64 = 0.8;
/// The search must then end with at most this share of the error, and with no more names. Both are
/// choices.
const KEPT: f64 = 0.8;

/// The ways in which one channel of one file may differ.
fn ways(data: &Prepared) -> Vec<(usize, Alteration)> {
    let channels = data.channels.len();
    let turned = (0..channels).map(Alteration::Turned);
    let pairs = (0..channels).flat_map(|i| (i + 1..channels).map(move |j| (i, j)));
    let swapped = pairs.map(|(i, j)| Alteration::Swapped(i, j));
    let alterations: Vec<Alteration> = turned.chain(swapped).collect();
    let files = data.pieces.iter().enumerate();
    let fitted: Vec<usize> = files.filter_map(|(k, p)| p.fitted.then_some(k)).collect();
    // Of two files either one may be meant: the later one is named.
    let altered = match fitted.as_slice() {
        [] | [_] => &[],
        [_, second] => std::slice::from_ref(second),
        all => all,
    };
    altered
        .iter()
        .flat_map(|&file| alterations.iter().map(move |&a| (file, a)))
        .collect()
}

/// The channel that was logged differently in one file, if the residual exceeds the noise and is
/// much smaller after the correction. `search` runs the identification on the corrected files.
pub(crate) fn channel_apart(
    data: &Prepared,
    ledger: &Ledger,
    done: &FinalFit,
    search: impl FnOnce(&Prepared) -> Option<Ledger>,
) -> Option<ChannelApart> {
    let ways = ways(data);
    let is_much = done.rmse.fit > AT_FLOOR * data.noise_floor;
    if !is_much || ways.len() > MOST_WAYS {
        return None;
    }
    let left = left_by_names(data, &ledger.declared)?;
    let promise = |(file, way): (usize, Alteration)| {
        let left = left_by_names(&data.altered(file, way), &ledger.declared)?;
        Some((left, file, way))
    };
    let best = ways.into_iter().filter_map(promise);
    let (least, file, way) = best.min_by(|a, b| a.0.total_cmp(&b.0))?;
    if least > PROMISED * left {
        return None;
    }
    let mended = data.altered(file, way);
    let other = search(&mended)?;
    let fitted = FinalFit::new(&mended, &other);
    let after = fitted.rmse.fit;
    let has_more = other.rounds.len() > ledger.rounds.len()
        || (other.unknown.is_some() && ledger.unknown.is_none());
    if after > KEPT * done.rmse.fit || has_more {
        return None;
    }
    let name = |channel: usize| data.channels[channel].name.clone();
    let (channel, swapped_with) = match way {
        Alteration::Turned(channel) => (name(channel), None),
        Alteration::Swapped(one, second) => (name(one), Some(name(second))),
    };
    let deviation = Segments::deviation(data, &data.target).fit;
    Some(ChannelApart {
        path: data.pieces[file].path.clone(),
        channel,
        swapped_with,
        names: other.rounds.iter().map(|r| fitted.title_of(r)).collect(),
        before: done.rmse.fit / deviation,
        after: after / deviation,
    })
}
