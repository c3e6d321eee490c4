//! An angle that wraps around, because a single-turn encoder jumps back by one turn.
//!
//! Three conditions identify such an angle. Each jump has the size of a known turn (2π, 360, or a
//! power of two of counts). The signal stays within one turn. The other signals do not respond to
//! the jump, as they would to a sawtooth or a reference step.

use super::scale::{range, steps, times, usual, BETTER, CLEAR, FEW, GRAVE, LEAP};
use std::f64::consts::TAU;

/// Removes the jumps from an angle, and returns a note.
pub(super) fn unwrap(name: &str, angle: &mut [f64], others: &[&[f64]]) -> Option<String> {
    let leaps = leaps(angle)?;
    let (turn, shown) = turn(angle, &leaps)?;
    if others.iter().any(|other| answers(other, &leaps)) {
        return None;
    }
    let mut turns = 0.0;
    let mut next = leaps.iter().peekable();
    let mut before = angle[0];
    for (i, value) in angle.iter_mut().enumerate() {
        if next.next_if_eq(&&i).is_some() {
            turns -= (*value - before).signum();
        }
        before = *value;
        *value += turns * turn;
    }
    Some(format!(
        "`{name}` wraps around at {shown} {} and was unwrapped",
        times(leaps.len())
    ))
}

/// The samples to which the signal jumps by most of its range, and far more than it usually moves.
fn leaps(signal: &[f64]) -> Option<Vec<usize>> {
    let (low, high) = range(signal);
    let sizes = || steps(signal).map(f64::abs);
    let least = (0.5 * (high - low)).max(LEAP * usual(sizes())?);
    let leaps = sizes().enumerate().filter(|(_, size)| *size > least);
    let leaps: Vec<usize> = leaps.map(|(i, _)| i + 1).collect();
    (!leaps.is_empty()).then_some(leaps)
}

/// The size of the known turn that equals all jumps, and its name.
fn turn(signal: &[f64], leaps: &[usize]) -> Option<(f64, String)> {
    let (low, high) = range(signal);
    let mut near = 0.0_f64;
    let mut lengths = Vec::with_capacity(leaps.len());
    for &i in leaps {
        let before = i.checked_sub(2).map(|k| signal[i - 1] - signal[k]);
        let after = signal.get(i + 1).map(|next| next - signal[i]);
        let (before, after) = (before.or(after)?, after.or(before)?);
        // A leap right behind another one is a spike.
        if before.abs().max(after.abs()) > 0.5 * (high - low) {
            return None;
        }
        near = near.max(before.abs()).max(after.abs());
        lengths.push((signal[i] - signal[i - 1] - 0.5 * (before + after)).abs());
    }
    // An encoder counts to a power of two, by eight bits at least.
    let counts = lengths.first()?.log2().round().exp2();
    let is_whole = counts >= 256.0 && signal.iter().all(|value| value.fract() == 0.0);
    let counts = is_whole.then(|| (counts, format!("{counts} counts")));
    let degrees = [(TAU, "2π".to_owned()), (360.0, "360".to_owned())];
    degrees.into_iter().chain(counts).find(|(turn, _)| {
        // If a turn were less certain, any length would match.
        let near = (CLEAR * near).max(1e-3 * turn).min(GRAVE * turn);
        high - low <= turn + near && lengths.iter().all(|length| (length - turn).abs() <= near)
    })
}

/// Whether a signal changes more around the jumps than elsewhere.
fn answers(other: &[f64], leaps: &[usize]) -> bool {
    let change = |i: usize| Some((other.get(i + FEW)? - other[i.checked_sub(FEW + 1)?]).abs());
    let mean = |all: &mut dyn Iterator<Item = f64>| {
        let (mut sum, mut count) = (0.0, 0.0_f64);
        all.for_each(|own| (sum, count) = (sum + own, count + 1.0));
        sum / count.max(1.0)
    };
    let there = mean(&mut leaps.iter().filter_map(|&i| change(i)));
    let elsewhere = mean(&mut (0..other.len()).filter_map(change));
    there > BETTER * elsewhere
}

#[cfg(test)]
mod tests {
    use super::*;

    fn swing(row: usize) -> f64 {
        9.0 * (0.004 * row as f64).sin() + 1.0
    }

    #[test]
    fn turns_are_put_together_again_to_the_last_bits() {
        for (turn, shown) in [(TAU, "2π"), (360.0, "360"), (4096.0, "4096 counts")] {
            let scale = turn / TAU;
            let round = |v: f64| if turn == 4096.0 { v.round() } else { v };
            let angle: Vec<f64> = (0..4000).map(|row| round(scale * swing(row))).collect();
            for from in [0.0, -0.5 * turn] {
                let mut wrapped: Vec<f64> = angle
                    .iter()
                    .map(|a| (a - from).rem_euclid(turn) + from)
                    .collect();
                let said = unwrap("phi", &mut wrapped, &[&angle]).unwrap();
                assert!(
                    said.starts_with(&format!("`phi` wraps around at {shown} ")),
                    "{said}"
                );
                let apart = wrapped[0] - angle[0];
                for (own, true_one) in wrapped.iter().zip(&angle) {
                    assert!((own - true_one - apart).abs() < 1e-9 * turn);
                }
            }
        }
    }

    #[test]
    fn a_sawtooth_a_switch_a_spike_and_another_length_stay_as_they_are() {
        let of = |f: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..4000).map(f).collect() };
        let sawtooth = of(&|row| (0.01 * row as f64).rem_euclid(360.0 / 36.0) * 36.0);
        let switched = of(&|row| if row / 500 % 2 == 0 { 0.0 } else { TAU });
        let spike = of(&|row| 0.01 * swing(row) + if row == 777 { TAU } else { 0.0 });
        let other = of(&|row| swing(row).rem_euclid(5.0));
        for (signal, answer) in [
            (&sawtooth, &sawtooth),
            (&switched, &switched),
            (&spike, &other),
            (&other, &spike),
        ] {
            let mut own = signal.clone();
            assert_eq!(unwrap("x", &mut own, &[answer]), None);
            assert_eq!(&own, signal);
        }
    }
}
