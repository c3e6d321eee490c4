//! What a step costs on a target: its image less the empty one, its run less an empty one.

use crate::build;
use crate::compare;
use crate::elf::Image;
use crate::emulator;
use crate::report::{Report, Step};
use crate::target::{Target, SHIFT};
use anyhow::{ensure, Context, Result};
use bowden_cases::{Signal, NAMES};
use std::path::Path;

/// Instructions a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cost {
    /// On average over a signal, rounded up.
    pub mean: u64,
    /// Of the longest step of a signal.
    pub worst: u64,
}

/// What the emulator shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Bytes of stack below the caller, at most.
    pub stack: u32,
    /// Distance of the outputs from the host's \[ulp\], at most.
    pub ulp: u32,
    /// Of each signal, in the order of [`Signal::ALL`].
    pub costs: [Cost; Signal::ALL.len()],
}

/// What one step costs.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Bytes of flash more than the empty image has.
    pub code: u64,
    /// Whether the image computes with `f64` in software.
    pub soft_double: bool,
    /// Whether the image can panic.
    pub panics: bool,
    /// Nothing where there is no emulator.
    pub run: Option<Run>,
}

/// Each step with its measurements, in the order given.
pub type Steps = Vec<(&'static str, Measured)>;

/// Builds, looks into and runs the images of these steps.
pub fn all(
    root: &Path,
    target: &Target,
    steps: &[&'static str],
    skipped: &mut Vec<String>,
) -> Result<Steps> {
    let emulated = target.has_emulator();
    if !emulated {
        skipped.push(format!(
            "{}: no instructions, stack and outputs without {} (Debian: qemu-system)",
            target.triple, target.emulator
        ));
    }
    let empty = NAMES[0];
    let wanted: Vec<&str> = std::iter::once(empty)
        .chain(steps.iter().copied())
        .collect();
    let images = build::images(root, target, "bowden-image", &[], &wanted)?;
    let path = |step: &str| {
        let path = images.get(step);
        path.with_context(|| format!("cargo built no image {step:?} for {}", target.triple))
    };
    let run = |step: &str| -> Result<Report> {
        let bytes = emulator::run(target, path(step)?, SHIFT)?;
        Report::parse(&String::from_utf8_lossy(&bytes), target.ticks)
            .with_context(|| format!("{step} on {}", target.triple))
    };
    let base = Image::read(path(empty)?)?;
    let overhead = if emulated { overhead(&run(empty)?)? } else { 0 };
    let measure = |step: &&'static str| -> Result<(&'static str, Measured)> {
        let image = Image::read(path(step)?)?;
        let run = if emulated {
            let report = run(step)?;
            let ulp = compare::distance(step, &report)
                .with_context(|| format!("{step} on {}", target.triple))?;
            Some(of_run(&report, overhead, ulp))
        } else {
            None
        };
        let measured = Measured {
            code: image.bytes.saturating_sub(base.bytes),
            soft_double: image.soft_double,
            panics: image.panics,
            run,
        };
        Ok((step, measured))
    };
    steps.iter().map(measure).collect()
}

/// What the measurement itself takes: the same at every sample, or it cannot be taken off.
fn overhead(empty: &Report) -> Result<u64> {
    let mut all = empty.runs.iter().flat_map(|(_, steps)| steps);
    let first = all
        .next()
        .context("the empty image has no samples")?
        .instructions;
    ensure!(
        all.all(|step| step.instructions == first),
        "the empty step does not take the same at every sample"
    );
    Ok(first)
}

fn of_run(report: &Report, overhead: u64, ulp: u32) -> Run {
    let cost = |steps: &[Step]| {
        let of = |step: &Step| step.instructions.saturating_sub(overhead);
        let sum: u64 = steps.iter().map(of).sum();
        Cost {
            mean: sum.div_ceil(steps.len().max(1) as u64),
            worst: steps.iter().map(of).max().unwrap_or(0),
        }
    };
    let mut costs = [Cost { mean: 0, worst: 0 }; Signal::ALL.len()];
    for (place, (_, steps)) in costs.iter_mut().zip(&report.runs) {
        *place = cost(steps);
    }
    let all = report.runs.iter().flat_map(|(_, steps)| steps);
    Run {
        stack: all.map(|step| step.stack).max().unwrap_or(0),
        ulp,
        costs,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowden_cases::Output;

    fn report(instructions: &[u64]) -> Report {
        let step = |&instructions: &u64| Step {
            output: Output::default(),
            instructions,
            stack: 8 * instructions as u32,
        };
        let steps: Vec<Step> = instructions.iter().map(step).collect();
        Report {
            runs: Signal::ALL.map(|signal| (signal, steps.clone())).to_vec(),
        }
    }

    #[test]
    fn the_empty_measurement_is_taken_off() {
        let run = of_run(&report(&[24, 14, 35]), 14, 0);
        assert_eq!(
            run.costs[2],
            Cost {
                mean: 11,
                worst: 21
            }
        ); // 31/3, rounded up
        assert_eq!(run.stack, 280);
    }

    #[test]
    fn an_empty_measurement_that_varies_is_refused() {
        assert_eq!(overhead(&report(&[14, 14])).unwrap(), 14);
        assert!(overhead(&report(&[14, 15])).is_err());
    }
}
