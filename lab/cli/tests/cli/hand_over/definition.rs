//! A channel that is the sum of two: whoever runs the model has to know how to compute it.

use crate::shell::{bowden as run, said, Folder};
use std::fmt::Write as _;

/// A spring across the sum of two angles, on three tones. Written without the generator.
fn spring_of_the_stretch() -> String {
    let mut csv = String::from("t [s],tau_i [N*m],tau_o [N*m],proximal [rad],distal [rad]\n");
    for k in 0..12_000 {
        let t = 1e-3 * f64::from(k);
        let (proximal, slip) = (
            (3.1 * t).sin(),
            0.2 * (1.3 * t).sin() + 0.1 * (7.7 * t).sin(),
        );
        let input = 4.0 * (5.3 * t).sin();
        let output = 0.8 * input + 6.0 * slip + 0.01 * (f64::from(k) * 12.9898).sin();
        let _ = writeln!(
            csv,
            "{t:.3},{input},{output},{proximal},{}",
            slip - proximal
        );
    }
    csv
}

#[test]
fn a_channel_that_is_a_sum_is_defined_in_every_file_that_is_handed_over() {
    let folder = Folder::new();
    let path = |name: &str| folder.path(name);
    let (record, model) = (path("rig.csv"), path("rig.toml"));
    std::fs::write(&record, spring_of_the_stretch()).unwrap();
    let stretch = ["--channel", "stretch=proximal+distal"];
    for form in [&model, &path("rig.rs")] {
        let mut close = vec!["identify", &record, "--max-terms", "0", "--baseline"];
        close.extend(["gain,stiffness-linear@stretch", "--model-out", form]);
        let output = run(&[&close[..], &stretch].concat());
        assert!(output.status.success(), "{output:?}");
    }
    let text = std::fs::read_to_string(&model).unwrap();
    assert!(
        text.contains("[about.definitions]\nstretch = \"proximal + distal\"\n"),
        "{text}"
    );
    let rust = std::fs::read_to_string(path("rig.rs")).unwrap();
    let listed = "`Sample::channels`: 0 stretch = proximal + distal [rad].";
    assert!(rust.contains(listed), "{rust}");
    let c = said(&["export", "--c", &model]);
    let listed = "#define RIG_CHANNEL_STRETCH 0 /* stretch = proximal + distal [rad] */";
    assert!(c.contains(listed), "{c}");
    // A record without the channel is told how to get it.
    let output = run(&["validate", &model, &record]);
    assert_eq!(output.status.code(), Some(2));
    let words = String::from_utf8(output.stderr).unwrap();
    assert!(
        words.contains(
            "channel `stretch` (fitted as proximal + distal), but the record has no such channel; pass its column with --channel stretch=COL"
        ),
        "{words}"
    );
    let output = run(&[&["validate", &model, &record], &stretch[..]].concat());
    assert!(output.status.success(), "{output:?}");
}
