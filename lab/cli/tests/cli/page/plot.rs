//! One figure as a file.

use crate::page::elements;
use crate::shell::{example, said, Folder};
use roxmltree::Document;

#[test]
fn each_figure_is_an_svg_of_its_own_with_a_title_and_lines() {
    let folder = Folder::new();
    let record = example("straight.csv");
    let out = folder.path("figure.svg");
    let mut all = Vec::new();
    for (figure, marks) in [("loop", 3), ("residual", 2), ("trace", 3), ("shares", 4)] {
        said(&["identify", &record, "--plot", &out, "--figure", figure]);
        let svg = folder.read("figure.svg");
        for word in ["NaN", "inf", "url(", "<script"] {
            assert!(!svg.contains(word), "{figure}: {word}");
        }
        let document = Document::parse(&svg).unwrap();
        let root = document.root_element();
        assert_eq!(
            root.tag_name().namespace(),
            Some("http://www.w3.org/2000/svg")
        );
        assert_eq!(root.attribute("role"), Some("img"));
        assert!(elements(root, "title").count() == 1 && elements(root, "desc").count() == 1);
        let bars = elements(root, "rect").filter(|r| r.attribute("class") == Some("bar"));
        let drawn = elements(root, "path").count() + bars.count();
        assert!(drawn >= marks, "{figure}: {drawn}");
        all.push(svg);
    }
    // Without a name it is the loop.
    said(&["identify", &record, "--plot", &out]);
    assert_eq!(folder.read("figure.svg"), all[0]);
    all.dedup();
    assert_eq!(all.len(), 4);
}
