//! Pages and figures: complete in themselves, the numbers of the JSON, the same bytes each time.

mod browser;
mod check;
mod close;
mod compare;
mod large;
mod plot;
mod refused;
mod terminal;

use roxmltree::{Document, Node};

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
fn sections(page: &Document<'_>) -> Vec<String> {
    let all = elements(page.root(), "section");
    all.filter_map(|s| s.attribute("id").map(str::to_owned))
        .collect()
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
                let target = &value[1..];
                let found = document
                    .descendants()
                    .any(|n| n.attribute("id") == Some(target));
                assert!(found, "{value} leads nowhere");
            }
            assert!(
                !value.contains("http://") && !value.contains("https://"),
                "{name}={value}"
            );
        }
        assert!(
            !["link", "iframe", "img", "object", "embed", "base"].contains(&node.tag_name().name())
        );
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
            let numbers = d
                .split(|c: char| "MLZ ".contains(c))
                .filter(|w| !w.is_empty());
            assert!(numbers.clone().count() >= 4, "{d}");
            assert!(numbers
                .clone()
                .all(|w| w.parse::<f64>().unwrap().is_finite()));
            // Every other number is an x: nothing is drawn beside the axis.
            let mut across = numbers.step_by(2).map(|w| w.parse::<f64>().unwrap());
            assert!(across.all(|x| (-1.0..=1001.0).contains(&x)), "{d}");
            marks += 1;
        }
        marks += elements(figure, "circle").count();
        marks += elements(figure, "rect")
            .filter(|r| r.attribute("class").is_some_and(|c| c.starts_with("bar")))
            .count();
        assert!(marks > 0, "an empty figure: {}", text(figure));
        for node in figure.descendants().filter(Node::is_element) {
            for name in [
                "x", "y", "x1", "x2", "y1", "y2", "cx", "cy", "width", "height",
            ] {
                let Some(value) = node.attribute(name) else {
                    continue;
                };
                let number: f64 = value.trim_end_matches('%').parse().unwrap();
                assert!(
                    number.is_finite() && number.abs() <= 1100.0,
                    "{name}={value}"
                );
                assert!(
                    !name.ends_with("th") && !name.ends_with("ht") || number >= 0.0,
                    "{name}={value}"
                );
            }
        }
    }
    assert!(figures > 3, "{figures} figures");
}

/// Titles, descriptions, captions, scopes, a skip link, no identity twice.
fn assert_readable(document: &Document<'_>) {
    let root = document.root_element();
    assert_eq!(root.attribute("lang"), Some("en"));
    let mut ids: Vec<&str> = document
        .descendants()
        .filter_map(|n| n.attribute("id"))
        .collect();
    let all = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), all, "an identity stands twice");
    for svg in elements(root, "svg") {
        let hidden = svg.attribute("aria-hidden") == Some("true");
        let inner = svg
            .ancestors()
            .skip(1)
            .any(|n| n.tag_name().name() == "svg");
        if hidden || inner {
            continue;
        }
        assert_eq!(svg.attribute("role"), Some("img"));
        for label in svg.attribute("aria-labelledby").unwrap().split(' ') {
            let node = document
                .descendants()
                .find(|n| n.attribute("id") == Some(label))
                .unwrap();
            assert!(text(node).chars().count() >= 1, "{label}");
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
    assert_eq!(
        (first.attribute("class"), first.attribute("href")),
        (Some("skip"), Some("#main"))
    );
    assert!(elements(root, "figure").all(|f| f.attribute("tabindex") == Some("0")));
}
