//! `bowden generate`, and the name that it had before.

use crate::shell::{args, said};

#[test]
fn the_old_name_record_gives_the_same_bytes() {
    let made = |name: &str| {
        said(&args(&format!(
            "{name} --effect viscous:2 --seed 3 --seconds 1"
        )))
    };
    let generated = made("generate");
    // A header and a thousand samples.
    assert_eq!(generated.lines().count(), 1001);
    assert_eq!(generated, made("record"));
}

#[test]
fn the_help_names_generate_and_not_record() {
    for arguments in [&["--help"][..], &["help"]] {
        let help = said(arguments);
        let is_listed = |name: &str| {
            let mut first = help.lines().filter_map(|l| l.split_whitespace().next());
            first.any(|word| word == name)
        };
        assert!(is_listed("generate"), "{help}");
        assert!(!is_listed("record"), "{help}");
        assert!(!help.contains("alias"), "{help}");
    }
    for name in ["generate", "record"] {
        let usage = said(&[name, "--help"]);
        assert!(usage.contains("Usage: bowden generate"), "{usage}");
        assert!(!usage.contains("bowden record"), "{usage}");
    }
}
