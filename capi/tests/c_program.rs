//! C programs on the library: the crate's numbers to the bit, on this computer, under sanitizers,
//! and on an emulated Cortex-M4F.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

mod compiler;
mod torque_loop;

use compiler::{compiler, first_of, library, root, said, scratch, FLAGS, HOST_LIBRARIES};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const C: [&str; 3] = ["cc", "gcc", "clang"];
const BARE_METAL: &str = "thumbv7em-none-eabihf";

/// Compiles the example with these flags beside the usual ones, and runs it.
fn run_example(test: &str, program: &str, flags: &[&str]) -> Vec<String> {
    let built = scratch(test).join("torque_loop");
    said(
        compiler(program)
            .args(flags)
            .arg(root().join("examples/torque_loop.c"))
            .arg(library(None))
            .args(HOST_LIBRARIES)
            .arg("-o")
            .arg(&built),
    );
    said(&mut Command::new(built))
        .lines()
        .map(str::to_owned)
        .collect()
}

#[test]
fn the_example_has_the_crates_numbers() {
    let Some(cc) = first_of("torque_loop.c", &C) else {
        return;
    };
    let expected = torque_loop::lines();
    assert!(expected.len() > 20, "{}", expected.len());
    assert_eq!(run_example("plain", cc, &[]), expected);
    // With an optimisation that a firmware may have, and without any.
    assert_eq!(run_example("small", cc, &["-Os"]), expected);
    assert_eq!(run_example("none", cc, &["-O0"]), expected);
}

#[test]
fn the_example_is_clean_under_address_and_undefined_behaviour_sanitizers() {
    let Some(cc) = first_of("torque_loop.c with sanitizers", &C) else {
        return;
    };
    let flags = [
        "-fsanitize=address,undefined",
        "-fno-sanitize-recover=all",
        "-g",
    ];
    if !links(cc, &flags) {
        println!("skipped: {cc} has no sanitizers here (Debian: libasan, libubsan)");
        return;
    }
    assert_eq!(run_example("sanitized", cc, &flags), torque_loop::lines());
}

/// Whether a compiler can link an empty program with these flags.
fn links(cc: &str, flags: &[&str]) -> bool {
    let folder = scratch("probe");
    let source = folder.join("empty.c");
    std::fs::write(&source, "int main(void) { return 0; }\n").unwrap();
    let program = folder.join("empty");
    let mut command = Command::new(cc);
    command.args(flags).arg(source).arg("-o").arg(&program);
    let tried = command.stderr(Stdio::null()).status();
    tried.is_ok_and(|status| status.success())
        && Command::new(program)
            .status()
            .is_ok_and(|status| status.success())
}

#[test]
fn the_header_is_c99_and_cpp11_and_may_be_included_twice() {
    let Some(cc) = first_of("the header in C", &C) else {
        return;
    };
    let folder = scratch("header");
    let text = "#include \"bowden.h\"\n#include \"bowden.h\"\n#include \"demo.h\"\n\
                int main(void) { bowden_model_f64 m; return demo_load_f64(&m, NULL); }\n";
    for (name, standards, programs) in [
        ("twice.c", &["c99", "c11", "c17"][..], vec![cc]),
        (
            "twice.cpp",
            &["c++11", "c++17"][..],
            vec!["c++", "g++", "clang++"],
        ),
    ] {
        let source = folder.join(name);
        std::fs::write(&source, text).unwrap();
        let Some(program) = first_of("the header in C++", &programs) else {
            continue;
        };
        for standard in standards {
            let mut command = Command::new(program);
            command
                .arg(format!("-std={standard}"))
                .args(FLAGS)
                .arg("-fsyntax-only");
            for folder in ["include", "examples"] {
                command.arg("-I").arg(root().join(folder));
            }
            said(command.arg(&source));
        }
    }
}

#[test]
fn an_exported_model_gives_the_labs_numbers() {
    let Some(cc) = first_of("demo.h", &C) else {
        return;
    };
    // `bowden identify --model-out` has written it next to the model that demo.h is exported from.
    let vector = root().join("../examples/data/demo.vector.csv");
    let vector = std::fs::read_to_string(vector).unwrap();
    let mut rows = vector.lines();
    let head: Vec<&str> = rows.next().unwrap().split(',').collect();
    assert_eq!(head[11..], ["output_f32", "output_f64"]);
    let rows: Vec<Vec<&str>> = rows.map(|row| row.split(',').collect()).collect();
    assert!(rows.len() > 10);
    let inputs: Vec<String> = rows
        .iter()
        .map(|row| format!("{{{}}}", row[..11].join(", ")))
        .collect();
    let folder = scratch("vector");
    let program = include_str!("c_program/vector.c").replace("ROWS", &inputs.join(",\n"));
    let (source, built) = (folder.join("vector.c"), folder.join("vector"));
    std::fs::write(&source, program).unwrap();
    said(
        compiler(cc)
            .arg(&source)
            .arg(library(None))
            .args(HOST_LIBRARIES)
            .arg("-o")
            .arg(&built),
    );
    let said = said(&mut Command::new(built));
    let printed: Vec<&str> = said.lines().collect();
    assert_eq!(printed.len(), rows.len());
    for (row, line) in rows.iter().zip(printed) {
        let (single, double) = line.split_once(' ').unwrap();
        let single_there: f32 = row[11].parse().unwrap();
        let double_there: f64 = row[12].parse().unwrap();
        assert_eq!(single, format!("{:08x}", single_there.to_bits()));
        assert_eq!(double, format!("{:016x}", double_there.to_bits()));
    }
}

