//! Where the emulated board has its memory, and defmt its sections, for the linker.

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let memory = "../image/memory/mps2-an386.x";
    println!("cargo:rerun-if-changed={memory}");
    if std::env::var("CARGO_CFG_TARGET_OS")? != "none" {
        return Ok(());
    }
    let folder = PathBuf::from(std::env::var("OUT_DIR")?);
    std::fs::copy(memory, folder.join("memory.x"))?;
    println!("cargo:rustc-link-search={}", folder.display());
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    println!("cargo:rustc-link-arg-bins=-Tdefmt.x");
    Ok(())
}
