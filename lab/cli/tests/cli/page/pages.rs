//! The pages of `identify`, `validate` and `compare`.

use crate::page::{assert_sound, elements, labelled, lead, parsed, sections, shows, text};
use crate::shell::{bowden_on, example, json, said, straight, Folder};
use bowden_synth::{Mode, Planted, Recipe};
use serde_json::Value;

/// The page of a command and its JSON.
fn page(asked: &str) -> (String, Value) {
    let folder = Folder::new();
    let out = folder.path("page.html");
    let report = json(&format!("{asked} --json --report {out}"));
    let page = folder.read("page.html");
    assert_eq!(folder.names(), ["page.html"]);
    assert_sound(&page);
    (page, report)
}

/// The page has all numbers of the JSON of `identify` that it must have, digit by digit.
fn assert_numbers(page: &str, report: &Value) {
    let mut expected = Vec::new();
    for model in ["baseline", "final"] {
        let (rmse, nrmse) = (&report[model]["rmse"], &report[model]["nrmse"]);
        expected.extend([&rmse["fit"], &rmse["selection"], &rmse["held_out"]]);
        expected.extend([&nrmse["fit"], &nrmse["held_out"]]);
    }
    let parameters = report["final"]["parameters"].as_array().unwrap();
    expected.extend(parameters.iter().map(|parameter| &parameter["value"]));
    for round in report["terms"].as_array().unwrap() {
        let after = &round["rmse_after"];
        expected.extend([&round["explained"], &after["fit"]]);
        expected.extend([&after["selection"], &after["held_out"]]);
    }
    shows(&parsed(page), expected);
}

#[test]
fn the_page_has_its_sections_in_order_and_the_numbers_of_the_json() {
    let columns = "--input motor_Nm --output joint_Nm --channel phi_p=motor_rad";
    let record = example("rig.csv");
    let (page, report) = page(&format!("identify {record} --mode torque {columns}"));
    assert_numbers(&page, &report);
    let document = parsed(&page);
    let wanted = "verdict loop ledger parameters signals residual blocks noise origin";
    assert_eq!(sections(&document).join(" "), wanted);
    // The first sentence of the page is the ledger's.
    assert_eq!(lead(&document), report["summary"].as_str().unwrap());
    let all = text(document.root());
    let effects = report["terms"].as_array().unwrap().iter();
    let effects = effects.map(|round| round["effect"].as_str().unwrap());
    let words = ["fit", "selection", "held-out", "joint_Nm"].into_iter();
    let words = words.chain(["schema = \"bowden.model/1\"", "--channel phi_p=motor_rad"]);
    for word in words.chain(report["verdict"].as_str()).chain(effects) {
        assert!(all.contains(word), "{word}");
    }
}

#[test]
fn the_model_on_the_page_is_the_one_that_model_out_writes_and_the_hash_is_the_files() {
    let (folder, record) = (Folder::new(), example("straight.csv"));
    straight(&folder);
    let (page, _) = page(&format!("identify {record}"));
    let document = parsed(&page);
    let blocks: Vec<String> = elements(document.root(), "pre").map(text).collect();
    assert!(blocks.contains(&folder.read("model.toml")));
    let source = bowden_lab::facts::Source::of_file(record.as_ref()).unwrap();
    assert!(text(document.root()).contains(&source.sha256));
}

#[test]
fn a_record_with_something_unknown_shows_its_curve() {
    let bump = Planted::new("bump-position");
    let recipe = Recipe {
        seed: 61_100,
        effects: vec![bump],
        ..Recipe::new(Mode::Displacement)
    };
    let folder = Folder::new();
    let record = folder.planted("bump.csv", &recipe);
    let (page, report) = page(&format!("identify {record}"));
    assert_eq!(report["verdict"], "unmodelled-dependence");
    let document = parsed(&page);
    assert!(sections(&document).contains(&"unknown"));
    // The curve and its interval.
    let svg = labelled(&document, "unknown-curve");
    assert_eq!(elements(svg, "path").count(), 2);
}

#[test]
fn several_records_have_a_part_each_on_one_page() {
    let records = ["straight.csv", "bent.csv"].map(example);
    let asked = format!(
        "identify {} --per-file gains --max-terms 1",
        records.join(" ")
    );
    let (page, report) = page(&asked);
    assert_numbers(&page, &report);
    let document = parsed(&page);
    let heads: Vec<String> = elements(document.root(), "h3").map(text).collect();
    for path in &records {
        assert_eq!(heads.iter().filter(|h| *h == path).count(), 3, "{heads:?}");
    }
    for id in ["trace-1-title", "loop-1-title"] {
        let mut all = document.descendants();
        assert!(all.any(|n| n.attribute("id") == Some(id)), "{id}");
    }
}

