//! A sensor at the limit of its range.
//!
//! A clipped signal has a flat top that begins and ends with a slope, while the other end of the
//! transmission continues to move. None of these signs alone is sufficient: a quantised signal is
//! flat at its turning points (but arrives there slowly), a held input is flat and entered at speed
//! (but then the output rests too), and a dry-friction force without noise is flat while the input
//! moves (but then the input does not turn on that plateau).

use std::fmt;
use std::ops::Range;

/// Shortest plateau that counts [samples].
const SHORTEST: usize = 5;
/// Share of the samples on such plateaus from which a record is refused.
const REFUSED: f64 = 0.05;
/// Share below which a plateau may be a turning point.
const TOLD: f64 = 1e-3;

/// Plateaus of a clipped signal at one of its two extremes.
pub(super) struct Clipped {
    pub(super) level: f64,
    pub(super) plateaus: Vec<Range<usize>>,
    share: f64,
}

impl fmt::Display for Clipped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (level, plateaus, share) = (self.level, self.plateaus.len(), 100.0 * self.share);
        let times = if plateaus == 1 {
            "once".to_owned()
        } else {
            format!("{plateaus} times")
        };
        write!(
            f,
            "clipped: flat at {level} {times}, {share:.1} % of the samples; "
        )?;
        write!(f, "use a sensor with a wider range")
    }
}

/// Looks for clipping of `signal` that is so heavy that nothing can be concluded, using the other
/// end of the transmission for comparison.
pub(super) fn heavy(signal: &[f64], other: &[f64]) -> Option<Clipped> {
    let mut ends = ends(signal, other).into_iter();
    ends.find(|clipped| clipped.share >= REFUSED)
}

/// Looks for clipping of `signal` at its upper and its lower end.
pub(super) fn ends(signal: &[f64], other: &[f64]) -> Vec<Clipped> {
    let (low, high) = range(signal);
    let judge = Judge::new(signal, other);
    let end = |level: f64| {
        let clipped: Vec<_> = plateaus(signal, level)
            .filter(|plateau| judge.is_clipped(plateau))
            .collect();
        let samples: usize = clipped.iter().map(ExactSizeIterator::len).sum();
        let share = samples as f64 / signal.len() as f64;
        (share >= TOLD).then_some(Clipped {
            level,
            plateaus: clipped,
            share,
        })
    };
    [high, low].into_iter().filter_map(end).collect()
}

/// Runs of the extreme value that have samples before and after them.
fn plateaus(signal: &[f64], level: f64) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut at = 0;
    std::iter::from_fn(move || {
        while at < signal.len() {
            let start = at;
            while at < signal.len() && signal[at] == level {
                at += 1;
            }
            if at - start >= SHORTEST && start > 0 && at < signal.len() {
                return Some(start..at);
            }
            at = at.max(start + 1);
        }
        None
    })
}

struct Judge<'a> {
    signal: &'a [f64],
    other: &'a [f64],
    /// Smallest step of the signal: one count of its converter.
    count: f64,
    /// Root mean square of the steps that are not zero.
    usual_step: f64,
    /// Whether noise moves the signal back and forth between samples.
    jitters: bool,
    /// Noise of the other end, from its second differences.
    other_noise: f64,
}

impl<'a> Judge<'a> {
    fn new(signal: &'a [f64], other: &'a [f64]) -> Self {
        let steps: Vec<f64> = signal
            .windows(2)
            .map(|pair| pair[1] - pair[0])
            .filter(|step| *step != 0.0)
            .collect();
        let moving = steps.len().max(1) as f64;
        let turns = steps
            .windows(2)
            .filter(|pair| pair[0] * pair[1] < 0.0)
            .count();
        let bends: f64 = other
            .windows(3)
            .map(|w| (w[2] - 2.0 * w[1] + w[0]).powi(2))
            .sum();
        Self {
            signal,
            other,
            count: steps
                .iter()
                .fold(f64::INFINITY, |count, step| count.min(step.abs())),
            usual_step: (steps.iter().map(|step| step * step).sum::<f64>() / moving).sqrt(),
            jitters: turns as f64 > 0.1 * moving,
            other_noise: (bends / (6.0 * other.len() as f64)).sqrt(),
        }
    }

    fn is_clipped(&self, plateau: &Range<usize>) -> bool {
        let (moves, turns) = self.other_end(plateau);
        self.is_steep(plateau) && moves && (turns || self.jitters)
    }

    /// Whether a parabola through the slopes at both ends would have risen
    /// well above the plateau.
    fn is_steep(&self, plateau: &Range<usize>) -> bool {
        let length = plateau.len();
        let reach = (length / 2).clamp(2, 50);
        let level = self.signal[plateau.start];
        let before = plateau.start.saturating_sub(reach);
        let after = (plateau.end - 1 + reach).min(self.signal.len() - 1);
        let slope_in = (level - self.signal[before]).abs() / (plateau.start - before).max(1) as f64;
        let slope_out =
            (level - self.signal[after]).abs() / (after + 1 - plateau.end).max(1) as f64;
        let slope = slope_in.min(slope_out);
        slope * length as f64 / 4.0 >= 4.0 * self.count && slope >= 0.1 * self.usual_step
    }

    /// Whether the other end moves in the middle of the plateau, and turns there.
    fn other_end(&self, plateau: &Range<usize>) -> (bool, bool) {
        let length = plateau.len();
        let part = |k: usize| {
            let (from, to) = (
                plateau.start + k * length / SHORTEST,
                plateau.start + (k + 1) * length / SHORTEST,
            );
            self.other[from..to].iter().sum::<f64>() / (to - from).max(1) as f64
        };
        let means: [f64; SHORTEST] = std::array::from_fn(part);
        let noise = self.other_noise / (length as f64 / SHORTEST as f64).sqrt();
        let (low, high) = range(&means);
        let reach = (length / 2).clamp(2, 50);
        let before = plateau.start.saturating_sub(reach);
        let speed = (self.other[plateau.start] - self.other[before]).abs()
            / (plateau.start - before).max(1) as f64;
        let moves = high - low > 5.0 * noise && high - low > speed * length as f64 / 50.0;
        let (first, last) = (means[0], means[SHORTEST - 1]);
        let beyond = (high - first.max(last)).max(first.min(last) - low);
        (moves, beyond > 5.0 * noise)
    }
}

/// Smallest and largest value.
pub(super) fn range(values: &[f64]) -> (f64, f64) {
    let wider = |(low, high): (f64, f64), value: &f64| (low.min(*value), high.max(*value));
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), wider)
}
