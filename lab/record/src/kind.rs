//! The format of a file from its first bytes, independent of its name.

use super::error::RecordError;

/// The supported formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Text,
    Gzip,
    Mat,
    /// A MAT-file of version 7.3, which is HDF5.
    MatHdf5,
    Parquet,
    /// A zip archive of NumPy arrays.
    Npz,
    /// One NumPy array.
    Npy,
    /// An Excel workbook, a zip archive of XML.
    Xlsx,
}

/// Unsupported formats: their first bytes, their name, and what to do instead.
const OTHERS: [(&[u8], &str, &str); 15] = [
    (
        b"PK\x03\x04",
        "a zip archive without an Excel workbook (.xlsx)",
        "unpack it, or save the sheet as CSV",
    ),
    (
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "an old Excel workbook (.xls) or one with a password",
        "save the sheet as CSV, or as .xlsx without a password",
    ),
    (b"%PDF", "a PDF", "export the values as CSV"),
    (b"TDSm", "a LabVIEW TDMS file", "export it as CSV or .mat"),
    (
        b"\x28\xb5\x2f\xfd",
        "compressed with zstd",
        "unpack it with `zstd -d`, or use gzip",
    ),
    (b"\x89HDF\r\n\x1a\n", "an HDF5 file", HDF5),
    (
        b"BZh",
        "compressed with bzip2",
        "unpack it with `bunzip2`, or use gzip",
    ),
    (
        b"\xfd7zXZ\0",
        "compressed with xz",
        "unpack it with `unxz`, or use gzip",
    ),
    (
        b"\x04\x22\x4d\x18",
        "compressed with lz4",
        "unpack it with `lz4 -d`, or use gzip",
    ),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive", "unpack it"),
    (b"Rar!", "a rar archive", "unpack it"),
    (b"MDF     ", "an ASAM MDF file", "export it as CSV or .mat"),
    (b"ARROW1", "an Arrow file", "save it as Parquet"),
    (
        b"SQLite format 3\0",
        "an SQLite database",
        "export the values as CSV",
    ),
    (
        b"{\\rtf",
        "a word-processor document",
        "export the values as CSV",
    ),
];

const HDF5: &str = "save it as CSV, Parquet or .mat v5";
/// The command that saves a supported format in MATLAB.
const V7: &str = "save it in MATLAB with `save -v7`";

/// The format of a file.
///
/// # Errors
/// A message with the unsupported format, and what to do instead.
pub(super) fn of(bytes: &[u8]) -> Result<Kind, RecordError> {
    let refuse = |what: &str, instead: &str| {
        let message = format!("the file is {what}, which bowden does not read; {instead}");
        Err(RecordError::new(message))
    };
    if bytes.starts_with(b"\x1f\x8b") {
        return Ok(Kind::Gzip);
    }
    // A column may be called `PAR1`; a file of Parquet goes on with a number.
    let number = |b: &u8| b.is_ascii_control() && !b.is_ascii_whitespace();
    if bytes.starts_with(b"PAR1") && bytes.get(4).is_none_or(number) {
        return Ok(Kind::Parquet);
    }
    if bytes.starts_with(b"PARE") {
        return refuse("an encrypted Parquet file", "save it without encryption");
    }
    // Behind the header of MATLAB.
    let behind = bytes.get(512..).unwrap_or_default();
    if bytes.starts_with(b"MATLAB 7.3 MAT-file") || behind.starts_with(b"\x89HDF\r\n\x1a\n") {
        return Ok(Kind::MatHdf5);
    }
    // The version and the order of its bytes, behind a text that anyone may have written.
    if matches!(bytes.get(124..128), Some(b"\x00\x01IM" | b"\x01\x00MI")) {
        return Ok(Kind::Mat);
    }
    if bytes.starts_with(b"\x93NUMPY") {
        return Ok(Kind::Npy);
    }
    if let Some(name) = first_of_zip(bytes) {
        let is_office = |part: &&[u8]| name.starts_with(part);
        let parts: [&[u8]; 5] = [
            b"[Content_Types].xml",
            b"_rels/",
            b"docProps/",
            b"customXml/",
            b"xl/",
        ];
        if name.ends_with(b".npy") {
            return Ok(Kind::Npz);
        }
        if parts.iter().any(is_office) {
            return Ok(Kind::Xlsx);
        }
    }
    if is_mat_4(bytes) {
        return refuse("a MATLAB file of version 4", V7);
    }
    match OTHERS.iter().find(|(magic, ..)| bytes.starts_with(magic)) {
        Some((_, what, instead)) => refuse(what, instead),
        None => Ok(Kind::Text),
    }
}

