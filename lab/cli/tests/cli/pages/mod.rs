//! The generated pages of `docs/reference`: the commands and the glossary from what the program
//! prints, the effects from the catalogue, the thresholds from their constants, the findings from one
//! example each.
//! `BOWDEN_WRITE_PAGES=1 cargo test -p bowden-cli --test cli pages` writes them.

mod findings;

use crate::shell::{example, said};
use bowden::effect::{Dimension, CATALOGUE};
use bowden_lab::model::mechanism::Mechanism;
use std::fmt::Write as _;

/// The subcommands, in the order of `bowden --help`.
const SUBCOMMANDS: &str =
    "identify validate design compare certify power plan export generate completions man";

/// What `bowden help …` prints, without blanks at the ends of lines.
fn help(topic: &str) -> String {
    let text = said(&format!("help {topic}"));
    let lines: Vec<&str> = text.trim().lines().map(str::trim_end).collect();
    lines.join("\n")
}

fn check(name: &str, page: &str) {
    let path = example(&format!("../../docs/reference/{name}"));
    if std::env::var_os("BOWDEN_WRITE_PAGES").is_some() {
        std::fs::write(&path, page).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(
        kept, page,
        "if this is meant: BOWDEN_WRITE_PAGES=1 cargo test -p bowden-cli --test cli pages"
    );
}

#[test]
fn the_glossary_is_what_the_program_prints() {
    let page = format!(
        "# Glossary\n\nThe output of `bowden help terms`. What to do after a verdict: \
         [verdicts](../howto/verdicts.md).\n\n```text\n{}\n```\n",
        help("terms")
    );
    check("glossary.md", &page);
}

#[test]
fn the_page_of_the_commands_is_what_the_program_prints() {
    let mut page =
        String::from("# Commands\n\nThe output of `bowden help` and of `bowden help COMMAND`.\n");
    for name in std::iter::once("").chain(SUBCOMMANDS.split(' ')) {
        let title = format!("bowden {name}");
        let (title, text) = (title.trim(), help(name));
        write!(page, "\n## {title}\n\n```text\n{text}\n```\n").unwrap();
    }
    check("cli.md", &page);
}

#[test]
fn the_page_of_the_findings_has_each_of_them() {
    check("findings.md", &findings::page());
}

/// The unit of a regressor, in those of the record.
fn unit(of: Dimension) -> String {
    let parts = [
        ("channel unit", of.channel),
        ("load unit", of.load),
        ("output unit", of.output),
        ("input unit", of.input),
        ("s", of.time),
    ];
    let parts = parts.into_iter().filter(|(_, exponent)| *exponent != 0);
    let parts = parts.map(|(name, exponent)| match exponent {
        1 => name.to_owned(),
        n => format!("{name}^{n}"),
    });
    let all = parts.collect::<Vec<_>>().join(" · ");
    [all, "1".to_owned()]
        .into_iter()
        .find(|unit| !unit.is_empty())
        .unwrap_or_default()
}

#[test]
fn the_page_of_the_effects_is_the_catalogue() {
    let mut page = String::from(
        "# Effects\n\nThe catalogue of effects that a model can contain and that `bowden identify` searches. \
         x, v and a are the position, velocity and acceleration of the effect's channel.\n\n\
         | effect | family | mechanism | regressor | unit | memory |\n|---|---|---|---|---|---|\n",
    );
    for info in CATALOGUE {
        let (name, family) = (info.name, info.family);
        let mechanism = Mechanism::of(name, family).name();
        let (formula, unit) = (info.formula.replace('|', "\\|"), unit(info.dimension));
        let memory = if info.memory { "yes" } else { "" };
        let row = format!("`{name}` | {family} | {mechanism} | {formula} | {unit} | {memory}");
        writeln!(page, "| {row} |").unwrap();
    }
    check("effects.md", &page);
}

/// The marks of all rooms and the constants of the search, with their documentation.
const SCALE: &str = include_str!("../../../../identify/src/scale.rs");
const POLICY: &str = include_str!("../../../../identify/src/search/policy.rs");

#[test]
fn the_page_of_the_thresholds_is_their_constants() {
    let mut page = String::from(
        "# Thresholds\n\nThe shared thresholds in `lab/identify/src/scale.rs`, and those of the search in \
         `lab/identify/src/search/policy.rs`. SSE is the squared error on the fit segment. A null is a \
         synthetic record without a missing effect. `operating_characteristics` generates the synthetic \
         records.\n\n| constant | value | meaning and reason |\n|---|---|---|\n",
    );
    let mut words: Vec<&str> = Vec::new();
    for line in SCALE.lines().chain(POLICY.lines()) {
        if let Some(text) = line.strip_prefix("///") {
            words.push(text.trim());
        } else if let Some(rest) = line.strip_prefix("pub const ") {
            let (name, value) = rest.split_once(": ").unwrap();
            let value = value.split_once(" = ").unwrap().1.trim_end_matches(';');
            let all = words.drain(..).filter(|line| !line.is_empty());
            let all = all.collect::<Vec<_>>().join(" ");
            let value = value.replace("core::f64::consts::LN_2", "ln 2");
            writeln!(page, "| `{name}` | {value} | {all} |").unwrap();
        } else {
            words.clear();
        }
    }
    check("thresholds.md", &page);
}