#[test]
fn the_same_record_gives_the_same_page_on_any_number_of_threads() {
    let folder = Folder::new();
    let (record, out) = (example("damper.csv"), folder.path("page.html"));
    let columns = "--mode displacement --input x_mm --output f_N --cutoff 10";
    let run = |threads: &str| {
        let asked = format!("identify {record} {columns} --report {out}");
        assert!(bowden_on(threads, &asked).status.success());
        folder.read("page.html")
    };
    let first = run("1");
    assert_eq!(first, run("1"));
    assert_eq!(first, run("3"));
}

#[test]
fn a_model_that_holds_and_one_that_does_not_have_a_page_with_the_sentence_first() {
    let folder = Folder::new();
    let (model, plot) = (straight(&folder), folder.path("check.svg"));
    for record in ["straight_later.csv", "bent.csv"].map(example) {
        let figure = format!("--plot {plot} --figure trace");
        let (page, report) = page(&format!("validate {model} {record} {figure}"));
        assert!(folder.read("check.svg").contains("with gain and offset"));
        let document = parsed(&page);
        assert_eq!(lead(&document), report["summary"].as_str().unwrap());
        let found = sections(&document);
        let wanted = "verdict errors signals loop residual noise parts origin";
        for wanted in wanted.split(' ') {
            assert!(found.contains(&wanted), "{wanted}: {found:?}");
        }
        shows(&document, [&report["rmse"]]);
        let names = elements(document.root(), "text");
        let names = names.filter(|t| t.attribute("class") == Some("name"));
        let names: Vec<String> = names.map(text).collect();
        assert!(names.iter().any(|n| n == "checked"), "{names:?}");
        assert!(!names.iter().any(|n| n == "fit"), "{names:?}");
        // Both files that were read, with their hashes.
        let mut all = document.descendants();
        let origin = all.find(|n| n.attribute("id") == Some("origin"));
        assert_eq!(elements(origin.unwrap(), "tr").count(), 3);
    }
}

#[test]
fn the_page_has_each_controller_with_the_conduit_at_rest_and_moved() {
    let asked = "compare --seconds 20 --seeds 1 --noise 0.02";
    let (page, report) = page(asked);
    let alone = json(&format!("{asked} --json"));
    assert_eq!(report, alone, "the page changes what is printed");
    let document = parsed(&page);
    let wanted = "verdict errors tracking transient estimates origin";
    assert_eq!(sections(&document).join(" "), wanted);
    let heads: Vec<String> = elements(document.root(), "h4").map(text).collect();
    for row in report["rows"].as_array().unwrap() {
        let name = row["controller"].as_str().unwrap();
        assert_eq!(heads.iter().filter(|h| *h == name).count(), 2, "{name}");
        shows(&document, [&row["rmse_true"]["mean"]]);
    }
    let titles: Vec<String> = elements(document.root(), "title").map(text).collect();
    for name in ["beta_hat", "delta_hat", "theta_hat_1"] {
        assert_eq!(titles.iter().filter(|t| *t == name).count(), 2, "{name}");
    }
    let lead = lead(&document);
    assert!(lead.contains("has the smallest true error"), "{lead}");
}

/// The paper's results stand beside the paper's rig alone, and the page says whose rig it is.
#[test]
fn the_page_names_model_gains_and_rig_and_keeps_the_papers_results_out() {
    let folder = Folder::new();
    let (model, gains) = (straight(&folder), folder.path("gains.toml"));
    said(&format!(
        "design {model} --rate 500 --delay 0.006 --out {gains}"
    ));
    let own = format!("--model {model} --gains {gains} --inertia 0.002");
    for (more, wanted) in [
        (
            &*own,
            "model.toml,gains.toml,Drive gain: 1 N·m/unit,inertia 0.002 kg·m²",
        ),
        ("--inertia 0.4", "Rig: inertia 0.4 kg·m²."),
    ] {
        let (page, _) = page(&format!("compare --seconds 8 --seeds 1 {more}"));
        assert!(!page.contains("0.5991"));
        let document = parsed(&page);
        let mut all = elements(document.root(), "section");
        let verdict = all.find(|n| n.attribute("id") == Some("verdict"));
        let verdict = text(verdict.unwrap());
        for words in wanted.split(',') {
            assert!(verdict.contains(words), "{words}: {verdict}");
        }
    }
}
