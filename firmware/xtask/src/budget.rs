//! `budgets.toml`: what each step may cost on each target.

use crate::measured::{Cost, Measured, Run};
use anyhow::{Context, Result};
use bowden_cases::Signal;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

const HEADER: &str = "\
# What a step may cost, by step and target. `cargo xtask --tighten` lowers these numbers and
# adds what is missing; it never raises one. Who raises one by hand says why in the commit.
#
# code         flash [B] with all that the step pulls in, its constructor included
# stack        below the caller [B]
# ulp          distance of any output from the host's; 0: bit for bit
# soft_double  whether the image may compute with f64 in software
# panics       whether the image may panic
# sine, …      instructions a step on each signal, on average and of the longest step
";

/// What one step may cost on one target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Bytes of flash.
    pub code: u64,
    /// Bytes of stack.
    pub stack: u32,
    /// Distance from the host's outputs.
    pub ulp: u32,
    soft_double: bool,
    panics: bool,
    sine: Cost,
    noise: Cost,
    jumps: Cost,
    faults: Cost,
}

impl Budget {
    /// What is allowed on a signal.
    pub fn cost(&self, signal: Signal) -> Cost {
        match signal {
            Signal::Sine => self.sine,
            Signal::Noise => self.noise,
            Signal::Jumps => self.jumps,
            Signal::Faults => self.faults,
        }
    }

    /// What is measured, with a margin for another release of the compiler.
    fn around(measured: &Measured, run: &Run) -> Self {
        let [sine, noise, jumps, faults] = run.costs.map(|cost| Cost {
            mean: with_margin(cost.mean, 2),
            worst: with_margin(cost.worst, 2),
        });
        Self {
            code: with_margin(measured.code, 16),
            stack: run.stack + 8,
            ulp: run.ulp,
            soft_double: measured.soft_double,
            panics: measured.panics,
            sine,
            noise,
            jumps,
            faults,
        }
    }

    fn at_most(&self, other: &Self) -> Self {
        let cost = |a: Cost, b: Cost| Cost {
            mean: a.mean.min(b.mean),
            worst: a.worst.min(b.worst),
        };
        Self {
            code: self.code.min(other.code),
            stack: self.stack.min(other.stack),
            ulp: self.ulp.min(other.ulp),
            soft_double: self.soft_double && other.soft_double,
            panics: self.panics && other.panics,
            sine: cost(self.sine, other.sine),
            noise: cost(self.noise, other.noise),
            jumps: cost(self.jumps, other.jumps),
            faults: cost(self.faults, other.faults),
        }
    }

    /// Each number that is beyond what is allowed, in words.
    fn broken(&self, measured: &Measured) -> Vec<String> {
        let mut broken = Vec::new();
        let mut most = |what: &str, measured: u64, budget: u64| {
            if measured > budget {
                broken.push(format!("{what} is {measured}, budget {budget}"));
            }
        };
        most("code [B]", measured.code, self.code);
        most(
            "soft-float double in the image",
            measured.soft_double.into(),
            self.soft_double.into(),
        );
        most(
            "a panic in the image",
            measured.panics.into(),
            self.panics.into(),
        );
        let Some(run) = &measured.run else {
            return broken;
        };
        most("stack [B]", run.stack.into(), self.stack.into());
        most(
            "distance from the host [ulp]",
            run.ulp.into(),
            self.ulp.into(),
        );
        for (signal, cost) in Signal::ALL.into_iter().zip(run.costs) {
            let (name, budget) = (signal.name(), self.cost(signal));
            most(
                &format!("{name}: instructions on average"),
                cost.mean,
                budget.mean,
            );
            most(
                &format!("{name}: instructions at worst"),
                cost.worst,
                budget.worst,
            );
        }
        broken
    }
}

/// Two percent more, and at least `least`.
fn with_margin(measured: u64, least: u64) -> u64 {
    measured + measured.div_ceil(50).max(least)
}

/// All budgets, by step and target.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Budgets(BTreeMap<String, BTreeMap<String, Budget>>);

impl Budgets {
    /// Reads the file.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
        toml::from_str(&text).with_context(|| path.display().to_string())
    }

    /// Writes the file.
    pub fn write(&self, path: &Path) -> Result<()> {
        std::fs::write(path, self.text()).with_context(|| path.display().to_string())
    }

    fn text(&self) -> String {
        let mut text = HEADER.to_owned();
        for (step, targets) in &self.0 {
            for (target, budget) in targets {
                let Budget {
                    code,
                    stack,
                    ulp,
                    soft_double,
                    panics,
                    ..
                } = budget;
                text += &format!(
                    "\n[{step}.{target}]\ncode = {code}\nstack = {stack}\nulp = {ulp}\n\
                     soft_double = {soft_double}\npanics = {panics}\n"
                );
                for signal in Signal::ALL {
                    let (name, Cost { mean, worst }) = (signal.name(), budget.cost(signal));
                    text += &format!("{name} = {{ mean = {mean}, worst = {worst} }}\n");
                }
            }
        }
        text
    }

    /// The budget of a step on a target.
    pub fn of(&self, step: &str, target: &str) -> Option<&Budget> {
        self.0.get(step)?.get(target)
    }

    /// What is beyond its budget, or has none, in words.
    pub fn broken(&self, step: &str, target: &str, measured: &Measured) -> Vec<String> {
        let Some(budget) = self.of(step, target) else {
            return vec![format!(
                "{step} on {target}: no budget (cargo xtask --tighten adds one)"
            )];
        };
        let broken = budget.broken(measured).into_iter();
        broken
            .map(|line| format!("{step} on {target}: {line}"))
            .collect()
    }

    /// Budgets of something that is not measured.
    pub fn without_a_step(&self, steps: &[&str], targets: &[&str]) -> Vec<String> {
        let all = self.0.iter();
        let all = all.flat_map(|(step, each)| each.keys().map(move |target| (step, target)));
        all.filter(|(step, target)| {
            !(steps.contains(&step.as_str()) && targets.contains(&target.as_str()))
        })
        .map(|(step, target)| format!("a budget of {step} on {target}, which is not measured"))
        .collect()
    }

    /// Lowers each budget to what is measured and adds those that are missing.
    pub fn tighten(&mut self, target: &str, steps: &[(&str, Measured)]) {
        for (step, measured) in steps {
            let Some(run) = &measured.run else { continue };
            let around = Budget::around(measured, run);
            let targets = self.0.entry((*step).to_owned()).or_default();
            let budget = targets.entry(target.to_owned()).or_insert(around);
            *budget = budget.at_most(&around);
        }
    }
}

#[cfg(test)]
#[path = "budget/tests.rs"]
mod tests;
