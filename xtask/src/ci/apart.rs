//! Steps in the separate workspaces, and on other targets.

use super::shell::{fail, skip, text, Done, Shell};
use std::fs;
use std::thread;

const BARE_METAL: &str = "thumbv7em-none-eabihf";
const FUZZ_SECONDS: u32 = 30;

pub fn bare_metal(shell: &Shell) -> Done {
    if !shell.has_target(BARE_METAL) {
        let missing = format!("the target {BARE_METAL} is not installed");
        if !shell.succeeds("rustup --version") {
            return skip(format!("{missing}, and there is no rustup to add it"));
        }
        if shell
            .run_at_most(180, &format!("rustup target add {BARE_METAL}"))
            .is_err()
        {
            return skip(format!("{missing}, and rustup could not add it"));
        }
    }
    for (package, features) in [
        ("bowden", ""),
        ("bowden", "serde,defmt"),
        ("bowden-bound", "serde,defmt"),
        ("bowden-rig", "serde,defmt"),
    ] {
        shell.run(&format!(
            "cargo build -p {package} --target {BARE_METAL} --no-default-features --features={features}"
        ))?;
    }
    Ok(())
}

pub fn proofs(shell: &Shell) -> Done {
    if !shell.succeeds("cargo kani --version") {
        return skip(
            "Kani is not installed (cargo install --locked kani-verifier && cargo kani setup)",
        );
    }
    // If the compiler inlines a function, as it does without incremental builds, a stub has
    // nothing to replace.
    shell
        .env("CARGO_INCREMENTAL", "1")
        .run("cargo kani -p bowden")
}

pub fn theorems(shell: &Shell) -> Done {
    if !shell.succeeds("coqc --version") {
        return skip("coqc is not installed (Debian: coq libcoq-flocq libcoq-gappa gappa)");
    }
    shell.run("bash theorems/check")
}

/// The cost of the steps on a microcontroller, in a separate workspace; it runs in QEMU.
pub fn firmware(shell: &Shell) -> Done {
    let shell = shell.within("firmware");
    shell.run("cargo fmt --all --check")?;
    shell.run("cargo clippy --locked --all-targets -- -D warnings")?;
    shell.run("cargo test --locked --quiet")?;
    for target in [BARE_METAL, "riscv32imc-unknown-none-elf"] {
        if shell.has_target(target) {
            shell.run(&format!(
                "cargo clippy --locked --release -p bowden-image --target {target} -- -D warnings"
            ))?;
        }
    }
    if shell.has_target(BARE_METAL) {
        shell.run(&format!(
            "cargo clippy --locked --release -p bowden-firmware-examples --features board \
             --target {BARE_METAL} -- -D warnings"
        ))?;
    }
    shell.run_or_skip("cargo xtask")
}

/// The C interface, in a separate workspace: its header, and C programs that use its library.
pub fn c_api(shell: &Shell) -> Done {
    let shell = shell.within("capi");
    shell.run("cargo fmt --all --check")?;
    shell.run("cargo clippy --locked --workspace --all-targets -- -D warnings")?;
    if shell.has_target(BARE_METAL) {
        shell.run(&format!(
            "cargo clippy --locked --release --lib --target {BARE_METAL} -- -D warnings"
        ))?;
    }
    shell
        .env("RUSTDOCFLAGS", "-D warnings")
        .run("cargo doc --locked --no-deps")?;
    shell.run("cargo xtask header --check")?;
    shell.run_or_skip("cargo test --locked -- --nocapture")
}

/// The seeds with the usual toolchain; then, if nightly Rust and cargo-fuzz are installed, each
/// target. Findings stay out of the repository; seeds are only read.
pub fn fuzzing(shell: &Shell) -> Done {
    shell
        .within("fuzz")
        .run("cargo test --locked --lib --no-default-features")?;
    if shell.toolchain("nightly").is_none() || !shell.succeeds("cargo fuzz --version") {
        return skip(
            "cargo-fuzz or nightly Rust is not installed (cargo install cargo-fuzz --locked); \
             the seeds passed",
        );
    }
    shell.run("cargo +nightly fuzz build")?;
    let targets = shell.output("cargo fuzz list")?;
    let targets: Vec<&str> = targets.split_whitespace().collect();
    if targets.is_empty() {
        return fail("cargo fuzz list names no target");
    }
    let at_once = thread::available_parallelism().map_or(1, usize::from);
    for targets in targets.chunks(at_once) {
        let done: Vec<Done> = thread::scope(|scope| {
            let started = targets
                .iter()
                .map(|target| scope.spawn(|| fuzz(shell, target)));
            let started: Vec<_> = started.collect();
            let ended = started.into_iter().map(|thread| thread.join());
            ended
                .map(|done| done.unwrap_or_else(|_| fail("a thread panicked")))
                .collect()
        });
        done.into_iter().collect::<Done>()?;
    }
    Ok(())
}

