//! Builds the images.

use crate::target::Target;
use anyhow::{bail, Context, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The programs of a package, by name.
pub fn images(
    root: &Path,
    target: &Target,
    package: &str,
    features: &[&str],
    names: &[&str],
) -> Result<BTreeMap<String, PathBuf>> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(root).stdout(Stdio::piped()).args([
        "build",
        "--quiet",
        "--locked",
        "--release",
        "--message-format=json-render-diagnostics",
        "--target",
        target.triple,
        "--package",
        package,
        "--features",
        &features.join(","),
    ]);
    for name in names {
        cargo.args(["--bin", name]);
    }
    for name in foreign(std::env::vars_os().map(|(name, _)| name.to_string_lossy().into_owned())) {
        cargo.env_remove(name);
    }
    let output = cargo.output().context("cargo")?;
    if !output.status.success() {
        bail!("{package} does not build for {}", target.triple);
    }
    Ok(executables(&String::from_utf8_lossy(&output.stdout)))
}

/// Variables that would measure another build than the one that the budgets are for.
fn foreign(names: impl Iterator<Item = String>) -> Vec<String> {
    let changes = |name: &String| {
        name.starts_with("CARGO_PROFILE_")
            || name.ends_with("RUSTFLAGS")
            || name.starts_with("CARGO_BUILD_")
    };
    names.filter(changes).collect()
}

/// What cargo says it has built.
fn executables(messages: &str) -> BTreeMap<String, PathBuf> {
    messages
        .lines()
        .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
        .filter_map(|message| {
            let name = message.pointer("/target/name")?.as_str()?.to_owned();
            let path = message.get("executable")?.as_str()?;
            Some((name, PathBuf::from(path)))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn executables_are_found_among_what_cargo_says() {
        let messages = concat!(
            r#"{"reason":"compiler-artifact","target":{"name":"bowden"},"executable":null}"#,
            "\n",
            r#"{"reason":"compiler-artifact","target":{"name":"pi"},"executable":"target/pi"}"#,
            "\nnot json\n",
            r#"{"reason":"build-finished","success":true}"#,
        );
        let found = executables(messages);
        assert_eq!(found.len(), 1);
        assert_eq!(found["pi"], PathBuf::from("target/pi"));
    }

    #[test]
    fn a_profile_or_flags_of_the_caller_do_not_reach_the_images() {
        let names = [
            "CARGO_PROFILE_RELEASE_LTO",
            "RUSTFLAGS",
            "CARGO_ENCODED_RUSTFLAGS",
            "CARGO_BUILD_TARGET",
            "CARGO_HOME",
            "PATH",
        ];
        let kept = foreign(names.iter().map(ToString::to_string));
        assert_eq!(kept, names[..4]);
    }
}
