//! `bowden export --c`: what a firmware engineer in C opens. That it compiles and gives the lab's
//! numbers is tested in `capi/tests`, where the library is.

use crate::shell::{bowden as run, said, Folder};
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
    let folder = Folder::new();
    let model = folder.root().join("0 rig.toml");
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
    // The bytes are those that the file of `identify --model-out` has.
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
        "#define MODEL_0_RIG_CHANNEL_U 3 /* µ [no unit] */",
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
    // The guard has an `#error` of its own.
    let code = code.replacen("#error \"two headers", "", 1);
    assert!(!code.contains("error") && !code.contains("*/"), "{code}");
}

#[test]
fn what_the_c_interface_has_no_room_for_is_refused_in_one_line() {
    let many = vec![term("x"); 17].join(", ");
    let (done, words) = exported(&nasty("\"x\"", &many));
    assert!(
        !done && words.contains("the model has 17 terms, but the C interface allows at most 16"),
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

/// What the program says of a model of that text that it writes under that name.
fn written(text: &str, folder: &Path, name: &str) -> Result<String, String> {
    let model = folder.join("own.toml");
    std::fs::write(&model, text).unwrap();
    let out = folder.join(name);
    let (model, path) = (model.to_str().unwrap(), out.to_str().unwrap());
    let output = run(&["export", "--c", model, "--out", path]);
    if output.status.success() {
        return Ok(std::fs::read_to_string(out).unwrap());
    }
    assert_eq!(output.status.code(), Some(2));
    assert!(!out.exists());
    Err(String::from_utf8(output.stderr).unwrap())
}

#[test]
fn a_play_before_the_model_has_its_name_and_half_width_in_c() {
    let text = nasty("\"x\"", &term("x")).replace(
        "[about.units]",
        "[about.play]\nhalf_width = 0.081\nheld_out_causal = 0.026\n[about.units]",
    );
    let (done, header) = exported(&text);
    assert!(done, "{header}");
    for line in [
        " * The same error with bowden_play of half-width 0.081 on the input: 2.60 %.\n",
        "#define MODEL_0_RIG_PLAY_HALF_WIDTH_F32 0.081f\n",
        "#define MODEL_0_RIG_PLAY_HALF_WIDTH_F64 0.081\n",
    ] {
        assert!(header.contains(line), "{header}");
    }
    assert!(!header.contains("signal::"), "{header}");
}

/// The macros of a header, sorted: name and value.
fn defined(header: &str) -> Vec<(String, String)> {
    let lines = header.lines().filter_map(|l| l.strip_prefix("#define "));
    let pairs = lines.map(|line| {
        let mut words = line.split(' ').map(str::to_owned);
        let name = words.next().unwrap_or_default();
        (name, words.next().unwrap_or_default())
    });
    let mut pairs: Vec<_> = pairs.collect();
    pairs.sort();
    pairs
}

#[test]
fn no_macro_of_a_header_is_defined_twice_and_a_name_of_its_own_is_kept() {
    for (channels, some) in [
        (
            &["phi_p", "a_3", "A", "a"][..],
            &[("A_3", 1), ("A", 2), ("A_3_3", 3)][..],
        ),
        (&["a", "A", "a_1"], &[("A", 0), ("A_1_1", 1), ("A_1", 2)]),
        (&["A", "a", "a-1", "a_1_1"], &[("A_1", 2), ("A_1_1", 3)]),
        (&["s", "S", "s_0", "s_1"], &[("S_0", 2), ("S_1", 3)]),
        (
            &["キ", "_", "model", "2", "1", "12"],
            &[
                ("0", 0),
                ("1_1", 1),
                ("MODEL", 2),
                ("2", 3),
                ("1", 4),
                ("12", 5),
            ],
        ),
        (
            &["µ", "ν", "φ_p", "Δphi", "_tau", "u"],
            &[
                ("U", 0),
                ("NU", 1),
                ("PHI_P", 2),
                ("DELTAPHI", 3),
                ("TAU", 4),
                ("U_5", 5),
            ],
        ),
    ] {
        let listed: Vec<String> = channels.iter().map(|name| format!("\"{name}\"")).collect();
        let (done, header) = exported(&nasty(&listed.join(", "), &term(channels[0])));
        assert!(done, "{header}");
        let macros = defined(&header);
        let twice = macros.windows(2).find(|two| two[0].0 == two[1].0);
        assert_eq!(twice, None, "{header}");
        let places = macros.iter().filter(|m| m.0.contains("_RIG_CHANNEL_"));
        assert_eq!(places.count(), channels.len(), "{header}");
        for (own, index) in some {
            let pair = (format!("MODEL_0_RIG_CHANNEL_{own}"), index.to_string());
            assert!(macros.contains(&pair), "{pair:?}: {header}");
        }
    }
}

#[test]
fn a_file_name_without_a_letter_is_refused_in_one_line_that_says_which_work() {
    let folder = Folder::new();
    let text = nasty("\"x\"", &term("x"));
    for name in ["1.h", "_-_.h", "キ.h"] {
        let words = written(&text, folder.root(), name).unwrap_err();
        assert_eq!(words.lines().count(), 1, "{words}");
        assert!(
            words.contains("a letter from a to z or a Greek letter"),
            "{words}"
        );
        assert!(words.contains(name), "{words}");
    }
    // It would have the functions of the library, as bowden_model.h would.
    let words = written(&text, folder.root(), "bowden-model.h").unwrap_err();
    assert!(words.contains("the library uses this name"), "{words}");
    for (name, prefix) in [
        ("1a.h", "model_1a"),
        ("µm.h", "um"),
        ("μm.h", "um"),
        ("θ_d.h", "theta_d"),
        ("-x.h", "x"),
        ("_1.キa.h", "model_1__a"),
        ("Rig 1.h", "rig_1"),
    ] {
        let header = written(&text, folder.root(), name).unwrap();
        assert!(header.contains(&format!(" {prefix}_load_f32(")), "{header}");
        // The comment says from where the prefix is.
        let stem = name.strip_suffix(".h").unwrap();
        let said = format!(
            " * The prefix {prefix}_ (of macros {}_) comes from the file name \"{stem}\".\n",
            prefix.to_uppercase()
        );
        assert!(header.contains(&said), "{header}");
    }
    // On stdout it is named after the model.
    let model = folder.root().join("1.toml");
    std::fs::write(&model, &text).unwrap();
    let output = run(&["export", "--c", model.to_str().unwrap()]);
    let words = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty() && words.lines().count() == 1);
    assert!(words.contains("1.toml") && words.contains("--out FILE.h"));
}

/// `rig-1.h` and `rig_1.h` have one prefix: the second one must not be left out in silence.
#[test]
fn two_headers_of_one_prefix_meet_in_peace_only_where_they_hold_the_same() {
    let folder = Folder::new();
    let write = |channels: &str, name: &str| {
        written(&nasty(channels, &term("x")), folder.root(), name).unwrap();
    };
    write("\"x\", \"y\"", "rig-1.h");
    write("\"x\", \"y\"", "Rig_1.h");
    // The bytes of this model are the same, its channels are not.
    write("\"x\", \"z\"", "rig_1.h");
    write("\"x\", \"z\"", "rig_2.h");
    let compiled = |headers: &[&str]| {
        let lines = headers.iter().map(|name| format!("#include \"{name}\"\n"));
        let source = folder.root().join("program.c");
        std::fs::write(&source, lines.collect::<String>()).unwrap();
        let output = std::process::Command::new("cc")
            .args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wundef"])
            .args(["-Wno-unused", "-Werror", "-fsyntax-only", "-I"])
            .arg(repository().join("capi/include"))
            .arg(&source)
            .output();
        output.map(|o| (o.status.success(), String::from_utf8(o.stderr).unwrap()))
    };
    for headers in [
        &["rig-1.h", "rig-1.h"][..],
        &["rig-1.h", "Rig_1.h"],
        &["rig-1.h", "rig_2.h"],
    ] {
        let Ok((is_good, words)) = compiled(headers) else {
            println!("skipped: two headers of one prefix, no cc");
            return;
        };
        assert!(is_good, "{headers:?}: {words}");
    }
    for headers in [["rig-1.h", "rig_1.h"], ["rig_1.h", "Rig_1.h"]] {
        let (is_good, words) = compiled(&headers).unwrap();
        assert!(!is_good, "{headers:?}");
        let told = "two headers of different models have the prefix RIG_1_";
        assert!(words.contains(told), "{words}");
        assert_eq!(words.matches("error:").count(), 1, "{words}");
    }
}
