//! `bowden export`: a model file as source for firmware.

use super::{outputs, Failure};
use bowden_lab::facts::{model_in_c, prefix_in_c};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct Export {
    /// The model: a file written by `identify --model-out`.
    #[arg(value_name = "MODEL.toml")]
    model: PathBuf,
    /// Write a C header that needs only the library in capi/.
    #[arg(long, required = true)]
    c: bool,
    /// Write to this file instead of stdout. The file name becomes the prefix of all names in the
    /// header, and must contain a letter from a to z or a Greek letter.
    #[arg(long, value_name = "FILE.h")]
    out: Option<PathBuf>,
}

impl Export {
    pub fn run(self) -> Result<(), Failure> {
        if let Some(path) = &self.out {
            if path.extension().is_none_or(|e| e != "h") {
                return Err(format!(
                    "--out {}: the file name must end in .h",
                    path.display()
                ));
            }
            outputs::check(&[&self.model], &[("--out", path)])?;
        }
        // Named after the file that C includes; on stdout, after the model.
        let named = self.out.as_ref().unwrap_or(&self.model);
        let name = named.file_stem().unwrap_or_default().to_string_lossy();
        prefix_in_c(&name).map_err(|e| match &self.out {
            Some(path) => format!("--out {}: {e}", path.display()),
            None => format!(
                "{}: {e}; choose the name with --out FILE.h",
                named.display()
            ),
        })?;
        let header = model_in_c(&super::check::load(&self.model)?, &name)
            .map_err(|e| format!("{}: {e}", self.model.display()))?;
        match &self.out {
            Some(path) => outputs::write_whole(path, header.as_bytes()),
            None => super::pour(header.as_bytes()),
        }
    }
}
