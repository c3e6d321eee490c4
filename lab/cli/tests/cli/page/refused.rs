//! What cannot be written or drawn is refused before anything is read.

use crate::shell::{bowden_in, example, refused, refuses_all, Folder};

/// Two outputs in one file, an output over what is read, or one that has no place: nothing is
/// computed, and every file keeps its bytes. Another spelling of a path is the same file.
#[test]
fn no_output_takes_the_place_of_another_file_of_the_command() {
    let folder = Folder::new();
    folder.file("out.html", "before");
    std::fs::copy(example("straight.csv"), folder.path("record.csv")).unwrap();
    for taken in ["taken.toml", "gains-2.toml", "model.vector.csv"] {
        std::fs::create_dir(folder.path(taken)).unwrap();
    }
    let names = folder.names();
    let own = folder.root().file_name().unwrap().to_str().unwrap();
    let both = "another option also writes this file";
    // A record that does not exist, later.csv, would be complained of first if it were read first.
    refuses_all(
        &folder,
        &format!(
            "compare --report out.html --trace out.html => {both}
            compare --report out.html --trace ../{own}/out.html => {both}
            compare --gains out.html --trace ../{own}/out.html => would overwrite
            compare --seconds 3600 --seeds 1000 --report no/page.html => --report
            compare --seconds 3600 --seeds 1000 --trace no/trace.csv => --trace
            identify later.csv --model-out m.toml --trace m.vector.csv => {both}
            identify later.csv --report same.html --plot same.html => {both}
            identify later.csv --report same.html --trace same.html => {both}
            identify later.csv --model-out no/m.toml => --model-out
            identify later.csv --model-out taken.toml => --model-out
            identify later.csv --model-out model.toml => --model-out
            identify later.csv last.csv --per-file gains --model-out gains.toml => --model-out
            identify later.csv --report no/page.html => --report
            identify later.csv --report . => --report
            identify later.csv --plot no/page.svg => --plot
            identify later.csv --plot . => --plot
            identify later.csv --trace no/t.csv => --trace
            identify later.csv --trace . => --trace
            validate out.html later.csv --trace record.csv --plot record.csv => {both}
            validate out.html later.csv --report no/page.html => --report
            validate out.html later.csv --report out.html => would overwrite
            validate out.html later.csv --plot no/page.svg => --plot
            validate out.html later.csv --plot out.html => would overwrite
            validate out.html later.csv --trace no/t.csv => --trace
            validate out.html later.csv --trace out.html => would overwrite
            plan record.csv --out record.csv => would overwrite"
        ),
    );
    // A record that is read and is bad leaves what was there.
    let bad = folder.file("bad.csv", "t,x,f\n0,0,0\n0.1,zero,1\n");
    let out = folder.path("out.html");
    refused(&format!("identify {bad} --report {out}"));
    assert_eq!(folder.read("out.html"), "before");
    std::fs::remove_file(bad).unwrap();
    assert_eq!(folder.names(), names);
}

/// A model or a record that is named by mistake stays, and a name says what is in its file.
#[test]
fn a_name_of_another_form_is_refused_before_anything_is_read() {
    let folder = Folder::new();
    let names = "kept.toml f.png r.csv p.html s.svg c.csv.gz none";
    names
        .split(' ')
        .for_each(|name| drop(folder.file(name, "before")));
    let before = folder.names();
    for (option, fits, expected) in [
        ("--report", "p.html", ".html or .htm"),
        ("--plot", "s.svg", ".svg"),
        ("--trace", "r.csv", ".csv"),
    ] {
        for name in names.split(' ').filter(|name| *name != fits) {
            let output = format!("{option} {name}");
            let line = format!("bowden: {output}: the file name must end in {expected}");
            let mut table = format!(
                "identify later.csv {output} => {line}
                validate later.csv later.csv {output} => {line}"
            );
            if option != "--plot" {
                table += &format!("\ncompare {output} => {line}");
            }
            refuses_all(&folder, &table);
            assert_eq!(folder.read(name), "before");
        }
        // Of a name that fits the record is what is complained of.
        refuses_all(
            &folder,
            &format!("identify later.csv {option} {fits} => later.csv"),
        );
    }
    for name in ["P.HTM", "p.Html"] {
        refuses_all(
            &folder,
            &format!("identify later.csv --report {name} => later.csv"),
        );
    }
    assert_eq!(folder.names(), before);
    // An unknown figure and a figure without a file are bad use.
    for options in ["--plot f.svg --figure pie", "--figure loop"] {
        let output = bowden_in(&folder, &format!("identify r.csv {options}"));
        assert_eq!(output.status.code(), Some(2), "{options}");
        assert!(output.stdout.is_empty());
    }
}
