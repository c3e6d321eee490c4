//! Identification, and the figures of its result.

use crate::failure;
use crate::record::Record;
use crate::run::run;
use bowden_cli::view::json;
use bowden_lab::facts::{
    close as ask, Asked, Close as Question, Closed as Answer, Detail, Figures, Form, Meter, Source,
    MOST_NAMES,
};
use bowden_lab::record as lab;
use bowden_page::{figure, Close as Page, Figure, Provenance};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// The options for the records.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Wanted {
    baseline: Vec<String>,
    max_terms: Option<usize>,
    time_limit: Option<f64>,
    cutoff: Option<f64>,
    own_gains: bool,
    invertible: bool,
    figures: bool,
}

/// The given cut-off \[Hz\].
pub fn cutoff(given: Option<f64>) -> PyResult<Option<f64>> {
    match given {
        Some(hz) if !(hz.is_finite() && hz > 0.0) => Err(failure::plain(format!(
            "cutoff={hz}: a positive frequency in Hz is allowed"
        ))),
        given => Ok(given),
    }
}

impl Wanted {
    fn question(self, records: usize) -> PyResult<Question> {
        if let Some(rounds) = self.max_terms.filter(|rounds| *rounds > MOST_NAMES) {
            return Err(failure::plain(format!(
                "max_terms={rounds}: a whole number from 0 to {MOST_NAMES} is allowed"
            )));
        }
        if let Some(budget) = self.time_limit.filter(|b| !(b.is_finite() && *b > 0.0)) {
            return Err(failure::plain(format!(
                "time_limit={budget}: a positive number of seconds is allowed"
            )));
        }
        if self.own_gains && records < 2 {
            let message = "per_file=\"gains\": one record; two or more are allowed";
            return Err(failure::plain(message));
        }
        Ok(Question {
            asked: Asked {
                cutoff: cutoff(self.cutoff)?,
                declare: self.baseline,
                rounds: self.max_terms,
                budget: self.time_limit,
                ..Asked::default()
            },
            own_gains: self.own_gains,
            invertible: self.invertible,
            // A model that cannot be handed over is no failure here: what it lacks is told where
            // it is asked for. Models come with the figures.
            models: false,
            trace: self.figures,
            figures: self.figures,
            detail: Detail::EachRound,
            meter: Meter::start(),
        })
    }
}

/// The result, from which Python's `Report` is made.
#[pyclass(frozen, module = "bowden._bowden")]
pub struct Closed {
    answer: Answer,
    json: String,
    sources: Vec<Source>,
}

/// Identifies the terms that a baseline model lacks, from one or more records.
#[pyfunction]
pub fn close(
    py: Python<'_>,
    records: Vec<PyRef<'_, Record>>,
    wanted: Wanted,
    threads: Option<usize>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Closed> {
    let question = wanted.question(records.len())?;
    let sources = records.iter().filter_map(|own| own.1.clone()).collect();
    let records: Vec<lab::Record> = records.iter().map(|own| own.0.clone()).collect();
    let paths: Vec<String> = records.iter().map(|record| record.path.clone()).collect();
    let label = paths.join(", ");
    let answer = run(py, threads, progress, move |tell| {
        ask(&records, &question, tell)
    })?;
    let files = paths.iter().chain([&label]).map(String::as_str);
    let answer = answer.map_err(|message| failure::in_one_of(files, message))?;
    let json = json(&answer.facts, Some(&answer.cost)).map_err(failure::plain)?;
    Ok(Closed {
        answer,
        json,
        sources,
    })
}

#[pymethods]
impl Closed {
    #[getter]
    fn json(&self) -> &str {
        &self.json
    }

    /// Number of models that can be exported.
    #[getter]
    fn models(&self) -> usize {
        self.answer.models.len()
    }

    /// Why no model can be exported.
    #[getter]
    fn no_model(&self) -> Option<String> {
        self.answer.facts.hand_over.as_ref().err().cloned()
    }

    /// A model as the bytes of its `.toml`.
    fn model<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyBytes>> {
        let model = self.answer.models.get(index);
        let model = model.ok_or_else(|| failure::plain("there is no such model"))?;
        let bytes = model.file(Form::Toml).map_err(failure::plain)?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// The test vector of a model, as CSV.
    fn vector(&self, index: usize) -> PyResult<&str> {
        let model = self.answer.models.get(index);
        let model = model.ok_or_else(|| failure::plain("there is no such model"))?;
        model.vector().map_err(failure::plain)
    }

    /// The trace: the names of the columns, and their values as texts or numbers.
    fn trace<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        columns_of(py, self.answer.trace.as_deref().ok_or_else(no_figures)?)
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
            facts: &self.answer.facts,
            figures: self.answer.figures.as_ref().ok_or_else(no_figures)?,
            models: &self.answer.models,
        };
        Ok(page.page(&provenance(command, &self.sources)))
    }
}

pub fn no_figures() -> PyErr {
    failure::plain("figures=False: nothing was kept to draw")
}

/// The provenance of a page.
pub fn provenance(command: String, sources: &[Source]) -> Provenance {
    Provenance {
        command,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        sources: sources.to_vec(),
    }
}

/// One figure as SVG.
pub fn drawn(figures: &Figures, name: &str) -> PyResult<String> {
    let which = match name {
        "loop" => Figure::Loop,
        "residual" => Figure::Residual,
        "trace" => Figure::Trace,
        "shares" => Figure::Shares,
        other => {
            return Err(failure::plain(format!(
                "{other:?}: \"loop\", \"residual\", \"trace\" or \"shares\" is allowed"
            )))
        }
    };
    Ok(figure(figures, which))
}

/// The columns of a CSV from this program: names, and numbers if all cells of a column are numbers.
pub fn columns_of<'py>(py: Python<'py>, csv: &str) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let names = reader.headers().map_err(failure::plain)?.clone();
    let mut cells: Vec<Vec<String>> = vec![Vec::new(); names.len()];
    let mut numbers: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    for row in reader.records() {
        let row = row.map_err(failure::plain)?;
        for (column, cell) in row.iter().enumerate() {
            match &names[column] {
                "record" | "segment" => cells[column].push(cell.to_owned()),
                _ => numbers[column].push(cell.parse().map_err(failure::plain)?),
            }
        }
    }
    let mut all = Vec::with_capacity(names.len());
    for ((name, cells), numbers) in names.iter().zip(cells).zip(numbers) {
        let values = match cells.is_empty() && name != "record" && name != "segment" {
            true => {
                let array: Bound<'py, PyArray1<f64>> = numbers.into_pyarray(py);
                array.into_any()
            }
            false => cells.into_pyobject(py)?.into_any(),
        };
        all.push((name.to_owned(), values));
    }
    Ok(all)
}
