//! `bowden compare`: a law that ran away has no error, and the rig takes torque models only.

use crate::shell::{bowden, Folder};
use serde_json::Value;

fn written(text: &str) -> (Folder, String) {
    let folder = Folder::new();
    let path = folder.root().join("gains.toml");
    std::fs::write(&path, text).unwrap();
    let path = path.display().to_string();
    (folder, path)
}

#[test]
fn a_law_that_ran_away_has_a_time_and_no_figures() {
    let (_folder, gains) = written("[pi]\nk_p = 1e5\nk_i = 1e6\n");
    let run = |more: &[&str]| {
        let fixed = [
            "compare",
            "--gains",
            &gains,
            "--seconds",
            "8",
            "--seeds",
            "1",
        ];
        let output = bowden(&[&fixed, more].concat());
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let text = run(&["--verbose"]);
    let lines: Vec<&str> = text.lines().filter(|l| l.starts_with("  pi ")).collect();
    assert_eq!(lines.len(), 2, "steady part and transient: {text}");
    for line in lines {
        assert!(line.contains("–, diverged at 0."), "{line}");
        assert!(!line.contains("0.0000"), "{line}");
    }
    let json: Value = serde_json::from_str(&run(&["--json"])).unwrap();
    let rows = json["rows"].as_array().unwrap();
    let pi = rows.iter().find(|row| row["controller"] == "pi").unwrap();
    assert_eq!(pi["diverged"], 1);
    assert!(pi["ran_away_at"].as_f64().unwrap() < 8.0);
    assert!(pi["rmse_true"]["mean"].is_null(), "{pi}");
    let pid = rows.iter().find(|row| row["controller"] == "pid").unwrap();
    assert!(pid["ran_away_at"].is_null());
    assert!(pid["rmse_true"]["mean"].is_f64());
}

#[test]
fn a_displacement_model_is_refused_on_the_torque_rig() {
    let (_folder, model) = written(
        "schema = \"bowden.model/1\"\nmode = \"displacement\"\nchannels = []\n[transmission]\ngain = 1.0\nkappa_eta = 0.5\noffset = 0.0\nrho = 1.0\nsigma = 0.6\nn = 1.5\n",
    );
    let output = bowden(&["compare", "--model", &model]);
    assert_eq!(output.status.code(), Some(2));
    let line = String::from_utf8(output.stderr).unwrap();
    assert!(line.contains("must be \"torque\""), "{line}");
    assert_eq!(line.trim_end().lines().count(), 1, "{line}");
}