fn fuzz(shell: &Shell, target: &str) -> Done {
    fs::create_dir_all(shell.root.join("fuzz/corpus").join(target))?;
    let command = format!(
        "cargo +nightly fuzz run {target} fuzz/corpus/{target} fuzz/seeds/{target} -- \
         -max_total_time={FUZZ_SECONDS} -timeout=10 -print_final_stats=1"
    );
    let output = shell.ask(&command)?;
    let log = text(&output.stdout) + &text(&output.stderr);
    let lines: Vec<&str> = log.lines().collect();
    if !output.status.success() {
        let end = lines[lines.len().saturating_sub(40)..].join("\n");
        return fail(format!("{end}\n    {target}: see fuzz/artifacts/{target}"));
    }
    let counts = lines.iter().filter(|line| {
        line.contains("number_of_executed_units")
            || (line.starts_with('#') && line.contains("DONE"))
    });
    let counts: String = counts
        .map(|line| format!("    {}\n", line.trim()))
        .collect();
    print!("    $ {command}\n{counts}");
    Ok(())
}

/// The wheel in a virtual environment (kept in target/, so that packages are fetched once): its
/// tests against the program, its types, its notebook.
pub fn python(shell: &Shell) -> Done {
    if !shell.succeeds("python3 --version") {
        return skip("python3 is not installed");
    }
    let script = shell.scratch.join("recent.py");
    fs::write(script, "import sys; sys.exit(sys.version_info < (3, 9))")?;
    if !shell.succeeds("python3 {scratch}/recent.py") {
        return skip("python3 is older than 3.9");
    }
    let venv = shell.root.join("target/venv-python");
    if !venv.join("bin/python").exists() {
        let _ = fs::remove_dir_all(&venv);
        if !shell.succeeds("python3 -m venv target/venv-python") {
            return skip("python3 cannot create a virtual environment (Debian: python3-venv)");
        }
    }
    let path = std::env::var("PATH").unwrap_or_default();
    let shell = shell
        .env("VIRTUAL_ENV", venv.display().to_string())
        .env("PATH", format!("{}/bin:{path}", venv.display()))
        .env("PIP_DISABLE_PIP_VERSION_CHECK", "1")
        .env(
            "BOWDEN_PROGRAM",
            shell.root.join("target/debug/bowden").display().to_string(),
        );
    let requirements = "{root}/target/venv-python/bin/pip install --quiet --requirement python/requirements-test.txt";
    if shell.run_at_most(240, requirements).is_err() {
        return skip(
            "pip could not install python/requirements-test.txt (is the registry reached?)",
        );
    }
    let built = "--manifest-path python/Cargo.toml --target-dir target --locked";
    let bin = "{root}/target/venv-python/bin";
    let within = shell.within("python");
    within.run("cargo fmt --check")?;
    shell.run(&format!("cargo clippy {built} --quiet -- -D warnings"))?;
    shell.run("cargo build --quiet -p bowden-cli")?;
    shell.run(&format!(
        "{bin}/maturin build {built} --profile dev --quiet --out {{scratch}}/wheels"
    ))?;
    for wheel in fs::read_dir(shell.scratch.join("wheels"))? {
        let wheel = wheel?.path();
        shell.run(&format!(
            "{bin}/pip install --quiet --force-reinstall --no-deps {}",
            wheel.display()
        ))?;
    }
    within.run(&format!("{bin}/python -m pytest -q"))?;
    within.run(&format!("{bin}/mypy package/bowden tests/sample_typed.py"))?;
    within.run(&format!(
        "{bin}/jupyter nbconvert --to html --execute examples/close_the_loop.ipynb \
         --log-level ERROR --output-dir {{scratch}}"
    ))
}

/// The page in a browser, in a separate workspace: Chromium must give the program's answers.
pub fn web(shell: &Shell) -> Done {
    // What the lab and its dependencies have built is not built again.
    let target = shell.root.join("target").display().to_string();
    let shell = shell.within("web").env("CARGO_TARGET_DIR", target);
    shell.run("cargo fmt --all --check")?;
    shell.run("cargo clippy --locked --all-targets -- -D warnings")?;
    if shell.has_target("wasm32-unknown-unknown") {
        shell.run(
            "cargo clippy --locked --package bowden-web --target wasm32-unknown-unknown -- -D warnings",
        )?;
    }
    shell.run("cargo test --locked --quiet")?;
    shell.run_or_skip("cargo xtask test")
}
