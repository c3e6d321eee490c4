//! The program `bowden`.

use std::process::ExitCode;

fn main() -> ExitCode {
    match bowden_cli::run() {
        Ok(status) => status,
        Err(line) => {
            anstream::eprintln!("bowden: {line}");
            ExitCode::from(2)
        }
    }
}
