//! Validation of a model on another record.

use crate::close::{columns_of, cutoff, drawn, no_figures, provenance};
use crate::failure;
use crate::model::Model;
use crate::record::Record;
use crate::run::run;
use bowden_cli::view::check_json;
use bowden_lab::facts::{check_record, Asked, CheckQuestion, Checked as Answer, Source};
use bowden_page::Check as Page;
use pyo3::prelude::*;

/// The result, from which Python's `CheckReport` is made.
#[pyclass(frozen, module = "bowden._bowden")]
pub struct Checked {
    answer: Answer,
    model: String,
    json: String,
    source: Option<Source>,
}

/// Runs a model on a record that was not used in its fit. `name` replaces the name of the model
/// file.
#[pyfunction]
pub fn check(
    py: Python<'_>,
    model: PyRef<'_, Model>,
    name: String,
    record: PyRef<'_, Record>,
    cutoff_hz: Option<f64>,
    threads: Option<usize>,
) -> PyResult<Checked> {
    let question = CheckQuestion {
        asked: Asked {
            cutoff: cutoff(cutoff_hz)?,
            ..Asked::default()
        },
        trace: true,
        figures: true,
    };
    let source = record.1.clone();
    let (given, record) = (model.given.clone(), record.0.clone());
    let path = record.path.clone();
    let answer = run(py, threads, None, move |_| {
        check_record(&given, record, &question)
    })?;
    let answer = answer.map_err(|message| failure::in_one_of([path.as_str()], message))?;
    let json = check_json(&name, &answer.label, &answer.facts).map_err(failure::plain)?;
    Ok(Checked {
        answer,
        model: name,
        json,
        source,
    })
}

#[pymethods]
impl Checked {
    #[getter]
    fn json(&self) -> &str {
        &self.json
    }

    /// The trace: the names of the columns, and their values as texts or numbers.
    fn trace<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        columns_of(py, self.trace_csv()?)
    }

    /// The trace as the program writes it.
    #[getter]
    fn trace_csv(&self) -> PyResult<&str> {
        self.answer.trace.as_deref().ok_or_else(no_figures)
    }

    /// One figure as SVG.
    fn figure(&self, name: &str) -> PyResult<String> {
        drawn(self.answer.figures.as_ref().ok_or_else(no_figures)?, name)
    }

    /// The page.
    fn page(&self, command: String) -> PyResult<String> {
        let page = Page {
            model: &self.model,
            record: &self.answer.label,
            facts: &self.answer.facts,
            figures: self.answer.figures.as_ref().ok_or_else(no_figures)?,
        };
        Ok(page.page(&provenance(command, self.source.as_slice())))
    }
}
