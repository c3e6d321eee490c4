//! What a file may claim at most. Whatever it states of itself, no more is read.

use super::error::RecordError;

/// Bytes of a file, and of all that is unpacked from it: about ten hours of six columns at 1 kHz.
pub(super) const BYTES: u64 = 1 << 31;
/// Pieces of a file: bytes of a line or of the beginning that tells its form, names of columns,
/// variables and cells.
pub(super) const PIECES: usize = 1 << 16;
/// Columns of a sheet or a matrix: a wider matrix is an image.
pub(super) const COLUMNS: usize = 256;
/// Matrices in cells in structures in …: no record needs more.
pub(super) const DEPTH: usize = 6;
/// Lines in which the table of a text is searched, of a KiB on average.
const HEAD: usize = 1000;

/// The first lines of a text, each with its position.
pub(super) fn head(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut end = 0;
    text.split_inclusive('\n')
        .take(HEAD)
        .map_while(move |line| {
            let start = end;
            end += line.len();
            (end <= HEAD << 10).then_some((start, line))
        })
}

/// The refusal of a file with more bytes; `how` says where they are.
pub(super) fn too_large(how: &str) -> RecordError {
    let size = BYTES >> 20;
    RecordError::new(format!(
        "the file is larger than {size} MiB{how}; split it into records"
    ))
}
