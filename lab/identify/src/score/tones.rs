//! A tone: a line in the residual's spectrum, a function of nothing measured.
//!
//! A peak is compared with the median of the bins around it, since a coloured residual has no
//! common level (Fisher's g supposes one and rejects on every record). The slope of the filter is
//! divided out first, so that a line above the cut-off is found too: the filter passes half of
//! the amplitude there. Lines of the input and their multiples are excluded: a static
//! non-linearity also produces lines there.

use crate::model::structure::FitTerm;
use crate::problem::filter::gain;
use crate::problem::spectrum::power_of_fit;
use crate::problem::{Prepared, MOST_RECORDS};
use bowden::effect::Effect;
use bowden::model::Source;
use rustfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Level of the test, divided by the number of bins.
const LEVEL: f64 = 0.01;
/// Bins on either side from which the noise level is taken.
const AROUND: usize = 25;
/// Least gain of the filter at a frequency that is searched: up to 1.3 times the cut-off.
const PASSED: f64 = 0.1;
/// Multiples of the input's lines that count as its own ...
const MULTIPLES: usize = 7;
/// ... this many bins to either side; more of either leaves little to search ...
const NEAR: f64 = 0.6;
/// ... and the power from which a line of the input is one, of its strongest.
const LINE: f64 = 0.01;
/// Steps to either side in which the frequency is refined, within one bin.
const STEPS: i32 = 50;

/// Step of the estimation grid \[s\].
fn step(data: &Prepared) -> f64 {
    data.dt * data.stride as f64
}

/// The bin with the most significant peak and its p-value, if one is significant.
pub(crate) fn strongest(data: &Prepared, residual: &[f64]) -> Option<(f64, f64)> {
    let hann = |at: f64, n: f64| 0.5 - 0.5 * (TAU * at / n).cos();
    let power_of = |signal: &[f64]| power_of_fit(data, signal, hann);
    let mut powers = power_of(residual)?;
    let position: Vec<f64> = data
        .input
        .motion
        .iter()
        .step_by(data.stride)
        .map(|m| m.position)
        .collect();
    let own = lines(&power_of(&position)?);
    let bins = data.split.fit.last()? - data.split.fit.first()? + 1;
    let seconds = bins as f64 * step(data);
    let passed = |k: &usize| gain(data.cutoff, 1.0 / data.dt, *k as f64 / seconds);
    let passes = (0..powers.len()).take_while(|k| passed(k) >= PASSED);
    let highest = passes.last()?;
    for (k, power) in powers.iter_mut().enumerate().take(highest + 1) {
        *power /= passed(&k).powi(2);
    }
    let free: Vec<usize> = (2..highest)
        .filter(|&k| {
            !own.iter()
                .any(|line| (1..=MULTIPLES).any(|m| (k as f64 - m as f64 * line).abs() <= NEAR))
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

/// Positions of the lines of a spectrum, to a fraction of a bin.
fn lines(power: &[f64]) -> Vec<f64> {
    let peak = power.iter().copied().fold(0.0, f64::max);
    (1..power.len().saturating_sub(1))
        .filter(|&k| power[k] >= LINE * peak && power[k] >= power[k - 1] && power[k] > power[k + 1])
        .map(|k| {
            // In logarithms the main lobe of a Hann window is nearly a parabola.
            let [a, b, c] = [power[k - 1], power[k], power[k + 1]].map(|p| p.max(1e-300).ln());
            k as f64 + 0.5 * (a - c) / (a - 2.0 * b + c)
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
