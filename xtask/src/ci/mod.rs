//! `.ci/run`: everything that must pass before a change is merged.

mod apart;
mod lab;
mod links;
mod packages;
mod readme;
mod repository;
mod shell;
mod slow;
mod steps;

use shell::{Shell, Stop};
use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;
use steps::{Step, STEPS};

/// In a run of every step, the late steps start only within this many seconds: a machine that
/// stops the run after 90 minutes would lose the results of the others.
const LATEST_START: u64 = 4200;

/// Steps that build in separate folders start only if at least this much disk space is free.
const LEAST_MEGABYTES: u64 = 2000;

/// Runs the named steps, or every step, and prints a summary.
pub fn main(root: &Path, names: &[String]) -> ExitCode {
    if names.iter().any(|name| name == "--list") {
        for step in STEPS {
            println!("{:<22} {}", step.name, step.heading);
        }
        return ExitCode::SUCCESS;
    }
    match run(root, names) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("cannot run the steps: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The number of steps that failed.
fn run(root: &Path, names: &[String]) -> std::io::Result<usize> {
    let begun = Instant::now();
    let mut shell = Shell::new(root.canonicalize()?)?;
    let all = names.is_empty();
    if all {
        // A run of every step builds a dozen programs for four targets. Incremental data and
        // debug information take most of their disk space; a full run needs neither.
        shell = shell
            .env("CARGO_INCREMENTAL", "0")
            .env("CARGO_PROFILE_DEV_DEBUG", "false");
    }
    let (mut passed, mut skipped, mut failed) = (0, 0, 0);
    let mut summary = Vec::new();
    for step in STEPS {
        if !all && !names.iter().any(|name| name == step.name) {
            continue;
        }
        match one(&shell, step, all.then_some(begun)) {
            Ok(()) => passed += 1,
            Err(Stop::Skipped(reason)) => {
                skipped += 1;
                summary.push(format!("skipped  {}: {reason}", step.name));
            }
            Err(Stop::Failed(_)) => {
                failed += 1;
                summary.push(format!("FAILED   {}: {}", step.name, step.heading));
            }
        }
    }
    for name in names {
        if !STEPS.iter().any(|step| step.name == name) {
            failed += 1;
            summary.push(format!("FAILED   {name}: no such step here (see --list)"));
        }
    }
    println!("\n==> Summary");
    for line in summary {
        println!("{line}");
    }
    println!("{passed} passed, {failed} failed, {skipped} skipped");
    fs::remove_dir_all(&shell.scratch)?;
    Ok(failed)
}

/// Runs one step. In a run of every step, `begun` is its start, and a folder that only this step
/// builds in is removed if the step created it.
fn one(shell: &Shell, step: &Step, begun: Option<Instant>) -> Result<(), Stop> {
    println!("\n==> {}: {}", step.name, step.heading);
    let created = step.folder.map(|folder| shell.root.join(folder));
    let created = created.filter(|folder| begun.is_some() && !folder.exists());
    let start = Instant::now();
    let done =
        may_start(shell, step, begun, created.is_some()).and_then(|()| (step.run)(&shell.anew()?));
    let mut spent = format!("{} s", start.elapsed().as_secs());
    if let Some(megabytes) = shell.free_megabytes() {
        spent += &format!(", {megabytes} MB free");
    }
    if let Some(folder) = created.filter(|folder| folder.exists()) {
        let _ = fs::remove_dir_all(folder);
    }
    match &done {
        Ok(()) => println!("    passed in {spent}"),
        Err(Stop::Skipped(reason)) => println!("    skipped: {reason}"),
        Err(Stop::Failed(reason)) => {
            eprintln!("    {reason}");
            println!("    FAILED after {spent}");
        }
    }
    done
}

/// Skips a late step after [`LATEST_START`], and a step with a folder on a full disk.
fn may_start(
    shell: &Shell,
    step: &Step,
    begun: Option<Instant>,
    builds_apart: bool,
) -> Result<(), Stop> {
    let seconds = begun.map_or(0, |begun| begun.elapsed().as_secs());
    if step.late && seconds > LATEST_START {
        return Err(Stop::Skipped(format!(
            "{} minutes had passed (bash .ci/run {})",
            seconds / 60,
            step.name
        )));
    }
    match shell.free_megabytes() {
        Some(megabytes) if builds_apart && megabytes < LEAST_MEGABYTES => {
            Err(Stop::Skipped(format!(
                "{megabytes} MB are free, fewer than {LEAST_MEGABYTES} (bash .ci/run {})",
                step.name
            )))
        }
        _ => Ok(()),
    }
}
