//! What is said before anything is fitted.

use crate::sentences::files::{Rows, T};
use crate::shell::{bowden, Folder};

#[test]
fn a_time_column_without_a_unit_and_with_long_steps_is_asked_about() {
    let mut rows = Rows::generated(&["--mode", "torque", "--seed", "38", "--rate", "500"]);
    let header = rows.header.clone();
    let (_, others) = header.split_once(',').unwrap();
    rows.header = format!("t,{others}");
    rows.set(T, |_, row| 1000.0 * row[T]);
    let closed = rows.close(&[]);
    let text = closed.text();
    assert!(
        text.contains("with a median step of 2 s; set --time '"),
        "{text}"
    );
    rows.header = format!("t [ms],{others}");
    let closed = rows.close(&[]);
    let text = closed.text();
    assert!(!text.contains("is that ms?"), "{text}");
}

#[test]
fn a_column_that_is_not_there_is_named_with_the_nearest_ones() {
    let folder = Folder::new();
    let mut rows = Rows::generated(&["--mode", "displacement", "--seed", "39"]);
    rows.header = "t [s],x_mm,force_N".to_owned();
    for row in &mut rows.rows {
        row.truncate(3);
    }
    let path = rows.write(&folder, "excel.csv");
    for (given, meant) in [("X", "`x_mm`"), ("force_n", "`force_N`")] {
        let output = bowden(&["identify", &path, "--input", given]);
        assert_eq!(output.status.code(), Some(2));
        let line = String::from_utf8(output.stderr).unwrap();
        assert!(line.contains(&format!("column `{given}`")), "{line}");
        assert!(line.contains(&format!("nearest: {meant}")), "{line}");
    }
}

/// A friction rig logs velocity and force; the model is one from displacement to force.
#[test]
fn a_velocity_in_place_of_the_displacement_is_asked_about() {
    let mut rows = Rows::generated(&["--mode", "displacement", "--seed", "40", "--rate", "250"]);
    for row in &mut rows.rows {
        row.truncate(3);
    }
    let ends = ["--mode", "displacement", "--output", "f [N]", "--input"];
    rows.set(2, |_, row| 20.0 * (10.0 * row[1]).tanh() + 3.0 * row[1]);
    for (header, input, is_velocity) in [
        ("t,drive [mm/s],f [N]", "drive", true),
        ("t,v,f [N]", "v", true),
        ("t,drive [mm],f [N]", "drive", false),
    ] {
        rows.header = header.to_owned();
        let closed = rows.close(&[&ends[..], &[input]].concat());
        let asked = format!("Is `{input}` a velocity? The input must be a displacement");
        assert_eq!(closed.sentence().contains(&asked), is_velocity);
    }
}