/// The block of the README behind this mark.
fn block<'a>(readme: &'a str, mark: &str) -> &'a str {
    let (_, behind) = readme.split_once(&format!("```{mark}\n")).unwrap();
    behind.split_once("```").unwrap().0
}

#[test]
fn the_readmes_program_prints_what_the_readme_says() {
    let Some(cc) = first_of("the README's program", &C) else {
        return;
    };
    let readme = include_str!("../README.md");
    let folder = scratch("readme");
    let (source, built) = (folder.join("least.c"), folder.join("least"));
    std::fs::write(&source, block(readme, "c")).unwrap();
    said(
        compiler(cc)
            .arg(&source)
            .arg(library(None))
            .args(HOST_LIBRARIES)
            .arg("-o")
            .arg(&built),
    );
    assert_eq!(said(&mut Command::new(built)), block(readme, "text"));
}

/// Against `libbowden.so` in place of the archive.
#[cfg(target_os = "linux")]
#[test]
fn the_shared_library_has_the_same_numbers() {
    let Some(cc) = first_of("libbowden.so", &C) else {
        return;
    };
    let archive = library(None);
    let folder = archive.parent().unwrap();
    let built = scratch("shared").join("torque_loop");
    said(
        compiler(cc)
            .arg(root().join("examples/torque_loop.c"))
            .arg(folder.join("libbowden.so"))
            .arg(format!("-Wl,-rpath,{}", folder.display()))
            .arg("-o")
            .arg(&built),
    );
    let said = said(&mut Command::new(built));
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines, torque_loop::lines());
}

/// The target's core library, where the compiler has it.
fn has_bare_metal() -> bool {
    let mut rustc = Command::new("rustc");
    rustc.args(["--print", "target-libdir", "--target", BARE_METAL]);
    let folder = said(&mut rustc);
    let entries = std::fs::read_dir(Path::new(folder.trim()));
    entries.is_ok_and(|mut entries| {
        entries.any(|entry| {
            let name = entry.unwrap().file_name();
            name.to_string_lossy().starts_with("libcore-")
        })
    })
}

/// An image of the example for the board, with every one of these functions in it; what is
/// missing for it is said.
fn image(test: &str, functions: &[&str]) -> Option<PathBuf> {
    let gcc = first_of(test, &["arm-none-eabi-gcc"])?;
    if !has_bare_metal() {
        println!("skipped: {test}: rustup target add {BARE_METAL}");
        return None;
    }
    let board = root().join("examples/mps2-an386");
    let image = scratch(test).join("torque_loop.elf");
    let roots = functions.iter().map(|name| format!("-Wl,-u,{name}"));
    said(
        compiler(gcc)
            .args([
                "-ffreestanding",
                "-nostdlib",
                "-Wl,--gc-sections",
                "-Wl,-z,noexecstack",
            ])
            .args(["-ffunction-sections", "-fdata-sections"])
            .args([
                "-mcpu=cortex-m4",
                "-mthumb",
                "-mfloat-abi=hard",
                "-mfpu=fpv4-sp-d16",
            ])
            .args(roots)
            .arg(root().join("examples/torque_loop.c"))
            .arg(board.join("start.c"))
            .arg(library(Some(BARE_METAL)))
            .arg("-T")
            .arg(board.join("link.ld"))
            .arg("-o")
            .arg(&image),
    );
    Some(image)
}

/// The linker keeps what is reached: a function that could panic would keep the panic's code.
#[test]
fn no_function_of_the_interface_can_panic() {
    let header = std::fs::read_to_string(root().join("include/bowden.h")).unwrap();
    let mut functions: Vec<&str> = header
        .lines()
        .filter(|line| line.starts_with("bowden_result ") || line.starts_with("const char *"))
        .filter_map(|line| line.split_once('('))
        .filter_map(|(head, _)| head.rsplit([' ', '*']).next())
        .collect();
    functions.sort_unstable();
    let doubles = functions
        .iter()
        .filter(|name| name.ends_with("_f64"))
        .count();
    assert!(
        doubles > 25 && functions.len() == 2 * doubles + 3,
        "{functions:?}"
    );
    let Some(image) = image("no_panic", &functions) else {
        return;
    };
    let names = said(Command::new("arm-none-eabi-nm").arg(&image));
    for function in functions {
        assert!(names.contains(&format!(" T {function}\n")), "{function}");
    }
    let panics: Vec<&str> = names
        .lines()
        .filter(|line| line.contains("panic"))
        .collect();
    assert!(panics.is_empty(), "{panics:?}");
}

#[test]
fn the_example_has_the_crates_numbers_on_a_cortex_m4f() {
    let test = "torque_loop.c_on_a_Cortex-M4F";
    let Some(qemu) = first_of(test, &["qemu-system-arm"]) else {
        return;
    };
    let Some(image) = image(test, &[]) else {
        return;
    };
    let mut command = Command::new(qemu);
    command
        .args(["-machine", "mps2-an386", "-no-reboot", "-display", "none"])
        .args([
            "-monitor",
            "none",
            "-serial",
            "none",
            "-chardev",
            "stdio,id=out",
        ])
        .args(["-semihosting-config", "enable=on,target=native,chardev=out"])
        .arg("-kernel")
        .arg(&image)
        .stdin(Stdio::null());
    let said = said(&mut command);
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines, torque_loop::lines());
}
