//! A tone: a line in the residual's spectrum that depends on no measured signal.
//!
//! A peak is compared with the median of the bins around it, since a coloured residual has no
//! common level (Fisher's g supposes one and rejects on every record). The slope of the filter is
//! divided out first, so that a line above the cut-off is found too: the filter passes half of
//! the amplitude there, and a search goes on to where it passes a tenth. Lines of the input and their
//! multiples are excluded: a static non-linearity also produces lines there. A line at a sum or
//! difference of the motion's lines may also have this cause ([`is_combination`]).

use crate::model::kind::{kind, Kind};
use crate::model::structure::FitTerm;
use crate::problem::filter::gain;
use crate::problem::spectrum::power_of_fit;
use crate::problem::{Channel, Prepared, MOST_RECORDS};
use crate::scale::{LEVEL, PART, QUARTER, TRACE};
use bowden::effect::Effect;
use bowden::model::Source;
use bowden_fourier::Complex;
use std::f64::consts::TAU;

/// Bins on either side from which the noise level is taken.
const AROUND: usize = 25;
/// Multiples of the input's lines that count as lines of the input ...
const MULTIPLES: usize = 7;
/// ... this many bins to either side; more of either leaves little to search.
const NEAR: f64 = 0.6;
/// Number of the strongest lines of the motion whose sums and differences are considered ...
const COMBINED: usize = 6;
/// ... up to the highest of these orders (a combination of n lines, with repetitions, has order n)
/// at which they cover no more than a quarter of the bins.
const ORDERS: [i32; 3] = [5, 3, 2];
/// Steps to either side in which the frequency is refined, within one bin.
const STEPS: i32 = 50;

/// Step of the estimation grid \[s\].
fn step(data: &Prepared) -> f64 {
    data.dt * data.stride as f64
}

/// The bin with the most significant peak and its p-value, if one is significant.
pub(crate) fn strongest(data: &Prepared, residual: &[f64]) -> Option<(f64, f64)> {
    let power_of = |signal: &[f64]| power_of_fit(data, signal, hann);
    let mut powers = power_of(residual)?;
    let own = lines_of(data, &data.input)?;
    let bins = data.split.fit.last()? - data.split.fit.first()? + 1;
    let seconds = bins as f64 * step(data);
    let passed = |k: &usize| gain(data.cutoff, 1.0 / data.dt, *k as f64 / seconds);
    let passes = (0..powers.len()).take_while(|k| passed(k) >= PART);
    let highest = passes.last()?;
    for (k, power) in powers.iter_mut().enumerate().take(highest + 1) {
        *power /= passed(&k).powi(2);
    }
    let free: Vec<usize> = (2..highest)
        .filter(|&k| {
            let is_multiple = |(line, _): &Line| is_multiple(k as f64, *line);
            !own.iter().any(is_multiple)
        })
        .collect();
    let (bin, p) = free
        .iter()
        .map(|&k| {
            let mut around: Vec<f64> = (k.saturating_sub(AROUND).max(1)
                ..=(k + AROUND).min(highest))
                .filter(|i| i.abs_diff(k) > 1)
                .map(|i| powers[i])
                .collect();
            around.sort_by(f64::total_cmp);
            let median = around.get(around.len() / 2).copied().unwrap_or(0.0);
            // The power of noise is exponential: its median is ln 2 of its mean.
            (k, (-powers[k] / median).exp2())
        })
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    (p <= LEVEL / free.len() as f64).then_some((bin as f64 / seconds, p))
}

/// Whether a place is near a multiple of a line.
fn is_multiple(place: f64, line: f64) -> bool {
    (1..=MULTIPLES).any(|m| (place - m as f64 * line).abs() <= NEAR)
}

/// Window of a spectrum of `n` samples.
fn hann(at: f64, n: f64) -> f64 {
    0.5 - 0.5 * (TAU * at / n).cos()
}

/// A line of a spectrum: its bin, to a fraction, and its power, of the strongest.
type Line = (f64, f64);

/// The lines of a channel.
fn lines_of(data: &Prepared, channel: &Channel) -> Option<Vec<Line>> {
    let motion = channel.motion.iter().step_by(data.stride);
    let position: Vec<f64> = motion.map(|m| m.position).collect();
    power_of_fit(data, &position, hann).map(|power| lines(&power))
}

/// Whether a term is a tone at a line that the motion itself may cause.
pub(crate) fn may_be_of_the_motion(data: &Prepared, term: &FitTerm) -> bool {
    let effect = &term.effect;
    let frequency = effect.shape(0).filter(|_| effect.name() == "tone");
    frequency.is_some_and(|f| is_combination(data, f))
}

/// Whether a frequency \[Hz\] is a sum or difference of the lines of the input and of the other
/// motions, or a multiple of one line. Effects that are not linear in the motion, such as friction,
/// cause lines there. No search begins at a multiple, but a search that begins near one may end
/// there.
fn is_combination(data: &Prepared, frequency: f64) -> bool {
    let (Some(&first), Some(&last)) = (data.split.fit.first(), data.split.fit.last()) else {
        return false;
    };
    let seconds = (last - first + 1) as f64 * step(data);
    let moving = data.channels.iter().enumerate().filter(|(index, channel)| {
        kind(data.mode, Source::Channel(*index as u8), channel) == Kind::Motion
    });
    let all = std::iter::once(&data.input).chain(moving.map(|(_, channel)| channel));
    let mut lines: Vec<Line> = all
        .filter_map(|one| lines_of(data, one))
        .flatten()
        .collect();
    lines.sort_by(|a, b| b.1.total_cmp(&a.1));
    let strongest: Vec<f64> = lines.iter().take(COMBINED).map(|line| line.0).collect();
    let highest = (data.cutoff * seconds) as usize;
    let place = frequency * seconds;
    lines.iter().any(|(line, _)| is_multiple(place, *line))
        || is_near_a_sum(&strongest, highest, place)
}

