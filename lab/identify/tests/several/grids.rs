//! Records behind each other: nothing runs over from one into the next.

use crate::rig::{on, Files};
use bowden_lab::problem::{HeldOut, Preparation, Prepared};
use bowden_lab::score::blocks::{blocks, BLOCKS};
use bowden_synth::{Base, Mode, Recipe};

fn three() -> Files {
    let short = Recipe {
        seconds: 12.0,
        ..on(Base::CABLE, Mode::Torque, 2)
    };
    let slow = Recipe {
        rate: 500.0,
        ..on(Base::CABLE, Mode::Torque, 3)
    };
    Files::new(&[on(Base::CABLE, Mode::Torque, 1), short, slow])
}

#[test]
fn each_record_has_the_target_that_it_has_alone() {
    let files = three();
    let data = files.joined(HeldOut::Trailing);
    let cutoff = Some(data.cutoff);
    let size = data.target.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
    for (record, piece) in files.records.iter().zip(&data.pieces) {
        let alone = Prepared::new(record, Preparation { cutoff }).unwrap();
        let step = |data: &Prepared| data.dt * data.stride as f64;
        for (k, row) in piece.rows.clone().enumerate().skip(20) {
            if k + 20 > piece.rows.len() {
                break;
            }
            let t = k as f64 * step(&data);
            let at = t / step(&alone);
            let (i, f) = (at as usize, at.fract());
            let expected = alone.target[i] + f * (alone.target[i + 1] - alone.target[i]);
            // Same step: the same samples, but for the filter's memory of the cut ends.
            // Other step: a straight line over a quarter period of the cut-off, whose tones
            // are eight times slower: (pi/16)²/2 of the amplitude.
            let tolerance = if f < 1e-6 { 1e-3 } else { 0.02 };
            let off = (data.target[row] - expected).abs();
            assert!(off < tolerance * size, "{} row {k}: {off}", piece.path);
        }
    }
}

/// The top of the band of a slower record is empty on the common grid: its noise was taken for
/// half of what it is, and a right model told to leave more than noise.
#[test]
fn the_noise_of_a_slower_record_is_not_underestimated() {
    let slow = Recipe {
        rate: 250.0,
        ..on(Base::CABLE, Mode::Torque, 3)
    };
    let files = Files::new(&[on(Base::CABLE, Mode::Torque, 1), slow]);
    let data = files.joined(HeldOut::Trailing);
    let cutoff = Some(data.cutoff);
    let alone = |record| {
        let data = Prepared::new(record, Preparation { cutoff }).unwrap();
        (
            data.noise_floor,
            data.split.fit.len() as f64 * data.dt * data.stride as f64,
        )
    };
    let own: Vec<(f64, f64)> = files.records.iter().map(alone).collect();
    // A quarter of the rate: four times the noise power in the band.
    assert!((own[1].0 / own[0].0 - 2.0).abs() < 0.1, "{own:?}");
    let seconds: f64 = own.iter().map(|(_, seconds)| seconds).sum();
    let squares: f64 = own
        .iter()
        .map(|(floor, seconds)| floor * floor * seconds)
        .sum();
    let expected = (squares / seconds).sqrt();
    // The cut ends are a few rows more or less on another grid.
    assert!(
        (data.noise_floor / expected - 1.0).abs() < 0.01,
        "{} {expected}",
        data.noise_floor
    );
}

#[test]
fn no_block_straddles_two_records_and_all_have_about_the_same_path() {
    let data = three().joined(HeldOut::Trailing);
    let rows = &data.split.fit;
    let all = blocks(&data);
    assert_eq!(all.len(), BLOCKS);
    assert_eq!((all[0].start, all[BLOCKS - 1].end), (0, rows.len()));
    let mut lengths = Vec::new();
    for (block, next) in all.iter().zip(all.iter().skip(1)) {
        assert_eq!(block.end, next.start);
    }
    for block in &all {
        let (first, last) = (rows[block.start], rows[block.end - 1]);
        let own = |row: usize| data.pieces.iter().position(|p| p.rows.contains(&row));
        assert_eq!(own(first), own(last));
        lengths.push(data.path[last] - data.path[first]);
    }
    let mean = lengths.iter().sum::<f64>() / BLOCKS as f64;
    for length in lengths {
        // A record's share is rounded to whole blocks: half of one in about four.
        assert!((length / mean - 1.0).abs() < 0.25, "{length} {mean}");
    }
}

#[test]
fn of_three_records_the_fit_sees_nothing_of_the_last() {
    let data = three().joined(HeldOut::LastRecord);
    let last = data.pieces.last().unwrap();
    assert!(!last.fitted);
    assert!(data.split.fit.iter().all(|&row| row < last.rows.start));
    assert!(data
        .split
        .selection
        .iter()
        .all(|&row| row < last.rows.start));
    assert!(data
        .split
        .held_out
        .iter()
        .all(|row| last.rows.contains(row)));
    let search = data.for_search(true);
    assert!(search.pieces.last().unwrap().work.is_empty());
    assert_eq!(search.split.fit.len(), data.split.fit.len());
}

#[test]
fn the_search_sees_the_same_target_of_every_record() {
    let data = three().joined(HeldOut::Trailing);
    let coarse = data.for_search(true);
    let size = data.target.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
    for (&row, &thin) in data.split.fit.iter().zip(&coarse.split.fit) {
        // The same analogue filter at two rates: bilinear warping near the cut-off.
        assert!((data.target[row] - coarse.target[thin]).abs() < 5e-3 * size);
        // A step of the pretension keeps its place.
        assert!((data.moment(row) - coarse.moment(thin)).abs() < 1e-9);
    }
}

#[test]
fn rates_too_far_apart_are_refused_by_name() {
    let fast = on(Base::CABLE, Mode::Torque, 1);
    let slow = Recipe {
        rate: 50.0,
        ..fast.clone()
    };
    let files = Files::new(&[fast, slow]);
    let line =
        Prepared::joined(&files.records, Preparation::default(), HeldOut::Trailing).unwrap_err();
    assert!(
        line.starts_with("1.csv: the file is sampled at 50.000000 Hz"),
        "{line}"
    );
}
