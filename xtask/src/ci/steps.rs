//! The table of steps, in the order in which they run, and the steps of a few commands each.

use super::shell::{Done, Shell};
use super::{apart, lab, packages, readme, repository, slow};

/// One step.
pub struct Step {
    pub name: &'static str,
    pub heading: &'static str,
    /// Only this step builds in this folder.
    pub folder: Option<&'static str>,
    /// In a run of every step, it starts only in time.
    pub late: bool,
    pub run: fn(&Shell) -> Done,
}

const fn step(name: &'static str, heading: &'static str, run: fn(&Shell) -> Done) -> Step {
    Step {
        name,
        heading,
        folder: None,
        late: false,
        run,
    }
}

impl Step {
    const fn builds_in(mut self, folder: &'static str) -> Self {
        self.folder = Some(folder);
        self
    }

    const fn late(mut self) -> Self {
        self.late = true;
        self
    }
}

#[rustfmt::skip]
pub const STEPS: &[Step] = &[
    step("tracked-files", "no build products, no file over 500 lines, no machine-specific paths", repository::tracked_files),
    step("lock-file", "Cargo.lock is committed and up to date", repository::lock_file),
    step("formatting", "rustfmt changes nothing", |shell| shell.run("cargo fmt --all --check")),
    step("run-time-dependencies", "the core depends only on num-traits and libm", packages::run_time_dependencies),
    step("tests", "the README's test command", tests),
    step("identification", "slow: every effect, nulls of three colours, parameters, several records, the generator", |shell| slow::run(shell, "identification")),
    step("conclusions", "slow: verdicts and sentences, validation, power, plan, exported models", |shell| slow::run(shell, "conclusions")),
    step("measured-records", "slow: published measured records, if present", |shell| slow::run(shell, "measured-records")),
    step("closed-loop", "slow: models identified on the rig lower the tracking error", |shell| slow::run(shell, "closed-loop")),
    step("results", "slow: the code reproduces one table of the results per run, in turn", lab::results),
    step("ledger", "the README's run command prints a results table", lab::ledger),
    step("same-bytes", "the same record gives identical output bytes", lab::same_bytes),
    step("bad-input", "a bad record gives one clear line and exit status 2", lab::bad_input),
    step("lints", "clippy has no warnings", |shell| shell.run("cargo clippy --workspace --all-targets --all-features -- -D warnings")),
    step("features", "core and rig with every combination of their features", features),
    step("bound", "slow: a million adversarial steps against the ultimate error bound", |shell| slow::run(shell, "bound")),
    step("docs", "the documentation builds without warnings", docs),
    step("links", "links from the pages to files of the repository are valid", repository::page_links),
    step("bare-metal", "core and rig build for thumbv7em-none-eabihf", apart::bare_metal),
    // Checked, not built: linking ten programs that are not run here would take minutes.
    step("benches", "the benchmarks compile", |shell| shell.run("cargo check --workspace --benches")),
    step("oldest-rust-core", "the core builds with its minimum supported Rust version", |shell| packages::oldest_rust(shell, "bowden", "Cargo.toml")),
    step("oldest-rust-lab", "the lab builds with its minimum supported Rust version", |shell| packages::oldest_rust(shell, "bowden-cli", "lab/cli/Cargo.toml")),
    step("packages", "the packages build and pass their tests outside the repository", packages::packages).builds_in("target/packages"),
    step("public-api", "the public interface matches docs/public-api", repository::public_api).builds_in("target/public-api"),
    step("semver", "changes since the last tagged version respect semantic versioning", packages::semver),
    step("deny", "the dependencies have allowed licences and sources, and no advisories", packages::deny),
    step("proofs-table", "the table of proofs matches the sources", |shell| shell.run("bash proofs/table --check")),
    // Links only if no public function of the core or of the rig can panic; needs a Unix linker.
    step("no-panic", "no public function of the core or of the rig can panic", |shell| shell.run("bash proofs/no_panic/check")).builds_in("proofs/no_panic/target"),
    step("firmware", "each firmware step within its budget on three targets, with the host's numbers", apart::firmware).builds_in("firmware/target"),
    step("c-api", "the C interface: its header, and C programs here, under sanitizers and on a Cortex-M", apart::c_api).builds_in("capi/target").late(),
    step("python", "the Python wheel: its tests against the program, its types, its notebook", apart::python).builds_in("target/venv-python").late(),
    step("web", "the page in Chromium: the program's answers, no other request, no error", apart::web).late(),
    step("exhaustive", "the assumptions of the proofs about libm, at all 2^32 arguments", |shell| shell.run("cargo test --release -p bowden --test exhaustive -- --ignored")).late(),
    step("theorems", "Coq checks the theorems and three certificates, and rejects tampered ones", apart::theorems).late(),
    step("fuzzing", "the seeds, and each fuzz target for 30 seconds", apart::fuzzing).builds_in("fuzz/target").late(),
    step("proofs", "Kani verifies its proof harnesses", apart::proofs),
];

fn tests(shell: &Shell) -> Done {
    readme::documents(shell, "cargo test")?;
    shell.run("cargo test")?;
    shell.run("cargo test --quiet -p bowden-xtask")
}

/// Every combination of the three features. Clippy checks as `cargo check` does, and can deny
/// warnings without building every dependency anew.
fn features(shell: &Shell) -> Done {
    for some in 0..8 {
        let names = ["serde,", "defmt,", "std,"].into_iter().enumerate();
        let set: String = names
            .filter(|(at, _)| some >> at & 1 == 1)
            .map(|(_, name)| name)
            .collect();
        for package in ["bowden", "bowden-bound", "bowden-rig"] {
            shell.run(&format!(
                "cargo clippy -p {package} --no-default-features --features={set} -- -D warnings"
            ))?;
        }
    }
    for set in ["", "mat", "parquet", "xlsx"] {
        shell.run(&format!(
            "cargo clippy -p bowden-record --no-default-features --features={set} -- -D warnings"
        ))?;
    }
    Ok(())
}

fn docs(shell: &Shell) -> Done {
    let shell = shell.env("RUSTDOCFLAGS", "-D warnings");
    shell.run("cargo doc --workspace --no-deps --all-features")
}
