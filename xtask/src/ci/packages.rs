//! Steps on what is published: the packages, their dependencies and their oldest Rust.

use super::readme;
use super::shell::{fail, skip, text, Done, Shell};
use std::fs;
use std::path::{Path, PathBuf};

/// The features in brackets must be empty: no `default`, and no `arch` of libm.
pub fn run_time_dependencies(shell: &Shell) -> Done {
    let tree = "cargo tree -p bowden -e normal --target all --prefix none --no-dedupe --format";
    let tree = shell.output(&format!("{tree} {{lib}}[{{f}}]"))?;
    let mut found: Vec<&str> = tree.lines().filter(|l| !l.starts_with("bowden[")).collect();
    found.sort_unstable();
    found.dedup();
    println!("    {}", found.join("\n    "));
    if found != ["libm[]", "num_traits[]"] {
        return fail("the core may depend on num-traits and libm only, both without any feature");
    }
    Ok(())
}

/// The `rust-version` of a manifest, by default that of the workspace.
fn rust_version(shell: &Shell, manifest: &str) -> Done<String> {
    for manifest in [manifest, "Cargo.toml"] {
        let manifest = fs::read_to_string(shell.root.join(manifest))?;
        let version = manifest
            .lines()
            .find_map(|line| line.strip_prefix("rust-version = \"")?.strip_suffix('"'));
        if let Some(version) = version {
            return Ok(version.to_owned());
        }
    }
    fail("no rust-version in Cargo.toml")
}

/// Checks a package with the oldest Rust that its manifest allows.
pub fn oldest_rust(shell: &Shell, package: &str, manifest: &str) -> Done {
    let version = rust_version(shell, manifest)?;
    let Some(name) = shell.toolchain(&version) else {
        return skip(format!(
            "Rust {version} is not installed (rustup toolchain install {version})"
        ));
    };
    shell.run(&format!(
        "cargo +{name} check -p {package} --all-features --locked"
    ))
}

/// Unpacks what would be published in an empty folder, and runs its tests there, and the README's
/// first program in an otherwise empty project. All but these three packages come from the registry.
pub fn packages(shell: &Shell) -> Done {
    let command =
        "cargo package -p bowden -p bowden-bound -p bowden-rig --no-verify --allow-dirty \
                   --target-dir {scratch}/packed";
    println!("    $ {command}");
    let packed = shell.ask(command)?;
    let printed = text(&packed.stdout) + &text(&packed.stderr);
    print!("{printed}");
    if !packed.status.success() || printed.lines().any(|line| line.starts_with("warning")) {
        return fail("cargo package has warnings or errors");
    }
    let unpacked = unpack(shell)?;
    let [bound, rig, core] = ["bowden-bound-", "bowden-rig-", "bowden-"].map(|start| {
        let rest = |folder: &&PathBuf| {
            let name = folder.file_name()?.to_str()?.strip_prefix(start)?;
            name.starts_with(|c: char| c.is_ascii_digit()).then_some(())
        };
        unpacked.iter().find(|folder| rest(folder).is_some())
    });
    let (Some(bound), Some(rig), Some(core)) = (bound, rig, core) else {
        return fail("cargo package has not written three packages");
    };
    let shell = shell.env(
        "CARGO_TARGET_DIR",
        shell.root.join("target/packages").display().to_string(),
    );
    user(&shell, core)?;
    println!("    unpacked:");
    // Same optimisation as in the workspace; otherwise the tests would take minutes.
    let test = "cargo test --quiet --config profile.dev.opt-level=2 --all-features";
    shell.within(core).run(test)?;
    shell
        .within(core)
        .run(&format!("{test} --test torque_loop -- --ignored"))?;
    let patch = format!("--config patch.crates-io.bowden.path='{}'", core.display());
    shell.within(bound).run(&format!("{test} {patch}"))?;
    shell.within(rig).run(&format!("{test} {patch}"))
}

/// Unpacks each package; the folders.
fn unpack(shell: &Shell) -> Done<Vec<PathBuf>> {
    let mut folders = Vec::new();
    for file in fs::read_dir(shell.scratch.join("packed/package"))? {
        let file = file?.path();
        if file
            .extension()
            .is_some_and(|extension| extension == "crate")
        {
            // Sets the current time (m): the files of all packages have the same old date, so cargo
            // would take the build of an earlier package for the build of this one.
            shell
                .within(&shell.scratch)
                .run(&format!("tar -xzmf {}", file.display()))?;
            let name = file.file_stem().unwrap_or_default();
            folders.push(shell.scratch.join(name));
        }
    }
    Ok(folders)
}

/// Runs the README's first program in an otherwise empty project.
fn user(shell: &Shell, core: &Path) -> Done {
    let folder = shell.scratch.join("user");
    fs::create_dir_all(folder.join("src"))?;
    let readme = fs::read_to_string(shell.root.join("README.md"))?;
    let program = readme::block(&readme, "rust", "## In firmware");
    // Add `bowden = …` to your dependencies: the first code of the section.
    let section = readme.split_once("## In firmware");
    let dependency = section.and_then(|(_, text)| text.split('`').nth(1));
    let (Some(program), Some(dependency)) = (program, dependency) else {
        return fail("README.md has no program or no dependency under: In firmware");
    };
    // The README's line has a path to a clone next to the project; here it is the package.
    fs::rename(core, shell.scratch.join("bowden"))?;
    let manifest = "[package]\nname = \"user\"\nversion = \"0.0.0\"\nedition = \"2021\"\n";
    fs::write(folder.join("src/main.rs"), program)?;
    fs::write(
        folder.join("Cargo.toml"),
        format!("{manifest}[dependencies]\n{dependency}\n"),
    )?;
    println!("    in an empty project:");
    shell.within(&folder).run("cargo run --quiet")?;
    let version = rust_version(shell, "Cargo.toml")?;
    match shell.toolchain(&version) {
        Some(name) => shell
            .within(&folder)
            .run(&format!("cargo +{name} run --quiet"))?,
        None => println!("    Rust {version} is not installed: not tested with it"),
    }
    Ok(fs::rename(shell.scratch.join("bowden"), core)?)
}

/// Compares with the last tagged version.
pub fn semver(shell: &Shell) -> Done {
    if !shell.succeeds("cargo semver-checks --version") {
        return skip(
            "cargo-semver-checks is not installed (cargo install cargo-semver-checks --locked)",
        );
    }
    let tag = shell.ask("git describe --tags --abbrev=0 --match v*")?;
    if !tag.status.success() {
        return skip("no version has a tag yet; until then docs/public-api shows each change");
    }
    shell.run(&format!(
        "cargo semver-checks -p bowden -p bowden-bound -p bowden-rig --baseline-rev {}",
        text(&tag.stdout)
    ))
}

/// Licences, sources and forbidden duplicates; also advisories, if their list can be fetched.
pub fn deny(shell: &Shell) -> Done {
    if !shell.succeeds("cargo deny --version") {
        return skip("cargo-deny is not installed (cargo install cargo-deny --locked)");
    }
    let fetched = shell.run_at_most(60, "cargo deny fetch db").is_ok();
    let advisories = if fetched { "advisories" } else { "" };
    for folder in ["", "capi/", "firmware/", "fuzz/", "python/", "web/"] {
        shell.run(&format!(
            "cargo deny --manifest-path {folder}Cargo.toml --config {{root}}/deny.toml --offline \
             check bans licenses sources {advisories}"
        ))?;
    }
    if fetched {
        return Ok(());
    }
    skip("the list of advisories was not reached; licences, bans and sources passed")
}
