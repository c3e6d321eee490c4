//! The program from outside: exit status, what goes to which stream, files written.

use crate::shell::{
    bowden, bowden_in, bowden_on, builtin, has, json, program, refused, refuses_all, said,
    straight, text, without_seconds, Folder,
};
use serde_json::Value;

#[test]
fn without_arguments_the_embedded_record_gives_a_ledger_without_colours() {
    let output = bowden("");
    assert_eq!(output.status.code(), Some(0));
    let ledger = text(&output.stdout);
    // Its lines are those of the golden files.
    has(ledger, &["viscous@phi_p -0.2637"]);
    assert!(!ledger.contains('\u{1b}'), "escape codes in a pipe");
    assert!(output.stderr.is_empty());
    // The record is the one that the named command writes.
    let folder = Folder::new();
    let path = folder.record("r.csv", "--mode torque --effect viscous --seed 7");
    let file = json(&format!("identify {path} --json"));
    assert_eq!(builtin()["final"], file["final"]);
    assert_eq!(builtin()["terms"], file["terms"]);
}

#[test]
fn the_same_command_prints_the_same_bytes_whatever_the_number_of_threads() {
    let folder = Folder::new();
    let path = folder.record("r.csv", "--mode displacement --effect stribeck --seed 3");
    let model = straight(&folder);
    for command in [
        format!("identify {path} --json"),
        format!("design {model} --rate 1000 --delay 0.002 --json"),
        "compare --seconds 9 --seeds 3 --json".to_owned(),
    ] {
        let run = |threads: &str| {
            let json = bowden_on(threads, &command).stdout;
            match text(&json).contains("\"seconds\":{") {
                true => without_seconds(&json),
                false => text(&json).to_owned(),
            }
        };
        let first = run("1");
        assert_eq!(first, run("1"), "{command}");
        assert_eq!(first, run("3"), "{command}");
    }
}

#[test]
fn a_search_whose_time_is_over_gives_the_best_so_far_and_says_so() {
    // Over before the first look at what is missing, on whatever machine.
    let report = json("identify --json --time-limit 1e-9");
    assert_eq!(report["stopped_by_time_limit"], 1e-9);
    assert_eq!(report["verdict"], "stopped");
    has(report["summary"].as_str().unwrap(), &["stopped after"]);
    assert_eq!(report["terms"].as_array().unwrap().len(), 0);
    assert!(report["baseline"]["rmse"]["fit"].as_f64().unwrap() > 0.0);
    // With time enough it is as if none had been given.
    let mut ample = json("identify --json --time-limit 3600");
    ample["cost"] = builtin()["cost"].clone();
    assert_eq!(*builtin(), ample);
}

#[test]
fn a_bad_record_or_option_gives_one_line_and_status_two() {
    let folder = Folder::new();
    folder.file("text.csv", "t,x,f\n0,0,0\n0.1,zero,1\n");
    folder.file("empty.csv", "");
    folder.file("binary.csv", [0, 159, 146, 150, 0, 0]);
    folder.record("good.csv", "--seconds 5");
    refuses_all(
        &folder,
        "identify missing.csv => missing.csv
        identify . => bowden: .
        identify empty.csv => empty.csv
        identify binary.csv => binary.csv
        identify text.csv => text.csv:3: column `x`
        identify good.csv --time-limit=0 => --time-limit
        identify good.csv --time-limit=NaN => --time-limit
        identify good.csv --cutoff=-1 => --cutoff
        identify good.csv --cutoff=NaN => --cutoff
        identify good.csv --cutoff=900 => --cutoff
        identify good.csv --cutoff=0.01 => --cutoff
        identify good.csv --start=99 => bowden:
        identify good.csv --rate=0 => bowden:
        identify good.csv --baseline=bouc-wen,nonsense => nonsense
        identify good.csv --baseline=viscous,viscous => viscous
        identify good.csv --channel=phi_p => phi_p
        identify good.csv --input=nowhere => nowhere
        identify good.csv --model-out=model.json => model.json
        identify --baseline bouc-wen,viscos => `viscous`
        identify --baseline viscous@phi-p => `phi_p`
        identify --max-term 1 => '--max-terms'
        identify --max-terms 9 => `--max-terms 9` is out of range (0 to 8)
        identify --no-such-option => --no-such-option
        generate --effect nonsense => nonsense
        generate --effect viscous:much => much
        generate --seconds 0 => seconds
        export --c m.toml --out bowden.h => the library uses this name
        export --c m.toml --out Bowden_model.h => the library uses this name
        man clsoe => clsoe
        man --out missing => no such folder",
    );
    for asked in ["help nonsense", "completions cmd"] {
        let output = bowden(asked);
        assert_eq!(output.status.code(), Some(2), "{asked}");
        has(
            text(&output.stderr),
            &[asked.split(' ').next_back().unwrap()],
        );
    }
}

#[test]
fn a_model_file_is_whole_or_absent_and_reads_back_to_the_same_model() {
    use bowden_lab::export::ModelFile;
    let folder = Folder::new();
    let recipe = "--mode displacement --effect drag-quadratic --seed 5";
    let record = folder.record("r.csv", recipe);
    let out = folder.path("model.toml");
    said(&format!("identify {record} --model-out {out}"));
    let text = folder.read("model.toml");
    let file: ModelFile = toml::from_str(&text).unwrap();
    let model = file.model::<8>().unwrap();
    assert_eq!(model.terms().len(), file.terms.len());
    let kappa_eta = file.transmission.as_ref().unwrap().kappa_eta;
    assert_eq!(model.transmission().unwrap().kappa_eta(), kappa_eta);
    let again = toml::to_string(&file).unwrap();
    assert_eq!(file, toml::from_str(&again).unwrap());
    let unknown = text.replace("mode =", "mood =");
    assert!(toml::from_str::<ModelFile>(&unknown).is_err());
    let before = folder.names();
    let nowhere = folder.path("no-such-folder/model.toml");
    refused(&format!("identify {record} --model-out {nowhere}"));
    assert_eq!(folder.names(), before);
}

