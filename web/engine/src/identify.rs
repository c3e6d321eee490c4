//! The model of one or several files, with everything that the program prints and writes.

use crate::options::Choices;
use crate::{command, Answer, File};
use bowden_cli::view::{json, text, Report, Width};
use bowden_lab::facts::{close, model_in_c, Close, Closed, Detail, Form, Handed, Meter};
use bowden_page::{Close as Page, Provenance};

pub(crate) fn identify(
    files: &[&File],
    choices: &Choices,
    tell: &dyn Fn(&str),
) -> Result<Answer, String> {
    if choices.per_file && files.len() < 2 {
        return Err("--per-file gains needs more than one file".to_owned());
    }
    let meter = Meter::start();
    tell("reading");
    let asked = choices.asked()?;
    let bytes: Vec<(&str, &[u8])> = files
        .iter()
        .map(|file| (file.name.as_str(), &file.bytes[..]))
        .collect();
    let (records, sources) = asked.read_together_in_memory(&bytes)?;
    let question = Close {
        asked,
        own_gains: choices.per_file,
        invertible: choices.invertible,
        // The page writes the model files itself; a result may have no exported model.
        models: false,
        trace: true,
        figures: true,
        detail: Detail::EachRound,
        meter,
    };
    let closed = close(&records, &question, tell)?;
    let command = command::identify(files, choices);
    let mut answer = Answer::default();
    write(&mut answer, &closed, choices)?;
    if let Some(figures) = &closed.figures {
        let page = Page {
            facts: &closed.facts,
            figures,
            models: &closed.models,
        };
        let from = Provenance {
            command: command.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            sources,
        };
        answer
            .files
            .push(("report.html".to_owned(), page.page(&from).into_bytes()));
    }
    answer.put("command", command);
    Ok(answer)
}

/// The answer as JSON and text, the trace and the model.
fn write(answer: &mut Answer, closed: &Closed, choices: &Choices) -> Result<(), String> {
    let facts = &closed.facts;
    let report = json(facts, Some(&closed.cost)).map_err(|e| e.to_string())?;
    let shown = text(
        facts,
        Report {
            width: Width::of(80),
            verbose: false,
            chosen_cutoff: choices.cutoff.is_some(),
        },
    );
    let shown = plain(&shown);
    answer.put("label", &facts.label);
    answer.put("headline", headline(&shown));
    answer.put("summary", &facts.sentence);
    answer.put("verdict", facts.verdict.name());
    answer.put("mode", facts.record.mode.name());
    answer.put("notes", &facts.record.notes);
    answer.put("baseline_nrmse", facts.declared.nrmse.held_out);
    answer.put("nrmse", facts.shown().nrmse.held_out);
    answer.put("seconds", closed.cost.seconds.total());
    let mut file = |name: &str, bytes: Vec<u8>| answer.files.push((name.to_owned(), bytes));
    file("result.json", format!("{report}\n").into_bytes());
    file("result.txt", shown.into_bytes());
    if let Some(trace) = &closed.trace {
        file("trace.csv", trace.clone().into_bytes());
    }
    // With separate gains there is one model for each file, numbered as the program does.
    let mut models = Vec::new();
    let mut no_model = facts.hand_over.as_ref().err().cloned();
    for (place, model) in closed.models.iter().enumerate() {
        let name = match closed.models.len() {
            1 => "model".to_owned(),
            _ => format!("model-{}", place + 1),
        };
        match model_files(&name, model, &mut file) {
            Ok(()) => models.push(format!("{name}.toml")),
            Err(line) => no_model = Some(line),
        }
    }
    answer.put("models", models);
    if let Some(line) = no_model {
        answer.put("no_model", line);
    }
    Ok(())
}

/// The model in its three forms, with its test vector. A form that cannot represent a part of the
/// model is left out.
fn model_files(
    name: &str,
    model: &Handed,
    file: &mut impl FnMut(&str, Vec<u8>),
) -> Result<(), String> {
    let toml = model.file(Form::Toml)?;
    let header = std::str::from_utf8(&toml)
        .ok()
        .and_then(|text| model_in_c(text, name).ok());
    file(&format!("{name}.toml"), toml);
    if let Ok(source) = model.file(Form::Rust) {
        file(&format!("{name}.rs"), source);
    }
    if let Some(header) = header {
        file(&format!("{name}.h"), header.into_bytes());
    }
    let vector = model.vector()?.as_bytes().to_vec();
    file(&format!("{name}.vector.csv"), vector);
    Ok(())
}

/// A terminal text without its colours.
pub(crate) fn plain(text: &str) -> String {
    anstream::adapter::strip_str(text).to_string()
}

/// The paragraph below the title of the program's output, one sentence per line.
pub(crate) fn headline(text: &str) -> Vec<String> {
    let paragraph = text.split("\n\n").nth(1).unwrap_or_default();
    paragraph
        .lines()
        .map(|line| line.trim().to_owned())
        .collect()
}
