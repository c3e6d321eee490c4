//! The program `bowden`.

use std::process::ExitCode;

fn main() -> ExitCode {
    match bowden_cli::run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(line) => {
            anstream::eprintln!("bowden: {line}");
            ExitCode::from(2)
        }
    }
}
