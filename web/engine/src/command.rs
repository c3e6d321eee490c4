//! The command line that gives the same answer.

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
