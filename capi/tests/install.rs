//! `cargo xtask install`: a C program builds on the installed files with CMake and with pkg-config,
//! after their folder was moved.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

#[allow(dead_code)]
mod compiler;

use compiler::{first_of, is_there, root, said, scratch};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

const README: &str = include_str!("../README.md");

/// The block of the README behind this mark.
fn block(mark: &str) -> &'static str {
    let (_, behind) = README.split_once(&format!("```{mark}\n")).unwrap();
    behind.split_once("```").unwrap().0
}

/// The files, installed once and moved.
fn installed() -> &'static Path {
    static AT: OnceLock<PathBuf> = OnceLock::new();
    AT.get_or_init(|| {
        let folder = scratch("install");
        let (first, moved) = (folder.join("first"), folder.join("moved here"));
        for old in [&first, &moved] {
            if old.exists() {
                std::fs::remove_dir_all(old).unwrap();
            }
        }
        let mut install = Command::new(env!("CARGO"));
        install.args(["xtask", "install", "--prefix"]).arg(&first);
        said(install.current_dir(root()));
        std::fs::rename(&first, &moved).unwrap();
        moved
    })
}

/// A folder with the README's program.
fn project(test: &str) -> PathBuf {
    let folder = scratch(test);
    std::fs::write(folder.join("own.c"), block("c")).unwrap();
    folder
}

#[test]
fn the_installed_files_name_no_folder_of_this_machine() {
    let prefix = installed();
    for file in [
        "lib/pkgconfig/bowden.pc",
        "lib/cmake/bowden/bowden-config.cmake",
        "lib/cmake/bowden/bowden-config-version.cmake",
    ] {
        let text = std::fs::read_to_string(prefix.join(file)).unwrap();
        assert!(!text.contains(root().to_str().unwrap()), "{file}: {text}");
        assert!(!text.contains("install/first"), "{file}: {text}");
    }
    let header = std::fs::read(prefix.join("include/bowden.h")).unwrap();
    assert_eq!(
        header,
        std::fs::read(root().join("include/bowden.h")).unwrap()
    );
    assert!(prefix.join("lib/libbowden.a").is_file());
    let pc = std::fs::read_to_string(prefix.join("lib/pkgconfig/bowden.pc")).unwrap();
    let version = format!("\nVersion: {}\n", env!("CARGO_PKG_VERSION"));
    assert!(pc.contains(&version), "{pc}");
}

#[test]
fn a_program_builds_with_pkg_config() {
    let Some(cc) = first_of("pkg-config: a C compiler", &["cc"]) else {
        return;
    };
    if first_of("bowden.pc", &["pkg-config"]).is_none() {
        return;
    }
    let folder = project("pkg_config");
    // As the README has it; a folder with a space is quoted by pkg-config, which `eval` reads.
    let line = format!("{cc} own.c $(pkg-config --cflags --libs bowden) -o own");
    assert!(README.contains(&line), "{line}");
    let mut shell = Command::new("sh");
    shell.args(["-ec", &format!("eval \"{line}\"")]);
    shell.env("PKG_CONFIG_PATH", installed().join("lib/pkgconfig"));
    said(shell.current_dir(&folder));
    assert_eq!(said(&mut Command::new(folder.join("own"))), block("text"));
}

#[test]
fn a_program_builds_with_cmake() {
    if first_of("the CMake package", &["cmake"]).is_none() {
        return;
    }
    if first_of("CMake: a C compiler", &["cc", "gcc", "clang"]).is_none() {
        return;
    }
    let folder = project("cmake");
    let build = folder.join("build");
    if build.exists() {
        std::fs::remove_dir_all(&build).unwrap();
    }
    let configure = |text: &str| {
        std::fs::write(folder.join("CMakeLists.txt"), text).unwrap();
        let mut cmake = Command::new("cmake");
        cmake.arg("-S").arg(&folder).arg("-B").arg(&build);
        cmake.arg(format!("-DCMAKE_PREFIX_PATH={}", installed().display()));
        cmake
    };
    // Before 1.0 another minor version is another interface.
    let other = block("cmake").replace("bowden 0.2", "bowden 0.1");
    assert_ne!(other, block("cmake"));
    assert!(!configure(&other).output().unwrap().status.success());
    std::fs::remove_dir_all(&build).unwrap();
    said(&mut configure(block("cmake")));
    said(Command::new("cmake").arg("--build").arg(&build));
    assert_eq!(said(&mut Command::new(build.join("own"))), block("text"));
}

#[test]
fn a_wrong_argument_is_refused_with_the_usage() {
    assert!(is_there(env!("CARGO")));
    for wrong in [
        &["install"][..],
        &["install", "--prefix"],
        &["instal", "--prefix", "x"],
    ] {
        let mut xtask = Command::new(env!("CARGO"));
        let told = xtask
            .arg("xtask")
            .args(wrong)
            .current_dir(root())
            .output()
            .unwrap();
        assert_eq!(told.status.code(), Some(2), "{wrong:?}");
        assert!(String::from_utf8_lossy(&told.stderr).contains("install --prefix DIR"));
    }
}
