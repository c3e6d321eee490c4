//! The command line that gives the same answer.

use crate::control::{Trials, Wanted};
use crate::options::Choices;
use crate::{File, EXAMPLE};
use bowden_cli::quoted;

/// `bowden identify` with the files and the options.
pub(crate) fn identify(files: &[&File], choices: &Choices) -> String {
    let mut words = vec!["bowden".to_owned(), "identify".to_owned()];
    words.extend(records(files));
    words.extend(columns(choices));
    let mut option = |name: &str, value: Option<String>| {
        words.extend(value.into_iter().flat_map(|v| [name.to_owned(), v]));
    };
    let list = |all: &[String]| (!all.is_empty()).then(|| all.join(","));
    option("--baseline", list(&choices.baseline));
    option("--max-terms", choices.max_terms.map(|n| n.to_string()));
    option("--time-limit", choices.time_limit.map(|s| s.to_string()));
    option("--per-file", choices.per_file.then(|| "gains".to_owned()));
    if choices.invertible {
        words.push("--invertible".to_owned());
    }
    words.extend(["--report".to_owned(), "report.html".to_owned()]);
    line(&words)
}

/// `bowden validate` with the model, the file and the options.
pub(crate) fn validate(model: &str, file: &File, choices: &Choices) -> String {
    let mut words = vec!["bowden".to_owned(), "validate".to_owned(), model.to_owned()];
    words.extend(records(&[file]));
    words.extend(columns(choices));
    words.extend(["--report".to_owned(), "report.html".to_owned()]);
    line(&words)
}

/// `bowden design` with the model and the options.
pub(crate) fn design(model: &str, wanted: &Wanted) -> String {
    let mut words = vec!["bowden".to_owned(), "design".to_owned(), model.to_owned()];
    words.extend(numbers([
        ("--rate", Some(wanted.rate)),
        ("--delay", Some(wanted.delay)),
        ("--noise", wanted.noise),
        ("--drive-gain", wanted.drive_gain),
    ]));
    words.extend(["--out".to_owned(), "gains.toml".to_owned()]);
    line(&words)
}

/// `bowden compare` with the model, the gains and the options.
pub(crate) fn compare(model: &str, gains: Option<&str>, trials: &Trials) -> String {
    let mut words = vec!["bowden".to_owned(), "compare".to_owned()];
    words.extend(["--model".to_owned(), model.to_owned()]);
    words.extend(
        gains
            .into_iter()
            .flat_map(|g| ["--gains".to_owned(), g.to_owned()]),
    );
    for (flag, is_set) in [("--varying", trials.varying), ("--gait", trials.gait)] {
        words.extend(is_set.then(|| flag.to_owned()));
    }
    if let Some(seeds) = trials.seeds {
        words.extend(["--seeds".to_owned(), seeds.to_string()]);
    }
    words.extend(numbers([
        ("--seconds", trials.seconds),
        ("--noise", trials.noise),
    ]));
    words.extend(numbers(trials.rig.options()));
    words.extend(["--report".to_owned(), "report.html".to_owned()]);
    line(&words)
}

/// The options that have a value.
fn numbers<const N: usize>(all: [(&str, Option<f64>); N]) -> impl Iterator<Item = String> + '_ {
    all.into_iter()
        .filter_map(|(name, value)| Some([name.to_owned(), value?.to_string()]))
        .flatten()
}

fn line(words: &[String]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| quoted(word)).collect();
    quoted.join(" ")
}

/// The files on the command line; the program needs none for the built-in record.
fn records(files: &[&File]) -> Vec<String> {
    let own = files.iter().filter(|file| file.name != EXAMPLE);
    own.map(|file| file.name.clone()).collect()
}

fn columns(choices: &Choices) -> Vec<String> {
    let number = |value: Option<f64>| value.map(|v| v.to_string());
    let whole = |value: Option<usize>| value.map(|v| v.to_string());
    let names = (!choices.names.is_empty()).then(|| choices.names.join(","));
    let channels = choices.channels.iter();
    let channels = channels.map(|(name, column)| ("--channel", Some(format!("{name}={column}"))));
    let mut words: Vec<String> = [
        ("--mode", choices.mode.clone()),
        ("--time", choices.time.clone()),
        ("--input", choices.input.clone()),
        ("--output", choices.output.clone()),
    ]
    .into_iter()
    .chain(channels)
    .chain([
        ("--start", number(choices.start)),
        ("--end", number(choices.end)),
        ("--cutoff", number(choices.cutoff)),
        ("--rate", number(choices.rate)),
        ("--header-line", whole(choices.header_line)),
        ("--segment", whole(choices.segment)),
        ("--sheet", choices.sheet.clone()),
        ("--names", names),
    ])
    .filter_map(|(name, value)| Some([name.to_owned(), value?]))
    .flatten()
    .collect();
    if choices.drop_bad {
        words.push("--drop-bad".to_owned());
    }
    words
}
