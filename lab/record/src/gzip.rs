//! Decompression of gzip.

use super::error::RecordError;
use super::limits::{too_large, BYTES};
use flate2::read::MultiGzDecoder;
use std::io::Read;

pub(super) fn unpack(bytes: &[u8]) -> Result<Vec<u8>, RecordError> {
    let mut unpacked = Vec::new();
    let read = MultiGzDecoder::new(bytes)
        .take(BYTES + 1)
        .read_to_end(&mut unpacked);
    match read {
        Err(error) => Err(RecordError::new(format!(
            "the gzip file is damaged: {error}"
        ))),
        Ok(_) if unpacked.len() as u64 > BYTES => Err(too_large(" when unpacked")),
        Ok(_) => Ok(unpacked),
    }
}
