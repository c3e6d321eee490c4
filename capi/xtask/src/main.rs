//! The tasks of the C interface.
//!
//! - `cargo xtask header` writes `include/bowden.h` from the sources; with `--check` it compares the
//!   file with the sources, and its exit status is 1 if they differ.
//! - `cargo xtask install --prefix DIR` builds the library and installs it for CMake and pkg-config.

mod initialisers;
mod install;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const USAGE: &str =
    "cargo xtask header [--check]\n       cargo xtask install --prefix DIR [--target TRIPLE]";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["header"] => write_header(),
        ["header", "--check"] => check_header(),
        ["install", "--prefix", prefix] => install::install(&root(), Path::new(prefix), None),
        ["install", "--prefix", prefix, "--target", target] => {
            install::install(&root(), Path::new(prefix), Some(target))
        }
        _ => {
            eprintln!("usage: {USAGE}");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("FAILED: {error}");
            ExitCode::FAILURE
        }
    }
}

fn write_header() -> Result<(), Box<dyn Error>> {
    Ok(std::fs::write(
        root().join("include/bowden.h"),
        text(&root())?,
    )?)
}

fn check_header() -> Result<(), Box<dyn Error>> {
    let made = text(&root())?;
    let there = std::fs::read_to_string(root().join("include/bowden.h")).unwrap_or_default();
    if there == made {
        return Ok(());
    }
    let lines = there.lines().zip(made.lines());
    let same = lines.take_while(|(there, made)| there == made).count();
    Err(format!(
        "include/bowden.h differs from the sources in line {} (cd capi && cargo xtask header)",
        same + 1
    )
    .into())
}

/// The folder `capi/`.
fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_path_buf()
}

/// The header as cbindgen makes it, with the macros of the settings. cbindgen reads the sources as
/// the compiler has expanded them, which a stable compiler does with `RUSTC_BOOTSTRAP`.
fn text(capi: &Path) -> Result<String, Box<dyn Error>> {
    std::env::set_var("RUSTC_BOOTSTRAP", "1");
    let config = cbindgen::Config::from_file(capi.join("cbindgen.toml"))?;
    let made = cbindgen::Builder::new()
        .with_crate(capi)
        .with_config(config)
        .generate()?;
    let mut bytes = Vec::new();
    made.write(&mut bytes);
    initialisers::added_to(&String::from_utf8(bytes)?)
}
