//! `design.toml`: what was asked for, and what a step cost before it was rewritten.

use anyhow::{Context, Result};
use bowden_cases::Signal;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// A goal and the figure before, as they are shown.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Figure {
    /// What is asked for.
    pub goal: String,
    /// What it was before.
    pub before: String,
}

/// Of one step; on the target with a float unit only.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Figures {
    /// Flash \[B\].
    pub code: Figure,
    /// Stack \[B\].
    pub stack: Figure,
    sine: Figure,
    noise: Figure,
    jumps: Figure,
    faults: Figure,
}

impl Figures {
    /// Instructions on a signal: the mean, in brackets the worst.
    pub fn cost(&self, signal: Signal) -> &Figure {
        match signal {
            Signal::Sine => &self.sine,
            Signal::Noise => &self.noise,
            Signal::Jumps => &self.jumps,
            Signal::Faults => &self.faults,
        }
    }
}

/// The target that the figures are of.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Design {
    target: String,
    steps: BTreeMap<String, Figures>,
}

impl Design {
    /// Reads the file.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
        toml::from_str(&text).with_context(|| path.display().to_string())
    }

    /// The figures of a step; empty ones where there are none.
    pub fn of(&self, step: &str, target: &str) -> Figures {
        let figures = self.steps.get(step).filter(|_| self.target == target);
        figures.cloned().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_of_this_repository_is_read_and_names_steps_that_there_are() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../design.toml");
        let design = Design::read(&path).unwrap();
        for step in design.steps.keys() {
            assert!(bowden_cases::NAMES.contains(&step.as_str()), "{step}");
        }
        let pi = design.of("pi", "thumbv7em-none-eabihf");
        assert_eq!(pi.cost(Signal::Sine).goal, "60");
        assert_eq!(design.of("pi", "thumbv6m-none-eabi"), Figures::default());
    }
}
