//! What cannot be drawn is refused before anything is read.

use crate::shell::{args, bowden, example, refused, said, Folder};

#[test]
fn a_page_that_cannot_be_written_is_refused_before_the_record_is_read() {
    let folder = Folder::new();
    // A record that does not exist would be complained of first if it were read first.
    let missing = folder.path("later.csv");
    let model = folder.path("model.toml");
    said(&[
        "identify",
        &example("straight.csv"),
        "--max-terms",
        "0",
        "--model-out",
        &model,
    ]);
    let before = folder.names();
    for option in ["--report", "--plot"] {
        for place in ["no-such-folder/page.html", "."] {
            let path = folder.path(place);
            for command in [
                vec!["identify", &missing],
                vec!["validate", &model, &missing],
            ] {
                let line = refused(&[command.as_slice(), &[option, &path]].concat());
                assert!(line.contains(option), "{line}");
            }
        }
        let line = refused(&["validate", &model, &missing, option, &model]);
        assert!(line.contains("would overwrite"), "{line}");
    }
    let nowhere = folder.path("no-such-folder/page.html");
    let line = refused(&args(&format!(
        "compare --seconds 3600 --seeds 1000 --report {nowhere}"
    )));
    assert!(line.contains("--report"), "{line}");
    let same = folder.path("same.html");
    for other in ["--plot", "--trace"] {
        let line = refused(&["identify", &missing, "--report", &same, other, &same]);
        assert!(
            line.contains("another option also writes this file"),
            "{line}"
        );
    }
    assert_eq!(folder.names(), before);
}

/// Two outputs in one file, or an output over what is read: nothing is computed, and every file
/// keeps its bytes. Another spelling of a path is the same file.
#[test]
fn no_output_takes_the_place_of_another_file_of_the_command() {
    let folder = Folder::new();
    let (missing, record) = (folder.path("later.csv"), folder.path("record.csv"));
    let (model, out) = (folder.path("model.toml"), folder.path("out.html"));
    let vector = folder.path("model.vector.csv");
    let name = folder.root().file_name().unwrap().to_str().unwrap();
    let other = folder.path(&format!("../{name}/out.html"));
    std::fs::write(&out, "before").unwrap();
    std::fs::copy(example("straight.csv"), &record).unwrap();
    let names = folder.names();
    let both = "another option also writes this file";
    let over = "would overwrite";
    let short = ["compare", "--seconds", "8", "--seeds", "1"];
    for (arguments, part) in [
        (
            [&short[..], &["--report", &out, "--trace", &out]].concat(),
            both,
        ),
        (
            [&short[..], &["--report", &out, "--trace", &other]].concat(),
            both,
        ),
        (vec!["compare", "--gains", &out, "--trace", &other], over),
        (
            vec![
                "identify",
                &missing,
                "--model-out",
                &model,
                "--trace",
                &vector,
            ],
            both,
        ),
        (
            vec![
                "validate", &missing, &missing, "--trace", &out, "--plot", &other,
            ],
            both,
        ),
        (vec!["plan", &record, "--out", &record], over),
    ] {
        let line = refused(&arguments);
        assert!(line.contains(part), "{line}");
        assert_eq!(folder.read("out.html"), "before");
        assert_eq!(folder.names(), names);
    }
    let line = refused(&[short.as_slice(), &["--trace", &folder.path("no/trace.csv")]].concat());
    assert!(line.contains("--trace"), "{line}");
}

/// A model or a record that is named by mistake stays, and a name says what is in its file.
#[test]
fn a_name_of_another_form_is_refused_before_anything_is_read() {
    let folder = Folder::new();
    let missing = folder.path("later.csv");
    let short = ["compare", "--seconds", "8", "--seeds", "1"];
    let names = [
        "kept.toml",
        "f.png",
        "r.csv",
        "p.html",
        "s.svg",
        "c.csv.gz",
        "none",
    ];
    for name in names {
        std::fs::write(folder.path(name), "before").unwrap();
    }
    let before = folder.names();
    for (option, fits, expected) in [
        ("--report", "p.html", ".html or .htm"),
        ("--plot", "s.svg", ".svg"),
        ("--trace", "r.csv", ".csv"),
    ] {
        for name in names.into_iter().filter(|name| *name != fits) {
            let path = folder.path(name);
            let mut commands = vec![
                vec!["identify", &missing, option, &path],
                vec!["validate", &missing, &missing, option, &path],
            ];
            if option != "--plot" {
                commands.push([&short[..], &[option, &path]].concat());
            }
            for command in commands {
                assert_eq!(
                    refused(&command),
                    format!("bowden: {option} {path}: the file name must end in {expected}")
                );
            }
            assert_eq!(folder.read(name), "before");
        }
        // Of a name that fits the record is what is complained of.
        let line = refused(&["identify", &missing, option, &folder.path(fits)]);
        assert!(line.contains("later.csv"), "{line}");
    }
    for name in ["P.HTM", "p.Html"] {
        let line = refused(&["identify", &missing, "--report", &folder.path(name)]);
        assert!(line.contains("later.csv"), "{line}");
    }
    assert_eq!(folder.names(), before);
}

#[test]
fn a_bad_record_leaves_the_page_that_was_there() {
    let folder = Folder::new();
    let (bad, page) = (folder.path("bad.csv"), folder.path("page.html"));
    std::fs::write(&bad, "t,x,f\n0,0,0\n0.1,zero,1\n").unwrap();
    std::fs::write(&page, "before").unwrap();
    refused(&["identify", &bad, "--report", &page]);
    assert_eq!(folder.read("page.html"), "before");
    assert_eq!(folder.names(), ["bad.csv", "page.html"]);
}

#[test]
fn an_unknown_figure_and_a_figure_without_a_file_are_bad_use() {
    let record = example("straight.csv");
    let out = Folder::new().path("f.svg");
    for arguments in [
        vec!["identify", &record, "--plot", &out, "--figure", "pie"],
        vec!["identify", &record, "--figure", "loop"],
    ] {
        let output = bowden(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty());
    }
}
