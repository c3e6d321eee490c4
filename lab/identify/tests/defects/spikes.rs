//! Samples that leap away and back, and what is none of them.

use super::*;

#[test]
fn spikes_are_named_with_their_lines_and_change_no_name() {
    let sound = closed(&Cells::of(&recipe()).read());
    for (column, name) in [(TAU_I, "tau_i"), (TAU_O, "tau_o"), (PHI_P, "phi_p")] {
        let mut cells = Cells::of(&recipe());
        let (low, high) = cells.low_and_high(column);
        // Leaps over the range, both ways; two neighbours; a marker for a missing value.
        for (row, leap) in [
            (1000, 1.0),
            (1900, -2.0),
            (3100, 1.0),
            (3101, 0.8),
            (7000, 5.0),
        ] {
            cells.rows[row][column] += leap * (high - low);
        }
        (8200..8212).for_each(|row| cells.rows[row][column] = -9999.0);
        let record = cells.read();
        let defect = only(&record);
        assert_named(defect, DefectKind::Spike, name);
        let lines = [
            [1000, 1000],
            [1900, 1900],
            [3100, 3101],
            [7000, 7000],
            [8200, 8211],
        ];
        assert_eq!(
            defect.ranges,
            lines.map(|[from, to]| [line(from), line(to)])
        );
        let (data, ledger) = closed(&record);
        assert_eq!(names(&ledger), names(&sound.1), "{name}");
        assert_eq!(verdict_of(&data, &ledger), verdict_of(&sound.0, &sound.1));
    }
}

#[test]
fn a_frame_of_zeros_is_a_spike_at_both_ends() {
    let mut cells = Cells::of(&recipe());
    for row in [2000, 5555] {
        (TAU_I..=TAU_O).for_each(|column| cells.rows[row][column] = 0.0);
    }
    let record = cells.read();
    let found: Vec<_> = record
        .defects
        .iter()
        .map(|d| (d.kind, &*d.channel))
        .collect();
    assert_eq!(
        found,
        [(DefectKind::Spike, "tau_i"), (DefectKind::Spike, "tau_o")]
    );
}

#[test]
fn what_comes_back_slowly_repeats_or_is_answered_is_no_spike() {
    let high = Cells::of(&recipe()).low_and_high(TAU_O).1;
    // A step, a burst of oscillation, a shock that decays, a blow that the output answers.
    let step = |row: usize| if row >= 4000 { high } else { 0.0 };
    let rings = |row: usize| match row.checked_sub(4000) {
        Some(k) => high * (-(k as f64) / 30.0).exp() * (2.0 * k as f64).cos(),
        None => 0.0,
    };
    let decays = |row: usize| match row.checked_sub(4000) {
        Some(k) => high * (-(k as f64) / 4.0).exp(),
        None => 0.0,
    };
    let all: [&dyn Fn(usize) -> f64; 3] = [&step, &rings, &decays];
    for added in all {
        let mut cells = Cells::of(&recipe());
        for (row, own) in cells.rows.iter_mut().enumerate() {
            own[TAU_O] += added(row);
        }
        assert_eq!(cells.read().defects, []);
    }
    let mut blow = Cells::of(&recipe());
    blow.rows[4000][TAU_I] += high;
    for (k, row) in blow.rows[4001..].iter_mut().enumerate() {
        row[TAU_O] += 0.5 * high * (-(k as f64) / 20.0).exp();
    }
    assert_eq!(blow.read().defects, []);
}
