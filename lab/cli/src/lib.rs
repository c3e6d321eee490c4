//! The program `bowden`: its subcommands, one file each, and its views.
//!
//! A subcommand calls one function of [`bowden_lab::facts`] or [`bowden_trials::facts`] and passes
//! the answer to a [`view`] or to `bowden_page`. This package runs no fit and computes no number.

mod bar;
mod certify;
mod check;
mod close;
mod compare;
mod completions;
mod design;
mod drawing;
mod export;
mod generate;
mod help;
mod man;
mod outputs;
mod pattern;
mod plan;
mod power;
mod progress;
mod reading;
mod rows;
mod usage;
pub mod view;

pub use drawing::quoted;
pub use progress::share;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// What went wrong, in one line, for exit status 2.
pub type Failure = String;

#[derive(Parser)]
#[command(
    name = "bowden",
    version,
    about = "Identification and control of hysteretic cable transmissions (Bowden cables)",
    disable_help_subcommand = true,
    after_help = "Without a subcommand, bowden runs `bowden identify` on the built-in record.\n`bowden help terms` explains the terms of the output.\nExit status: 0 for any verdict. 1 if `bowden certify` does not prove your gains, or if `bowden plan` has no motion to write to --out. 2 for a usage error or an invalid record."
)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Fit the baseline model, add the missing terms, and compare the errors.
    // `close` and `check` were the names up to 0.1 and remain for scripts; the help does not show
    // them.
    #[command(alias = "close")]
    Identify(close::Close),
    /// Test a model on another record from the same rig.
    #[command(alias = "check")]
    Validate(check::Check),
    /// Derive controller gains, command limits and a slew-rate limit from an identified model.
    Design(design::Design),
    /// Compare the errors, the control effort and the error bounds of controllers on a simulated
    /// rig.
    Compare(compare::Compare),
    /// Print the proved bounds on the tracking error, and their assumptions.
    Certify(certify::Certify),
    /// Print the smallest effects that the search would find in a record.
    Power(power::Power),
    /// Plan a motion that separates ambiguous terms, and print it as CSV.
    Plan(plan::Plan),
    /// Export a model as a C header for firmware.
    Export(export::Export),
    /// Generate a synthetic record as CSV, with effects that the baseline model lacks.
    // `record` was the name up to 0.1 and stays for scripts; the help does not show it.
    #[command(alias = "record")]
    Generate(generate::Generate),
    /// Print a completion script for a shell.
    Completions(completions::Completions),
    /// Print the manual page of the program or of a subcommand.
    Man(man::Man),
    /// Explain a subcommand, or the terms of the output: `bowden help terms`.
    Help(help::Help),
}

/// Runs the program.
///
/// # Errors
/// The line to be printed on stderr.
pub fn run() -> Result<ExitCode, Failure> {
    match usage::arguments()?.command {
        Some(Command::Certify(certify)) => return certify.run(),
        Some(Command::Plan(plan)) => return plan.run(),
        None => close::Close::default().run(),
        Some(Command::Identify(identify)) => identify.run(),
        Some(Command::Validate(validate)) => validate.run(),
        Some(Command::Design(design)) => design.run(),
        Some(Command::Compare(compare)) => compare.run(),
        Some(Command::Power(power)) => power.run(),
        Some(Command::Export(export)) => export.run(),
        Some(Command::Generate(generate)) => generate.run(),
        Some(Command::Completions(completions)) => completions.run(),
        Some(Command::Man(man)) => man.run(),
        Some(Command::Help(help)) => help.run(),
    }?;
    Ok(ExitCode::SUCCESS)
}

/// Text on stdout, with colours only on a terminal; a reader that has gone away is no
/// failure.
fn say(text: &str) -> Result<(), Failure> {
    use std::io::Write as _;
    unless_gone(writeln!(anstream::stdout(), "{text}"))
}

/// Bytes on stdout as they are; a reader that has gone away (`| head`) is no failure.
fn pour(bytes: &[u8]) -> Result<(), Failure> {
    use std::io::Write as _;
    let mut out = std::io::stdout();
    unless_gone(out.write_all(bytes).and_then(|()| out.flush()))
}

/// Whether it was written, or its reader has gone away; else why not, such as a full disk.
fn unless_gone(written: std::io::Result<()>) -> Result<(), Failure> {
    match written {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(format!("stdout: {e}")),
        _ => Ok(()),
    }
}
