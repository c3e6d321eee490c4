//! What the command prints and writes, and which files it refuses.

use crate::shell::{bowden, example, has, refuses, said, text, Folder};
use serde_json::Value;
use std::process::Command;

/// An example's gains with some texts of it replaced.
fn changed(folder: &Folder, name: &str, texts: &[(&str, &str)]) -> String {
    let mut own = std::fs::read_to_string(example(name)).unwrap();
    for (from, to) in texts {
        assert!(own.contains(from), "{from}");
        own = own.replacen(from, to, 1);
    }
    folder.file("gains.toml", own)
}

/// The whole report, proved or not.
fn certified(path: &str) -> String {
    text(&bowden(&format!("certify {path} --verbose")).stdout).to_owned()
}

/// The number behind some words.
#[track_caller]
fn after(report: &str, words: &str) -> f64 {
    let Some((_, rest)) = report.split_once(words) else {
        panic!("{words}: {report}");
    };
    rest.split([' ', '\n', ','])
        .next()
        .unwrap()
        .parse()
        .unwrap()
}

fn count(report: &str, word: &str) -> usize {
    report.lines().filter(|line| line.starts_with(word)).count()
}

#[test]
fn gains_that_are_proved_are_said_to_be_with_all_nine_inequalities() {
    let report = said(&format!(
        "certify {} --verbose",
        example("gains_table2.toml")
    ));
    let all = "The bound includes every rounding error. The proof also gives |s| <= 0.4170";
    has(
        &report,
        &["  PROVED in f32: |e| <= 0.8340 N·m at every sample\n", all],
    );
    assert_eq!(count(&report, "holds "), 9);
    // Found twice, it is the same to the byte.
    let own = format!("certify {}", example("gains_own.toml"));
    assert_eq!(said(&own), said(&own));
}

/// A limit that the box needs more than: proved where it holds the reference against the load.
#[test]
fn a_limit_that_may_be_met_is_proved_with_its_own_inequalities() {
    let folder = Folder::new();
    let with = |command: &str| {
        let limit = format!("command = {command}");
        changed(&folder, "gains_own.toml", &[("command = 60.0", &limit)])
    };
    let report = certified(&with("41.0"));
    has(&report, &["\n  PROVED", "the command may saturate"]);
    assert_eq!(count(&report, "holds "), 8 + 3);
    assert_eq!(count(&report, "FAILS"), 0);
    // The box is the one without a limit.
    let boxed = |report: &str| {
        let line = report.lines().find(|l| l.starts_with("  PROVED"));
        line.unwrap().to_owned()
    };
    let own = certified(&example("gains_own.toml"));
    assert_eq!(boxed(&report), boxed(&own));
    let asked = format!("certify {} --coq {}", with("41.0"), folder.path("own.v"));
    refuses(&asked, &["theorems/Limit.v"]);
    // What is said to be enough is enough.
    let weak = certified(&with("40.0"));
    let enough = after(&weak, "a command limit of at least ");
    has(&certified(&with(&enough.to_string())), &["\n  PROVED"]);
}

/// What is advised mends: the numbers in the advice, put into the file, are proved.
#[test]
fn gains_that_are_not_proved_exit_with_1_and_what_is_said_to_mend_them_mends() {
    let output = bowden(&format!("certify {}", example("gains_refused.toml")));
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let report = text(&output.stdout);
    has(
        report,
        &["NOT PROVED in f32: h*lambda*g+*(k + delta*q) <= 1"],
    );
    assert_eq!(count(report, "FAILS"), 1);
    let advice = report.lines().find(|l| l.starts_with("  Remedy: "));
    let after = |words: &str| after(advice.unwrap(), words);
    let step = format!("step = {} ", 1.0 / after("a rate of at least "));
    let epsilon = format!("epsilon = {}", after("epsilon of at least "));
    let delta = format!("delta = [0.0, {}]", after("delta_hat up to "));
    let folder = Folder::new();
    for (from, to) in [
        ("step = 0.0005 ", step),
        ("epsilon = 0.015", epsilon),
        ("delta = [0.0, 5.0]", delta),
    ] {
        let path = changed(&folder, "gains_refused.toml", &[(from, &to)]);
        has(&certified(&path), &["\n  PROVED"]);
    }
}

