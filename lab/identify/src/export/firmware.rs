//! The model as bytes that firmware reads without a compiler: postcard with a checksum.

use super::{ModelFile, MOST_TERMS};
use bowden::model::Model;
use crc::{Crc, CRC_32_ISO_HDLC};

/// The checksum after the model: CRC-32/ISO-HDLC, as in zlib and most CRC units.
pub const CHECKSUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The model in `f32` as postcard, four bytes of CRC-32 last.
///
/// The bytes contain the number of terms, so they can be read into any capacity that is large
/// enough.
///
/// # Errors
/// A message with the part that the core refuses.
pub fn postcard(file: &ModelFile) -> Result<Vec<u8>, String> {
    let model: Model<f32, MOST_TERMS> = file.model_in()?;
    postcard::to_allocvec_crc32(&model, CHECKSUM.digest()).map_err(|e| e.to_string())
}

/// The same in `f64`.
pub(super) fn bytes_in_double(file: &ModelFile) -> Result<Vec<u8>, String> {
    let model: Model<f64, MOST_TERMS> = file.model_in()?;
    postcard::to_allocvec_crc32(&model, CHECKSUM.digest()).map_err(|e| e.to_string())
}
