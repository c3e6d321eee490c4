//! The links of a page of Markdown.

/// The paths that a page links to, without their anchors: neither addresses nor anchors of the
/// page itself.
pub fn of(page: &str) -> Vec<&str> {
    let targets = page.split("](").skip(1).filter_map(|rest| {
        let end = rest.find([')', '#', ':', ' ', '\n'])?;
        let is_path = end > 0 && matches!(rest.as_bytes()[end], b')' | b'#');
        is_path.then_some(&rest[..end])
    });
    targets.collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_link_is_a_path_without_its_anchor() {
        let page = "[a](one.md), [b](../two.md#part)\n![c](three.svg) [d](#here) \
                    [e](https://example.invalid/x) [f](not a path) [g](open\n)";
        assert_eq!(super::of(page), ["one.md", "../two.md", "three.svg"]);
    }
}
