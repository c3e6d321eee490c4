//! What is in an image: bytes of flash, and routines that should not be there.

use anyhow::{Context, Result};
use object::{Object, ObjectSection, ObjectSymbol, SectionFlags, SectionKind};
use std::path::Path;

/// What an image holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Image {
    /// Bytes of flash: code, constants, and initial values of variables.
    pub bytes: u64,
    /// Whether it computes with `f64` in software.
    pub soft_double: bool,
    /// Whether it can panic.
    pub panics: bool,
}

impl Image {
    /// Reads an ELF file.
    pub fn read(path: &Path) -> Result<Self> {
        let data = std::fs::read(path).with_context(|| path.display().to_string())?;
        let file = object::File::parse(&*data).with_context(|| path.display().to_string())?;
        let bytes = file.sections().filter(is_in_flash).map(|s| s.size()).sum();
        let names = || file.symbols().filter_map(|symbol| symbol.name().ok());
        Ok(Self {
            bytes,
            soft_double: names().any(is_soft_double),
            panics: names().any(is_panic),
        })
    }
}

/// Sections that are loaded. Unwinding tables are not: nothing reads them here.
fn is_in_flash<'a>(section: &impl ObjectSection<'a>) -> bool {
    const ALLOCATED: u64 = object::elf::SHF_ALLOC as u64;
    let SectionFlags::Elf { sh_flags } = section.flags() else {
        return false;
    };
    sh_flags & ALLOCATED != 0
        && section.kind() != SectionKind::UninitializedData
        && section.name() != Ok(".eh_frame")
}

/// A routine of the compiler that computes with `f64`, by Arm's names or by GCC's.
fn is_soft_double(symbol: &str) -> bool {
    const ENDS: [&str; 9] = [
        "df3", "df2", "dfsi", "dfdi", "dfti", "sidf", "didf", "tidf", "dfsf2",
    ];
    let arm = symbol.strip_prefix("__aeabi_").is_some_and(|name| {
        name.starts_with('d') || name.starts_with("cd") || name.ends_with("2d")
    });
    let gcc = symbol.starts_with("__") && ENDS.iter().any(|end| symbol.ends_with(end));
    arm || gcc
}

/// The core library's panics, in either mangling.
fn is_panic(symbol: &str) -> bool {
    symbol.contains("4core9panicking")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn routines_for_doubles_are_told_from_those_for_floats_and_integers() {
        for name in [
            "__aeabi_dmul",
            "__aeabi_dcmpgt",
            "__aeabi_cdcmple",
            "__aeabi_f2d",
            "__aeabi_ui2d",
            "__muldf3",
            "__adddf3",
            "__unorddf2",
            "__extendsfdf2",
            "__truncdfsf2",
            "__fixunsdfsi",
            "__floatsidf",
        ] {
            assert!(is_soft_double(name), "{name}");
        }
        for name in [
            "__aeabi_fmul",
            "__aeabi_fcmpgt",
            "__aeabi_f2iz",
            "__aeabi_memcpy",
            "__aeabi_uidivmod",
            "__mulsf3",
            "__addsf3",
            "__floatsisf",
            "_ZN12bowden_image4step17h0123456789abcdf3E",
        ] {
            assert!(!is_soft_double(name), "{name}");
        }
    }

    #[test]
    fn the_test_program_itself_is_read_and_can_panic() {
        let image = Image::read(&std::env::current_exe().unwrap()).unwrap();
        assert!(image.bytes > 100_000);
        assert!(image.panics);
        assert!(!image.soft_double); // the host multiplies doubles by itself
    }

    #[test]
    fn what_is_no_elf_is_refused_by_name() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
        let error = Image::read(path).unwrap_err().to_string();
        assert!(error.ends_with("Cargo.toml"), "{error}");
    }
}
