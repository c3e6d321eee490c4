//! The page of `compare`.

use crate::page::{assert_sound, elements, parsed, sections, text};
use crate::shell::{args, example, said, Folder};

#[test]
fn the_page_has_each_controller_with_the_conduit_at_rest_and_moved() {
    let folder = Folder::new();
    let out = folder.path("compare.html");
    let arguments = args("compare --seconds 20 --seeds 1 --noise 0.02 --json");
    let printed = said(&[arguments.as_slice(), &["--report", &out]].concat());
    assert_eq!(
        printed,
        said(&arguments),
        "the page changes what is printed"
    );
    let report: serde_json::Value = serde_json::from_str(&printed).unwrap();
    let page = folder.read("compare.html");
    assert_sound(&page);
    let document = parsed(&page);
    let wanted = [
        "verdict",
        "errors",
        "tracking",
        "transient",
        "estimates",
        "origin",
    ];
    assert_eq!(sections(&document), wanted);
    let heads: Vec<String> = elements(document.root(), "h4").map(text).collect();
    let shown: Vec<f64> = elements(document.root(), "data")
        .map(|d| d.attribute("value").unwrap().parse().unwrap())
        .collect();
    for row in report["rows"].as_array().unwrap() {
        let name = row["controller"].as_str().unwrap();
        assert_eq!(heads.iter().filter(|h| *h == name).count(), 2, "{name}");
        let error = row["rmse_true"]["mean"].as_f64().unwrap();
        let is_it = |n: &f64| (n - error).abs() <= 2.0 * f64::EPSILON * error;
        assert!(shown.iter().any(is_it), "{name}");
    }
    let titles: Vec<String> = elements(document.root(), "title").map(text).collect();
    for name in ["beta_hat", "delta_hat", "theta_hat_1"] {
        assert_eq!(titles.iter().filter(|t| *t == name).count(), 2, "{name}");
    }
    let lead = elements(elements(document.root(), "main").next().unwrap(), "p")
        .next()
        .unwrap();
    assert!(
        text(lead).contains("has the smallest true error"),
        "{}",
        text(lead)
    );
}

/// The paper's results stand beside the paper's rig alone, and the page says whose rig it is.
#[test]
fn the_page_names_model_gains_and_rig_and_keeps_the_papers_results_out() {
    let folder = Folder::new();
    let (model, gains) = (folder.path("model.toml"), folder.path("gains.toml"));
    let out = folder.path("compare.html");
    let record = example("straight.csv");
    said(&args(&format!(
        "identify {record} --max-terms 0 --model-out {model}"
    )));
    let asked = ["--rate", "500", "--delay", "0.006", "--out", &gains];
    said(&[&["design", &model], asked.as_slice()].concat());
    let short = [
        "compare",
        "--seconds",
        "8",
        "--seeds",
        "1",
        "--report",
        &out,
    ];
    let own = ["--model", &model, "--gains", &gains, "--inertia", "0.002"];
    for (more, wanted) in [
        (
            &own[..],
            &[
                "model.toml",
                "gains.toml",
                "Drive gain: 1 N·m/unit",
                "inertia 0.002 kg·m²",
            ][..],
        ),
        (&["--inertia", "0.4"], &["Rig: inertia 0.4 kg·m²."]),
    ] {
        said(&[&short, more].concat());
        let page = folder.read("compare.html");
        assert_sound(&page);
        assert!(!page.contains("0.5991"));
        let document = parsed(&page);
        let of_id = |n: &roxmltree::Node| n.attribute("id") == Some("verdict");
        let verdict = elements(document.root(), "section").find(of_id).unwrap();
        for words in wanted {
            assert!(text(verdict).contains(words), "{words}: {}", text(verdict));
        }
    }
}
