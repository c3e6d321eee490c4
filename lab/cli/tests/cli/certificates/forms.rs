//! What the command prints, and which files it refuses.

use crate::shell::{bowden, example, refused, said, text, Folder};

#[test]
fn gains_that_are_proved_are_said_to_be_with_all_nine_inequalities() {
    let report = said(&["certify", &example("gains_table2.toml"), "--verbose"]);
    assert!(
        report.contains("  PROVED in f32: |e| <= 0.8340 N·m at every sample\n")
            && report.contains(
                "The bound includes every rounding error. The proof also gives |s| <= 0.4170"
            ),
        "{report}"
    );
    assert_eq!(
        report.lines().filter(|l| l.starts_with("holds ")).count(),
        9
    );
    let report = said(&["certify", &example("gains_own.toml")]);
    assert!(
        report.contains("|e| <= 3.22") && report.contains("|s| <= 1.61"),
        "{report}"
    );
    // Found twice, it is the same to the byte.
    assert_eq!(report, said(&["certify", &example("gains_own.toml")]));
}

/// A limit that the box needs more than: proved where it holds the reference against the load.
#[test]
fn a_limit_that_may_be_met_is_proved_with_its_own_inequalities() {
    let own = std::fs::read_to_string(example("gains_own.toml")).unwrap();
    let folder = Folder::new();
    let path = folder.root().join("gains.toml");
    let with = |command: &str| {
        let limit = format!("command = {command}");
        std::fs::write(&path, own.replace("command = 60.0", &limit)).unwrap();
        bowden(&["certify", path.to_str().unwrap(), "--verbose"])
    };
    let report = with("41.0");
    assert!(report.status.success(), "{report:?}");
    let report = text(&report.stdout).to_owned();
    assert!(
        report.contains("\n  PROVED") && report.contains("the command may saturate"),
        "{report}"
    );
    let holds = report.lines().filter(|l| l.starts_with("holds "));
    assert_eq!(holds.count(), 8 + 3, "{report}");
    assert!(!report.contains("FAILS"), "{report}");
    // What is said to be enough is enough, and the box is the one without a limit.
    let weak = text(&with("40.0").stdout).to_owned();
    let (_, enough) = weak.split_once("a command limit of at least ").unwrap();
    let enough = enough.split(' ').next().unwrap();
    let mended = text(&with(enough).stdout).to_owned();
    assert!(mended.contains("\n  PROVED"), "{enough}: {mended}");
    let box_of = |report: &str| {
        let line = report.lines().find(|l| l.starts_with("  PROVED"));
        line.unwrap().to_owned()
    };
    assert_eq!(
        box_of(&report),
        box_of(&said(&["certify", &example("gains_own.toml")]))
    );
    let coq = folder.root().join("own.v");
    let (path, coq) = (path.to_str().unwrap(), coq.to_str().unwrap());
    let line = refused(&["certify", path, "--coq", coq]);
    assert!(line.contains("theorems/Limit.v"), "{line}");
}

