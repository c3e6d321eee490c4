//! Rest before and after a test.
//!
//! A signal rests while it stays within a trace of its range and the swing of its noise, both of the
//! value at that end of the record. Rest is left out if it is a part of the record.
//!
//! Loggers are started early and stopped late. A rest contains no information. But the segments are
//! shares of the record, and a held-out segment at rest has no standard deviation with which to
//! compare an error.

use crate::scale::{PART, SWING, TRACE};
use std::ops::Range;

/// Minimum number of rows that must remain.
pub(super) const FEWEST: usize = 160;

/// The rows of a record but for rest at either end; `edge` of them are left out at each end in
/// any case, and as many of the rest are kept: there the signals come to it.
///
/// Each signal has one value a row, and the rms of its noise.
pub(super) fn moving(signals: &[(Vec<f64>, f64)], edge: usize) -> Range<usize> {
    let rows = signals.first().map_or(0, |(values, _)| values.len());
    let all = edge..rows - edge;
    let kept = |rest: usize| match rest as f64 >= PART * rows as f64 {
        true => rest - edge.min(rest),
        false => 0,
    };
    let from = edge.max(kept(resting(signals, edge, |k| k)));
    let to = (rows - edge).min(rows - kept(resting(signals, edge, |k| rows - 1 - k)));
    match to.saturating_sub(from) >= FEWEST {
        true => from..to,
        false => all,
    }
}

/// The number of rows, from one end, over which all signals rest.
fn resting(signals: &[(Vec<f64>, f64)], edge: usize, row: impl Fn(usize) -> usize) -> usize {
    let of = |(values, noise): &(Vec<f64>, f64)| {
        let at_end = (0..edge).map(|k| values[row(k)]).sum::<f64>() / edge as f64;
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // The mean of equal values is rounded.
        let near = TRACE * (high - low) + SWING * noise + 1e-9 * at_end.abs();
        let rests = |k: &usize| (values[row(*k)] - at_end).abs() <= near;
        (0..values.len()).take_while(rests).count()
    };
    signals.iter().map(of).min().unwrap_or(0)
}

/// The notes on rest that is excluded at the start and at the end \[s\], and on the time \[s\] for
/// which the input rests within its noise.
pub(super) fn note(first: (bool, f64), last: (bool, f64), still: f64) -> Option<String> {
    let said = |(is, seconds): (bool, f64), which: &str| {
        is.then(|| format!("in the {which} {seconds:.3} s"))
    };
    let ends: Vec<String> = [said(first, "first"), said(last, "last")]
        .into_iter()
        .flatten()
        .collect();
    let left_out = format!(
        "nothing moves {}, so these samples are excluded",
        ends.join(" and ")
    );
    let line = format!(
        "for {still:.3} s in total, the input moves by no more than its noise; straight lines replace the noise, which would otherwise drive the hysteresis"
    );
    let said = [(!ends.is_empty(), left_out), (still > 0.0, line)];
    let said: Vec<String> = said
        .into_iter()
        .filter_map(|(is, words)| is.then_some(words))
        .collect();
    (!said.is_empty()).then(|| said.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(row: usize) -> f64 {
        (0.1 * row as f64).sin()
    }

    #[test]
    fn rest_at_both_ends_is_left_out_but_for_an_edge() {
        let signal: Vec<f64> = (0..1000)
            .map(|row| match row {
                0..200 => sine(200),
                200..700 => sine(row),
                _ => sine(699),
            })
            .collect();
        let still = vec![0.5; 1000];
        let all = [(signal.clone(), 0.0), (still, 0.0)];
        let found = moving(&all, 10);
        // A signal is within a hundredth of its end a row or two before it rests.
        assert!((190..=195).contains(&found.start), "{found:?}");
        assert!((705..=710).contains(&found.end), "{found:?}");
        // As long as another signal moves nothing rests.
        let all = [(signal, 0.0), ((0..1000).map(sine).collect(), 0.0)];
        assert_eq!(moving(&all, 10), 10..990);
    }

    #[test]
    fn short_rest_and_a_record_that_hardly_moves_stay_whole() {
        let short = |row: usize| sine(row.min(940));
        assert_eq!(
            moving(&[((0..1000).map(short).collect(), 0.0)], 10),
            10..990
        );
        let step = |row: usize| f64::from(u8::from(row > 100));
        assert_eq!(moving(&[((0..1000).map(step).collect(), 0.0)], 10), 10..990);
    }
}
