//! Reads a [`Setup`] from a file, and checks every law in it.

use super::design::rises;
use super::gains::{is_of_design, message};
use super::lineup::Laws;
use super::setup::Setup;
use std::path::Path;

/// The text of a file on the disk.
pub(crate) fn text_of_disk(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))
}

impl Setup {
    /// Reads a file.
    ///
    /// # Errors
    /// A message with file, line, column and key.
    pub fn read(path: &Path) -> Result<Self, String> {
        Self::parse(&text_of_disk(path)?, &path.display().to_string())
    }

    /// Reads a text; `label` is the name of the file.
    ///
    /// # Errors
    /// A message with file, line, column and key.
    pub fn parse(text: &str, label: &str) -> Result<Self, String> {
        if is_of_design(text) {
            return Err(format!(
                "{label}: this file was written by `bowden design`; pass a model written by `bowden identify --model-out`, or gains and rig in one file"
            ));
        }
        let failed = |e: toml::de::Error| message(&e, text, label);
        let table: toml::Table = toml::from_str(text).map_err(failed)?;
        let setup = if table.contains_key("schema") {
            Self {
                model: Some(toml::from_str(text).map_err(failed)?),
                ..Self::default()
            }
        } else {
            toml::from_str(text).map_err(failed)?
        };
        setup.check(label)?;
        Ok(setup)
    }

    /// Checks the conditions that the types do not express.
    fn check(&self, label: &str) -> Result<(), String> {
        if let Some(model) = &self.model {
            if model.schema != "bowden.model/1" {
                return Err(format!(
                    "{label}: model.schema {:?} must be \"bowden.model/1\"",
                    model.schema
                ));
            }
            if model.mode != "torque" {
                return Err(format!(
                    "{label}: model.mode {:?} must be \"torque\", because the simulated rig transmits torque to torque",
                    model.mode
                ));
            }
            rises(model).map_err(|e| format!("{label}: {e}"))?;
        }
        let refused = |what: &str, e: bowden::Error| format!("{label}: [{what}]: {e}");
        let none: &[bowden::model::Term<f64>] = &[];
        bowden_rig::Rig::<f64, 0>::try_new(self.rig, none).map_err(|e| refused("rig", e))?;
        Laws::new(self).map_err(|(what, e)| refused(what, e))?;
        Ok(())
    }
}
