//! Where the emulated board has its memory, for the linker.

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=memory");
    let board = match std::env::var("CARGO_CFG_TARGET_ARCH")?.as_str() {
        "arm" => "mps2-an386",
        "riscv32" => "virt",
        // The host: only looked at by tools, never linked.
        _ => return Ok(()),
    };
    let folder = PathBuf::from(std::env::var("OUT_DIR")?);
    std::fs::copy(format!("memory/{board}.x"), folder.join("memory.x"))?;
    println!("cargo:rustc-link-search={}", folder.display());
    if board == "virt" {
        println!("cargo:rustc-link-arg-bins=-Tmemory.x");
    }
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    Ok(())
}
