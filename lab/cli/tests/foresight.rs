//! The two commands from outside.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[allow(dead_code)]
mod shell;

use shell::{bowden, bowden_on};

fn made(folder: &tempfile::TempDir, name: &str, arguments: &[&str]) -> String {
    let path = folder.path().join(name).display().to_string();
    let mut all = vec!["generate", "--mode", "displacement", "--out", &path];
    all.extend(arguments);
    assert!(bowden(&all).status.success());
    path
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_power_of_a_record_is_the_same_bytes_for_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(&folder, "r.csv", &["--seconds", "10", "--seed", "5"]);
    let ask = |threads: &str| {
        let all = [
            "power",
            &path,
            "--json",
            "--effects",
            "viscous,offset",
            "--trials",
            "5",
        ];
        let output = bowden_on(threads, &all);
        assert!(output.status.success() && output.stderr.is_empty());
        output.stdout
    };
    let one = ask("1");
    assert_eq!(one, ask("3"));
    let table: serde_json::Value = serde_json::from_slice(&one).unwrap();
    assert_eq!(table["schema"], "bowden.power/1");
    let effects = table["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 2);
    assert_eq!(effects[0]["status"], "not-excited");
    assert_eq!(effects[1]["effect"], "viscous");
    assert!(effects[1]["amplitude"].as_f64().unwrap() > 0.0);
    assert_eq!(effects[1]["gain"]["unit"], "N·s/mm");
}

#[test]
fn a_plan_is_a_table_of_motion_and_names_what_it_is_for() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(
        &folder,
        "c.csv",
        &["--seed", "2", "--effect", "viscous:0.6"],
    );
    let output = bowden(&["plan", &path]);
    assert!(output.status.success());
    let csv = String::from_utf8(output.stdout).unwrap();
    assert!(csv.starts_with("t [s],x [mm]\n0,"));
    assert!(csv
        .lines()
        .skip(1)
        .all(|l| l.split(',').all(|c| c.parse::<f64>().is_ok())));
    assert!(String::from_utf8(output.stderr)
        .unwrap()
        .contains("viscous from delay"));
    let out = folder.path().join("plan.csv").display().to_string();
    assert!(bowden_on("1", &["plan", &path, "--out", &out])
        .status
        .success());
    assert_eq!(std::fs::read_to_string(&out).unwrap(), csv);
    let page = folder.path().join("page.html").display().to_string();
    let closed = bowden(&["close", &path, "--report", &page]).stdout;
    assert!(String::from_utf8(closed).unwrap().contains("to separate: "));
    // The page names what the motion separates, which may be less than all rivals.
    let page = std::fs::read_to_string(page).unwrap();
    let (_, aims) = page.split_once(" To separate it from ").unwrap();
    let (aims, _) = aims.split_once(": ").unwrap();
    assert!(aims.contains("<b>delay</b>"), "{aims}");
    let closed = bowden(&["close", &path, "--json"]).stdout;
    let report: serde_json::Value = serde_json::from_slice(&closed).unwrap();
    let experiment = &report["rounds"][0]["experiment"];
    assert!(experiment["trajectory"].is_string(), "{experiment}");
}

/// Presliding is backlash of the opposite sign: no motion tells them apart, and what is open is not
/// called settled.
#[test]
fn what_no_motion_tells_apart_is_said_and_not_called_settled() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(&folder, "b.csv", &["--seed", "325", "--effect", "backlash"]);
    let declared = ["--declare", "bouc-wen"];
    let plan = bowden(&[&["plan", &path], &declared[..]].concat());
    assert!(plan.status.success() && plan.stdout.is_empty());
    let told = String::from_utf8(plan.stderr).unwrap();
    assert!(
        told.contains("would tell presliding from backlash"),
        "{told}"
    );
    assert!(!told.contains("nothing is confounded"), "{told}");
    assert!(!told.contains("is not written"), "{told}");
    // A script that asked for a file learns that there is none.
    let out = folder.path().join("plan.csv").display().to_string();
    let plan = bowden(&[&["plan", &path, "--out", &out], &declared[..]].concat());
    assert_eq!(plan.status.code(), Some(1));
    assert!(plan.stdout.is_empty() && !std::path::Path::new(&out).exists());
    let with_file = String::from_utf8(plan.stderr).unwrap();
    let own = format!("{}; {out} is not written\n", told.trim_end());
    assert_eq!(with_file, own);
    assert_eq!(with_file.lines().count(), 1, "{with_file}");
    let closed = bowden(&[&["close", &path], &declared[..]].concat()).stdout;
    let closed = String::from_utf8(closed).unwrap();
    for text in [
        "Presliding and backlash are one function with opposite signs",
        "one of the other sign is slack",
    ] {
        assert!(closed.contains(text), "{closed}");
    }
}

