//! What `bowden validate` does not take: one line, status 2.

use crate::shell::{args, refused, said, Folder};
use bowden_synth::{Mode, Planted, Recipe};

fn model(folder: &Folder, mode: Mode, declare: &str) -> (String, String) {
    let recipe = Recipe {
        effects: vec![Planted::new("viscous")],
        seconds: 10.0,
        ..Recipe::of_one_rig(mode, 75_000)
    };
    let record = folder.planted("own.csv", &recipe);
    let model = folder.path("model.toml");
    said(&args(&format!(
        "identify {record} --max-terms 0 --baseline {declare} --model-out {model}"
    )));
    (model, record)
}

#[test]
fn what_is_no_model_is_refused_with_the_reason() {
    let folder = Folder::new();
    let (model, record) = model(&folder, Mode::Displacement, "bouc-wen,viscous");
    let text = folder.read("model.toml");
    let refuse = |name: &str, bytes: &[u8], word: &str| {
        let path = folder.file(name, bytes);
        let line = refused(&["validate", &path, &record]);
        assert!(line.contains(name) && line.contains(word), "{word}: {line}");
    };
    refuse("words.toml", b"this is no TOML", "TOML");
    refuse("empty.toml", b"", "no schema");
    refuse("binary.toml", &[0, 159, 146, 150], "is not text");
    refuse(
        "other.toml",
        text.replace("bowden.model/1", "bowden.model/9").as_bytes(),
        "bowden.model/9",
    );
    refuse(
        "key.toml",
        text.replace("mode =", "mood =").as_bytes(),
        "mood",
    );
    refuse(
        "effect.toml",
        text.replace("\"viscous\"", "\"sticky\"").as_bytes(),
        "sticky",
    );
    refuse(
        "mode.toml",
        text.replace("\"displacement\"", "\"volts\"").as_bytes(),
        "volts",
    );
    refuse(
        "shape.toml",
        text.replacen("rho = ", "rho = -", 1).as_bytes(),
        "transmission",
    );
    refuse(
        "about.toml",
        text.replace("cutoff_hz = ", "cutoff_hz = \"fast\" # ")
            .as_bytes(),
        "about",
    );
    let none = "schema = \"bowden.model/1\"\nmode = \"displacement\"\nchannels = []\n";
    refuse("nothing.toml", none.as_bytes(), "has no parts");
    refused(&["validate", &folder.path("missing.toml"), &record]);
    refused(&["validate", &folder.path("."), &record]);
    // And the model itself is taken.
    said(&["validate", &model, &record]);
}

#[test]
fn a_record_that_does_not_fit_the_model_is_refused_with_the_reason() {
    let folder = Folder::new();
    let (model, record) = model(&folder, Mode::Torque, "bouc-wen,viscous@phi_p");
    let csv = folder.read("own.csv");
    let without = folder.file("without.csv", csv.replace("phi_p", "angle"));
    let line = refused(&["validate", &model, &without]);
    assert!(
        line.contains("the model reads channel `phi_p`, but"),
        "{line}"
    );
    said(&["validate", &model, &without, "--channel", "phi_p=angle"]);

    let other = folder.planted(
        "other.csv",
        &Recipe {
            seconds: 10.0,
            ..Recipe::of_one_rig(Mode::Displacement, 1)
        },
    );
    let line = refused(&["validate", &model, &other]);
    assert!(line.contains("the model is in torque mode"), "{line}");
    let line = refused(&["validate", &model, &record, "--mode", "displacement"]);
    assert!(line.contains("--mode must be torque"), "{line}");

    // What has nothing to do with the mode is not put down to it.
    for bad in [folder.file("empty.csv", ""), folder.path("missing.csv")] {
        let line = refused(&["validate", &model, &bad]);
        assert!(!line.contains("mode"), "{line}");
    }
    // The cut-off is the model's: nobody has given an option, and the time is to blame.
    let mut rows = csv.lines();
    let header = format!("{}\n", rows.next().unwrap());
    let slow = rows.map(|row| {
        let (time, rest) = row.split_once(',').unwrap();
        format!("{},{rest}\n", 1000.0 * time.parse::<f64>().unwrap())
    });
    let slow = folder.file("slow.csv", header + &slow.collect::<String>());
    let line = refused(&["validate", &model, &slow]);
    assert!(
        line.contains("the model's cut-off of") && line.contains("is the time in seconds?"),
        "{line}"
    );
    // The most that is said to be allowed is.
    let line = refused(&["identify", &record, "--cutoff", "1e6"]);
    let most = line
        .split_once("at most ")
        .unwrap()
        .1
        .split(' ')
        .next()
        .unwrap();
    said(&["identify", &record, "--max-terms", "0", "--cutoff", most]);
    let short: String = csv.lines().take(400).flat_map(|l| [l, "\n"]).collect();
    let line = refused(&["validate", &model, &folder.file("short.csv", short)]);
    assert!(
        line.contains("too short") && !line.contains("--cutoff,"),
        "{line}"
    );
}

