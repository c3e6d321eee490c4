//! The sizes in the README's table are those of the types.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

use bowden::*;
use std::mem::size_of;

#[test]
fn the_table_has_the_sizes_of_the_objects() {
    let readme = include_str!("../README.md");
    let sizes = [
        (
            "pid",
            size_of::<bowden_pid_f32>(),
            size_of::<bowden_pid_f64>(),
        ),
        (
            "adaptive",
            size_of::<bowden_adaptive_f32>(),
            size_of::<bowden_adaptive_f64>(),
        ),
        (
            "hysteresis",
            size_of::<bowden_hysteresis_f32>(),
            size_of::<bowden_hysteresis_f64>(),
        ),
        (
            "cable",
            size_of::<bowden_cable_f32>(),
            size_of::<bowden_cable_f64>(),
        ),
        (
            "inverse",
            size_of::<bowden_inverse_f32>(),
            size_of::<bowden_inverse_f64>(),
        ),
        (
            "model",
            size_of::<bowden_model_f32>(),
            size_of::<bowden_model_f64>(),
        ),
        (
            "compensator",
            size_of::<bowden_compensator_f32>(),
            size_of::<bowden_compensator_f64>(),
        ),
        (
            "rates",
            size_of::<bowden_rates_f32>(),
            size_of::<bowden_rates_f64>(),
        ),
        (
            "observer",
            size_of::<bowden_observer_f32>(),
            size_of::<bowden_observer_f64>(),
        ),
        (
            "learning",
            size_of::<bowden_learning_f32>(),
            size_of::<bowden_learning_f64>(),
        ),
        (
            "play",
            size_of::<bowden_play_f32>(),
            size_of::<bowden_play_f64>(),
        ),
    ];
    for (name, single, double) in sizes {
        let head = format!("| `bowden_{name}` |");
        let row = readme.lines().find(|line| line.starts_with(&head)).unwrap();
        assert!(
            row.ends_with(&format!("| {single} | {double} |")),
            "{row}: {single}, {double}"
        );
    }
}
