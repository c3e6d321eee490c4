//! `bowden export --c`: what a firmware engineer in C opens. That it compiles and gives the lab's
//! numbers is tested in `capi/tests`, where the library is.

use crate::shell::{bowden as run, said};
use std::path::Path;

/// The root of the repository.
fn repository() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A model whose names are no names of C.
fn nasty(channels: &str, terms: &str) -> String {
    format!(
        "schema = \"bowden.model/1\"\nmode = \"torque\"\nchannels = [{channels}]\nterms = [{terms}]\n\
         [about]\nrecords = [\"a*/ b /*\\n#error\"]\n[about.units]\ninput = \"*/\"\n"
    )
}

fn term(source: &str) -> String {
    format!("{{ effect = \"viscous\", source = \"{source}\", gain = 1.0 }}")
}

/// What the program prints of a model of that text.
fn exported(text: &str) -> (bool, String) {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("0 rig.toml");
    std::fs::write(&model, text).unwrap();
    let output = run(&["export", "--c", model.to_str().unwrap()]);
    let words = if output.status.success() {
        output.stdout
    } else {
        output.stderr
    };
    (output.status.success(), String::from_utf8(words).unwrap())
}

#[test]
fn the_header_of_the_demonstration_is_the_one_that_the_c_example_includes() {
    let there = std::fs::read_to_string(repository().join("capi/examples/demo.h")).unwrap();
    let model = repository().join("examples/data/demo.toml");
    let printed = said(&["export", "--c", model.to_str().unwrap()]);
    assert_eq!(
        printed, there,
        "bowden export --c examples/data/demo.toml --out capi/examples/demo.h"
    );
    // The bytes are those that the file of `close --model-out` has.
    let bytes = std::fs::read(repository().join("examples/data/demo.postcard")).unwrap();
    let digits: Vec<String> = bytes.iter().map(|byte| format!("0x{byte:02x}")).collect();
    let (_, array) = printed.split_once("demo_bytes_f32[42] = {").unwrap();
    let (array, _) = array.split_once('}').unwrap();
    let array: Vec<&str> = array
        .split(',')
        .map(str::trim)
        .filter(|d| !d.is_empty())
        .collect();
    assert_eq!(array, digits);
}

#[test]
fn names_that_are_none_in_c_become_some_and_no_text_leaves_its_comment() {
    let (_, header) = exported(&nasty("\"phi p\", \"phi-p\", \"s\", \"µ\"", &term("phi p")));
    assert!(header.contains("model_0_rig_load_f32"), "{header}");
    for line in [
        "#define MODEL_0_RIG_CHANNEL_PHI_P 0 /* phi p [no unit] */",
        "#define MODEL_0_RIG_CHANNEL_PHI_P_1 1 /* phi-p [no unit] */",
        "#define MODEL_0_RIG_CHANNEL_MODEL 3 /* µ [no unit] */",
    ] {
        assert!(header.contains(line), "{header}");
    }
    // Each comment ends where it should: what is left is directives, code, and no word of the file.
    let mut code = String::new();
    let mut rest = header.as_str();
    while let Some((before, after)) = rest.split_once("/*") {
        code.push_str(before);
        let (inside, behind) = after.split_once("*/").unwrap();
        assert!(!inside.contains("/*"));
        rest = behind;
    }
    code.push_str(rest);
    assert!(!code.contains("error") && !code.contains("*/"), "{code}");
}

#[test]
fn what_the_c_interface_has_no_room_for_is_refused_in_one_line() {
    let many = vec![term("x"); 17].join(", ");
    let (done, words) = exported(&nasty("\"x\"", &many));
    assert!(
        !done && words.contains("17 terms: the C interface has room for 16"),
        "{words}"
    );
    let names: Vec<String> = (0..17).map(|k| format!("\"c{k}\"")).collect();
    let (done, words) = exported(&nasty(&names.join(", "), &term("c16")));
    assert!(
        !done && words.contains("viscous reads channel c16"),
        "{words}"
    );
    let (done, words) = exported(&nasty(&names.join(", "), &term("c15")));
    assert!(done, "{words}");
    let (done, words) = exported("schema = \"other\"");
    assert!(
        !done && words.lines().count() == 1 && words.contains("bowden.model/1"),
        "{words}"
    );
}

#[test]
fn a_name_without_its_ending_and_a_file_over_the_model_are_refused() {
    let model = repository().join("examples/data/demo.toml");
    let model = model.to_str().unwrap();
    for out in ["demo.c", "demo"] {
        let output = run(&["export", "--c", model, "--out", out]);
        assert_eq!(output.status.code(), Some(2));
    }
    assert_eq!(run(&["export", model]).status.code(), Some(2));
}
