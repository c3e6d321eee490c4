//! `cargo xtask header`: writes `include/bowden.h` from the sources; with `--check` it only says
//! whether the file is what the sources give, with exit status 1 where it is not.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const USAGE: &str = "cargo xtask header [--check]";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let is_check = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["header"] => false,
        ["header", "--check"] => true,
        _ => {
            eprintln!("usage: {USAGE}");
            return ExitCode::from(2);
        }
    };
    match header(is_check) {
        Ok(status) => status,
        Err(error) => {
            eprintln!("FAILED: {error}");
            ExitCode::FAILURE
        }
    }
}

fn header(is_check: bool) -> Result<ExitCode, Box<dyn Error>> {
    let capi = root();
    let path = capi.join("include/bowden.h");
    let made = text(&capi)?;
    if !is_check {
        std::fs::write(&path, made)?;
        return Ok(ExitCode::SUCCESS);
    }
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    if there == made {
        return Ok(ExitCode::SUCCESS);
    }
    let lines = there.lines().zip(made.lines());
    let same = lines.take_while(|(there, made)| there == made).count();
    eprintln!(
        "FAILED: include/bowden.h differs from the sources in line {} (cd capi && cargo xtask header)",
        same + 1
    );
    Ok(ExitCode::FAILURE)
}

/// The folder `capi/`.
fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_path_buf()
}

/// The header as cbindgen makes it. It reads the sources as the compiler has expanded them, which
/// a stable compiler does for whoever says that it may.
fn text(capi: &Path) -> Result<String, Box<dyn Error>> {
    std::env::set_var("RUSTC_BOOTSTRAP", "1");
    let config = cbindgen::Config::from_file(capi.join("cbindgen.toml"))?;
    let made = cbindgen::Builder::new()
        .with_crate(capi)
        .with_config(config)
        .generate()?;
    let mut bytes = Vec::new();
    made.write(&mut bytes);
    Ok(String::from_utf8(bytes)?)
}
