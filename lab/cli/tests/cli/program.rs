//! The program from outside: exit status, what goes to which stream, files written.

use crate::shell::{args, bowden, bowden_on, refused, said, text, without_seconds, Folder};

fn record(folder: &Folder, name: &str, arguments: &[&str]) -> String {
    let path = folder.path(name);
    let mut all = vec!["generate", "--out", &path];
    all.extend(arguments);
    assert!(bowden(&all).status.success());
    path
}

#[test]
fn without_arguments_the_embedded_record_gives_a_ledger_without_colours() {
    let output = bowden(&[]);
    assert_eq!(output.status.code(), Some(0));
    let ledger = text(&output.stdout);
    // Its lines are those of the golden files.
    assert!(ledger.contains("viscous@phi_p -0.2637"), "{ledger}");
    assert!(!ledger.contains('\u{1b}'), "escape codes in a pipe");
    assert!(output.stderr.is_empty());
}

#[test]
fn the_embedded_record_is_the_one_that_the_named_command_writes() {
    let folder = Folder::new();
    let path = record(
        &folder,
        "r.csv",
        &["--mode", "torque", "--effect", "viscous", "--seed", "7"],
    );
    let own: serde_json::Value =
        serde_json::from_slice(&bowden(&["identify", "--json"]).stdout).unwrap();
    let file: serde_json::Value =
        serde_json::from_slice(&bowden(&["identify", &path, "--json"]).stdout).unwrap();
    assert_eq!(own["final"], file["final"]);
    assert_eq!(own["terms"], file["terms"]);
}

