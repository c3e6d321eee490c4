//! A model file as a header for firmware in C.

use crate::check::{one_line, Given};
use crate::export::ModelFile;

pub use crate::export::prefix as prefix_in_c;

/// The C header of a model file: its bytes, and the functions that load them. `name`, the stem of
/// the file name, determines the names of the functions ([`prefix_in_c`]).
///
/// # Errors
/// One sentence on the first error in the text, on a name that gives no prefix, or on a part that
/// exceeds the capacity of the C interface.
pub fn model_in_c(text: &str, name: &str) -> Result<String, String> {
    // The same refusals as of a model that is checked.
    Given::parse(text)?;
    let file: ModelFile = toml::from_str(text).map_err(|e| one_line(&e.to_string()))?;
    file.c(name)
}