/// A full disk, where the system has one to try.
#[cfg(target_os = "linux")]
#[test]
fn whatever_is_printed_on_a_full_disk_is_one_line_and_status_two() {
    for asked in [
        "--version",
        "--help",
        "identify --help",
        "help terms",
        "certify",
        "generate --mode torque",
    ] {
        let full = std::fs::File::options().write(true).open("/dev/full");
        let output = program(asked).stdout(full.unwrap()).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{asked}");
        let line = text(&output.stderr);
        assert_eq!(line.lines().count(), 1, "{asked}: {line}");
        assert!(line.starts_with("bowden: stdout: "), "{line}");
    }
    // Elsewhere both are printed as ever.
    for asked in ["--version", "--help"] {
        let output = bowden(asked);
        assert_eq!(output.status.code(), Some(0));
        assert!(text(&output.stdout).contains("bowden") && output.stderr.is_empty());
    }
}

/// JSON is UTF-8: docs/reference/json.md says what becomes of another path.
#[cfg(target_os = "linux")]
#[test]
fn a_path_that_is_no_utf_8_is_read_and_has_the_sign_for_that_in_the_json() {
    use std::os::unix::ffi::OsStrExt as _;
    let folder = Folder::new();
    let plain = folder.record("plain.csv", "--mode torque");
    let foreign = std::ffi::OsStr::from_bytes(b"l\xe4uft.csv");
    let foreign = folder.root().join(foreign);
    std::fs::copy(&plain, &foreign).unwrap();
    let closed = |path: &std::path::Path| {
        let mut program = program("identify --max-terms 0 --json");
        let output = program.arg(path).output().unwrap();
        assert_eq!(output.status.code(), Some(0));
        output.stdout
    };
    let found = closed(&foreign);
    let own: Value = serde_json::from_slice(&found).unwrap();
    let there = own["record"]["path"].as_str().unwrap();
    assert!(there.ends_with("/l\u{fffd}uft.csv"), "{there}");
    // All else is as of any other name.
    let expected = without_seconds(&closed(plain.as_ref()));
    let expected = expected.replace("plain.csv", "l\u{fffd}uft.csv");
    assert_eq!(without_seconds(&found), expected);
    let documented = include_str!("../../../../docs/reference/json.md");
    assert!(documented.contains("U+FFFD"));
}

/// What comes through a pipe comes once: a page must have its hash from that reading.
#[cfg(target_os = "linux")]
#[test]
fn a_page_of_a_record_through_a_pipe_has_the_hash_of_what_came() {
    let folder = Folder::new();
    let plain = folder.record("plain.csv", "--mode torque");
    let page = |record: &str, name: &str| {
        let page = folder.path(name);
        said(&format!("identify {record} --max-terms 0 --report {page}"));
        folder.read(name)
    };
    let pipe = folder.path("pipe.csv");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let content = std::fs::read(&plain).unwrap();
    let to = pipe.clone();
    let writer = std::thread::spawn(move || std::fs::write(to, content));
    let of_pipe = page(&pipe, "pipe.html");
    writer.join().unwrap().unwrap();
    let of_file = page(&plain, "file.html");
    let is_hash = |word: &&str| word.len() == 64 && word.bytes().all(|b| b.is_ascii_hexdigit());
    has(
        &of_pipe,
        &[of_file.split(['<', '>']).find(is_hash).unwrap()],
    );
}

#[test]
fn generate_had_another_name_which_gives_the_same_bytes_and_no_help_shows() {
    let made = |name: &str| said(&format!("{name} --effect viscous:2 --seed 3 --seconds 1"));
    let generated = made("generate");
    // A header and a thousand samples.
    assert_eq!(generated.lines().count(), 1001);
    assert_eq!(generated, made("record"));
    let help = said("--help");
    let listed = help.lines().filter_map(|l| l.split_whitespace().next());
    assert!(!listed.into_iter().any(|word| word == "record"), "{help}");
    assert!(!help.contains("alias"), "{help}");
    for name in ["generate", "record"] {
        let usage = said(&format!("{name} --help"));
        has(&usage, &["Usage: bowden generate"]);
        assert!(!usage.contains("bowden record"), "{usage}");
    }
}

#[test]
fn with_a_file_the_true_values_are_printed_and_nothing_else() {
    let folder = Folder::new();
    let made = |effects: &str| {
        let output = bowden_in(&folder, &format!("generate --seed 7 {effects} --out m.csv"));
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let viscous = "viscous@phi_p: gain -0.2623, rms 0.15\n";
    assert_eq!(made("--effect viscous"), viscous);
    let two = made("--effect lag --effect stribeck@phi_d:2");
    let (first, second) = two.split_once('\n').unwrap();
    assert!(first.starts_with("lag: time [s] 0.01187,"), "{two}");
    assert!(second.starts_with("stribeck@phi_d: gain -"), "{two}");
    has(second, &[", v_s 0."]);
    assert_eq!(made(""), "");
}
