//! Bytes from a path, with a limit for endless files.

use super::encoding;
use super::error::RecordError;
use super::kind::{self, Kind};
use super::limits::{too_large, BYTES, PIECES};
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

pub(super) fn load(path: &Path, label: &str) -> Result<Vec<u8>, RecordError> {
    let refuse = |message: String| RecordError::new(message).in_file(label);
    let failed = |error: std::io::Error| {
        refuse(match error.kind() {
            ErrorKind::NotFound => "no such file".to_owned(),
            ErrorKind::PermissionDenied => "no permission to read the file".to_owned(),
            ErrorKind::IsADirectory => {
                "this is a folder; pass a record file, such as CSV, JSON or .xlsx".to_owned()
            }
            _ => format!("the file cannot be read: {error}"),
        })
    };
    // A pipe has no size and is fine; only a folder is refused beforehand.
    if std::fs::metadata(path).map_err(failed)?.is_dir() {
        return Err(refuse(
            "this is a folder; pass a record file, such as CSV, JSON or .xlsx".to_owned(),
        ));
    }
    let mut file = File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    (&mut file)
        .take(PIECES as u64)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    // A file that is not read is not taken in further.
    let kind = kind::of(&bytes).map_err(|error| error.in_file(label))?;
    if kind != Kind::Text || !bytes.contains(&0) || encoding::is_wide(&bytes) {
        (&mut file)
            .take(BYTES)
            .read_to_end(&mut bytes)
            .map_err(failed)?;
    }
    if bytes.len() as u64 > BYTES {
        return Err(too_large("").in_file(label));
    }
    Ok(bytes)
}