/// The same where k itself is too great, alone or together with delta_hat/epsilon.
#[test]
fn what_is_said_to_mend_a_large_k_mends() {
    let folder = Folder::new();
    let certify = |rate: f64, k: f64, epsilon: f64| {
        let texts = [
            ("step = 0.0005 ", &*format!("step = {} ", 1.0 / rate)),
            ("k = 17.3", &*format!("k = {k}")),
            ("epsilon = 0.015", &*format!("epsilon = {epsilon}")),
        ];
        certified(&changed(&folder, "gains_refused.toml", &texts))
    };
    let (rate, k) = (1000.0, 230.0);
    for (epsilon, words) in [
        (0.1, "or k of at most "),
        (0.015, "or k + delta_hat/epsilon of at most "),
    ] {
        let refused = certify(rate, k, epsilon);
        has(&refused, &["NOT PROVED"]);
        let room = after(&refused, words);
        let (k_room, wider) = match epsilon {
            0.1 => (room, epsilon),
            _ => (0.5 * room, 5.0 / (0.5 * room)),
        };
        let with_k = certify(rate, k_room, wider * (1.0 + 1e-6));
        has(&with_k, &["\n  PROVED"]);
        let with_rate = certify(after(&refused, "a rate of at least "), k, epsilon);
        for report in [with_k, with_rate] {
            let mut lines = report.lines();
            let line = lines.find(|l| l.contains("  h*lambda*g+*(k + delta*q) <= 1"));
            assert!(line.unwrap().starts_with("holds "), "{report}");
        }
    }
}

#[test]
fn both_sides_are_rounded_against_the_inequality() {
    let own = std::fs::read_to_string(example("gains_own.toml")).unwrap();
    let line = own.lines().find(|l| l.starts_with("z_limit = ")).unwrap();
    let folder = Folder::new();
    let certify = |z_limit: f64| -> (String, Value) {
        let limit = format!("z_limit = {z_limit:?}");
        let path = changed(&folder, "gains_own.toml", &[(line, &limit)]);
        let json = bowden(&format!("certify {path} --json")).stdout;
        (certified(&path), serde_json::from_slice(&json).unwrap())
    };
    let value = |own: &Value| own["value"].as_f64().unwrap();
    let (_, json) = certify(0.5);
    let mut all = json["inequalities"].as_array().unwrap().iter();
    let needed = value(&all.find(|own| own["name"] == "z-limit").unwrap()["left"]);
    for factor in [1.0 - 1e-3, 1.0 - 2e-7, 1.0 + 2e-7, 1.0 + 1e-3] {
        let (report, json) = certify(needed * factor);
        let printed = report.lines().filter_map(|line| {
            let (word, rest) = line.split_once("  ")?;
            let (left, rest) = rest.split_once(" <= ")?;
            let number = |text: &str| text.trim().parse::<f64>().ok();
            Some((word, number(left)?, number(rest.split("  ").next()?)?))
        });
        let printed: Vec<_> = printed.collect();
        let all = json["inequalities"].as_array().unwrap();
        assert_eq!(printed.len(), all.len());
        for ((word, left, right), own) in printed.into_iter().zip(all) {
            assert!(left >= value(&own["left"]), "{report}");
            assert!(right <= value(&own["right"]), "{report}");
            assert_eq!(left <= right, word == "holds", "{report}");
        }
        let (_, line) = report.split_once("|w| <= ").unwrap();
        let numbers = line
            .split([' ', ',', '[', ']', '\n'])
            .filter_map(|t| t.parse().ok());
        let shown: Vec<f64> = numbers.take(4).collect();
        let own = [&json["w"], &json["xi"], &json["g"][0], &json["g"][1]].map(value);
        assert!(shown[0] >= own[0] && shown[1] >= own[1], "{report}");
        assert!(shown[2] <= own[2] && shown[3] >= own[3], "{report}");
    }
}

