//! Lanes that run side by side behind one Python object: settings, states, copies and a lock.
//!
//! A second thread waits for the lock without holding the interpreter lock. Settings and states go
//! to Python as JSON in the form of the core, so the core names the fields and checks the values.

use crate::failure;
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use serde::de::DeserializeOwned;
use serde::Serialize;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// One of several objects that run side by side.
pub trait Lane: Clone + Send {
    /// The settings as JSON.
    fn settings(&self) -> PyResult<String>;

    /// The state as JSON.
    fn state(&self) -> PyResult<String>;

    /// The same object with a stored state.
    ///
    /// # Errors
    /// If the state does not belong to these settings.
    fn restored(&self, state: &str) -> PyResult<Self>;

    /// Returns to the initial state, before the first sample.
    fn restart(&mut self) -> PyResult<()>;
}

/// Lanes behind a lock.
pub struct Lanes<L> {
    all: Mutex<Vec<L>>,
    count: usize,
}

impl<L: Lane> Lanes<L> {
    pub fn new(all: Vec<L>) -> Self {
        Self {
            count: all.len(),
            all: Mutex::new(all),
        }
    }

    pub const fn count(&self) -> usize {
        self.count
    }

    /// The lanes, once no other thread uses them. Use this method for short work that does not call
    /// Python.
    pub fn now(&self, py: Python<'_>) -> MutexGuard<'_, Vec<L>> {
        let locked = self.all.lock_py_attached(py);
        locked.unwrap_or_else(PoisonError::into_inner)
    }

    /// The lanes, for a thread that has released the interpreter. Use this method for long work.
    pub fn detached(&self) -> MutexGuard<'_, Vec<L>> {
        self.all.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn settings(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.now(py).iter().map(Lane::settings).collect()
    }

    pub fn states(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.now(py).iter().map(Lane::state).collect()
    }

    /// Loads the stored state of every lane. An error changes nothing.
    pub fn load_state(&self, py: Python<'_>, states: &[String]) -> PyResult<()> {
        self.replace(py, states, |lane, state| lane.restored(state))
    }

    pub fn restart(&self, py: Python<'_>) -> PyResult<()> {
        self.now(py).iter_mut().try_for_each(Lane::restart)
    }

    pub fn copied(&self, py: Python<'_>) -> Self {
        Self::new(self.now(py).clone())
    }

    /// Makes every lane again from its text. An error changes nothing.
    pub fn replace(
        &self,
        py: Python<'_>,
        texts: &[String],
        made: impl Fn(&L, &str) -> PyResult<L>,
    ) -> PyResult<()> {
        let mut all = self.now(py);
        if texts.len() != all.len() {
            let (given, own) = (texts.len(), all.len());
            return Err(failure::plain(format!(
                "{given} lanes; {own} is the number of lanes here"
            )));
        }
        let own = all.iter().zip(texts);
        *all = own
            .map(|(lane, text)| made(lane, text))
            .collect::<PyResult<_>>()?;
        Ok(())
    }
}

/// A value as JSON.
pub fn written<T: Serialize>(value: &T) -> PyResult<String> {
    serde_json::to_string(value).map_err(failure::plain)
}

/// A value from JSON. The error contains no position, because no user has written this text.
pub fn read<T: DeserializeOwned>(text: &str) -> PyResult<T> {
    let value: serde_json::Value = serde_json::from_str(text).map_err(failure::plain)?;
    serde_json::from_value(value).map_err(failure::plain)
}
