//! Spectra: of the input, from which the default cut-off is taken, and of the fit segment.

use super::{Prepared, ZeroPhase};
use crate::scale::{QUARTER, SWING, TRACE};
use bowden_fourier::{Complex, Transform};

/// The smoother may change the input by at most this share of its half-range: the hysteresis and a
/// smoother do not commute, so a rounded corner looks like a lag. With 0.1 %, friction is still
/// reported on a sound rig that is moved by a triangle wave.
const ROUNDED: f64 = 3e-4;

/// About eight times the highest tone of the input \[Hz\], or more if the input has corners.
///
/// The highest tone is the highest frequency at which the amplitude spectrum (Hann
/// window, mean removed) reaches a tenth of its peak. The result is kept between
/// 50 periods in the record, which is what a search needs, and a fifth of the rate.
#[must_use]
pub fn default_cutoff(input: &[f64], rate: f64) -> f64 {
    let power = power(input);
    let seconds = input.len() as f64 / rate;
    let peak = power.iter().copied().fold(0.0, f64::max);
    let bin = power
        .iter()
        .rposition(|&p| p >= TRACE * peak)
        .unwrap_or(1)
        .max(1);
    let resolution = rate / (2 * (power.len() - 1)) as f64;
    // Two significant digits: a cut-off that can be said aloud and typed again.
    let digits = |raw: f64| format!("{raw:.1e}").parse().unwrap_or(raw);
    let (least, most) = (50.0 / seconds, 0.2 * rate);
    let of_tones = (8.0 * bin as f64 * resolution).clamp(least, most);
    // Above this, the smoother that represents the signal itself would be limited by half the rate.
    let last = most.min(0.09 * rate);
    let mut raw = of_tones;
    while let Some(corner) = rounded(input, rate, digits(raw)) {
        if raw >= last {
            return digits(match corner {
                Corner::Rare => raw,
                // Noise goes on to the end of the band.
                Corner::Large => of_tones,
            });
        }
        raw = ((1.0 + QUARTER) * raw).min(last);
    }
    digits(raw)
}

/// The corners that the smoother rounds.
enum Corner {
    /// Much larger than the changes elsewhere.
    Rare,
    /// So large that only a poor sensor could have such noise.
    Large,
}

/// The corners of a signal that the smoother for a cut-off rounds.
fn rounded(signal: &[f64], rate: f64, cutoff: f64) -> Option<Corner> {
    // Neither contains noise; a smoother with twice the cut-off represents the signal itself.
    let narrow = ZeroPhase::new(2.5 * cutoff, rate);
    let wide = ZeroPhase::new((5.0 * cutoff).min(0.45 * rate), rate);
    let apart = narrow.apply(signal);
    let apart = apart.iter().zip(wide.apply(signal));
    // What comes before and after the record is not known: its ends say nothing.
    let end = (3.0 * rate / cutoff).ceil() as usize;
    let inside = apart.skip(end).take(signal.len().saturating_sub(2 * end));
    let mut moved: Vec<f64> = inside.map(|(a, b)| (a - b).abs()).collect();
    let most = moved.iter().copied().fold(0.0, f64::max);
    let low = signal.iter().copied().fold(f64::INFINITY, f64::min);
    let high = signal.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // A staircase dwells, and a triangle has few corners: the quietest tenth is noise alone.
    let tenth = moved.len() / 10;
    if tenth == 0 {
        return None;
    }
    let quiet = *moved.select_nth_unstable_by(tenth, f64::total_cmp).1;
    // A tenth of the magnitudes of normal values is below 0.126 of their standard deviation.
    let (share, noise) = (most / (0.5 * (high - low)), quiet / 0.126);
    match most > SWING * noise {
        true if share > ROUNDED => Some(Corner::Rare),
        // Of the range a trace is not sensor noise, however often it occurs.
        false if 0.5 * share > TRACE => Some(Corner::Large),
        _ => None,
    }
}

