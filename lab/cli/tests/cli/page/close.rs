//! The page of `identify`.

use crate::page::{assert_sound, elements, parsed, sections, text};
use crate::shell::{bowden_on, example, said, text as utf8, Folder};

/// The numbers of all `data` elements.
fn numbers(page: &str) -> Vec<f64> {
    let document = parsed(page);
    let all = elements(document.root(), "data");
    all.map(|d| d.attribute("value").unwrap().parse().unwrap())
        .collect()
}

fn close(folder: &Folder, name: &str, more: &[&str]) -> (String, serde_json::Value) {
    let out = folder.path(name);
    let printed = said(&[&["identify", "--json", "--report", &out], more].concat());
    (folder.read(name), serde_json::from_str(&printed).unwrap())
}

/// All numbers of the JSON that the page must have, digit by digit.
fn assert_numbers(page: &str, report: &serde_json::Value) {
    let shown = numbers(page);
    let mut expected = Vec::new();
    for model in ["baseline", "final"] {
        for segment in ["fit", "selection", "held_out"] {
            expected.push(report[model]["rmse"][segment].as_f64().unwrap());
        }
        for segment in ["fit", "held_out"] {
            expected.push(report[model]["nrmse"][segment].as_f64().unwrap());
        }
    }
    for parameter in report["final"]["parameters"].as_array().unwrap() {
        expected.push(parameter["value"].as_f64().unwrap());
    }
    for round in report["terms"].as_array().unwrap() {
        expected.push(round["explained"].as_f64().unwrap());
        for segment in ["fit", "selection", "held_out"] {
            expected.push(round["rmse_after"][segment].as_f64().unwrap());
        }
    }
    for number in expected {
        // The reader of the JSON may be off in the last bit.
        let is_it = |n: &f64| (n - number).abs() <= 2.0 * f64::EPSILON * number.abs();
        assert!(shown.iter().any(is_it), "{number} is not on the page");
    }
}

#[test]
fn the_page_has_its_sections_in_order_and_the_numbers_of_the_json() {
    let folder = Folder::new();
    let (page, report) = close(
        &folder,
        "rig.html",
        &[
            &example("rig.csv"),
            "--mode",
            "torque",
            "--input",
            "motor_Nm",
            "--output",
            "joint_Nm",
            "--channel",
            "phi_p=motor_rad",
        ],
    );
    assert_sound(&page);
    assert_numbers(&page, &report);
    let document = parsed(&page);
    let wanted = [
        "verdict",
        "loop",
        "ledger",
        "parameters",
        "signals",
        "residual",
        "blocks",
        "noise",
        "origin",
    ];
    assert_eq!(sections(&document), wanted);
    // The first sentence of the page is the ledger's.
    let main = elements(document.root(), "main").next().unwrap();
    let lead = elements(main, "p").next().unwrap();
    assert_eq!(text(lead), report["summary"].as_str().unwrap());
    let all = text(document.root());
    assert!(all.contains(report["verdict"].as_str().unwrap()));
    for round in report["terms"].as_array().unwrap() {
        assert!(all.contains(round["effect"].as_str().unwrap()));
    }
    for word in [
        "fit",
        "selection",
        "held-out",
        "schema = \"bowden.model/1\"",
        "--channel phi_p=motor_rad",
        "joint_Nm",
    ] {
        assert!(all.contains(word), "{word}");
    }
    assert_eq!(folder.names(), ["rig.html"]);
}

#[test]
fn the_model_on_the_page_is_the_one_that_model_out_writes_and_the_hash_is_the_files() {
    let folder = Folder::new();
    let record = example("straight.csv");
    let model = folder.path("model.toml");
    let (page, _) = close(&folder, "page.html", &[&record, "--model-out", &model]);
    let document = parsed(&page);
    let blocks: Vec<String> = elements(document.root(), "pre").map(text).collect();
    assert!(blocks.contains(&folder.read("model.toml")));
    let source = bowden_lab::facts::Source::of_file(record.as_ref()).unwrap();
    assert!(text(document.root()).contains(&source.sha256));
}

#[test]
fn a_record_with_something_unknown_shows_its_curve() {
    let made = bowden_synth::generate(&bowden_synth::Recipe {
        seed: 61_100,
        effects: vec![bowden_synth::Planted {
            strength: 3.0,
            ..bowden_synth::Planted::new("bump-position")
        }],
        ..bowden_synth::Recipe::new(bowden_synth::Mode::Displacement)
    });
    let folder = Folder::new();
    let record = folder.path("bump.csv");
    std::fs::write(&record, made.unwrap().to_csv()).unwrap();
    let (page, report) = close(&folder, "bump.html", &[&record]);
    assert_sound(&page);
    assert_eq!(report["verdict"], "unmodelled-dependence");
    let document = parsed(&page);
    assert!(sections(&document).contains(&"unknown".to_owned()));
    let svg = elements(document.root(), "svg").find(|s| {
        s.attribute("aria-labelledby")
            .is_some_and(|l| l.starts_with("unknown-curve"))
    });
    // The curve and its interval.
    assert_eq!(elements(svg.unwrap(), "path").count(), 2);
}

#[test]
fn several_records_have_a_part_each_on_one_page() {
    let folder = Folder::new();
    let (first, second) = (example("straight.csv"), example("bent.csv"));
    let (page, report) = close(
        &folder,
        "both.html",
        &[&first, &second, "--per-file", "gains", "--max-terms", "1"],
    );
    assert_sound(&page);
    assert_numbers(&page, &report);
    let document = parsed(&page);
    let heads: Vec<String> = elements(document.root(), "h3").map(text).collect();
    for path in [&first, &second] {
        assert_eq!(heads.iter().filter(|h| *h == path).count(), 3, "{heads:?}");
    }
    let title = |id: &str| {
        document
            .descendants()
            .any(|n| n.attribute("id") == Some(id))
    };
    assert!(title("trace-1-title") && title("loop-1-title"));
}

#[test]
fn the_same_record_gives_the_same_page_on_any_number_of_threads() {
    let folder = Folder::new();
    let record = example("damper.csv");
    let out = folder.path("page.html");
    let run = |threads: &str| {
        let arguments = [
            "identify",
            &record,
            "--mode",
            "displacement",
            "--input",
            "x_mm",
            "--output",
            "f_N",
            "--cutoff",
            "10",
            "--report",
            &out,
        ];
        let output = bowden_on(threads, &arguments);
        assert_eq!(output.status.code(), Some(0), "{}", utf8(&output.stderr));
        folder.read("page.html")
    };
    let first = run("1");
    assert_eq!(first, run("1"));
    assert_eq!(first, run("3"));
}
