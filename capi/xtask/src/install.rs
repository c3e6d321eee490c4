//! `cargo xtask install`: header, static library, CMake package and `bowden.pc` below a prefix.
//!
//! The files name no folder of this machine: each finds the prefix from its own place.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Builds the library, for this computer or for a target, and copies it.
pub fn install(capi: &Path, prefix: &Path, target: Option<&str>) -> Result<(), Box<dyn Error>> {
    let libraries = system_libraries(target)?;
    let version = library_version(capi)?;
    let build = capi.join("target");
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--release", "--locked", "--package", "bowden-capi"]);
    cargo.arg("--target-dir").arg(&build).current_dir(capi);
    let mut built = build;
    if let Some(target) = target {
        cargo.args(["--target", target]);
        built = built.join(target);
    }
    if !cargo.status()?.success() {
        return Err("the library does not build, see above".into());
    }
    let archive = built.join("release/libbowden.a");
    let header = capi.join("include/bowden.h");
    copy(&header, &prefix.join("include/bowden.h"))?;
    copy(&archive, &prefix.join("lib/libbowden.a"))?;
    let cmake = prefix.join("lib/cmake/bowden");
    write(&cmake.join("bowden-config.cmake"), config(&libraries))?;
    write(
        &cmake.join("bowden-config-version.cmake"),
        config_version(&version),
    )?;
    write(
        &prefix.join("lib/pkgconfig/bowden.pc"),
        pc(&version, &libraries),
    )
}

/// The version of the library, from its manifest.
fn library_version(capi: &Path) -> Result<String, Box<dyn Error>> {
    let manifest = fs::read_to_string(capi.join("Cargo.toml"))?;
    let line = manifest
        .lines()
        .find_map(|line| line.strip_prefix("version = "));
    let version = line.ok_or("capi/Cargo.toml states no version")?;
    Ok(version.trim_matches('"').to_owned())
}

/// What the static library needs of the system's.
fn system_libraries(target: Option<&str>) -> Result<Vec<&'static str>, Box<dyn Error>> {
    let system = target.unwrap_or(std::env::consts::OS);
    if system.contains("windows") {
        let manual = "on Windows copy include/bowden.h and the library from target/release";
        return Err(format!("install supports Unix and bare metal; {manual}").into());
    }
    if system.contains("none") {
        return Ok(Vec::new());
    }
    if system.contains("macos") || system.contains("apple") {
        return Ok(vec!["m"]);
    }
    Ok(vec!["m", "pthread", "dl"])
}

fn copy(from: &Path, to: &Path) -> Result<(), Box<dyn Error>> {
    let bytes = fs::read(from).map_err(|error| format!("{}: {error}", from.display()))?;
    write(to, bytes)
}

fn write(to: &Path, text: impl AsRef<[u8]>) -> Result<(), Box<dyn Error>> {
    let named = |error| format!("{}: {error}", to.display());
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).map_err(named)?;
    }
    fs::write(to, text).map_err(named)?;
    println!("{}", to.display());
    Ok(())
}

fn config(libraries: &[&str]) -> String {
    format!(
        r#"# find_package(bowden CONFIG) defines the target bowden::bowden, a static library.
get_filename_component(_bowden_prefix "${{CMAKE_CURRENT_LIST_DIR}}/../../.." ABSOLUTE)
if(NOT TARGET bowden::bowden)
  add_library(bowden::bowden STATIC IMPORTED)
  set_target_properties(bowden::bowden PROPERTIES
    IMPORTED_LOCATION "${{_bowden_prefix}}/lib/libbowden.a"
    IMPORTED_LINK_INTERFACE_LANGUAGES "C"
    INTERFACE_INCLUDE_DIRECTORIES "${{_bowden_prefix}}/include"
    INTERFACE_LINK_LIBRARIES "{}")
endif()
unset(_bowden_prefix)
"#,
        libraries.join(";")
    )
}

/// As of Cargo: before 1.0 another minor version is another interface.
fn config_version(version: &str) -> String {
    let mut parts = version.split('.');
    let (major, minor) = (parts.next().unwrap_or("0"), parts.next().unwrap_or("0"));
    format!(
        r#"set(PACKAGE_VERSION "{version}")
if(PACKAGE_FIND_VERSION VERSION_GREATER PACKAGE_VERSION)
  set(PACKAGE_VERSION_COMPATIBLE FALSE)
elseif("${{PACKAGE_FIND_VERSION_MAJOR}}.${{PACKAGE_FIND_VERSION_MINOR}}" STREQUAL "{major}.{minor}"
    OR "${{PACKAGE_FIND_VERSION}}" STREQUAL "")
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
else()
  set(PACKAGE_VERSION_COMPATIBLE FALSE)
endif()
if("${{PACKAGE_FIND_VERSION}}" STREQUAL PACKAGE_VERSION)
  set(PACKAGE_VERSION_EXACT TRUE)
endif()
"#
    )
}

fn pc(version: &str, libraries: &[&str]) -> String {
    let libraries: String = libraries.iter().map(|name| format!(" -l{name}")).collect();
    format!(
        "prefix=${{pcfiledir}}/../..\n\
         \n\
         Name: bowden\n\
         Description: Control and identification of hysteretic cable transmissions\n\
         Version: {version}\n\
         Cflags: -I${{prefix}}/include\n\
         Libs: -L${{prefix}}/lib -lbowden{libraries}\n"
    )
}
