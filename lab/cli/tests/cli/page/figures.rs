//! One figure as a file, and a page of a million samples.

use crate::page::{assert_sound, elements};
use crate::shell::{example, said, Folder};
use bowden_lab::facts::{close, Asked, Close};
use bowden_page::{Close as Page, Provenance};
use roxmltree::Document;
use std::fmt::Write as _;

#[test]
fn each_figure_is_an_svg_of_its_own_with_a_title_and_lines() {
    let folder = Folder::new();
    let (record, out) = (example("straight.csv"), folder.path("figure.svg"));
    let drawn = |options: &str| {
        said(&format!("identify {record} --plot {out} {options}"));
        folder.read("figure.svg")
    };
    let mut all = Vec::new();
    for (figure, marks) in [("loop", 3), ("residual", 2), ("trace", 3), ("shares", 4)] {
        let svg = drawn(&format!("--figure {figure}"));
        for word in ["NaN", "inf", "url(", "<script"] {
            assert!(!svg.contains(word), "{figure}: {word}");
        }
        let document = Document::parse(&svg).unwrap();
        let root = document.root_element();
        let space = root.tag_name().namespace();
        assert_eq!(space, Some("http://www.w3.org/2000/svg"));
        assert_eq!(root.attribute("role"), Some("img"));
        assert!(elements(root, "title").count() == 1 && elements(root, "desc").count() == 1);
        let bars = elements(root, "rect").filter(|r| r.attribute("class") == Some("bar"));
        let drawn = elements(root, "path").count() + bars.count();
        assert!(drawn >= marks, "{figure}: {drawn}");
        all.push(svg);
    }
    // Without a name it is the loop.
    assert_eq!(drawn(""), all[0]);
    all.dedup();
    assert_eq!(all.len(), 4);
}

/// 1000 s at 1 kHz, whose cut-off leaves a grid of the same length, with one spike. That a drawn peak
/// of one sample stays is tested in `lab/page/src/chart/thin.rs`.
#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn a_million_samples_make_a_page_below_two_megabytes_that_finds_its_spike() {
    const SPIKE: usize = 876_543;
    let mut csv = String::from("t [s],x [mm],f [N]\n");
    // A fixed sequence in place of noise: the fractional parts of multiples of the golden ratio.
    for i in 0..1_000_000_usize {
        let t = i as f64 / 1000.0;
        let x = 10.0 * (1.9 * t).sin() + 3.0 * (37.1 * t).sin();
        let noise = (i as f64 * 0.618_033_988_75).fract() - 0.5;
        let spike = if i.abs_diff(SPIKE) < 4 { 200.0 } else { 0.0 };
        let _ = writeln!(csv, "{t:.3},{x:.5},{:.5}", 2.0 * x + noise + spike);
    }
    let asked = Asked {
        declare: ["stiffness-linear", "offset"].map(str::to_owned).into(),
        cutoff: Some(190.0),
        rounds: Some(0),
        ..Asked::default()
    };
    let record = asked.read_text(csv.as_bytes(), "large.csv").unwrap();
    let question = Close {
        figures: true,
        ..Close::new(asked)
    };
    let closed = close(&[record], &question, &|_| ()).unwrap();
    let figures = closed.figures.unwrap();
    let samples = figures.signals.segments.len();
    assert!(samples > 400_000, "{samples}");
    let page = Page {
        facts: &closed.facts,
        figures: &figures,
        models: &closed.models,
    };
    let page = page.page(&Provenance {
        command: "bowden identify large.csv".to_owned(),
        version: "0".to_owned(),
        sources: Vec::new(),
    });
    println!("{} bytes", page.len());
    assert_sound(&page);
    let worst = figures.signals.files[0].worst.as_ref().unwrap();
    assert!((figures.signals.time(worst.row) - 876.543).abs() < 0.02);
}
