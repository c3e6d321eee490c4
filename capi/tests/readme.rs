//! The sizes in the README's table are those of the types.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

use bowden::*;
use std::mem::size_of;

/// Name, bytes in `float` and bytes in `double` of each object.
macro_rules! sizes {
    ($($name:ident)*) => {
        pastey::paste! {
            [$((
                stringify!($name),
                size_of::<[<bowden_ $name _f32>]>(),
                size_of::<[<bowden_ $name _f64>]>(),
            )),*]
        }
    };
}

#[test]
fn the_table_has_the_sizes_of_the_objects() {
    let readme = include_str!("../README.md");
    let sizes = sizes!(
        pid adaptive hysteresis cable inverse model compensator
        rates observer iterative_learning relay low_pass biquad edge_velocity plausible play
    );
    for (name, single, double) in sizes {
        let head = format!("| `bowden_{name}` |");
        let row = readme.lines().find(|line| line.starts_with(&head)).unwrap();
        assert!(
            row.ends_with(&format!("| {single} | {double} |")),
            "{row}: {single}, {double}"
        );
    }
}
