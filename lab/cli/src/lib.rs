//! The program `bowden`: its subcommands, one file each, and its views.
//!
//! A subcommand asks one question of [`bowden_lab::facts`] or [`bowden_trials::facts`] and
//! hands the answer to a [`view`] or to `bowden_page`. No fit runs and no figure is computed in this package.

mod certify;
mod check;
mod close;
mod compare;
mod design;
mod drawing;
mod generate;
mod help;
mod plan;
mod power;
mod progress;
mod reading;
pub mod view;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// What went wrong, in one line, for exit status 2.
pub type Failure = String;

#[derive(Parser)]
#[command(
    name = "bowden",
    version,
    about = "Hysteretic cable transmissions: closes the loop between a model and measured data",
    disable_help_subcommand = true,
    after_help = "Without a subcommand: `bowden close` on the embedded record.\nThe words of its ledger: `bowden help terms`.\nExit status: 0 with any verdict, 1 where certify does not prove your gains, 2 for bad use or a bad record."
)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Fit the declared model, find the effect that it lacks, add it, compare.
    Close(close::Close),
    /// Try a model on the next record of the same rig: does it still hold?
    Check(check::Check),
    /// Derive gains, limits and slew rate from an identified model.
    Design(design::Design),
    /// Try controllers on the simulated rig: errors, effort, and what can be promised.
    Compare(compare::Compare),
    /// Print what can be promised of the tracking error, and what that rests on.
    Certify(certify::Certify),
    /// Say how small an effect would have been found on a record.
    Power(power::Power),
    /// Plan the experiment that tells what a record cannot: its motion, as CSV.
    Plan(plan::Plan),
    /// Generate a record with effects that the declared model lacks, as CSV.
    // `record` was the name up to 0.1 and stays for scripts; the help does not show it.
    #[command(alias = "record")]
    Generate(generate::Generate),
    /// Explain a subcommand, or the words of the ledger: `bowden help terms`.
    Help(help::Help),
}

/// Runs the program.
///
/// # Errors
/// The line to be printed on stderr.
pub fn run() -> Result<ExitCode, Failure> {
    match Arguments::parse().command {
        Some(Command::Certify(certify)) => return certify.run(),
        None => close::Close::default().run(),
        Some(Command::Close(close)) => close.run(),
        Some(Command::Check(check)) => check.run(),
        Some(Command::Design(design)) => design.run(),
        Some(Command::Compare(compare)) => compare.run(),
        Some(Command::Power(power)) => power.run(),
        Some(Command::Plan(plan)) => plan.run(),
        Some(Command::Generate(generate)) => generate.run(),
        Some(Command::Help(help)) => help.run(),
    }?;
    Ok(ExitCode::SUCCESS)
}

/// Text on stdout, with colours only on a terminal; a reader that has gone away is no
/// failure.
fn say(text: &str) -> Result<(), Failure> {
    use std::io::Write as _;
    match writeln!(anstream::stdout(), "{text}") {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(format!("stdout: {e}")),
        _ => Ok(()),
    }
}

/// Bytes on stdout as they are; a reader that has gone away (`| head`) is no failure.
fn pour(bytes: &[u8]) -> Result<(), Failure> {
    use std::io::Write as _;
    match std::io::stdout().write_all(bytes) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(format!("stdout: {e}")),
        _ => Ok(()),
    }
}

/// Whether a file could be written there, found out before anything is computed for it: its
/// folder exists and takes a file, and it is none of the files that are read.
fn writable(
    option: &str,
    path: &std::path::Path,
    read: &[&std::path::Path],
) -> Result<(), Failure> {
    let refuse = |message: String| Err(format!("{option} {}: {message}", path.display()));
    if path.is_dir() {
        return refuse("is a folder; the name of a file was expected".to_owned());
    }
    let same = |other: &&std::path::Path| match (path.canonicalize(), other.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    };
    if let Some(other) = read.iter().copied().find(|other| same(other)) {
        return refuse(format!(
            "would overwrite {}, which is read",
            other.display()
        ));
    }
    let part = neighbour(path);
    match std::fs::File::create(&part) {
        Ok(_) => std::fs::remove_file(&part).map_err(|e| format!("{}: {e}", part.display())),
        Err(e) => refuse(e.to_string()),
    }
}

/// The file beside another one into which that is written first.
fn neighbour(path: &std::path::Path) -> std::path::PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    path.with_file_name(name)
}

/// Writes a whole file or none: into a neighbour first, which then takes its name.
fn write_whole(path: &std::path::Path, bytes: &[u8]) -> Result<(), Failure> {
    write_together(&[(path.to_owned(), bytes.to_vec())])
}

/// Writes all files or none: each into a neighbour first; once all are on the disk each
/// takes its name, the last ones first. A file that was there keeps its bytes until then.
fn write_together(files: &[(std::path::PathBuf, Vec<u8>)]) -> Result<(), Failure> {
    let written = || -> Result<(), Failure> {
        for (path, bytes) in files {
            let failed = |e: std::io::Error| format!("{}: {e}", path.display());
            std::fs::write(neighbour(path), bytes).map_err(failed)?;
        }
        for (done, (path, _)) in files.iter().rev().enumerate() {
            std::fs::rename(neighbour(path), path).map_err(|e| {
                // What goes with a file that is not there is worth nothing.
                for (path, _) in files.iter().rev().take(done) {
                    let _ = std::fs::remove_file(path);
                }
                format!("{}: {e}", path.display())
            })?;
        }
        Ok(())
    };
    written().inspect_err(|_| {
        // Nothing half-written stays behind; that it may be absent already is fine.
        for (path, _) in files {
            let _ = std::fs::remove_file(neighbour(path));
        }
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::write_together;

    #[test]
    fn of_files_that_cannot_all_be_written_none_is() {
        // The place of the first or of the last one is taken by a folder.
        for taken in ["a", "c"] {
            let folder = tempfile::tempdir().unwrap();
            std::fs::create_dir(folder.path().join(taken)).unwrap();
            let file = |name: &str| (folder.path().join(name), name.as_bytes().to_vec());
            let line = write_together(&["a", "b", "c"].map(file)).unwrap_err();
            assert!(line.contains(&folder.path().join(taken).display().to_string()));
            let left = std::fs::read_dir(folder.path()).unwrap();
            let left: Vec<_> = left.map(|entry| entry.unwrap().file_name()).collect();
            assert_eq!(left, [taken]);
        }
    }
}