#[test]
fn gains_that_are_not_proved_exit_with_1_and_say_what_would_mend_them() {
    let output = bowden(&["certify", &example("gains_refused.toml")]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let report = text(&output.stdout);
    assert!(
        report.contains("NOT PROVED in f32: h*lambda*g+*(k + delta*q) <= 1"),
        "{report}"
    );
    assert_eq!(report.lines().filter(|l| l.starts_with("FAILS")).count(), 1);
    let mend = report
        .lines()
        .find(|l| l.starts_with("  Remedy: "))
        .unwrap();
    for part in [
        "a rate of at least",
        "epsilon of at least",
        "delta_hat up to",
    ] {
        assert!(mend.contains(part), "{mend}");
    }
}

/// The gains of `gains_refused.toml` with one line changed.
fn changed(from: &str, to: &str) -> (Folder, String) {
    let given = std::fs::read_to_string(example("gains_refused.toml")).unwrap();
    assert!(given.contains(from), "{from}");
    let folder = Folder::new();
    let path = folder.root().join("gains.toml");
    std::fs::write(&path, given.replacen(from, to, 1)).unwrap();
    (folder, path.to_str().unwrap().to_owned())
}

/// What is advised mends: the numbers in the advice, put into the file, are proved.
#[test]
fn what_is_said_to_mend_mends() {
    let advice = bowden(&["certify", &example("gains_refused.toml")]);
    let advice = text(&advice.stdout)
        .lines()
        .find(|l| l.starts_with("  Remedy: "))
        .unwrap()
        .to_owned();
    let after = |words: &str| -> f64 {
        let (_, rest) = advice.split_once(words).unwrap();
        rest.split_whitespace().next().unwrap().parse().unwrap()
    };
    let rate = after("a rate of at least ");
    for (from, to) in [
        ("step = 0.0005 ", format!("step = {} ", 1.0 / rate)),
        (
            "epsilon = 0.015",
            format!("epsilon = {}", after("epsilon of at least ")),
        ),
        (
            "delta = [0.0, 5.0]",
            format!("delta = [0.0, {}]", after("delta_hat up to ")),
        ),
    ] {
        let (_folder, path) = changed(from, &to);
        let report = said(&["certify", &path]);
        assert!(report.contains("\n  PROVED"), "{to}: {report}");
    }
}

/// The same where k itself is too great, alone or together with delta_hat/epsilon.
#[test]
fn what_is_said_to_mend_a_large_k_mends() {
    let given = std::fs::read_to_string(example("gains_refused.toml")).unwrap();
    let folder = Folder::new();
    let path = folder.root().join("gains.toml");
    let path = path.to_str().unwrap();
    let certify = |rate: f64, k: f64, epsilon: f64| {
        let own = given
            .replace("step = 0.0005 ", &format!("step = {} ", 1.0 / rate))
            .replace("k = 17.3", &format!("k = {k}"))
            .replace("epsilon = 0.015", &format!("epsilon = {epsilon}"));
        std::fs::write(path, own).unwrap();
        text(&bowden(&["certify", path, "--verbose"]).stdout).to_owned()
    };
    let after = |report: &str, words: &str| -> f64 {
        let (_, rest) = report
            .split_once(words)
            .unwrap_or_else(|| panic!("{words}: {report}"));
        let number = rest.split([' ', '\n', ',']).next().unwrap();
        number.parse().unwrap()
    };
    for (epsilon, words) in [
        (0.1, "or k of at most "),
        (0.015, "or k + delta_hat/epsilon of at most "),
    ] {
        let (rate, k) = (1000.0, 230.0);
        let refused = certify(rate, k, epsilon);
        assert!(refused.contains("NOT PROVED"), "{refused}");
        let room = after(&refused, words);
        let (k_room, wider) = match epsilon {
            0.1 => (room, epsilon),
            _ => (0.5 * room, 5.0 / (0.5 * room)),
        };
        let with_k = certify(rate, k_room, wider * (1.0 + 1e-6));
        let holds = |report: &str| {
            let line = report
                .lines()
                .find(|l| l.contains("  h*lambda*g+*(k + delta*q) <= 1"));
            line.is_some_and(|l| l.starts_with("holds "))
        };
        assert!(holds(&with_k), "{k_room}, {wider}: {with_k}");
        assert!(with_k.contains("\n  PROVED"), "{k_room}, {wider}: {with_k}");
        let with_rate = certify(after(&refused, "a rate of at least "), k, epsilon);
        assert!(holds(&with_rate), "{with_rate}");
    }
}

#[test]
fn both_sides_are_rounded_against_the_inequality() {
    let own = std::fs::read_to_string(example("gains_own.toml")).unwrap();
    let folder = Folder::new();
    let path = folder.root().join("gains.toml");
    let certify = |z_limit: f64| {
        let line = own.lines().find(|l| l.starts_with("z_limit = ")).unwrap();
        std::fs::write(&path, own.replace(line, &format!("z_limit = {z_limit:?}"))).unwrap();
        let path = path.to_str().unwrap();
        let json = bowden(&["certify", path, "--json"]).stdout;
        let json: serde_json::Value = serde_json::from_slice(&json).unwrap();
        (
            text(&bowden(&["certify", path, "--verbose"]).stdout).to_owned(),
            json,
        )
    };
    let needed = certify(0.5).1["inequalities"]
        .as_array()
        .unwrap()
        .iter()
        .find(|own| own["name"] == "z-limit")
        .and_then(|own| own["left"]["value"].as_f64())
        .unwrap();
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
            let value = |side: &str| own[side]["value"].as_f64().unwrap();
            assert!(left >= value("left") && right <= value("right"), "{report}");
            assert_eq!(left <= right, word == "holds", "{report}");
        }
        let (_, line) = report.split_once("|w| <= ").unwrap();
        let mut numbers = line
            .split([' ', ',', '[', ']', '\n'])
            .filter_map(|t| t.parse().ok());
        let mut next = || -> f64 { numbers.next().unwrap() };
        let value = |own: &serde_json::Value| own["value"].as_f64().unwrap();
        assert!(
            next() >= value(&json["w"]) && next() >= value(&json["xi"]),
            "{report}"
        );
        assert!(
            next() <= value(&json["g"][0]) && next() >= value(&json["g"][1]),
            "{report}"
        );
    }
}