/// A cable of four Maxwell-slip elements: what presliding and backlash are made of, four times over.
fn of_slipping_elements(folder: &tempfile::TempDir) -> String {
    let elements = [(0.25, 0.6), (0.2, 1.5), (0.1, 3.0), (0.05, 6.0)];
    let mut state = 7_u64;
    let mut unit = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let (mut stretched, mut last) = ([0.0_f64; 4], None);
    let mut csv = "t,tau_i,tau_o\n".to_owned();
    for k in 0..15_000 {
        let t = f64::from(k) / 500.0;
        let tone = |f: f64, phase: f64| (std::f64::consts::TAU * f * t + phase).sin();
        let x = 10.0 + 6.0 * tone(0.31, 4.9) + 3.0 * tone(0.73, 9.8) + 1.5 * tone(1.17, 14.7);
        let step = x - last.replace(x).unwrap_or(x);
        let mut friction = 0.0;
        for (own, (stiffness, width)) in stretched.iter_mut().zip(elements) {
            *own = (*own + step).clamp(-width, width);
            friction += stiffness * *own;
        }
        let output = 0.88 * x - friction + 0.4 + 0.1 * unit();
        csv += &format!("{t},{:.5},{output:.5}\n", x + 0.035 * unit());
    }
    let path = folder.path().join("slip.csv").display().to_string();
    std::fs::write(&path, csv).unwrap();
    path
}

/// The fit gives the rival of a round another width than the named effect has, and a motion seems to tell
/// the two apart.
#[test]
fn what_no_record_tells_apart_is_not_to_be_separated_and_stands_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = of_slipping_elements(&folder);
    let closed = String::from_utf8(bowden(&["close", &path]).stdout).unwrap();
    assert!(
        closed.contains("Presliding and backlash are one function"),
        "{closed}"
    );
    assert!(!closed.contains("to separate:"), "{closed}");
    let pairs = ["presliding from backlash", "backlash from presliding"];
    let count = |text: &str| -> usize { pairs.iter().map(|p| text.matches(p).count()).sum() };
    assert_eq!(count(&closed), 1, "{closed}");
    let plan = bowden(&["plan", &path]);
    assert!(plan.status.success());
    let told = String::from_utf8(plan.stderr).unwrap();
    assert_eq!(count(&told), 1, "{told}");
    assert!(told.contains("no planned motion would tell"), "{told}");
}

#[test]
fn bad_use_gives_one_line_and_status_two_and_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(
        &folder,
        "r.csv",
        &["--seconds", "10", "--effect", "viscous:0.6"],
    );
    let nowhere = folder.path().join("none/plan.csv").display().to_string();
    let absent = folder.path().join("absent.csv").display().to_string();
    let cases: [&[&str]; 6] = [
        &["power", &path, "--effects", "nonsense"],
        &["power", &path, "--trials", "1"],
        &["power", &absent],
        &["power", &path, "--cutoff=-1"],
        &["plan", &absent, "--out", &nowhere],
        &["plan", &path, "--declare", "nonsense", "--out", &nowhere],
    ];
    for arguments in cases {
        let output = bowden(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        let line = String::from_utf8(output.stderr).unwrap();
        assert!(
            line.starts_with("bowden: ") && line.lines().count() == 1,
            "{line}"
        );
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
