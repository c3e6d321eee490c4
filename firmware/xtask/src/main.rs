//! `cargo xtask`: what each step costs on a chip, held to its budget.
//!
//! Builds one image a step and target, runs it in QEMU, compares its outputs with those
//! that this program computes from the same source, and prints what is measured beside
//! the budget of `budgets.toml`, the design's goal and what it was before. Exit status: 0
//! where all budgets hold, 1 where one does not, 2 for bad use, 77 where nothing failed but
//! something was skipped; the reason then stands on a line `skipped: …`.

mod budget;
mod build;
mod compare;
mod design;
mod elf;
mod emulator;
mod measured;
mod report;
mod table;
mod target;
mod torque_loop;

use anyhow::{bail, Context, Result};
use bowden_cases::NAMES;
use budget::Budgets;
use design::Design;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use target::{Target, TARGETS};

/// The exit status that `.ci/run` takes for a skipped step.
const SKIPPED: u8 = 77;

const USAGE: &str = "\
cargo xtask [OPTIONS]

  --target TRIPLE   this target only; can be given several times
  --step NAME       this step only; can be given several times
  --tighten         lower the budgets in budgets.toml to what is measured, and add those
                    that are missing; a budget is never raised by a program
  --torque-loop     only run the example on the chip, and show its log
  --markdown        also write the first target's table into README.md
";

/// What the command line asks for.
#[derive(Debug, Default, PartialEq)]
struct Asked {
    targets: Vec<String>,
    steps: Vec<String>,
    tighten: bool,
    markdown: bool,
    torque_loop: bool,
}

impl Asked {
    fn parse(arguments: impl Iterator<Item = String>) -> Result<Self> {
        let mut asked = Self::default();
        let mut arguments = arguments;
        while let Some(argument) = arguments.next() {
            let mut value = || {
                let value = arguments.next();
                value.with_context(|| format!("{argument} needs a value"))
            };
            match argument.as_str() {
                "--target" => asked.targets.push(value()?),
                "--step" => asked.steps.push(value()?),
                "--tighten" => asked.tighten = true,
                "--torque-loop" => asked.torque_loop = true,
                "--markdown" => asked.markdown = true,
                other => bail!("unknown argument {other:?}"),
            }
        }
        let known = |name: &&String| TARGETS.iter().any(|target| target.triple == **name);
        if let Some(name) = asked.targets.iter().find(|name| !known(name)) {
            let triples: Vec<_> = TARGETS.iter().map(|target| target.triple).collect();
            bail!("unknown target {name:?}; there are {}", triples.join(", "));
        }
        if let Some(name) = asked.steps.iter().find(|s| !NAMES.contains(&s.as_str())) {
            bail!("unknown step {name:?}; there are {}", NAMES.join(", "));
        }
        Ok(asked)
    }

    /// Whether nothing was left out.
    fn is_everything(&self) -> bool {
        self.targets.is_empty() && self.steps.is_empty()
    }

    fn targets(&self) -> impl Iterator<Item = &'static Target> + '_ {
        let wanted = |target: &&Target| {
            self.targets.is_empty() || self.targets.iter().any(|t| t == target.triple)
        };
        TARGETS.iter().filter(wanted)
    }

    /// The steps, without the empty one that all are compared with.
    fn steps(&self) -> Vec<&'static str> {
        let wanted = |name: &&str| self.steps.is_empty() || self.steps.iter().any(|s| s == name);
        NAMES.iter().copied().skip(1).filter(wanted).collect()
    }
}

fn main() -> ExitCode {
    let asked = match Asked::parse(std::env::args().skip(1)) {
        Ok(asked) => asked,
        Err(error) => {
            eprintln!("{error}\n\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    match run(&asked) {
        Ok(status) => status,
        Err(error) => {
            eprintln!("FAILED: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// The folder `firmware/`.
fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_path_buf()
}

fn run(asked: &Asked) -> Result<ExitCode> {
    let root = root();
    let mut budgets = Budgets::read(&root.join("budgets.toml"))?;
    let design = Design::read(&root.join("design.toml"))?;
    let mut skipped = Vec::new();
    if asked.torque_loop {
        let log = torque_loop::run(&root, &mut skipped)?;
        log.iter().for_each(|line| println!("{line}"));
        return Ok(ended(&skipped, &[]));
    }
    let mut broken = budgets.without_a_step(NAMES, &TARGETS.map(|target| target.triple));
    table::versions();
    for target in asked.targets() {
        if !target.is_installed() {
            skipped.push(format!(
                "{0}: the target is not installed (rustup target add {0})",
                target.triple
            ));
            continue;
        }
        let measured = measured::all(&root, target, &asked.steps(), &mut skipped)?;
        if asked.tighten {
            budgets.tighten(target.triple, &measured);
        }
        for (step, measured) in &measured {
            broken.extend(budgets.broken(step, target.triple, measured));
        }
        table::print(target, &measured, &budgets, &design);
        if asked.markdown && target.triple == TARGETS[0].triple {
            let path = root.join("README.md");
            let text = std::fs::read_to_string(&path)?;
            std::fs::write(&path, table::with_table(&text, &measured)?)?;
        }
    }
    if asked.tighten {
        budgets.write(&root.join("budgets.toml"))?;
    }
    if asked.is_everything() {
        match torque_loop::run(&root, &mut skipped) {
            Ok(log) => println!(
                "\ntorque loop: {} lines of its log are the host's",
                log.len()
            ),
            Err(error) => broken.push(format!("{error:#}")),
        }
    }
    Ok(ended(&skipped, &broken))
}

/// Says what was skipped and what is wrong; the exit status.
fn ended(skipped: &[String], broken: &[String]) -> ExitCode {
    for reason in skipped {
        println!("skipped: {reason}");
    }
    for line in broken {
        println!("FAILED: {line}");
    }
    match (broken.is_empty(), skipped.is_empty()) {
        (false, _) => ExitCode::FAILURE,
        (true, false) => ExitCode::from(SKIPPED),
        (true, true) => ExitCode::SUCCESS,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Asked> {
        Asked::parse(line.split_whitespace().map(String::from))
    }

    #[test]
    fn no_arguments_ask_for_every_step_but_the_empty_one_on_every_target() {
        let asked = parse("").unwrap();
        assert_eq!(asked.targets().count(), TARGETS.len());
        assert_eq!(asked.steps(), NAMES[1..]);
    }

    #[test]
    fn steps_and_targets_can_be_chosen() {
        let asked = parse("--step pi --target thumbv6m-none-eabi --step pid").unwrap();
        assert_eq!(asked.steps(), ["pi", "pid"]);
        let triples: Vec<_> = asked.targets().map(|target| target.triple).collect();
        assert_eq!(triples, ["thumbv6m-none-eabi"]);
    }

    #[test]
    fn what_there_is_not_is_refused_with_what_there_is() {
        let message = |line| parse(line).unwrap_err().to_string();
        assert!(message("--step pie").starts_with("unknown step \"pie\"; there are empty, pi,"));
        assert!(message("--target avr").contains("thumbv7em-none-eabihf"));
        assert_eq!(message("--target"), "--target needs a value");
        assert_eq!(message("--loosen"), "unknown argument \"--loosen\"");
    }

    #[test]
    fn every_step_has_an_image_and_every_image_is_a_step() {
        let folder = root().join("image/src/bin");
        let mut images: Vec<_> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
            .collect();
        images.sort();
        let mut steps = NAMES.to_vec();
        steps.sort_unstable();
        assert_eq!(images, steps);
    }
}