#[test]
fn a_file_that_is_none_is_refused_with_file_line_and_column() {
    let given = std::fs::read_to_string(example("gains_refused.toml")).unwrap();
    let folder = Folder::new();
    // What is replaced (nothing: the line goes), where that is told, and with which words. The last
    // gain is one that the float of the controller cannot hold.
    let table = "
        lambda = 6.1 => lamda = 6.1 => :4:1: `lamda` => unknown field
        lambda = 6.1 => => :1:1: => missing field `lambda`
        epsilon = 0.015 => => :1:1: => missing field `epsilon`
        reference = 25.0 => => :12:1: => missing field `reference`
        rate = 3.0 => => :19:1: => missing field `rate`
        k = 17.3 => k = \"much\" => :3:5: `k` => string
        k = 17.3 => k = nan => :3:5: `k` => must be a finite positive number
        k = 17.3 => k = -1 => :3:5: `k` => must be a finite positive number
        k = 17.3 => k = => :3: => gains.toml
        k = 17.3 => k = 1e300 => gains.toml => gain is not finite
        disturbance = 7.056 => disturbance = inf => :14:15: `disturbance` => finite
        [0.9, 1.1] => [0.9, 1.0, 1.1] => :9:8: `beta` => a pair of
        [0.9, 1.1] => [0.9] => :9:8: `beta` => a pair of
        [0.9, 1.1] => [1.1, 0.9] => :9:8: `beta` => lower one first
        [0.92, 1.04] => [0.0, 1.04] => :13:9: `alpha` => positive
        [0.0, 5.0] => [-1, 5.0] => :10:9: `delta` => zero or positive
        \"f32\" => \"f16\" => :2:9: `float` => f16
        \"f32\" => \"f16\" => :2:9: `float` => f64";
    for row in table.lines().skip(1) {
        let cells: Vec<&str> = row.split("=>").map(str::trim).collect();
        let [from, to, place, part] = cells[..] else {
            panic!("{row}");
        };
        let line = given.lines().find(|line| line.contains(from)).unwrap();
        let other = match to {
            "" => given.replacen(&format!("{line}\n"), "", 1),
            _ => given.replacen(line, &line.replacen(from, to, 1), 1),
        };
        let path = folder.file("gains.toml", other);
        refuses(&format!("certify {path}"), &["gains.toml", place, part]);
    }
    refuses("certify absent.toml", &["absent.toml"]);
    let own = std::fs::read_to_string(example("gains_own.toml")).unwrap();
    let (before, rest) = own.split_once("[plant]").unwrap();
    let (_, behind) = rest.split_once("[[regressor]]").unwrap();
    let bare = folder.file("bare.toml", format!("{before}[[regressor]]{behind}"));
    refuses(
        &format!("certify {bare}"),
        &[
            "bare.toml: has no [plant]; add a [plant] table with alpha = [least, greatest], ",
            "disturbance, disturbance_rate, reference and reference_rate",
        ],
    );
}

#[test]
fn what_is_not_proved_or_has_no_place_is_not_written() {
    let folder = Folder::new();
    let (own, both) = (example("gains_own.toml"), folder.file("same.v", "mine"));
    let refused = example("gains_refused.toml");
    let output = bowden(&format!("certify {refused} --coq {}", folder.path("r.v")));
    assert_eq!(output.status.code(), Some(1));
    let nowhere = folder.path("none/c.v");
    refuses(&format!("certify {own} --coq {nowhere}"), &["--coq"]);
    let another = ["--gappa", "another option also writes this file"];
    refuses(
        &format!("certify {own} --coq {both} --gappa {both}"),
        &another,
    );
    // Without gains of one's own there is nothing to write.
    let output = bowden(&format!("certify --coq {both}"));
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(folder.read("same.v"), "mine");
    assert_eq!(folder.names(), ["same.v"]);
}

/// Whether Gappa takes a file; `None` where it is not there.
fn gappa_takes(file: &str) -> Option<bool> {
    let run = Command::new("gappa").arg(file).output();
    if run.is_err() {
        println!("skipped: gappa is not there");
    }
    run.ok().map(|output| output.status.success())
}

#[test]
fn gappa_takes_the_roundings_and_refuses_smaller_ones() {
    let folder = Folder::new();
    let script = folder.path("c.g");
    for (name, float) in [
        ("gains_table2.toml", "\"f32\""),
        ("gains_own.toml", "\"f32\""),
        ("gains_own.toml", "\"f64\""),
    ] {
        let gains = changed(&folder, name, &[("\"f32\"", float)]);
        said(&format!(
            "certify {gains} --coq {} --gappa {script}",
            folder.path("c.v")
        ));
        assert_ne!(gappa_takes(&script), Some(false), "{name} {float}");
        // The last bound, a quarter of it.
        let text = folder.read("c.g");
        let (before, last) = text.trim_end().rsplit_once("<= ").unwrap();
        let (mantissa, exponent) = last.trim_end_matches(" }").split_once('b').unwrap();
        let smaller = exponent.parse::<i32>().unwrap() - 2;
        let tampered = format!("{before}<= {mantissa}b{smaller} }}\n");
        let tampered = folder.file("tampered.g", tampered);
        assert_ne!(gappa_takes(&tampered), Some(true), "{name} {float}");
    }
}
