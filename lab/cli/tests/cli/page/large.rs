//! A page of a million samples.

use crate::page::{assert_sound, parsed};
use bowden_lab::facts::{close, Asked, Close};
use bowden_page::{Close as Page, Provenance};
use std::fmt::Write as _;

/// 1000 s at 1 kHz, whose cut-off leaves a grid of the same length, with one spike.
#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn a_million_samples_make_a_page_below_two_megabytes_that_keeps_its_spike() {
    // Inside of a column of pixels, not at its start.
    const SPIKE: usize = 876_543;
    let mut csv = String::with_capacity(40_000_000);
    csv.push_str("t [s],x [mm],f [N]\n");
    // A fixed sequence in place of noise: the fractional parts of multiples of the golden ratio.
    for i in 0..1_000_000_usize {
        let t = i as f64 / 1000.0;
        let x = 10.0 * (1.9 * t).sin() + 3.0 * (37.1 * t).sin();
        let noise = (i as f64 * 0.618_033_988_75).fract() - 0.5;
        let spike = if i.abs_diff(SPIKE) < 4 { 200.0 } else { 0.0 };
        let _ = writeln!(csv, "{t:.3},{x:.5},{:.5}", 2.0 * x + noise + spike);
    }
    let asked = Asked {
        declare: vec!["stiffness-linear".to_owned(), "offset".to_owned()],
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
    assert!(
        figures.signals.segments.len() > 400_000,
        "{}",
        figures.signals.segments.len()
    );
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
    // The residual's highest point is the spike: at the top of its axis but for the margin.
    let document = parsed(&page);
    let mut top = f64::INFINITY;
    let svg = document.descendants().find(|n| {
        n.attribute("aria-labelledby")
            .is_some_and(|l| l.starts_with("over-time-0"))
    });
    for path in crate::page::elements(svg.unwrap(), "path") {
        for point in path.attribute("d").unwrap().split(['M', 'L']).skip(1) {
            let (x, y) = point.split_once(' ').unwrap();
            let (x, y): (f64, f64) = (x.parse().unwrap(), y.parse().unwrap());
            if (875.0..878.0).contains(&x) {
                top = top.min(y);
            }
        }
    }
    assert!(top < 30.0, "the spike is drawn at {top} of 500");
    let worst = figures.signals.files[0].worst.as_ref().unwrap();
    assert!((figures.signals.time(worst.row) - 876.543).abs() < 0.02);
}
