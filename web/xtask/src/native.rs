//! The native program, with which the page is compared.

use crate::{failed, root, Ended};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The program and the folder in which it runs.
pub struct Native {
    program: PathBuf,
    folder: PathBuf,
}

impl Native {
    /// Builds the program, and copies the example records to the folder.
    pub fn build() -> Result<Self, Ended> {
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
        let output = Command::new(cargo)
            .current_dir(root().join(".."))
            .args(["build", "--release", "--locked", "--bin", "bowden"])
            .args(["--message-format", "json-render-diagnostics"])
            .stderr(std::process::Stdio::inherit())
            .output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let mut executable = text.lines().filter_map(|line| {
            let message: Value = serde_json::from_str(line).ok()?;
            message["executable"].as_str().map(PathBuf::from)
        });
        let program = executable
            .next_back()
            .ok_or_else(|| failed("the program bowden does not compile"))?;
        let folder = std::env::temp_dir().join(format!("bowden-native-{}", std::process::id()));
        std::fs::create_dir_all(&folder)?;
        for name in [
            "rig.csv",
            "damper.csv",
            "straight.csv",
            "straight_later.csv",
            "bent.csv",
        ] {
            std::fs::copy(examples().join(name), folder.join(name))?;
        }
        let workbook = root().join("../lab/cli/tests/cli/reading/files/vectors.xlsx");
        std::fs::copy(workbook, folder.join("vectors.xlsx"))?;
        Ok(Self { program, folder })
    }

    /// The folder with the records.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Writes a file into the folder.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, Ended> {
        let path = self.folder.join(name);
        std::fs::write(&path, bytes)?;
        Ok(path)
    }

    /// The JSON that a command line of the page prints.
    pub fn run(&self, line: &str) -> Result<Value, Ended> {
        Ok(serde_json::from_str(
            &self.text(&format!("{line} --json"))?,
        )?)
    }

    /// The text that a command line prints.
    pub fn text(&self, line: &str) -> Result<String, Ended> {
        let output = self.output(line)?;
        match output.status.success() {
            true => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
            false => Err(failed(format!(
                "{line}: {}",
                String::from_utf8_lossy(&output.stderr)
            ))),
        }
    }

    /// The error line of a command that fails, without the name of the program.
    pub fn refusal(&self, line: &str) -> Result<String, Ended> {
        let output = self.output(line)?;
        let text = String::from_utf8_lossy(&output.stderr);
        let said = text.trim();
        Ok(said.strip_prefix("bowden: ").unwrap_or(said).to_owned())
    }

    /// Runs a command line of the page, with one thread.
    fn output(&self, line: &str) -> Result<std::process::Output, Ended> {
        let words = line
            .strip_prefix("bowden ")
            .ok_or_else(|| failed("no command"))?;
        Ok(Command::new("sh")
            .current_dir(&self.folder)
            .env("RAYON_NUM_THREADS", "1")
            .arg("-c")
            .arg(format!("exec \"$0\" {words}"))
            .arg(&self.program)
            .output()?)
    }

    /// The report page that the last run wrote, with the command line of the page.
    pub fn report(&self) -> Result<String, Ended> {
        let html = std::fs::read_to_string(self.folder.join("report.html"))?;
        Ok(html.replace(" --json</code>", "</code>"))
    }
}

impl Drop for Native {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

/// The example records.
pub fn examples() -> PathBuf {
    root().join("../examples/data")
}
