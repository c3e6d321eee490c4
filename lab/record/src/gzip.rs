//! Decompression of gzip.

use super::error::RecordError;
use flate2::read::MultiGzDecoder;
use std::io::Read;

/// Most that is unpacked [bytes], as of a plain file.
const LIMIT: u64 = super::file::LIMIT;

pub(super) fn unpack(bytes: &[u8]) -> Result<Vec<u8>, RecordError> {
    let mut unpacked = Vec::new();
    let read = MultiGzDecoder::new(bytes)
        .take(LIMIT + 1)
        .read_to_end(&mut unpacked);
    match read {
        Err(error) => Err(RecordError::new(format!(
            "the gzip file is damaged: {error}"
        ))),
        Ok(_) if unpacked.len() as u64 > LIMIT => Err(RecordError::new(format!(
            "is larger than {} MiB unpacked; cut it into records",
            LIMIT >> 20
        ))),
        Ok(_) => Ok(unpacked),
    }
}
