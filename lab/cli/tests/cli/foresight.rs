//! The two commands from outside.

use crate::shell::{args, bowden, bowden_on, Folder};

fn made(folder: &Folder, name: &str, arguments: &[&str]) -> String {
    let path = folder.path(name);
    let mut all = vec!["generate", "--mode", "displacement", "--out", &path];
    all.extend(arguments);
    assert!(bowden(&all).status.success());
    path
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_power_of_a_record_is_the_same_bytes_for_any_number_of_threads() {
    let folder = Folder::new();
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
    let folder = Folder::new();
    let path = made(
        &folder,
        "c.csv",
        &["--seed", "1", "--effect", "stiffness-cubic:0.6"],
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
        .contains("stiffness-cubic from dead-zone"));
    // Of two files the one whose motion is changed is named.
    let other = made(
        &folder,
        "d.csv",
        &args("--seed 1 --effect stiffness-cubic:0.6 --seconds 10"),
    );
    let joint = bowden(&["plan", &path, &other]);
    assert!(joint.status.success(), "{joint:?}");
    let words = String::from_utf8(joint.stderr).unwrap();
    assert!(
        words.contains("c.csv)") || words.contains("d.csv)"),
        "{words}"
    );
    // A pattern leaves out what the program wrote beside a model, and says so.
    let model = folder.path("c.toml");
    assert!(bowden(&["identify", &path, "--model-out", &model])
        .status
        .success());
    let pattern = folder.path("c*.csv");
    let matched = bowden(&["plan", &pattern]);
    assert_eq!(matched.stdout, csv.as_bytes());
    let words = String::from_utf8(matched.stderr).unwrap();
    assert!(
        words.contains("1 test vector of --model-out excluded"),
        "{words}"
    );
    let out = folder.path("plan.csv");
    assert!(bowden_on("1", &["plan", &path, "--out", &out])
        .status
        .success());
    assert_eq!(std::fs::read_to_string(&out).unwrap(), csv);
    let page = folder.path("page.html");
    let closed = bowden(&["identify", &path, "--report", &page]).stdout;
    assert!(String::from_utf8(closed).unwrap().contains("to separate: "));
    // The page names what the motion separates, which may be less than all rivals.
    let page = std::fs::read_to_string(page).unwrap();
    let (_, aims) = page.split_once(" To separate it from ").unwrap();
    let (aims, _) = aims.split_once(": ").unwrap();
    assert!(aims.contains("<b>dead-zone</b>"), "{aims}");
    let closed = bowden(&["identify", &path, "--json"]).stdout;
    let report: serde_json::Value = serde_json::from_slice(&closed).unwrap();
    let experiment = &report["terms"][0]["experiment"];
    assert!(experiment["trajectory"].is_string(), "{experiment}");
}

fn report(path: &str) -> serde_json::Value {
    let output = bowden(&["identify", path, "--baseline", "bouc-wen", "--json"]);
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Presliding is backlash of the opposite sign: whichever is named, it is one effect, and a note says so.
#[test]
fn one_function_under_two_names_is_one_term_with_a_note() {
    let folder = Folder::new();
    let records = [
        ("presliding", ["--seed", "325", "--effect", "backlash"]),
        ("backlash", ["--seed", "5001", "--effect", "backlash:3"]),
    ];
    for (name, recipe) in records {
        let report = report(&made(&folder, name, &recipe));
        let [found] = &report["terms"].as_array().unwrap()[..] else {
            panic!("{report}");
        };
        assert_eq!(found["effect"], name);
        assert_eq!(found["alternatives"], serde_json::json!([]));
        assert_eq!(found["confidence"], "high");
        assert_eq!(report["verdict"], "explained");
        let summary = report["summary"].as_str().unwrap();
        for text in [
            "Presliding and backlash are the same function with opposite signs, so either name is correct",
            "With the opposite sign, it is slack",
        ] {
            assert!(summary.contains(text), "{summary}");
        }
    }
}

/// A cubic stiffness and a dead zone are two functions, which this motion does not separate.
#[test]
fn another_function_that_fits_as_well_is_an_alternative() {
    let folder = Folder::new();
    let recipe = ["--seed", "1", "--effect", "stiffness-cubic:0.6"];
    let report = report(&made(&folder, "c.csv", &recipe));
    assert_eq!(report["verdict"], "ambiguous");
    let found = &report["terms"][0];
    assert_eq!(found["confidence"], "low");
    let alternatives = found["alternatives"].as_array().unwrap().iter();
    let families: Vec<&str> = alternatives
        .map(|one| one["family"].as_str().unwrap())
        .collect();
    assert_eq!(families, ["backlash"]);
}

#[test]
fn what_no_motion_makes_known_is_said_and_not_called_settled() {
    let folder = Folder::new();
    let path = made(&folder, "b.csv", &["--seed", "325", "--effect", "backlash"]);
    let declared = ["--baseline", "bouc-wen"];
    let plan = bowden(&[&["plan", &path], &declared[..]].concat());
    assert!(plan.status.success() && plan.stdout.is_empty());
    let told = String::from_utf8(plan.stderr).unwrap();
    for known in [
        "No term is ambiguous.",
        "No planned motion identifies these parameters: n.",
    ] {
        assert!(told.contains(known), "{told}");
    }
    assert!(
        !told.to_lowercase().contains("no experiment is needed"),
        "{told}"
    );
    assert!(!told.contains("was not written"), "{told}");
    // A script that asked for a file learns that there is none.
    let out = folder.path("plan.csv");
    let plan = bowden(&[&["plan", &path, "--out", &out], &declared[..]].concat());
    assert_eq!(plan.status.code(), Some(1));
    assert!(plan.stdout.is_empty() && !std::path::Path::new(&out).exists());
    let with_file = String::from_utf8(plan.stderr).unwrap();
    assert_eq!(with_file, format!("{told}{out} was not written\n"));
}

/// A cable of four Maxwell-slip elements: what presliding and backlash are made of, four times over.
fn of_slipping_elements(folder: &Folder) -> String {
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
    let path = folder.path("slip.csv");
    std::fs::write(&path, csv).unwrap();
    path
}

/// Each of them is named once, and none is to be separated from its own other name.
#[test]
fn slipping_elements_have_no_alternatives_and_one_note() {
    let folder = Folder::new();
    let path = of_slipping_elements(&folder);
    let closed = String::from_utf8(bowden(&["identify", &path]).stdout).unwrap();
    let note = "Presliding and backlash are";
    assert_eq!(closed.matches(note).count(), 1, "{closed}");
    for absent in ["to separate:", "cannot tell", "AMBIGUOUS"] {
        assert!(!closed.contains(absent), "{closed}");
    }
    let plan = bowden(&["plan", &path]);
    assert!(plan.status.success());
    let told = String::from_utf8(plan.stderr).unwrap();
    assert!(told.contains("No term is ambiguous."), "{told}");
}

#[test]
fn bad_use_gives_one_line_and_status_two_and_leaves_nothing_behind() {
    let folder = Folder::new();
    let path = made(
        &folder,
        "r.csv",
        &["--seconds", "10", "--effect", "viscous:0.6"],
    );
    let nowhere = folder.path("none/plan.csv");
    let absent = folder.path("absent.csv");
    let cases: [&[&str]; 6] = [
        &["power", &path, "--effects", "nonsense"],
        &["power", &path, "--trials", "1"],
        &["power", &absent],
        &["power", &path, "--cutoff=-1"],
        &["plan", &absent, "--out", &nowhere],
        &["plan", &path, "--baseline", "nonsense", "--out", &nowhere],
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
    assert_eq!(std::fs::read_dir(folder.root()).unwrap().count(), 1);
}