#[test]
fn the_same_command_prints_the_same_bytes_whatever_the_number_of_threads() {
    let folder = Folder::new();
    let path = record(
        &folder,
        "r.csv",
        &args("--mode displacement --effect stribeck --seed 3"),
    );
    let model = folder.path("m.toml");
    said(&["identify", "--model-out", &model]);
    for command in [
        format!("identify {path} --json"),
        format!("design {model} --rate 1000 --delay 0.002 --json"),
        "compare --seconds 9 --seeds 3 --json".to_owned(),
    ] {
        let run = |threads: &str| {
            let json = bowden_on(threads, &args(&command)).stdout;
            let is_timed = text(&json).contains("\"seconds\":{");
            if is_timed {
                without_seconds(&json)
            } else {
                text(&json).to_owned()
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
    let output = bowden(&["identify", "--json", "--time-limit", "1e-9"]);
    assert!(output.status.success());
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["stopped_by_time_limit"], 1e-9);
    assert_eq!(report["verdict"], "stopped");
    let sentence = report["summary"].as_str().unwrap();
    assert!(sentence.contains("stopped after"), "{sentence}");
    assert_eq!(report["terms"].as_array().unwrap().len(), 0);
    assert!(report["baseline"]["rmse"]["fit"].as_f64().unwrap() > 0.0);
    // With time enough it is as if none had been given.
    let found = |arguments: &[&str]| {
        let output = bowden(arguments);
        let mut report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        report["cost"].take();
        report
    };
    let ample = found(&["identify", "--json", "--time-limit", "3600"]);
    assert_eq!(found(&["identify", "--json"]), ample);
}

#[test]
fn a_bad_record_or_option_gives_one_line_and_status_two() {
    let folder = Folder::new();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.root().join(name);
        std::fs::write(&path, bytes).unwrap();
        path.display().to_string()
    };
    let missing = folder.path("missing.csv");
    assert!(refused(&["identify", &missing]).contains("missing.csv"));
    assert!(refused(&["identify", &folder.root().display().to_string()]).contains("bowden: "));
    refused(&["identify", &file("empty.csv", b"")]);
    refused(&["identify", &file("binary.csv", &[0, 159, 146, 150, 0, 0])]);
    let text = refused(&["identify", &file("text.csv", b"t,x,f\n0,0,0\n0.1,zero,1\n")]);
    assert!(text.contains("text.csv:3") && text.contains('x'), "{text}");
    let good = record(&folder, "good.csv", &["--seconds", "5"]);
    for (option, value) in [
        ("--time-limit", "0"),
        ("--time-limit", "NaN"),
        ("--cutoff", "-1"),
        ("--cutoff", "NaN"),
        ("--cutoff", "900"),
        ("--cutoff", "0.01"),
        ("--start", "99"),
        ("--rate", "0"),
        ("--baseline", "bouc-wen,nonsense"),
        ("--baseline", "viscous,viscous"),
        ("--channel", "phi_p"),
        ("--input", "nowhere"),
        ("--model-out", "model.json"),
    ] {
        let line = refused(&["identify", &good, &format!("{option}={value}")]);
        assert!(line.starts_with("bowden: "), "{line}");
    }
    assert!(refused(&["generate", "--effect", "nonsense"]).contains("nonsense"));
    for (mistyped, meant) in [
        (["identify", "--baseline", "bouc-wen,viscos"], "`viscous`"),
        (["identify", "--baseline", "viscous@phi-p"], "`phi_p`"),
        (["identify", "--max-term", "1"], "'--max-terms'"),
    ] {
        let line = refused(&mistyped);
        assert!(line.contains(meant), "{line}");
    }
    assert!(refused(&["generate", "--effect", "viscous:much"]).contains("much"));
    assert!(refused(&["generate", "--seconds", "0"]).contains("seconds"));
    for taken in ["bowden.h", "Bowden_model.h"] {
        let line = refused(&["export", "--c", "model.toml", "--out", taken]);
        assert!(line.contains("the library uses this name"), "{line}");
    }
    assert!(refused(&["identify", "--no-such-option"]).contains("--no-such-option"));
    assert!(refused(&["compare", "--inertia", "0"])
        .contains("--inertia 0 is out of range; it must be positive"));
    assert!(refused(&["compare", "--delay", "9"]).contains("9 is not in 0..=8"));
    assert!(refused(&["compare", "--noise", "-1"]).contains("--noise -1 is out of range (0"));
}

#[test]
fn a_model_file_is_whole_or_absent_and_reads_back_to_the_same_model() {
    let folder = Folder::new();
    let record = record(
        &folder,
        "r.csv",
        &args("--mode displacement --effect drag-quadratic --seed 5"),
    );
    let path = folder.root().join("model.toml");
    let out = path.display().to_string();
    assert!(bowden(&["identify", &record, "--model-out", &out])
        .status
        .success());
    let file: bowden_lab::export::ModelFile =
        toml::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    let model = file.model::<8>().unwrap();
    assert_eq!(model.terms().len(), file.terms.len());
    assert_eq!(
        model.transmission().unwrap().kappa_eta(),
        file.transmission.as_ref().unwrap().kappa_eta
    );
    assert_eq!(
        file,
        toml::from_str(&toml::to_string(&file).unwrap()).unwrap()
    );

    let unknown = std::fs::read_to_string(&path)
        .unwrap()
        .replace("mode =", "mood =");
    assert!(toml::from_str::<bowden_lab::export::ModelFile>(&unknown).is_err());

    let nowhere = folder.path("no-such-folder/model.toml");
    refused(&["identify", &record, "--model-out", &nowhere]);
    let left: Vec<_> = std::fs::read_dir(folder.root())
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    assert!(
        left.iter().all(|n| !n.to_string_lossy().contains("part")),
        "{left:?}"
    );
}

/// A full disk, where the system has one to try.
#[cfg(target_os = "linux")]
#[test]
fn whatever_is_printed_on_a_full_disk_is_one_line_and_status_two() {
    for arguments in [
        &["--version"][..],
        &["--help"],
        &["identify", "--help"],
        &["help", "terms"],
        &["certify"],
        &["generate", "--mode", "torque"],
    ] {
        let full = std::fs::File::options().write(true).open("/dev/full");
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_bowden"))
            .args(arguments)
            .stdout(full.unwrap())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let line = text(&output.stderr);
        assert_eq!(line.lines().count(), 1, "{arguments:?}: {line}");
        assert!(line.starts_with("bowden: stdout: "), "{line}");
    }
    // Elsewhere both are printed as ever.
    for asked in ["--version", "--help"] {
        let output = bowden(&[asked]);
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
    let plain = record(&folder, "plain.csv", &["--mode", "torque"]);
    let foreign = folder
        .root()
        .join(std::ffi::OsStr::from_bytes(b"l\xe4uft.csv"));
    std::fs::copy(&plain, &foreign).unwrap();
    let closed = |path: &std::path::Path| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_bowden"))
            .args(["identify", "--max-terms", "0", "--json"])
            .arg(path)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0));
        output.stdout
    };
    let found = closed(&foreign);
    let own: serde_json::Value = serde_json::from_slice(&found).unwrap();
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
    let plain = record(&folder, "plain.csv", &["--mode", "torque"]);
    let page = |record: &str, name: &str| {
        let page = folder.path(name);
        let output = bowden(&["identify", record, "--max-terms", "0", "--report", &page]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        std::fs::read_to_string(page).unwrap()
    };
    let pipe = folder.path("pipe.csv");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let content = std::fs::read(&plain).unwrap();
    let writer = {
        let pipe = pipe.clone();
        std::thread::spawn(move || std::fs::write(pipe, content))
    };
    let of_pipe = page(&pipe, "pipe.html");
    writer.join().unwrap().unwrap();
    let of_file = page(&plain, "file.html");
    let is_hash = |word: &&str| word.len() == 64 && word.bytes().all(|b| b.is_ascii_hexdigit());
    let hash = of_file.split(['<', '>']).find(is_hash).unwrap();
    assert!(of_pipe.contains(hash));
}