/// Whether a position is near a sum or difference of lines, of the highest order at which these
/// cover no more than their share of the bins.
fn is_near_a_sum(lines: &[f64], highest: usize, place: f64) -> bool {
    let near = |sums: &[f64], place: f64| sums.iter().any(|sum| (place - sum).abs() <= NEAR);
    let mut orders = ORDERS.iter().map(|&order| combinations(lines, order));
    let is_few = |sums: &Vec<f64>| {
        let taken = (1..=highest).filter(|&k| near(sums, k as f64)).count();
        taken as f64 <= QUARTER * highest as f64
    };
    orders.find(is_few).is_some_and(|sums| near(&sums, place))
}

/// Positions of the sums and differences of lines, up to an order. Of the even orders only the
/// second is included, because friction is odd.
fn combinations(lines: &[f64], order: i32) -> Vec<f64> {
    let mut sums = vec![(0, 0.0)];
    for line in lines {
        let with = sums.iter().flat_map(|&(used, at): &(i32, f64)| {
            let left = order - used;
            (-left..=left).map(move |n| (used + n.abs(), at + f64::from(n) * line))
        });
        sums = with.collect();
    }
    let counts = |used: i32| used == 2 || used % 2 == 1;
    let all = sums
        .into_iter()
        .filter(|&(used, at)| counts(used) && at > 0.0);
    all.map(|(_, at)| at).collect()
}

/// The lines of a spectrum that have at least a trace of the power of its strongest.
fn lines(power: &[f64]) -> Vec<Line> {
    let peak = power.iter().copied().fold(0.0, f64::max);
    (1..power.len().saturating_sub(1))
        .filter(|&k| {
            power[k] >= TRACE * peak && power[k] >= power[k - 1] && power[k] > power[k + 1]
        })
        .map(|k| {
            // In logarithms the main lobe of a Hann window is nearly a parabola.
            let [a, b, c] = [power[k - 1], power[k], power[k + 1]].map(|p| p.max(1e-300).ln());
            let place = k as f64 + 0.5 * (a - c) / (a - 2.0 * b + c);
            (place, power[k] / peak)
        })
        .collect()
}

/// The tone near a frequency \[Hz\] that reduces the SSE most.
pub(crate) fn term(data: &Prepared, residual: &[f64], frequency: f64) -> Option<FitTerm> {
    let fit = &data.split.fit;
    let seconds = (fit.last()? - fit.first()? + 1) as f64 * step(data);
    let at = |f: f64| -> Complex<f64> {
        fit.iter()
            .map(|&i| Complex::cis(-TAU * f * i as f64 * step(data)) * residual[i])
            .sum()
    };
    let (f, line) = (-STEPS..=STEPS)
        .map(|k| frequency + f64::from(k) / f64::from(STEPS) / seconds)
        .filter(|f| *f > 0.0)
        .map(|f| (f, at(f)))
        .max_by(|a, b| a.1.norm_sqr().total_cmp(&b.1.norm_sqr()))?;
    // sum r·e^(−iwt) of a sine of phase psi turns by psi − 90°.
    let psi = line.arg() + 0.25 * TAU;
    Some(FitTerm {
        effect: Effect::try_from_name("tone", &[f, psi]).ok()?,
        source: Source::Input,
        origin: 0.0,
        start: [0.0; MOST_RECORDS],
    })
}

#[cfg(test)]
mod tests {
    use super::{is_multiple, is_near_a_sum};

    #[test]
    fn a_line_beside_a_multiple_is_told_from_it_by_a_bin() {
        assert!(is_multiple(4.0 * 60.4, 60.4) && is_multiple(7.0 * 60.4 - 0.5, 60.4));
        assert!(!is_multiple(4.0 * 60.4 + 1.0, 60.4) && !is_multiple(8.0 * 60.4, 60.4));
    }

    /// Friction of a motion at bins 7.4, 19.9 and 40.8 makes a line at 2·40.8 − 19.9 = 61.7.
    #[test]
    fn a_sum_or_difference_of_the_lines_of_what_moves_is_no_disturbance() {
        let own = [7.4, 19.9, 40.8];
        let is_sum = |place| is_near_a_sum(&own, 437, place);
        assert!(is_sum(61.7), "2·40.8 - 19.9");
        assert!(is_sum(68.0), "7.4 + 19.9 + 40.8");
        assert!(is_sum(48.3), "7.4 + 40.8");
        // No combination of up to five is near.
        assert!(!is_sum(24.0) && !is_sum(213.0) && !is_sum(300.0));
        // Of the lines of another channel too, here 40.8 - 17.1.
        assert!(is_near_a_sum(&[7.4, 19.9, 40.8, 17.1], 437, 23.7));
        // A tone is doubted in a quarter of the cases at most, however many lines there are.
        let many = [7.4, 19.9, 40.8, 17.1, 55.3, 31.9];
        let doubted = (1..=437).filter(|&k| is_near_a_sum(&many, 437, f64::from(k)));
        assert!(4 * doubted.count() <= 437);
    }
}