#[test]
fn a_file_that_is_none_is_refused_with_file_line_and_column() {
    for (from, to, parts) in [
        (
            "lambda = 6.1",
            "lamda = 6.1",
            &["gains.toml:4:1: `lamda`", "unknown field"][..],
        ),
        (
            "lambda = 6.1            # [1/s]\n",
            "",
            &["gains.toml:1:1: ", "missing field `lambda`"],
        ),
        (
            "reference = 25.0        # |y_r| [N·m]\n",
            "",
            &["gains.toml:12:1: ", "missing field `reference`"],
        ),
        (
            "rate = 3.0",
            "",
            &["gains.toml:19:1: ", "missing field `rate`"],
        ),
        (
            "k = 17.3",
            "k = \"much\"",
            &["gains.toml:3:5: `k`", "string"],
        ),
        (
            "k = 17.3",
            "k = nan",
            &["gains.toml:3:5: `k`", "must be a finite positive number"],
        ),
        (
            "k = 17.3",
            "k = -1",
            &["gains.toml:3:5: `k`", "must be a finite positive number"],
        ),
        (
            "disturbance = 7.056",
            "disturbance = inf",
            &["gains.toml:14:15: `disturbance`", "finite"],
        ),
        (
            "beta = [0.9, 1.1]",
            "beta = [0.9, 1.0, 1.1]",
            &["gains.toml:9:8: `beta`", "a pair of"],
        ),
        (
            "beta = [0.9, 1.1]",
            "beta = [0.9]",
            &["gains.toml:9:8: `beta`", "a pair of"],
        ),
        (
            "beta = [0.9, 1.1]",
            "beta = [1.1, 0.9]",
            &["gains.toml:9:8: `beta`", "lower one first"],
        ),
        (
            "alpha = [0.92, 1.04]",
            "alpha = [0.0, 1.04]",
            &["gains.toml:13:9: `alpha`", "positive"],
        ),
        (
            "delta = [0.0, 5.0]",
            "delta = [-1, 5.0]",
            &["gains.toml:10:9: `delta`", "zero or positive"],
        ),
        (
            "float = \"f32\"",
            "float = \"f16\"",
            &["gains.toml:2:9: `float`", "f16", "f64"],
        ),
        ("k = 17.3", "k = ", &["gains.toml:3:"]),
    ] {
        let (_folder, path) = changed(from, to);
        let line = refused(&["certify", &path]);
        for part in parts {
            assert!(line.contains(part), "{to:?}: {part:?} is missing in {line}");
        }
    }
}

#[test]
fn a_file_that_is_absent_or_a_gain_beyond_its_float_is_refused() {
    let line = refused(&["certify", "absent.toml"]);
    assert!(line.contains("absent.toml"), "{line}");
    // A gain that the float of the controller cannot hold.
    let (_folder, path) = changed("k = 17.3", "k = 1e300");
    assert!(refused(&["certify", &path]).contains("gain is not finite"));
}

#[test]
fn one_file_for_both_checkers_is_refused_and_what_was_there_stays() {
    let folder = Folder::new();
    let both = folder.root().join("same.v");
    std::fs::write(&both, "mine").unwrap();
    let own = example("gains_own.toml");
    let path = both.to_str().unwrap();
    let line = refused(&["certify", &own, "--coq", path, "--gappa", path]);
    assert!(
        line.contains("--gappa") && line.contains("another option also writes this file"),
        "{line}"
    );
    assert_eq!(std::fs::read_to_string(&both).unwrap(), "mine");
    assert_eq!(std::fs::read_dir(folder.root()).unwrap().count(), 1);
}

#[test]
fn gains_without_their_plant_are_told_what_was_expected() {
    let own = std::fs::read_to_string(example("gains_own.toml")).unwrap();
    let (before, rest) = own.split_once("[plant]").unwrap();
    let (_, behind) = rest.split_once("[[regressor]]").unwrap();
    let folder = Folder::new();
    let path = folder.root().join("bare.toml");
    std::fs::write(&path, format!("{before}[[regressor]]{behind}")).unwrap();
    let line = refused(&["certify", path.to_str().unwrap()]);
    let expected = "bare.toml: has no [plant]; add a [plant] table with alpha = [least, greatest], disturbance, disturbance_rate, reference and reference_rate";
    assert!(line.ends_with(expected), "{line}");
    // What else is missing is told without the comment at the head of the file.
    std::fs::write(&path, own.replace("epsilon = 0.08", "")).unwrap();
    let line = refused(&["certify", path.to_str().unwrap()]);
    assert!(
        line.ends_with("bare.toml:1:1: missing field `epsilon`"),
        "{line}"
    );
}
