//! Pages and figures: complete in themselves, the numbers of the JSON, the same bytes each time.

mod figures;
mod pages;
mod refused;
mod shown;

use roxmltree::{Document, Node};
use serde_json::Value;
use std::collections::BTreeMap;

/// A page without its doctype, which is well-formed XML.
fn parsed(page: &str) -> Document<'_> {
    let text = page.strip_prefix("<!DOCTYPE html>\n").unwrap();
    Document::parse(text).unwrap()
}

fn elements<'a, 'i>(of: Node<'a, 'i>, name: &'a str) -> impl Iterator<Item = Node<'a, 'i>> {
    of.descendants()
        .filter(move |n| n.is_element() && n.tag_name().name() == name)
}

/// All text below an element.
fn text(of: Node<'_, '_>) -> String {
    of.descendants()
        .filter(Node::is_text)
        .filter_map(|n| n.text())
        .collect()
}

/// The identities of the sections, in their order.
fn sections<'a>(page: &'a Document<'_>) -> Vec<&'a str> {
    let all = elements(page.root(), "section");
    all.filter_map(|s| s.attribute("id")).collect()
}

/// The first sentence.
fn lead(page: &Document<'_>) -> String {
    let main = elements(page.root(), "main").next().unwrap();
    text(elements(main, "p").next().unwrap())
}

/// The figure whose label begins so.
fn labelled<'a, 'i>(page: &'a Document<'i>, label: &str) -> Node<'a, 'i> {
    let mut all = elements(page.root(), "svg");
    let is_it = |s: &Node<'_, '_>| {
        s.attribute("aria-labelledby")
            .is_some_and(|l| l.starts_with(label))
    };
    all.find(is_it).unwrap()
}

/// The page has each of these numbers, digit by digit.
fn shows<'v>(page: &Document<'_>, expected: impl IntoIterator<Item = &'v Value>) {
    let all = elements(page.root(), "data");
    let shown: Vec<f64> = all
        .map(|d| d.attribute("value").unwrap().parse().unwrap())
        .collect();
    for number in expected.into_iter().map(|number| number.as_f64().unwrap()) {
        // The reader of the JSON may be off in the last bit.
        let is_it = |n: &f64| (n - number).abs() <= 2.0 * f64::EPSILON * number.abs();
        assert!(shown.iter().any(is_it), "{number} is not on the page");
    }
}

/// What any page must be: complete in itself, with names for all that it draws.
fn assert_sound(page: &str) {
    assert!(page.len() <= 2_000_000, "{} bytes", page.len());
    for word in [
        "NaN",
        "inf\"",
        "infinity",
        "url(",
        "@import",
        "<script",
        "javascript:",
    ] {
        assert!(!page.contains(word), "{word} is in the page");
    }
    let document = parsed(page);
    assert_names_no_resource(&document);
    assert_drawn(&document);
    assert_readable(&document);
}

fn assert_names_no_resource(document: &Document<'_>) {
    for node in document.descendants().filter(Node::is_element) {
        for attribute in node.attributes() {
            let (name, value) = (attribute.name(), attribute.value());
            assert!(!name.starts_with("on"), "{name}={value}");
            if ["src", "href", "data", "srcset", "action"].contains(&name) {
                assert!(value.starts_with('#'), "{name}={value}");
                let is_target = |n: Node<'_, '_>| n.attribute("id") == Some(&value[1..]);
                let mut all = document.descendants();
                assert!(all.any(is_target), "{value} leads nowhere");
            }
            let is_web = value.contains("http://") || value.contains("https://");
            assert!(!is_web, "{name}={value}");
        }
        let outside = ["link", "iframe", "img", "object", "embed", "base"];
        assert!(!outside.contains(&node.tag_name().name()));
    }
}

/// Every figure draws something, at numbers.
fn assert_drawn(document: &Document<'_>) {
    let mut figures = 0;
    for figure in elements(document.root(), "figure") {
        figures += 1;
        let mut marks = 0;
        for path in elements(figure, "path") {
            let d = path.attribute("d").unwrap();
            let words = d
                .split(|c: char| "MLZ ".contains(c))
                .filter(|w| !w.is_empty());
            let numbers: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
            assert!(
                numbers.len() >= 4 && numbers.iter().all(|n| n.is_finite()),
                "{d}"
            );
            // Every other number is an x: nothing is drawn beside the axis.
            let mut across = numbers.iter().step_by(2);
            assert!(across.all(|x| (-1.0..=1001.0).contains(x)), "{d}");
            marks += 1;
        }
        marks += elements(figure, "circle").count();
        marks += elements(figure, "rect")
            .filter(|r| r.attribute("class").is_some_and(|c| c.starts_with("bar")))
            .count();
        assert!(marks > 0, "an empty figure: {}", text(figure));
        for node in figure.descendants().filter(Node::is_element) {
            for name in "x y x1 x2 y1 y2 cx cy width height".split(' ') {
                let Some(value) = node.attribute(name) else {
                    continue;
                };
                let number: f64 = value.trim_end_matches('%').parse().unwrap();
                let least = if ["width", "height"].contains(&name) {
                    0.0
                } else {
                    -1100.0
                };
                assert!((least..=1100.0).contains(&number), "{name}={value}");
            }
        }
    }
    assert!(figures > 3, "{figures} figures");
}

/// Titles, descriptions, captions, scopes, a skip link, no identity twice.
fn assert_readable(document: &Document<'_>) {
    let root = document.root_element();
    assert_eq!(root.attribute("lang"), Some("en"));
    let mut ids = BTreeMap::new();
    for node in document.descendants() {
        let twice = node.attribute("id").and_then(|id| ids.insert(id, node));
        assert!(twice.is_none(), "an identity stands twice: {twice:?}");
    }
    for svg in elements(root, "svg") {
        let hidden = svg.attribute("aria-hidden") == Some("true");
        let mut outer = svg.ancestors().skip(1);
        let inner = outer.any(|n| n.tag_name().name() == "svg");
        if hidden || inner {
            continue;
        }
        assert_eq!(svg.attribute("role"), Some("img"));
        for label in svg.attribute("aria-labelledby").unwrap().split(' ') {
            let node = ids[label];
            assert!(!text(node).is_empty(), "{label}");
            assert!(node.ancestors().any(|n| n == svg));
        }
        assert!(elements(svg, "title").count() == 1 && elements(svg, "desc").count() == 1);
    }
    for table in elements(root, "table") {
        assert_eq!(elements(table, "caption").count(), 1);
        assert!(elements(table, "th").all(|th| th.attribute("scope").is_some()));
    }
    let body = elements(root, "body").next().unwrap();
    let first = elements(body, "a").next().unwrap();
    assert_eq!(first.attribute("class"), Some("skip"));
    assert_eq!(first.attribute("href"), Some("#main"));
    assert!(elements(root, "figure").all(|f| f.attribute("tabindex") == Some("0")));
}