/// The name of the first file in a zip archive; the length of the name is before it.
fn first_of_zip(bytes: &[u8]) -> Option<&[u8]> {
    let own = bytes.strip_prefix(b"PK\x03\x04")?.get(22..)?;
    let (length, rest) = own.split_first_chunk::<2>()?;
    rest.get(2..)?
        .get(..usize::from(u16::from_le_bytes(*length)))
}

/// Whether a file is a MAT-file of version 4. This version has no signature, but a header of five
/// numbers and a name that ends with NUL.
fn is_mat_4(bytes: &[u8]) -> bool {
    let number = |index: usize, of: fn([u8; 4]) -> u32| -> Option<u32> {
        let own = bytes.get(4 * index..4 * index + 4)?;
        own.try_into().ok().map(of)
    };
    [u32::from_le_bytes as fn([u8; 4]) -> u32, u32::from_be_bytes]
        .into_iter()
        .any(|of| {
            let header: Option<Vec<u32>> = (0..5).map(|index| number(index, of)).collect();
            let Some([kind, rows, columns, complex, length]) = header.as_deref() else {
                return false;
            };
            let digits = [kind / 1000, kind / 100 % 10, kind / 10 % 10, kind % 10];
            let name = bytes.get(20..20 + (*length).min(64) as usize);
            digits[0] <= 4
                && digits[1] == 0
                && digits[2] <= 5
                && digits[3] <= 2
                && *rows > 0
                && *columns > 0
                && *complex <= 1
                && (2..=64).contains(length)
                && name
                    .and_then(<[u8]>::split_last)
                    .is_some_and(|(end, name)| {
                        *end == 0 && name.iter().all(|b| b.is_ascii_alphanumeric() || *b == b'_')
                    })
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_other_form_is_named_with_what_to_do_instead() {
        for (magic, what, instead) in OTHERS {
            let line = of(magic).unwrap_err().to_string();
            assert_eq!(
                line,
                format!(": the file is {what}, which bowden does not read; {instead}")
            );
        }
        let line = |bytes: &[u8]| of(bytes).unwrap_err().to_string();
        let v4 = b"\0\0\0\0\x02\0\0\0\x01\0\0\0\0\0\0\0\x02\0\0\0x\0";
        assert!(line(v4).contains("version 4"));
        assert!(line(b"PARE").contains("encrypted"));
    }

    #[test]
    fn hdf5_behind_a_header_is_matlab_7_3() {
        let v7_3 = [b"MATLAB 7.3 MAT-file, Platform".as_slice(), &[b' '; 483]].concat();
        assert_eq!(of(&v7_3).unwrap(), Kind::MatHdf5);
        let other = [&[b' '; 512], b"\x89HDF\r\n\x1a\n".as_slice()].concat();
        assert_eq!(of(&other).unwrap(), Kind::MatHdf5);
    }

    #[test]
    fn text_is_text() {
        for text in ["t,x,f\n", "", "P", "0,1", "BZ", "7zip,x", "PAR1,PAR2\n"] {
            assert_eq!(of(text.as_bytes()).unwrap(), Kind::Text, "{text}");
        }
    }
}
