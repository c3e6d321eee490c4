//! `bowden power` and `bowden plan`, and what is said of effects that a motion does not separate.

use crate::sentences::files::Rows;
use crate::shell::{bowden, bowden_on, has, json, refuses_all, said, text, Folder};
use serde_json::{json, Value};

fn made(folder: &Folder, name: &str, options: &str) -> String {
    folder.record(name, &format!("--mode displacement {options}"))
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_power_of_a_record_is_the_same_bytes_for_any_number_of_threads() {
    let folder = Folder::new();
    let path = made(&folder, "r.csv", "--seconds 10 --seed 5");
    let ask = |threads: &str| {
        let asked = format!("power {path} --json --effects viscous,offset --trials 5");
        let output = bowden_on(threads, &asked);
        assert!(output.status.success() && output.stderr.is_empty());
        output.stdout
    };
    let one = ask("1");
    assert_eq!(one, ask("3"));
    let table: Value = serde_json::from_slice(&one).unwrap();
    assert_eq!(table["schema"], "bowden.power/1");
    let effects = table["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 2);
    assert_eq!(effects[0]["status"], "not-excited");
    assert_eq!(effects[1]["effect"], "viscous");
    assert!(effects[1]["amplitude"].as_f64().unwrap() > 0.0);
    assert_eq!(effects[1]["gain"]["unit"], "N·s/mm");
}

/// What a plan prints, and what it tells.
fn plan(asked: &str) -> (String, String) {
    let output = bowden(&format!("plan {asked}"));
    assert!(output.status.success(), "{output:?}");
    let [csv, told] = [output.stdout, output.stderr].map(|bytes| text(&bytes).to_owned());
    (csv, told)
}

#[test]
fn a_plan_is_a_table_of_motion_and_names_what_it_is_for() {
    let folder = Folder::new();
    let cubic = "--seed 1 --effect stiffness-cubic:0.6";
    let path = made(&folder, "c.csv", cubic);
    let (csv, told) = plan(&path);
    let (header, rows) = csv.split_once('\n').unwrap();
    assert!(header == "t [s],x [mm]" && rows.starts_with("0,"), "{csv}");
    let mut cells = rows.lines().flat_map(|line| line.split(','));
    assert!(cells.all(|cell| cell.parse::<f64>().is_ok()));
    has(&told, &["stiffness-cubic from dead-zone"]);
    // Of two files the one whose motion is changed is named.
    let other = made(&folder, "d.csv", &format!("{cubic} --seconds 10"));
    let (_, told) = plan(&format!("{path} {other}"));
    assert!(told.contains("c.csv)") || told.contains("d.csv)"), "{told}");
    let out = folder.path("plan.csv");
    assert!(bowden_on("1", &format!("plan {path} --out {out}"))
        .status
        .success());
    assert_eq!(folder.read("plan.csv"), csv);

    let (page, model) = (folder.path("page.html"), folder.path("c.toml"));
    let files = format!("--report {page} --model-out {model}");
    has(
        &said(&format!("identify {path} {files}")),
        &["to separate: "],
    );
    // The page names what the motion separates, which may be less than all rivals.
    let page = folder.read("page.html");
    let (_, aims) = page.split_once(" To separate it from ").unwrap();
    has(aims.split_once(": ").unwrap().0, &["<b>dead-zone</b>"]);
    // A pattern leaves out what the program wrote beside a model, and says so.
    let (matched, told) = plan(&folder.path("c*.csv"));
    assert_eq!(matched, csv);
    has(&told, &["1 test vector of --model-out excluded"]);

    // A cubic stiffness and a dead zone are two functions, which this motion does not separate.
    let report = json(&format!("identify {path} --baseline bouc-wen --json"));
    assert_eq!(report["verdict"], "ambiguous");
    let found = &report["terms"][0];
    assert_eq!(found["confidence"], "low");
    let alternatives = found["alternatives"].as_array().unwrap();
    assert_eq!(alternatives.len(), 1);
    assert_eq!(alternatives[0]["family"], "backlash");
    let trajectory = &found["experiment"]["trajectory"];
    assert!(trajectory.is_string(), "{found}");
}

/// Presliding is backlash of the opposite sign: whichever is named, it is one effect, and a note says so.
#[test]
fn one_function_under_two_names_is_one_term_with_a_note() {
    let folder = Folder::new();
    for (name, recipe) in [
        ("presliding", "--seed 325 --effect backlash"),
        ("backlash", "--seed 5001 --effect backlash:3"),
    ] {
        let record = made(&folder, name, recipe);
        let report = json(&format!("identify {record} --baseline bouc-wen --json"));
        assert_eq!(report["terms"].as_array().unwrap().len(), 1, "{report}");
        let found = &report["terms"][0];
        assert_eq!(found["effect"], name);
        assert_eq!(found["alternatives"], json!([]));
        assert_eq!(found["confidence"], "high");
        assert_eq!(report["verdict"], "explained");
        let same = "Presliding and backlash are the same function with opposite signs, so either name is correct";
        let summary = report["summary"].as_str().unwrap();
        has(summary, &[same, "With the opposite sign, it is slack"]);
    }
}

#[test]
fn what_no_motion_makes_known_is_said_and_not_called_settled() {
    let folder = Folder::new();
    let record = made(&folder, "b.csv", "--seed 325 --effect backlash");
    let asked = format!("{record} --baseline bouc-wen");
    let (csv, told) = plan(&asked);
    assert!(csv.is_empty());
    let unknown = "No planned motion identifies these parameters: n.";
    has(&told, &["No term is ambiguous.", unknown]);
    for absent in ["o experiment is needed", "was not written"] {
        assert!(!told.contains(absent), "{told}");
    }
    // A script that asked for a file learns that there is none.
    let out = folder.path("plan.csv");
    let plan = bowden(&format!("plan {asked} --out {out}"));
    assert_eq!(plan.status.code(), Some(1));
    assert!(plan.stdout.is_empty());
    assert_eq!(text(&plan.stderr), format!("{told}{out} was not written\n"));
    assert_eq!(folder.names(), ["b.csv"]);
}

/// A cable of four Maxwell-slip elements is what presliding and backlash are made of, four times over:
/// each of them is named once, and none is to be separated from its own other name.
#[test]
fn slipping_elements_have_no_alternatives_and_one_note() {
    let elements = [(0.25, 0.6), (0.2, 1.5), (0.1, 3.0), (0.05, 6.0)];
    let mut state = 7_u64;
    let mut unit = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005);
        state = state.wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let (mut stretched, mut last) = ([0.0_f64; 4], None);
    let row = |k: i32| {
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
        vec![t, x + 0.035 * unit(), output]
    };
    let folder = Folder::new();
    let path = Rows::new("t,tau_i,tau_o", (0..15_000).map(row)).write(&folder, "slip.csv");
    let closed = said(&format!("identify {path}"));
    let notes = closed.matches("Presliding and backlash are");
    assert_eq!(notes.count(), 1, "{closed}");
    for absent in ["to separate:", "cannot tell", "AMBIGUOUS"] {
        assert!(!closed.contains(absent), "{closed}");
    }
    has(&plan(&path).1, &["No term is ambiguous."]);
}

#[test]
fn bad_use_gives_one_line_and_status_two_and_leaves_nothing_behind() {
    let folder = Folder::new();
    made(&folder, "r.csv", "--seconds 10 --effect viscous:0.6");
    refuses_all(
        &folder,
        "power r.csv --effects nonsense => bowden: | nonsense
        power r.csv --trials 1 => bowden: | trials
        power absent.csv => bowden: absent.csv
        power r.csv --cutoff=-1 => bowden: | --cutoff
        plan absent.csv --out none/plan.csv => bowden:
        plan r.csv --baseline nonsense --out none/plan.csv => bowden:",
    );
    assert_eq!(folder.names(), ["r.csv"]);
}
