//! The page of `validate`.

use crate::page::{assert_sound, elements, parsed, sections, text};
use crate::shell::{example, said, Folder};

fn page(folder: &Folder, record: &str) -> (String, serde_json::Value) {
    let (model, out) = (folder.path("model.toml"), folder.path("check.html"));
    said(&["identify", &example("straight.csv"), "--model-out", &model]);
    let plot = folder.path("check.svg");
    let printed = said(&[
        "validate",
        &model,
        &example(record),
        "--json",
        "--report",
        &out,
        "--plot",
        &plot,
        "--figure",
        "trace",
    ]);
    assert!(folder.read("check.svg").contains("with gain and offset"));
    (
        folder.read("check.html"),
        serde_json::from_str(&printed).unwrap(),
    )
}

#[test]
fn a_model_that_holds_and_one_that_does_not_have_a_page_with_the_sentence_first() {
    let folder = Folder::new();
    for record in ["straight_later.csv", "bent.csv"] {
        let (page, report) = page(&folder, record);
        assert_sound(&page);
        let document = parsed(&page);
        let main = elements(document.root(), "main").next().unwrap();
        let lead = elements(main, "p").next().unwrap();
        assert_eq!(text(lead), report["summary"].as_str().unwrap());
        let found = sections(&document);
        for wanted in [
            "verdict", "errors", "signals", "loop", "residual", "noise", "parts", "origin",
        ] {
            assert!(found.contains(&wanted.to_owned()), "{wanted}: {found:?}");
        }
        let rmse = report["rmse"].as_f64().unwrap();
        let is_it = |n: f64| (n - rmse).abs() <= 2.0 * f64::EPSILON * rmse;
        let mut shown = elements(document.root(), "data")
            .map(|d| d.attribute("value").unwrap().parse().unwrap());
        assert!(shown.any(is_it), "{rmse}");
        let names: Vec<String> = elements(document.root(), "text")
            .filter(|t| t.attribute("class") == Some("name"))
            .map(text)
            .collect();
        assert!(names.iter().any(|n| n == "checked"), "{names:?}");
        assert!(!names.iter().any(|n| n == "fit"), "{names:?}");
        // Both files that were read, with their hashes.
        let origin = document
            .descendants()
            .find(|n| n.attribute("id") == Some("origin"));
        assert_eq!(elements(origin.unwrap(), "tr").count(), 3);
    }
}
