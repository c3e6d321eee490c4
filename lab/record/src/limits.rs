//! Limits on the size of a file and its parts. No more is read, whatever sizes the file states.

use super::error::RecordError;

/// Maximum number of bytes of a file, and of its unpacked contents. This is about ten hours of six
/// columns at 1 kHz.
pub(super) const BYTES: u64 = 1 << 31;
/// Maximum number of parts: bytes in a line or in the part that identifies the format, column
/// names, variables, and cells.
pub(super) const PIECES: usize = 1 << 16;
/// Maximum number of columns in a sheet or a matrix. A wider matrix is an image.
pub(super) const COLUMNS: usize = 256;
/// Maximum depth of nested matrices, cells and structures.
pub(super) const DEPTH: usize = 6;
/// Maximum number of lines in which the table of a text is searched, with an average length of 1
/// KiB.
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

/// The error for a file with too many bytes. `how` describes their location.
pub(super) fn too_large(how: &str) -> RecordError {
    let size = BYTES >> 20;
    RecordError::new(format!(
        "the file is larger than {size} MiB{how}; split it into records"
    ))
}