#[test]
fn units_are_converted_or_refused() {
    let folder = Folder::new();
    let (model, record) = model(&folder, Mode::Displacement, "bouc-wen,viscous");
    let json = |path: &str| -> serde_json::Value {
        serde_json::from_str(&said(&args(&format!(
            "validate {model} {path} --json --cutoff 8"
        ))))
        .unwrap()
    };
    let own = json(&record);

    // The same motion in metres.
    let csv = folder.read("own.csv");
    let mut metres = String::from("t [s],x [m],f [N]\n");
    for line in csv.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let x: f64 = cells[1].parse().unwrap();
        metres += &format!("{},{},{}\n", cells[0], x / 1000.0, cells[2]);
    }
    let converted = json(&folder.file("metres.csv", metres));
    let (a, b) = (
        own["nrmse"].as_f64().unwrap(),
        converted["nrmse"].as_f64().unwrap(),
    );
    // A division and a multiplication by a thousand.
    assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
    assert!(converted["notes"]
        .to_string()
        .contains("converted from unit m to unit mm"));

    // Without any unit, as in a .mat file, it is in those of the model; with some, all are needed.
    let without = csv.replacen("t [s],x [mm],f [N]", "t,x,f", 1);
    let without = json(&folder.file("without.csv", without));
    assert_eq!(own["nrmse"], without["nrmse"]);
    assert!(without["notes"].to_string().contains("has no units"));

    for (header, word) in [
        ("t [s],x [V],f [N]", "unit V"),
        ("t [s],x,f [N]", "no unit"),
        ("t [s],x [mm],f [Pa]", "unit Pa"),
    ] {
        let path = folder.file("wrong.csv", csv.replacen("t [s],x [mm],f [N]", header, 1));
        let line = refused(&["validate", &model, &path]);
        assert!(
            line.contains("wrong.csv")
                && line.contains(word)
                && line.contains(", but it must have unit ")
                && line.contains(", as in the model"),
            "{line}"
        );
    }
}

#[test]
fn a_trace_that_cannot_be_written_is_refused_before_the_record_is_read() {
    let folder = Folder::new();
    let (model, record) = model(&folder, Mode::Displacement, "bouc-wen,viscous");
    let before = folder.names();
    for path in [
        folder.path("no-such-folder/t.csv"),
        folder.path("."),
        record.clone(),
    ] {
        // A record that does not exist would be complained of first if it were read first.
        let line = refused(&[
            "identify",
            &record,
            &folder.path("later.csv"),
            "--trace",
            &path,
        ]);
        assert!(line.contains("--trace"), "{line}");
        let line = refused(&["validate", &model, &record, "--trace", &path]);
        assert!(line.contains("--trace"), "{line}");
    }
    assert!(refused(&["validate", &model, &record, "--trace", &model]).contains("would overwrite"));
    assert_eq!(folder.names(), before);
}

#[test]
fn a_model_that_cannot_be_written_is_refused_before_the_record_is_read() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("taken.toml")).unwrap();
    std::fs::create_dir(folder.path("gains-2.toml")).unwrap();
    std::fs::create_dir(folder.path("model.vector.csv")).unwrap();
    let before = folder.names();
    // Neither record exists: it would be complained of first if it were read first.
    let (one, two) = (folder.path("later.csv"), folder.path("last.csv"));
    let refuses = |path: &str, more: &[&str]| {
        let path = folder.path(path);
        let line = refused(&[&["identify", &one, "--model-out", &path], more].concat());
        assert!(line.contains("--model-out"), "{line}");
    };
    refuses("no-such-folder/m.toml", &[]);
    refuses("taken.toml", &[]);
    refuses("model.toml", &[]);
    refuses("gains.toml", &[&two, "--per-file", "gains"]);
    assert_eq!(folder.names(), before);
}

/// A model that describes nothing holds nowhere, on its own record neither.
#[test]
fn a_model_whose_verdict_is_no_model_is_refused() {
    let folder = Folder::new();
    let (model, record) = model(&folder, Mode::Displacement, "bouc-wen");
    let mut table: toml::Table = toml::from_str(&folder.read("model.toml")).unwrap();
    let about = table["about"].as_table_mut().unwrap();
    about.insert("verdict".to_owned(), "no-input-dependence".into());
    let none = folder.file("none.toml", toml::to_string(&table).unwrap().as_bytes());
    let line = refused(&["validate", &none, &record]);
    assert!(
        line.contains("none.toml: the model does not describe its own records (verdict `no-input-dependence`)"),
        "{line}"
    );
    said(&["validate", &model, &record]);
}
