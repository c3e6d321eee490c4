//! The origin of a record: the length and hash of its file.

use crate::record::{self, Options, Record, RecordError};
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::path::Path;

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// Its path as it was given.
    pub path: String,
    /// Its length \[bytes\].
    pub bytes: usize,
    /// Its SHA-256 in hexadecimal digits.
    pub sha256: String,
}

impl Source {
    /// The source of a file.
    ///
    /// # Errors
    /// A message with the file.
    pub fn of_file(path: &Path) -> Result<Self, String> {
        let label = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|e| format!("{label}: {e}"))?;
        Ok(Self::of_bytes(&label, &bytes))
    }

    /// The source of bytes in memory. `label` replaces the name of their file.
    #[must_use]
    pub fn of_bytes(label: &str, bytes: &[u8]) -> Self {
        let mut sha256 = String::with_capacity(64);
        for byte in Sha256::digest(bytes) {
            let _ = write!(sha256, "{byte:02x}");
        }
        Self {
            path: label.to_owned(),
            bytes: bytes.len(),
            sha256,
        }
    }
}

/// Reads a record together with the hash of the same bytes.
///
/// # Errors
/// The error, with its position in the file.
pub fn read_with_source(path: &Path, options: &Options) -> Result<(Record, Source), RecordError> {
    let label = path.display().to_string();
    let bytes = record::load(path)?;
    let record = record::parse(&bytes, &label, options)?;
    Ok((record, Source::of_bytes(&label, &bytes)))
}

#[cfg(test)]
mod tests {
    use super::Source;

    #[test]
    fn the_hash_is_that_of_the_standard() {
        // FIPS 180-4, example of one block.
        let source = Source::of_bytes("abc", b"abc");
        assert_eq!(source.bytes, 3);
        assert_eq!(
            source.sha256,
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
    }
}
