//! What a page draws agrees with the ledger and with the record.

use crate::rig::Closed;
use bowden_lab::facts::{Figures, Segment};
use bowden_synth::{Mode, Planted, Recipe};

fn closed() -> Closed {
    let recipe = Recipe {
        effects: vec![Planted::new("viscous")],
        ..Recipe::of_one_rig(Mode::Displacement, 75_300)
    };
    Closed::new(&recipe, &["bouc-wen"], 1)
}

fn rms(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let n = values.clone().count() as f64;
    (values.map(|v| v * v).sum::<f64>() / n).sqrt()
}

#[test]
fn signals_residuals_and_block_scores_are_those_of_the_ledger() {
    let closed = closed();
    let figures = Figures::of_close(&closed.data, &closed.ledger, ("final", &closed.done)).unwrap();
    let signals = &figures.signals;
    assert_eq!(signals.measured.values, closed.data.target);
    assert_eq!(signals.models[1].values, closed.done.solution.prediction);
    let held_out = |of: usize| {
        let rows = 0..signals.segments.len();
        let own = rows.filter(|&row| signals.segments[row] == Segment::HeldOut);
        rms(own.map(move |row| signals.residuals[of][row]))
    };
    let expected = [
        closed.ledger.declared.rmse.held_out,
        closed.done.rmse.held_out,
    ];
    for (of, expected) in expected.into_iter().enumerate() {
        assert!((held_out(of) / expected - 1.0).abs() < 1e-9);
    }

    // Weighted by the blocks' own errors the shares make up that of the whole round.
    let round = &closed.ledger.rounds[0];
    let blocks = bowden_lab::score::blocks::blocks(&closed.data);
    let sse = |block: &std::ops::Range<usize>| -> f64 {
        let rows = closed.data.split.fit[block.clone()].iter();
        let declared = &closed.ledger.declared.residual;
        rows.map(|&row| declared[row].powi(2)).sum()
    };
    let whole: f64 = blocks.iter().map(sse).sum();
    let scores = blocks.iter().zip(figures.blocks[0].removed);
    let removed: f64 = scores.map(|(block, share)| share * sse(block)).sum();
    assert_eq!(figures.blocks.len(), 1);
    assert!((removed / whole - round.explained).abs() < 1e-9);
    let better = figures.blocks[0].removed.iter().filter(|s| **s > 0.0);
    assert!(better.count() >= 14);
}

#[test]
fn the_parts_have_the_size_that_their_signals_have_and_the_worst_spot_is_the_worst() {
    let closed = closed();
    let figures = Figures::of_close(&closed.data, &closed.ledger, ("final", &closed.done)).unwrap();
    let signals = &figures.signals;
    let rows = signals.counting();
    let deviation = |values: &[f64]| {
        let mean = rows.iter().map(|&r| values[r]).sum::<f64>() / rows.len() as f64;
        rms(rows.iter().map(|&r| values[r] - mean))
    };
    for part in &signals.parts {
        let expected = deviation(&part.signal.values) / deviation(&signals.measured.values);
        assert!(
            (part.share - expected).abs() < 1e-12,
            "{}",
            part.signal.name
        );
    }
    let worst = signals.files[0].worst.as_ref().unwrap();
    assert_eq!(signals.segments[worst.row], Segment::HeldOut);
    assert!(worst.around.contains(&worst.row));
    let largest = worst.errors.map(f64::abs).into_iter().fold(0.0, f64::max);
    for row in rows
        .iter()
        .filter(|&&r| signals.segments[r] == Segment::HeldOut)
    {
        for residual in &signals.residuals {
            assert!(residual[*row].abs() <= largest);
        }
    }
}

#[test]
fn the_missing_effect_shows_over_its_variable_and_the_final_residual_is_noise() {
    let closed = closed();
    let figures = Figures::of_close(&closed.data, &closed.ledger, ("final", &closed.done)).unwrap();
    let of = |words: &str| figures.over.iter().find(|d| d.words == words).unwrap();
    let off_zero = |words: &str, which: usize| {
        let bins = of(words).bins.iter();
        let intervals = bins.filter_map(|b| b.means[which].ci95);
        intervals
            .filter(|[low, high]| *low > 0.0 || *high < 0.0)
            .count()
    };
    let velocity = "the velocity of x";
    assert!(off_zero(velocity, 0) >= 8, "{}", off_zero(velocity, 0));
    assert!(off_zero(velocity, 1) <= 4, "{}", off_zero(velocity, 1));
    let outside = |which: usize| {
        let all = &figures.autocorrelation;
        all.outside(&all.residuals[which])
    };
    assert!(outside(0) > 0.4, "{}", outside(0));
    assert!(outside(1) < 0.25, "{}", outside(1));
    // The spectra: above the floor before, on it after.
    let spectrum = &figures.spectrum;
    let over = |which: usize| -> f64 {
        let pairs = spectrum.residuals[which].iter().zip(&spectrum.floor);
        let own = pairs.zip(&spectrum.frequency);
        let inside = own.filter(|(_, f)| **f < 0.25 * closed.data.cutoff);
        let logs: Vec<f64> = inside.map(|((r, f), _)| (r / f).ln()).collect();
        (logs.iter().sum::<f64>() / logs.len() as f64).exp()
    };
    assert!(over(0) > 2.0, "{}", over(0));
    assert!((0.6..1.6).contains(&over(1)), "{}", over(1));
}
