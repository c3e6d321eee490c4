//! The lab in a browser tab: bytes in, the program's answers out.
//!
//! A request is one line of JSON, optionally followed by the bytes of a file. An answer is one line
//! of JSON, followed by its files. An [`Engine`] keeps the files that were added and answers
//! [one request](Engine::answer) after another. It computes nothing itself: every answer comes from
//! [`bowden_lab::facts`], in the views of the program `bowden`, so the tab and the terminal show
//! the same numbers.
//!
//! In WebAssembly, `abi` passes these bytes to and from JavaScript; it is the only unsafe code.

#[cfg(target_family = "wasm")]
mod abi;
mod answer;
mod command;
mod control;
mod identify;
mod look;
mod options;
mod shape;
mod validate;

pub use answer::Answer;

use control::{Trials, Wanted};
use options::Choices;
use serde::Deserialize;

/// The label of the built-in record, as the program writes it.
pub const EXAMPLE: &str =
    "built-in synthetic record (bowden generate --mode torque --effect viscous --seed 7)";

/// A file that was added.
struct File {
    name: String,
    bytes: Vec<u8>,
}

/// The files of a tab.
#[derive(Default)]
pub struct Engine {
    files: Vec<File>,
}

/// A request of the page.
#[derive(Deserialize)]
#[serde(tag = "ask", rename_all = "kebab-case")]
enum Request {
    /// Keeps the file whose bytes follow; it replaces a file of the same name.
    Add { name: String },
    /// Keeps the built-in record.
    Example,
    /// The columns of a file, and the reader's messages about the file.
    Look {
        file: String,
        #[serde(default)]
        choices: Choices,
    },
    /// The model of one or several files.
    Identify {
        files: Vec<String>,
        #[serde(default)]
        choices: Choices,
    },
    /// The hysteresis state along an input, whose bytes follow.
    Shape {
        /// rho, sigma, n and the initial state.
        parameters: [f64; 4],
    },
    /// Whether a model, whose bytes follow, is valid for a file.
    Validate {
        model: String,
        file: String,
        #[serde(default)]
        choices: Choices,
    },
    /// Controller gains for a model, whose bytes follow.
    Design { model: String, options: Wanted },
    /// Controllers on the simulated rig, with a file of a model and one of gains for it.
    Compare {
        model: String,
        gains: Option<String>,
        #[serde(default)]
        options: Trials,
    },
}

impl Engine {
    /// Answers a request: a line of JSON and the bytes that follow it. `tell` receives one message
    /// per step.
    #[must_use]
    pub fn answer(&mut self, request: &[u8], tell: &dyn Fn(&str)) -> Answer {
        match self.answered(request, tell) {
            Ok(answer) => answer,
            Err(line) => Answer::refusal(&line),
        }
    }

    fn answered(&mut self, request: &[u8], tell: &dyn Fn(&str)) -> Result<Answer, String> {
        let end = request.iter().position(|byte| *byte == b'\n');
        let (line, rest) = request.split_at(end.unwrap_or(request.len()));
        let bytes = rest.get(1..).unwrap_or_default();
        let request: Request = serde_json::from_slice(line).map_err(|e| format!("request: {e}"))?;
        match request {
            Request::Add { name } => {
                self.keep(name, bytes.to_vec());
                Ok(Answer::default())
            }
            Request::Example => {
                let stored = bowden_synth::stored_csv();
                self.keep(EXAMPLE.to_owned(), stored.into_bytes());
                Ok(Answer::default())
            }
            Request::Look { file, choices } => look::look(self.file(&file)?, &choices),
            Request::Identify { files, .. } if files.is_empty() => {
                Err("no file is chosen".to_owned())
            }
            Request::Identify { files, choices } => {
                let files: Vec<&File> = files
                    .iter()
                    .map(|name| self.file(name))
                    .collect::<Result<_, _>>()?;
                identify::identify(&files, &choices, tell)
            }
            Request::Shape { parameters } => shape::shape(parameters, bytes),
            Request::Validate {
                model,
                file,
                choices,
            } => validate::validate((&model, bytes), self.file(&file)?, &choices),
            Request::Design { model, options } => control::design((&model, bytes), &options),
            Request::Compare {
                model,
                gains,
                options,
            } => {
                let gains = gains.map(|name| self.file(&name)).transpose()?;
                control::compare(self.file(&model)?, gains, &options, tell)
            }
        }
    }

    fn keep(&mut self, name: String, bytes: Vec<u8>) {
        self.files.retain(|file| file.name != name);
        self.files.push(File { name, bytes });
    }

    fn file(&self, name: &str) -> Result<&File, String> {
        let mut all = self.files.iter();
        all.find(|file| file.name == name)
            .ok_or_else(|| format!("{name}: no such file in this tab"))
    }
}
