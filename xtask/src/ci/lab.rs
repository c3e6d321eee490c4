//! Steps that run the program.

use super::readme;
use super::shell::{fail, text, Done, Shell};
use std::fs;

/// Builds the program and gives its path.
fn program(shell: &Shell) -> Done<String> {
    let messages = shell
        .output("cargo build --release --bin bowden --message-format json-render-diagnostics")?;
    let path = messages.split("\"executable\":\"").nth(1);
    match path.and_then(|path| path.split('"').next()) {
        Some(path) => Ok(path.to_owned()),
        None => fail("cargo has not said where the program is"),
    }
}

/// Checks one cell of the judge per run, in turn: the code must give the last table of the page.
pub fn results(shell: &Shell) -> Done {
    let page = "docs/results/judged.md";
    let commits = shell.ask("git rev-list --count HEAD");
    let commits = commits.map_or(String::new(), |output| text(&output.stdout));
    let commits: usize = commits.trim().parse().unwrap_or(0);
    let cell = ["nulls", "single", "three", "outside"][commits % 4];
    let command = "cargo run --release -p bowden-lab --example judge --";
    println!("    $ {command} {cell}");
    let judged = shell.ask(&format!("{command} {cell}"))?;
    let judged = text(&judged.stdout);
    print!("{judged}");
    if same_row(&fs::read_to_string(shell.root.join(page))?, &judged, cell) {
        return Ok(());
    }
    fail(format!(
        "{page} has another row of {cell} ({command} {cell})"
    ))
}

/// Whether the last row of a cell on the page and the printed one agree in `found` and `false`.
/// Two processors may differ in the last digit, on which a few of these records depend.
fn same_row(page: &str, printed: &str, cell: &str) -> bool {
    let numbers = |line: &str| -> Option<[f64; 2]> {
        let mut words = line.split_whitespace().filter(|word| *word != "|");
        let mut number = || words.next().map(|word| word.parse().unwrap_or(0.0));
        number()?;
        number()?;
        Some([number()?, number()?])
    };
    let is_row = |line: &&str| line.trim_start_matches("| ").split(' ').next() == Some(cell);
    let mut kept = page.lines().filter(|line| line.starts_with('|'));
    let kept = kept.rfind(is_row).and_then(numbers);
    let now = printed.lines().find(is_row).and_then(numbers);
    match (kept, now) {
        (Some(kept), Some(now)) => {
            (kept[0] - now[0]).abs() <= 0.01 && (kept[1] - now[1]).abs() <= 0.02
        }
        _ => false,
    }
}

pub fn ledger(shell: &Shell) -> Done {
    readme::documents(shell, "cargo run --release")?;
    println!("    $ cargo run --release");
    let printed = shell.output("cargo run --release")?;
    print!("{printed}");
    if !printed.to_lowercase().contains("held") {
        return fail("the results table has no held-out error");
    }
    if printed.contains('\x1b') {
        return fail("the output has colours without a terminal");
    }
    Ok(())
}

/// Only the measured times may differ.
pub fn same_bytes(shell: &Shell) -> Done {
    let bowden = program(shell)?;
    let mut counted = Vec::new();
    for _ in 0..2 {
        let json = shell.ask(&format!("{bowden} identify --json"))?;
        if !json.status.success() {
            return fail(text(&json.stderr));
        }
        let json = text(&json.stdout);
        if !json.contains("\"bowden.identify/1\"") {
            return fail("stdout is not the results table in JSON");
        }
        match without_seconds(&json) {
            Some(json) => counted.push(json),
            None => return fail("the results table has no seconds"),
        }
    }
    if counted[0] != counted[1] {
        return fail("two runs gave different results tables");
    }
    Ok(())
}

/// A results table in JSON without its measured times.
fn without_seconds(json: &str) -> Option<String> {
    let (before, rest) = json.split_once("\"seconds\":{")?;
    let (_, after) = rest.split_once('}')?;
    Some(format!("{before}{after}"))
}

pub fn bad_input(shell: &Shell) -> Done {
    let bowden = program(shell)?;
    let mut wrong = String::new();
    for (record, bytes) in [
        ("missing", None),
        ("empty", Some(&b""[..])),
        ("header", Some(b"t,x,f\n")),
        ("text", Some(b"t,x,f\n0,1,2\n1,two,3\n")),
        ("binary", Some(b"\x00\x01\xff\xfe\x00")),
    ] {
        let file = format!("{record}.csv");
        if let Some(bytes) = bytes {
            fs::write(shell.scratch.join(&file), bytes)?;
        }
        let output = shell
            .within(&shell.scratch)
            .ask(&format!("{bowden} identify {file}"))?;
        let error = text(&output.stderr);
        print!("    {error}");
        if output.status.code() != Some(2) {
            wrong += &format!("{record}: {} instead of exit status 2\n    ", output.status);
        }
        let one_line = error.lines().count() == 1 && error.ends_with('\n');
        if !one_line || !output.stdout.is_empty() || error.contains("panicked") {
            wrong += &format!("{record}: not one clear line on stderr and nothing on stdout\n    ");
        }
    }
    if wrong.is_empty() {
        return Ok(());
    }
    fail(wrong.trim_end())
}

#[cfg(test)]
mod tests {
    use super::{same_row, without_seconds};

    const PAGE: &str = "\
| single | 400 | 0.9 | 0.5 |
| nulls | 300 | – | 0.000 |
| single | 400 | 0.980 | 0.015 |
";

    #[test]
    fn a_row_of_the_judge_agrees_with_the_last_one_of_the_page() {
        let agrees = |printed| same_row(PAGE, printed, "single");
        assert!(agrees("judging …\n| single | 400 | 0.980 | 0.015 |\n"));
        assert!(agrees("single 400 0.971 0.034"));
        assert!(!agrees("single 400 0.969 0.015"));
        assert!(!agrees("single 400 0.980 0.036"));
        assert!(!agrees("nulls 400 0.980 0.015"));
        assert!(same_row(PAGE, "| nulls | 300 | – | 0.000 |", "nulls"));
        assert!(!same_row(PAGE, "three 1 1 1", "three"));
    }

    #[test]
    fn a_results_table_without_its_seconds_keeps_the_rest() {
        let json = "{\"cost\":{\"fits\":3,\"seconds\":{\"a\":1,\"b\":2},\"c\":{}}}";
        let rest = without_seconds(json);
        assert_eq!(rest.as_deref(), Some("{\"cost\":{\"fits\":3,,\"c\":{}}}"));
        assert_eq!(without_seconds("{}"), None);
    }
}
