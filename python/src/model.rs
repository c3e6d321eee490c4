//! Models as files, and sample by sample as firmware runs them.

use crate::failure;
use bowden::effect::Motion;
use bowden::model::{Model as Core, ModelState, Sample};
use bowden::signal::{Rates, RatesState};
use bowden::Real;
use bowden_lab::export::{postcard, ModelFile, MOST_TERMS};
use bowden_lab::facts::ModelOfFile;
use numpy::ndarray::ArrayView2;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::de::DeserializeOwned;

/// The checked text of a model file.
#[pyclass(frozen, module = "bowden._bowden")]
pub struct Model {
    text: String,
    file: ModelFile,
    pub given: ModelOfFile,
}

#[pymethods]
impl Model {
    #[new]
    fn new(text: String) -> PyResult<Self> {
        let given = ModelOfFile::parse(&text).map_err(failure::plain)?;
        let file: ModelFile = toml::from_str(&text).map_err(failure::plain)?;
        Ok(Self { text, file, given })
    }

    #[getter]
    fn toml(&self) -> &str {
        &self.text
    }

    #[getter]
    fn mode(&self) -> &'static str {
        self.given.mode().name()
    }

    #[getter]
    fn channels(&self) -> Vec<String> {
        self.file.channels.clone()
    }

    /// Everything in the file, as JSON.
    #[getter]
    fn json(&self) -> PyResult<String> {
        let table: toml::Table = toml::from_str(&self.text).map_err(failure::plain)?;
        serde_json::to_string(&table).map_err(failure::plain)
    }

    /// Time constant of the rates in the file \[s\].
    #[getter]
    fn time_constant(&self) -> Option<f64> {
        let about = self.file.about.as_ref();
        about
            .map(|about| about.rates_time_constant_s)
            .filter(|t| *t > 0.0)
    }

    fn rust(&self) -> PyResult<String> {
        self.file.rust().map_err(failure::plain)
    }

    fn postcard<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = postcard(&self.file).map_err(failure::plain)?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// The outputs for samples, starting from a new state. `sources` are the input and the
    /// channels, each (samples, 1) with the position or (samples, 3) with position, velocity and
    /// acceleration.
    fn answers<'py>(
        &self,
        py: Python<'py>,
        dt: PyReadonlyArray1<'py, f64>,
        sources: Vec<PyReadonlyArray2<'py, f64>>,
        time_constant: f64,
        single: bool,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let dt = dt.as_array().to_vec();
        let sources: Vec<Source> = sources
            .iter()
            .map(|own| Source::of(own.as_array()))
            .collect();
        let even = sources.iter().all(|own| own.0.len() == dt.len());
        if !even || sources.len() != self.file.channels.len() + 1 {
            return Err(failure::plain(
                "one input and each channel, of one length, are allowed",
            ));
        }
        let load = self.file.channels.iter().position(|name| name == "load");
        let torque = self.file.mode == "torque";
        let answers = py.detach(|| match single {
            true => answers::<f32>(&self.file, &dt, &sources, (load, torque), time_constant),
            false => answers::<f64>(&self.file, &dt, &sources, (load, torque), time_constant),
        });
        Ok(answers.map_err(failure::plain)?.into_pyarray(py))
    }
}

/// A source sample by sample, and whether it includes rates.
struct Source(Vec<Motion<f64>>, bool);

impl Source {
    fn of(array: ArrayView2<'_, f64>) -> Self {
        let given = array.ncols() == 3;
        let at = |row: numpy::ndarray::ArrayView1<'_, f64>, k: usize| row.get(k).copied();
        let motion = |row| Motion {
            position: at(row, 0).unwrap_or(f64::NAN),
            velocity: at(row, 1).unwrap_or(0.0),
            acceleration: at(row, 2).unwrap_or(0.0),
        };
        Self(array.rows().into_iter().map(motion).collect(), given)
    }
}

fn answers<T: Real + DeserializeOwned>(
    file: &ModelFile,
    dt: &[f64],
    sources: &[Source],
    (load, torque): (Option<usize>, bool),
    time_constant: f64,
) -> Result<Vec<f64>, String> {
    let model: Core<T, MOST_TERMS> = file.model_in()?;
    let rates = Rates::try_new(T::from_f64(time_constant)).map_err(|e| e.to_string())?;
    let mut state = ModelState::new();
    let mut past = vec![RatesState::new(); sources.len()];
    let mut motions: Vec<Motion<T>> = Vec::with_capacity(sources.len());
    let mut out = Vec::with_capacity(dt.len());
    for (i, &dt) in dt.iter().enumerate() {
        let dt = T::from_f64(dt);
        motions.clear();
        for (Source(all, given), past) in sources.iter().zip(&mut past) {
            let own = all[i];
            motions.push(match given {
                true => Motion {
                    position: T::from_f64(own.position),
                    velocity: T::from_f64(own.velocity),
                    acceleration: T::from_f64(own.acceleration),
                },
                false => rates.step(past, T::from_f64(own.position), dt).motion,
            });
        }
        let (input, channels) = (motions[0], &motions[1..]);
        let load = match load.and_then(|index| channels.get(index)) {
            Some(load) => load.position,
            None if torque => input.position,
            None => T::zero(),
        };
        let sample = Sample {
            dt,
            input,
            load,
            channels,
        };
        out.push(model.step(&mut state, &sample).to_f64().unwrap_or(f64::NAN));
    }
    Ok(out)
}