/// One-sided power spectrum under a Hann window, zero-padded to a power of two.
#[must_use]
pub fn power(signal: &[f64]) -> Vec<f64> {
    let n = signal.len();
    let mean = signal.iter().sum::<f64>() / n.max(1) as f64;
    let size = n.next_power_of_two().max(4);
    let mut buffer = vec![Complex::new(0.0, 0.0); size];
    for (i, (slot, value)) in buffer.iter_mut().zip(signal).enumerate() {
        let window = 0.5 - 0.5 * (2.0 * std::f64::consts::PI * (i as f64 + 0.5) / n as f64).cos();
        slot.re = (value - mean) * window;
    }
    Transform::forward(size).apply(&mut buffer);
    buffer[..=size / 2].iter().map(|c| c.norm_sqr()).collect()
}

/// Power at each multiple of one over the fit segment's length, mean removed and gaps taken as
/// zero, under a window, a function of position and length \[samples\].
pub(crate) fn power_of_fit(
    data: &Prepared,
    signal: &[f64],
    window: impl Fn(f64, f64) -> f64,
) -> Option<Vec<f64>> {
    let fit = &data.split.fit;
    let (&first, &last) = (fit.first()?, fit.last()?);
    let n = last - first + 1;
    let mean = fit.iter().map(|&i| signal[i]).sum::<f64>() / fit.len() as f64;
    let mut buffer = vec![Complex::new(0.0, 0.0); n];
    for &i in fit {
        buffer[i - first].re = (signal[i] - mean) * window((i - first) as f64 + 0.5, n as f64);
    }
    Transform::forward(n).apply(&mut buffer);
    Some(buffer[..=n / 2].iter().map(|c| c.norm_sqr()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_cutoff_is_eight_times_the_highest_tone() {
        let rate = 500.0;
        let signal: Vec<f64> = (0..10_000)
            .map(|i| {
                let t = f64::from(i) / rate;
                3.0 * (2.0 * std::f64::consts::PI * 0.4 * t).sin()
                    + (2.0 * std::f64::consts::PI * 1.5 * t).sin()
                    + 7.0
            })
            .collect();
        let cutoff = default_cutoff(&signal, rate);
        // The main lobe of the Hann window is two bins wide on each side: 8 × 2 × 0.05 Hz.
        assert!((12.0..13.0).contains(&cutoff), "{cutoff}");
    }

    /// Uniform, of unit variance.
    fn noise(i: i32) -> f64 {
        let mut state = (i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        state = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        state = (state ^ (state >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        12_f64.sqrt() * ((state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
    }

    fn cutoff_of(of: impl Fn(f64) -> f64, deviation: f64) -> f64 {
        let signal = |i: i32| of(f64::from(i) / 500.0) + deviation * noise(i);
        default_cutoff(&(0..20_000).map(signal).collect::<Vec<f64>>(), 500.0)
    }

    #[test]
    fn corners_raise_the_cutoff_and_noise_does_not() {
        let sine = |t: f64| 5.0 * (std::f64::consts::TAU * 0.4 * t).sin();
        let triangle = |t: f64| 20.0 * ((0.4 * t).fract() - 0.5).abs() - 5.0;
        // Three seconds on a step, fifty milliseconds to the next one.
        let stairs = |t: f64| {
            let (step, within) = ((t / 3.0).floor(), (t % 3.0) / 0.05);
            (step + within.min(1.0)) % 8.0
        };
        let plain = cutoff_of(sine, 0.0);
        assert!((3.0..4.0).contains(&plain), "{plain}");
        for deviation in [0.01, 0.1, 0.5] {
            assert_eq!(cutoff_of(sine, deviation), plain, "{deviation}");
        }
        for deviation in [0.0, 1e-3] {
            let (triangle, stairs) = (cutoff_of(triangle, deviation), cutoff_of(stairs, deviation));
            assert!(
                triangle > 3.0 * plain && stairs > 20.0,
                "{triangle} {stairs}"
            );
        }
    }
}
