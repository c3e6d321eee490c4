//! A sensor at the limit of its range.
//!
//! A clipped signal has a flat top that begins and ends with a slope, while the other end of the
//! transmission continues to move. No single sign is sufficient. A quantised signal is flat at its
//! turning points, but approaches them slowly. A held input is flat and begins abruptly, but then
//! the output also rests. A dry-friction force without noise is flat while the input moves, but
//! then the input does not reverse during the plateau.

use super::companion::Companion;
use super::{share, Found};
use crate::scale::{is_noisy, range, runs, steps, times, CLEAR, FEW, FRACTION, GRAVE, TOLD};
use std::ops::Range;

/// Plateaus of a clipped signal at one of its two extremes.
struct Clipped {
    level: f64,
    plateaus: Vec<Range<usize>>,
}

/// The first sample and the error message if `signal` is clipped so heavily that no conclusion is
/// possible. `other` is the other end of the transmission.
pub(crate) fn heavy(signal: &[f64], other: &[f64]) -> Option<(usize, String)> {
    let mut all = ends(signal, &Companion::new(other)).into_iter();
    let own = |end: Clipped| {
        let share = share(&end.plateaus, signal.len());
        let message = message(&end.level.to_string(), end.plateaus.len(), share, 1);
        (share >= GRAVE).then_some((end.plateaus.first()?.start, message))
    };
    all.find_map(own)
}

/// Clipping that is not severe enough to reject the record.
pub(super) fn find(
    signal: &[f64],
    other: &Companion,
    few: f64,
    spoilt: impl Fn(&Range<usize>) -> bool,
) -> Option<Found> {
    let mut samples: Vec<Range<usize>> = Vec::new();
    let mut levels = Vec::new();
    for mut end in ends(signal, other) {
        end.plateaus.retain(|plateau| !spoilt(plateau));
        if !end.plateaus.is_empty() {
            levels.push(end.level.to_string());
        }
        samples.extend(end.plateaus);
    }
    samples.sort_by_key(|plateau| plateau.start);
    let share = share(&samples, signal.len());
    (!samples.is_empty()).then(|| Found {
        message: message(&levels.join(" and "), samples.len(), share, 2),
        grave: share > few,
        samples,
    })
}

fn message(levels: &str, plateaus: usize, share: f64, decimals: usize) -> String {
    format!(
        "clipped: flat at {levels} {}, {:.decimals$} % of the samples; use a sensor with a wider range",
        times(plateaus),
        100.0 * share
    )
}

/// Clipping at the upper and at the lower end. A single plateau may be a turning point.
fn ends(signal: &[f64], other: &Companion) -> Vec<Clipped> {
    let (low, high) = range(signal);
    let judge = Judge::new(signal, other);
    let within = |run: &Range<usize>| run.len() >= FEW && run.start > 0 && run.end < signal.len();
    let end = |level: f64| {
        let plateaus = runs(signal).filter(|run| within(run) && signal[run.start] == level);
        let plateaus: Vec<_> = plateaus.filter(|own| judge.is_clipped(own)).collect();
        let is_told = share(&plateaus, signal.len()) >= TOLD;
        is_told.then_some(Clipped { level, plateaus })
    };
    [high, low].into_iter().filter_map(end).collect()
}

struct Judge<'a> {
    signal: &'a [f64],
    other: &'a Companion,
    /// Smallest step of the signal, which is one count of its converter.
    count: f64,
    /// Root mean square of the steps that are not zero.
    usual_step: f64,
    /// Whether noise moves the signal back and forth between samples.
    jitters: bool,
}

impl<'a> Judge<'a> {
    fn new(signal: &'a [f64], other: &'a Companion) -> Self {
        let moving: Vec<f64> = steps(signal).filter(|step| *step != 0.0).collect();
        let squares: f64 = moving.iter().map(|step| step * step).sum();
        Self {
            signal,
            other,
            count: range(&moving.iter().map(|step| step.abs()).collect::<Vec<_>>()).0,
            usual_step: (squares / moving.len().max(1) as f64).sqrt(),
            jitters: is_noisy(&moving),
        }
    }

    /// The samples next to a plateau over which slopes are measured.
    fn beside(&self, plateau: &Range<usize>) -> (usize, usize) {
        let reach = (plateau.len() / 2).clamp(2, 50);
        let after = (plateau.end - 1 + reach).min(self.signal.len() - 1);
        (plateau.start.saturating_sub(reach), after)
    }

    /// Whether a parabola through the slopes at both ends would have risen
    /// well above the plateau.
    fn is_steep(&self, plateau: &Range<usize>) -> bool {
        let level = self.signal[plateau.start];
        let (before, after) = self.beside(plateau);
        let slope = |at: usize, gone: usize| (level - self.signal[at]).abs() / gone.max(1) as f64;
        let slope =
            slope(before, plateau.start - before).min(slope(after, after + 1 - plateau.end));
        slope * plateau.len() as f64 / 4.0 >= 4.0 * self.count && slope >= 0.1 * self.usual_step
    }

    /// Whether the other end moves during the plateau. If the signal has no noise, the other end
    /// must also reverse.
    fn is_clipped(&self, plateau: &Range<usize>) -> bool {
        let (means, noise) = self.other.parts(plateau);
        let (low, high) = range(&means);
        let (before, _) = self.beside(plateau);
        let came = self.other.mean(plateau.start, 1) - self.other.mean(before, 1);
        let speed = came.abs() / (plateau.start - before).max(1) as f64;
        let moves = high - low > (CLEAR * noise).max(FRACTION * speed * plateau.len() as f64);
        let (first, last) = (means[0], means[FEW - 1]);
        let beyond = (high - first.max(last)).max(first.min(last) - low);
        self.is_steep(plateau) && moves && (beyond > CLEAR * noise || self.jitters)
    }
}
