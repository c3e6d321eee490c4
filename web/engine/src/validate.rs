//! Whether a model is valid for another file.

use crate::identify::{headline, plain};
use crate::options::Choices;
use crate::{command, Answer, File};
use bowden_cli::view::{check_json, check_text, Width};
use bowden_lab::facts::{check_record, CheckQuestion, ModelOfFile, Source};
use bowden_page::{Check as Page, Provenance};

pub(crate) fn validate(
    (name, toml): (&str, &[u8]),
    file: &File,
    choices: &Choices,
) -> Result<Answer, String> {
    let of_model = |message: String| format!("{name}: {message}");
    let text = std::str::from_utf8(toml).map_err(|_| of_model("is not text".to_owned()))?;
    let model = ModelOfFile::parse(text).map_err(of_model)?;
    let mut asked = choices.asked()?;
    asked.options.mode = Some(model.mode());
    let record = asked.read_text(&file.bytes, &file.name)?;
    let question = CheckQuestion {
        asked,
        trace: true,
        figures: true,
    };
    let checked = check_record(&model, record, &question)?;
    let (label, facts) = (&checked.label, &checked.facts);
    let command = command::validate(name, file, choices);
    let mut answer = Answer::default();
    let report = check_json(name, label, facts).map_err(|e| e.to_string())?;
    let shown = plain(&check_text(name, label, facts, Width::of(80)));
    answer.put("label", label);
    answer.put("headline", headline(&shown));
    answer.put("summary", &facts.sentence);
    answer.put("notes", &facts.record.notes);
    let mut own = |name: &str, bytes: Vec<u8>| answer.files.push((name.to_owned(), bytes));
    own("result.json", format!("{report}\n").into_bytes());
    own("result.txt", shown.into_bytes());
    if let Some(trace) = &checked.trace {
        own("trace.csv", trace.clone().into_bytes());
    }
    if let Some(figures) = &checked.figures {
        let page = Page {
            model: name,
            record: label,
            facts,
            figures,
        };
        let from = Provenance {
            command: command.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            sources: vec![
                Source::of_bytes(name, toml),
                Source::of_bytes(&file.name, &file.bytes),
            ],
        };
        own("report.html", page.page(&from).into_bytes());
    }
    answer.put("command", command);
    Ok(answer)
}
