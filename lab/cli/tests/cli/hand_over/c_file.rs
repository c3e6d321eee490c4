//! `bowden export --c`: what a firmware engineer in C opens. That it compiles and gives the lab's
//! numbers is tested in `capi/tests`, where the library is.

use crate::shell::{bowden, example, has, refused, refuses, said, Folder};

/// A model whose names are no names of C.
fn nasty(channels: &[&str], terms: &[String]) -> String {
    format!(
        "schema = \"bowden.model/1\"\nmode = \"torque\"\nchannels = {channels:?}\nterms = [{}]\n\
         [about]\nrecords = [\"a*/ b /*\\n#error\"]\n[about.units]\ninput = \"*/\"\n",
        terms.join(", ")
    )
}

fn term(source: &str) -> String {
    format!("{{ effect = \"viscous\", source = \"{source}\", gain = 1.0 }}")
}

/// What the program prints of a model of that text.
fn exported(text: &str) -> Result<String, String> {
    let folder = Folder::new();
    let model = folder.file("0 rig.toml", text);
    let asked = ["export", "--c", &model];
    if bowden(&asked).status.success() {
        Ok(said(&asked))
    } else {
        Err(refused(&asked))
    }
}

/// Writes a model of that text under that name.
fn write(folder: &Folder, text: &str, name: &str) -> String {
    let (model, out) = (folder.file("own.toml", text), folder.path(name));
    said(&["export", "--c", &model, "--out", &out]);
    folder.read(name)
}

#[test]
fn the_header_of_the_demonstration_is_the_one_that_the_c_example_includes() {
    let there = std::fs::read_to_string(example("../../capi/examples/demo.h")).unwrap();
    let model = example("demo.toml");
    let printed = said(&format!("export --c {model}"));
    let meant = "bowden export --c examples/data/demo.toml --out capi/examples/demo.h";
    assert_eq!(printed, there, "{meant}");
    // The bytes are those that the file of `identify --model-out` has.
    let bytes = std::fs::read(example("demo.postcard")).unwrap();
    let digits: Vec<String> = bytes.iter().map(|byte| format!("0x{byte:02x}")).collect();
    let (_, array) = printed.split_once("demo_bytes_f32[42] = {").unwrap();
    let (array, _) = array.split_once('}').unwrap();
    let array = array.split(',').map(str::trim).filter(|d| !d.is_empty());
    assert_eq!(array.collect::<Vec<_>>(), digits);
    for out in ["--c --out demo.c", "--c --out demo", ""] {
        let output = bowden(&format!("export {model} {out}"));
        assert_eq!(output.status.code(), Some(2));
    }
}

