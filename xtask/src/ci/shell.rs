//! Commands of the steps.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// Why a step did not pass.
pub enum Stop {
    Failed(String),
    /// The step cannot run on this machine.
    Skipped(String),
}

pub type Done<T = ()> = Result<T, Stop>;

pub fn fail<T>(reason: impl Into<String>) -> Done<T> {
    Err(Stop::Failed(reason.into()))
}

pub fn skip<T>(reason: impl Into<String>) -> Done<T> {
    Err(Stop::Skipped(reason.into()))
}

impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Self {
        Self::Failed(error.to_string())
    }
}

/// Where a step's commands run, and their environment variables.
#[derive(Clone)]
pub struct Shell {
    /// The folder of the repository.
    pub root: PathBuf,
    /// An empty folder for the step's own files.
    pub scratch: PathBuf,
    folder: PathBuf,
    variables: Vec<(&'static str, String)>,
}

impl Shell {
    pub fn new(root: PathBuf) -> io::Result<Self> {
        let scratch = std::env::temp_dir().join(format!("bowden-ci-{}", std::process::id()));
        fs::create_dir_all(&scratch)?;
        Ok(Self {
            folder: root.clone(),
            root,
            scratch,
            variables: Vec::new(),
        })
    }

    /// The same with an empty scratch folder.
    pub fn anew(&self) -> io::Result<Self> {
        fs::remove_dir_all(&self.scratch)?;
        fs::create_dir(&self.scratch)?;
        Ok(self.clone())
    }

    /// The same in another folder, relative to the repository or absolute.
    pub fn within(&self, folder: impl AsRef<Path>) -> Self {
        let mut shell = self.clone();
        shell.folder = self.root.join(folder);
        shell
    }

    /// The same with an environment variable.
    pub fn env(&self, name: &'static str, value: impl Into<String>) -> Self {
        let mut shell = self.clone();
        shell.variables.push((name, value.into()));
        shell
    }

    /// The words of a command, in which `{root}` and `{scratch}` are replaced.
    fn command(&self, words: &str) -> Command {
        let mut words = words.split_whitespace().map(|word| {
            word.replace("{root}", &self.root.display().to_string())
                .replace("{scratch}", &self.scratch.display().to_string())
        });
        let mut command = Command::new(words.next().unwrap_or_default());
        command
            .args(words)
            .current_dir(&self.folder)
            .envs(self.variables.iter().map(|(name, value)| (name, value)))
            .stdin(Stdio::null());
        command
    }

    /// Prints a command, then runs it.
    pub fn run(&self, command: &str) -> Done {
        println!("    $ {command}");
        match self.command(command).status() {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => fail(format!("{command}: {status}")),
            Err(error) => fail(format!("{command}: {error}")),
        }
    }

    /// The exit status and the output of a command.
    pub fn ask(&self, command: &str) -> Done<Output> {
        let output = self.command(command).output();
        output.or_else(|error| fail(format!("{command}: {error}")))
    }

    /// What a command writes to stdout; fails if the command does.
    pub fn output(&self, command: &str) -> Done<String> {
        let output = self
            .command(command)
            .stderr(Stdio::inherit())
            .output()
            .or_else(|error| fail(format!("{command}: {error}")))?;
        if !output.status.success() {
            return fail(format!("{command}: {}", output.status));
        }
        Ok(text(&output.stdout))
    }

    /// Whether a command exists and succeeds, without its output.
    pub fn succeeds(&self, command: &str) -> bool {
        let output = self.command(command).output();
        output.is_ok_and(|output| output.status.success())
    }

    /// Runs a command with a time limit in seconds, if the machine can set one.
    pub fn run_at_most(&self, seconds: u32, command: &str) -> Done {
        if self.succeeds("timeout 1 true") {
            self.run(&format!("timeout {seconds} {command}"))
        } else {
            self.run(command)
        }
    }

    /// Prints a command and its indented output. A line `skipped: REASON` of a command that
    /// succeeds or exits with status 77 skips the step.
    pub fn run_or_skip(&self, command: &str) -> Done {
        println!("    $ {command}");
        let output = self.ask(command)?;
        let printed = text(&output.stdout) + &text(&output.stderr);
        for line in printed.lines() {
            println!("    {line}");
        }
        if !output.status.success() && output.status.code() != Some(77) {
            return fail(format!("{command}: {}", output.status));
        }
        let reasons = printed.lines().filter_map(|line| {
            let (_, reason) = line.split_once("skipped: ")?;
            Some(reason)
        });
        let reasons: Vec<&str> = reasons.collect();
        if reasons.is_empty() && output.status.success() {
            return Ok(());
        }
        skip(reasons.join(";"))
    }

    /// Megabytes that can still be written in the repository, if `df` says so.
    pub fn free_megabytes(&self) -> Option<u64> {
        let output = self.command("df -Pk .").output().ok()?;
        let printed = text(&output.stdout);
        let free = printed.lines().nth(1)?.split_whitespace().nth(3)?;
        Some(free.parse::<u64>().ok()? / 1024)
    }

    /// Whether the compiler has a core library for the target.
    pub fn has_target(&self, target: &str) -> bool {
        let folder = self.ask(&format!("rustc --print target-libdir --target {target}"));
        let Ok(folder) = folder else { return false };
        let files = fs::read_dir(text(&folder.stdout).trim());
        files.is_ok_and(|files| {
            files.flatten().any(|file| {
                let name = file.file_name();
                name.to_string_lossy().starts_with("libcore-")
            })
        })
    }

    /// The full name of a toolchain, if rustup has it here.
    pub fn toolchain(&self, version: &str) -> Option<String> {
        let listed = self.command("rustup toolchain list").output().ok()?;
        find_toolchain(&text(&listed.stdout), version)
    }
}

/// The first toolchain of this version, or of one of its patches.
fn find_toolchain(listed: &str, version: &str) -> Option<String> {
    let mut names = listed.lines().filter_map(|l| l.split_whitespace().next());
    let found = names.find(|name| {
        let rest = name.strip_prefix(version);
        let rest = rest.map(|rest| match rest.strip_prefix('.') {
            Some(patch) => patch.trim_start_matches(|c: char| c.is_ascii_digit()),
            None => rest,
        });
        rest.is_some_and(|rest| rest.starts_with('-'))
    });
    found.map(str::to_owned)
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::find_toolchain;

    #[test]
    fn a_toolchain_is_found_by_its_version_or_by_one_of_its_patches() {
        let listed = "stable-x86_64-linux (active)\n1.85.1-x86_64-linux\n1.8-x86_64-linux\n";
        let found = |version| find_toolchain(listed, version);
        assert_eq!(found("stable").as_deref(), Some("stable-x86_64-linux"));
        assert_eq!(found("1.85").as_deref(), Some("1.85.1-x86_64-linux"));
        assert_eq!(found("1.8").as_deref(), Some("1.8-x86_64-linux"));
        assert_eq!(found("1.86"), None);
    }
}
