//! `bowden generate`, and the name that it had before.

use crate::shell::{args, bowden_in, said, Folder};

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

#[test]
fn with_a_file_the_true_values_are_printed_and_nothing_else() {
    let folder = Folder::new();
    let made = |effects: &str| {
        let command = format!("generate --seed 7{effects} --out made.csv");
        let output = bowden_in(&folder, &args(&command));
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    assert_eq!(
        made(" --effect viscous"),
        "viscous@phi_p: gain -0.2623, rms 0.15\n"
    );
    let two = made(" --effect lag --effect stribeck@phi_d:2");
    let (first, second) = two.split_once('\n').unwrap();
    assert!(first.starts_with("lag: time [s] 0.01187,"), "{two}");
    assert!(second.starts_with("stribeck@phi_d: gain -"), "{two}");
    assert!(second.contains(", v_s 0."), "{two}");
    assert_eq!(made(""), "");
}