#[test]
fn names_that_are_none_in_c_become_some_and_no_text_leaves_its_comment() {
    let text = nasty(&["phi p", "phi-p", "s", "µ"], &[term("phi p")]);
    let play = "[about.play]\nhalf_width = 0.081\nheld_out_causal = 0.026\n[about.units]";
    let header = exported(&text.replace("[about.units]", play)).unwrap();
    for line in [
        "model_0_rig_load_f32",
        "#define MODEL_0_RIG_CHANNEL_PHI_P 0 /* phi p [no unit] */",
        "#define MODEL_0_RIG_CHANNEL_PHI_P_1 1 /* phi-p [no unit] */",
        "#define MODEL_0_RIG_CHANNEL_U 3 /* µ [no unit] */",
        " * The same error with bowden_play of half-width 0.081 on the input: 2.60 %.\n",
        "#define MODEL_0_RIG_PLAY_HALF_WIDTH_F32 0.081f\n",
        "#define MODEL_0_RIG_PLAY_HALF_WIDTH_F64 0.081\n",
    ] {
        has(&header, &[line]);
    }
    assert!(!header.contains("signal::"), "{header}");
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
    let names: Vec<String> = (0..17).map(|k| format!("c{k}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let of = |source: &str, terms: usize| nasty(&names, &vec![term(source); terms]);
    for (text, part) in [
        (
            of("c0", 17),
            "the model has 17 terms, but the C interface allows at most 16",
        ),
        (of("c16", 1), "viscous reads channel c16"),
        ("schema = \"other\"".to_owned(), "bowden.model/1"),
    ] {
        has(&exported(&text).unwrap_err(), &[part]);
    }
    exported(&of("c15", 16)).unwrap();
}

/// The macros of a header, sorted: name and value.
fn defined(header: &str) -> Vec<(&str, &str)> {
    let lines = header.lines().filter_map(|l| l.strip_prefix("#define "));
    let pairs = lines.map(|line| {
        let mut words = line.split(' ');
        (
            words.next().unwrap_or_default(),
            words.next().unwrap_or_default(),
        )
    });
    let mut pairs: Vec<_> = pairs.collect();
    pairs.sort_unstable();
    pairs
}

#[test]
fn no_macro_of_a_header_is_defined_twice_and_a_name_of_its_own_is_kept() {
    for (channels, some) in [
        ("phi_p a_3 A a", "A_3=1 A=2 A_3_3=3"),
        ("a A a_1", "A=0 A_1_1=1 A_1=2"),
        ("A a a-1 a_1_1", "A_1=2 A_1_1=3"),
        ("s S s_0 s_1", "S_0=2 S_1=3"),
        ("キ _ model 2 1 12", "0=0 1_1=1 MODEL=2 2=3 1=4 12=5"),
        (
            "µ ν φ_p Δphi _tau u",
            "U=0 NU=1 PHI_P=2 DELTAPHI=3 TAU=4 U_5=5",
        ),
    ] {
        let channels: Vec<&str> = channels.split(' ').collect();
        let header = exported(&nasty(&channels, &[term(channels[0])])).unwrap();
        let macros = defined(&header);
        let twice = macros.windows(2).find(|two| two[0].0 == two[1].0);
        assert_eq!(twice, None, "{header}");
        let places = macros.iter().filter(|m| m.0.contains("_RIG_CHANNEL_"));
        assert_eq!(places.count(), channels.len(), "{header}");
        for (name, index) in some.split(' ').filter_map(|pair| pair.split_once('=')) {
            let name = format!("MODEL_0_RIG_CHANNEL_{name}");
            assert!(macros.contains(&(&name, index)), "{name} {index}: {header}");
        }
    }
}

#[test]
fn a_file_name_without_a_letter_is_refused_in_one_line_that_says_which_work() {
    let folder = Folder::new();
    let text = nasty(&["x"], &[term("x")]);
    let model = folder.file("1.toml", &text);
    let letter = "a letter from a to z or a Greek letter";
    for (name, part) in [
        ("1.h", letter),
        ("_-_.h", letter),
        ("キ.h", letter),
        // It would have the functions of the library, as bowden_model.h would.
        ("bowden-model.h", "the library uses this name"),
    ] {
        let out = folder.path(name);
        refuses(&format!("export --c {model} --out {out}"), &[part, name]);
    }
    // On stdout it is named after the model.
    refuses(&format!("export --c {model}"), &["1.toml", "--out FILE.h"]);
    assert_eq!(folder.names(), ["1.toml"]);
    for (stem, prefix) in [
        ("1a", "model_1a"),
        ("µm", "um"),
        ("μm", "um"),
        ("θ_d", "theta_d"),
        ("-x", "x"),
        ("_1.キa", "model_1__a"),
        ("Rig 1", "rig_1"),
    ] {
        let header = write(&folder, &text, &format!("{stem}.h"));
        // The comment says from where the prefix is.
        let of_macros = format!("(of macros {}_)", prefix.to_uppercase());
        let from = format!("comes from the file name \"{stem}\".\n");
        let told = format!(" * The prefix {prefix}_ {of_macros} {from}");
        has(&header, &[&format!(" {prefix}_load_f32("), &told]);
    }
}

/// `rig-1.h` and `rig_1.h` have one prefix: the second one must not be left out in silence.
#[test]
fn two_headers_of_one_prefix_meet_in_peace_only_where_they_hold_the_same() {
    let folder = Folder::new();
    // The bytes of the models are the same, their channels are not.
    for (second, name) in [
        ("y", "rig-1.h"),
        ("y", "Rig_1.h"),
        ("z", "rig_1.h"),
        ("z", "rig_2.h"),
    ] {
        write(&folder, &nasty(&["x", second], &[term("x")]), name);
    }
    let compiled = |headers: &[&str; 2]| {
        let lines = headers.map(|name| format!("#include \"{name}\"\n"));
        let source = folder.file("program.c", lines.concat());
        let output = std::process::Command::new("cc")
            .args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wundef"])
            .args(["-Wno-unused", "-Werror", "-fsyntax-only", "-I"])
            .args([&example("../../capi/include"), &source])
            .output();
        output.map(|o| (o.status.success(), String::from_utf8(o.stderr).unwrap()))
    };
    for (headers, is_good) in [
        (["rig-1.h", "rig-1.h"], true),
        (["rig-1.h", "Rig_1.h"], true),
        (["rig-1.h", "rig_2.h"], true),
        (["rig-1.h", "rig_1.h"], false),
        (["rig_1.h", "Rig_1.h"], false),
    ] {
        let Ok((compiles, words)) = compiled(&headers) else {
            println!("skipped: two headers of one prefix, no cc");
            return;
        };
        assert_eq!(compiles, is_good, "{headers:?}: {words}");
        if !is_good {
            has(
                &words,
                &["two headers of different models have the prefix RIG_1_"],
            );
            assert_eq!(words.matches("error:").count(), 1, "{words}");
        }
    }
}
