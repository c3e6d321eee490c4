//! The words and numbers of the report, and what is said before anything is fitted.

use crate::sentences::files::{Closed, Rows, T};
use crate::shell::{has, json, refuses, said, Folder};
use serde_json::Value;

#[test]
fn a_sound_record_is_explained_and_words_and_table_have_the_numbers_of_the_json() {
    let closed = Closed::of("");
    assert_eq!(closed.verdict(), "explained");
    let held_out = |part: &str| closed.number(&format!("/{part}/held_out"));
    let [before, after] = ["baseline", "final"].map(|p| 100.0 * held_out(&format!("{p}/nrmse")));
    let falls = format!("from {before:.2} % to {after:.2} %");
    closed.says(&["falls", &falls, "The residual is sensor noise."]);
    let floor = closed.number("/noise_floor");
    for segment in ["fit", "held_out"] {
        let floors = closed.number(&format!("/final/rmse/{segment}")) / floor;
        assert!(floors <= 1.2, "{segment}: {floors}");
    }
    let text = closed.text();
    let baseline = text.lines().find(|l| l.contains("(baseline)")).unwrap();
    let multiple = format!("{:.1} ×", held_out("baseline/rmse") / floor);
    assert!(baseline.ends_with(&multiple), "{baseline}");
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn tones_are_named_by_their_frequency_and_ripples_by_their_order() {
    for (effect, seed, words) in [
        ("tone", 41, ["tone (", " Hz)"]),
        ("ripple", 42, ["(order ", ""]),
    ] {
        let recipe = format!("--mode torque --seed {seed} --effect {effect}");
        let closed = Rows::generated(&recipe).close("");
        assert!(closed.names().contains(&effect), "{:?}", closed.names());
        closed.says(&words);
    }
}

#[test]
fn a_time_column_without_a_unit_and_with_long_steps_is_asked_about() {
    let mut rows = Rows::generated("--mode torque --seed 38 --rate 500");
    rows.set(T, |_, row| 1000.0 * row[T]);
    let (_, others) = rows.header.split_once(',').unwrap();
    let [without, with] = ["t", "t [ms]"].map(|time| format!("{time},{others}"));
    rows.header = without;
    has(
        &rows.close("").text(),
        &["with a median step of 2 s; set --time '"],
    );
    rows.header = with;
    let text = rows.close("").text();
    assert!(!text.contains("set --time '"), "{text}");
}

/// A displacement record of the generator without its channels.
fn ends(seed: u64, header: &str) -> Rows {
    let mut rows = Rows::generated(&format!("--mode displacement --seed {seed} --rate 250"));
    rows.header = header.to_owned();
    rows.rows.iter_mut().for_each(|row| row.truncate(3));
    rows
}

#[test]
fn a_column_that_is_not_there_is_named_with_the_nearest_ones() {
    let folder = Folder::new();
    let path = ends(39, "t [s],x_mm,force_N").write(&folder, "excel.csv");
    for (given, meant) in [("X", "`x_mm`"), ("force_n", "`force_N`")] {
        let parts = [&format!("column `{given}`"), &format!("nearest: {meant}")];
        refuses(
            &format!("identify {path} --input {given}"),
            &parts.map(String::as_str),
        );
    }
}

/// A friction rig logs velocity and force; the model is one from displacement to force.
#[test]
fn a_velocity_in_place_of_the_displacement_is_asked_about() {
    for (header, input, is_velocity) in [
        ("t,drive [mm/s],f [N]", "drive", true),
        ("t,v,f [N]", "v", true),
        ("t,drive [mm],f [N]", "drive", false),
    ] {
        let mut rows = ends(40, header);
        rows.set(2, |_, row| 20.0 * (10.0 * row[1]).tanh() + 3.0 * row[1]);
        let (folder, mode) = (Folder::new(), "--mode displacement");
        let record = rows.write(&folder, "record.csv");
        let asked = format!("{record} {mode} --output f --input {input}");
        let closed = Closed::within(folder, &asked);
        let asked = format!("Is `{input}` a velocity? The input must be a displacement");
        assert_eq!(closed.sentence().contains(&asked), is_velocity, "{header}");
    }
}

#[test]
fn a_law_that_ran_away_has_a_time_and_no_figures() {
    let folder = Folder::new();
    let gains = folder.file("gains.toml", "[pi]\nk_p = 1e5\nk_i = 1e6\n");
    let compare = format!("compare --gains {gains} --seconds 8 --seeds 1");
    let text = said(&format!("{compare} --verbose"));
    let lines: Vec<&str> = text.lines().filter(|l| l.starts_with("  pi ")).collect();
    assert_eq!(lines.len(), 2, "steady part and transient: {text}");
    for line in lines {
        has(line, &["–, diverged at 0."]);
        assert!(!line.contains("0.0000"), "{line}");
    }
    let report = json(&format!("{compare} --json"));
    let rows = report["rows"].as_array().unwrap();
    let row = |name: &str| -> &Value { rows.iter().find(|r| r["controller"] == name).unwrap() };
    assert_eq!(row("pi")["diverged"], 1);
    assert!(row("pi")["ran_away_at"].as_f64().unwrap() < 8.0);
    assert!(row("pi")["rmse_true"]["mean"].is_null());
    assert!(row("pid")["ran_away_at"].is_null());
    assert!(row("pid")["rmse_true"]["mean"].is_f64());
}
