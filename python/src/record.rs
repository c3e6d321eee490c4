//! Records from files and from arrays.

use crate::failure;
use bowden_lab::facts::{read_with_source, Mode, Options, Source};
use bowden_lab::record::{self as lab, Column};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// The program's options for reading columns.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Columns {
    mode: Option<String>,
    time: Option<String>,
    input: Option<String>,
    output: Option<String>,
    channels: Vec<(String, String)>,
    start: f64,
    end: Option<f64>,
    rate: Option<f64>,
    header_line: Option<usize>,
    segment: Option<usize>,
    sheet: Option<String>,
    names: Vec<String>,
    drop_bad: bool,
}

impl Columns {
    fn options(self) -> PyResult<Options> {
        Ok(Options {
            mode: self.mode.as_deref().map(mode).transpose()?,
            time: self.time,
            input: self.input,
            output: self.output,
            channels: self.channels,
            skip: self.start,
            until: self.end,
            rate: self.rate,
            header_line: self.header_line,
            segment: self.segment,
            sheet: self.sheet,
            names: self.names,
            drop_bad: self.drop_bad,
        })
    }
}

fn mode(name: &str) -> PyResult<Mode> {
    match name {
        "torque" => Ok(Mode::Torque),
        "displacement" => Ok(Mode::Displacement),
        other => Err(failure::plain(format!(
            "mode={other:?}: \"torque\" or \"displacement\" is allowed"
        ))),
    }
}

/// A checked record, and the file from which it was read.
#[pyclass(frozen, module = "bowden")]
pub struct Record(pub lab::Record, pub Option<Source>);

#[pymethods]
impl Record {
    #[getter]
    fn path(&self) -> &str {
        &self.0.path
    }

    #[getter]
    fn mode(&self) -> &'static str {
        self.0.mode.name()
    }

    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.time.clone().into_pyarray(py)
    }

    #[getter]
    fn input<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.input.values.clone().into_pyarray(py)
    }

    #[getter]
    fn output<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.output.values.clone().into_pyarray(py)
    }

    #[getter]
    fn channels<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for column in &self.0.channels {
            all.set_item(&column.name, column.values.clone().into_pyarray(py))?;
        }
        Ok(all)
    }

    /// The unit of each column by name, if the record contains units.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for column in [&self.0.input, &self.0.output]
            .into_iter()
            .chain(&self.0.channels)
        {
            if let Some(unit) = &column.unit {
                all.set_item(&column.name, unit)?;
            }
        }
        Ok(all)
    }

    /// Names of the input and output columns.
    #[getter]
    fn names(&self) -> (&str, &str) {
        (&self.0.input.name, &self.0.output.name)
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.0.notes.clone()
    }

    #[getter]
    fn defects(&self) -> Vec<String> {
        let defects = self.0.defects.iter();
        defects
            .map(|d| format!("{}: {}", d.channel, d.message))
            .collect()
    }

    #[getter]
    fn dropped(&self) -> usize {
        self.0.dropped
    }

    fn __len__(&self) -> usize {
        self.0.samples()
    }

    fn __repr__(&self) -> String {
        let record = &self.0;
        format!(
            "<bowden.Record {}: {} samples, {} mode>",
            record.path,
            record.samples(),
            record.mode.name()
        )
    }
}

/// Reads a file without holding the interpreter lock.
#[pyfunction]
pub fn record_of_file(py: Python<'_>, path: PathBuf, columns: Columns) -> PyResult<Record> {
    let options = columns.options()?;
    py.detach(|| {
        let read = read_with_source(&path, &options);
        read.map(|(record, source)| Record(record, Some(source)))
            .map_err(|e| failure::of_record(&e))
    })
}

/// A record of (name, unit, values). Each array is read in place and copied once.
#[pyfunction]
pub fn record_of_columns(
    py: Python<'_>,
    arrays: Vec<(String, Option<String>, PyReadonlyArray1<'_, f64>)>,
    label: &str,
    columns: Columns,
) -> PyResult<Record> {
    let options = columns.options()?;
    let column = |(name, unit, values): (_, _, PyReadonlyArray1<'_, f64>)| Column {
        name,
        unit,
        values: values.as_array().to_vec(),
        definition: None,
    };
    let all: Vec<Column> = arrays.into_iter().map(column).collect();
    py.detach(|| lab::of_columns(all, label, &options))
        .map(|record| Record(record, None))
        .map_err(|e| failure::of_record(&e))
}

/// Several records in the units of the first one.
#[pyfunction]
pub fn agree(records: Vec<PyRef<'_, Record>>) -> PyResult<Vec<Record>> {
    let mut all: Vec<lab::Record> = records.iter().map(|own| own.0.clone()).collect();
    lab::agree(&mut all).map_err(|e| failure::of_record(&e))?;
    let sources = records.iter().map(|own| own.1.clone());
    Ok(all
        .into_iter()
        .zip(sources)
        .map(|(r, s)| Record(r, s))
        .collect())
}
