//! Zip archives with stored or deflated files.
//!
//! Source: PKWARE, *APPNOTE.TXT*. Every length is checked against the number of bytes.

use super::limits::too_large;
use flate2::read::DeflateDecoder;
use flate2::Crc;
use std::io::Read;

/// The reason why the bytes are not an archive.
pub(super) type Damage = String;

pub(super) fn damaged(what: &str) -> Damage {
    format!("the file is damaged: {what}")
}

/// The names of the files in an archive, and the positions of their entries in the directory.
pub(super) fn entries(bytes: &[u8]) -> Result<Vec<(String, usize)>, Damage> {
    let end = b"PK\x05\x06";
    let end = bytes.windows(end.len()).rposition(|own| own == end);
    let end = end.ok_or_else(|| damaged("the zip archive is truncated"))?;
    let count = number::<2>(bytes, end + 10)?;
    let mut at = number::<4>(bytes, end + 16)?;
    let mut all = Vec::new();
    for _ in 0..count {
        let lengths = [28, 30, 32].map(|field| number::<2>(bytes, at + field));
        let [name, extra, comment] = lengths;
        let (name, extra, comment) = (name?, extra?, comment?);
        let own = String::from_utf8_lossy(slice(bytes, at + 46, name)?).into_owned();
        all.push((own, at));
        at += 46 + name + extra + comment;
    }
    Ok(all)
}

/// The packed size of a file and the position of its local header, neither beyond the archive. A
/// number that needs more than 32 bits is in the extra field of ZIP64.
fn place(bytes: &[u8], entry: usize) -> Result<(usize, usize), Damage> {
    let full = u32::MAX as usize;
    let mut fields = [0; 3];
    for (field, at) in fields.iter_mut().zip([24, 20, 42]) {
        *field = number::<4>(bytes, entry + at)?;
    }
    if fields.contains(&full) {
        let sizes = [28, 30].map(|at| number::<2>(bytes, entry + at));
        let [name, extra] = sizes;
        let mut extra = slice(bytes, entry + 46 + name?, extra?)?;
        while !extra.is_empty() {
            let (kind, length) = (number::<2>(extra, 0)?, number::<2>(extra, 2)?);
            let (long, _) = slice(extra, 4, length)?.as_chunks();
            let full = fields.iter_mut().filter(|own| kind == 1 && **own == full);
            for (field, own) in full.zip(long) {
                *field = usize::try_from(u64::from_le_bytes(*own)).unwrap_or(usize::MAX);
            }
            extra = &extra[4 + length..];
        }
    }
    let [_, packed, local] = fields;
    match packed.max(local) <= bytes.len() {
        true => Ok((packed, local)),
        false => Err(damaged("the zip archive is truncated")),
    }
}

/// The bytes of the file whose directory entry begins at `entry`, at most `left` bytes.
pub(super) fn unpacked(bytes: &[u8], entry: usize, left: u64) -> Result<Vec<u8>, Damage> {
    let field = |at: usize| number::<2>(bytes, entry + at);
    let (flags, method) = (field(8)?, field(10)?);
    let check = number::<4>(bytes, entry + 16)?;
    let (packed, local) = place(bytes, entry)?;
    if flags % 2 == 1 {
        return Err("the file is encrypted; save it without a password".to_owned());
    }
    let names = number::<2>(bytes, local + 26)? + number::<2>(bytes, local + 28)?;
    let packed = slice(bytes, local + 30 + names, packed)?;
    let mut file = Vec::new();
    let read = match method {
        0 => packed.take(left + 1).read_to_end(&mut file),
        8 => DeflateDecoder::new(packed)
            .take(left + 1)
            .read_to_end(&mut file),
        _ => {
            return Err(format!(
                "the zip archive uses compression method {method}, which bowden does not read; store or deflate its files"
            ))
        }
    };
    read.map_err(|error| damaged(&error.to_string()))?;
    if file.len() as u64 > left {
        return Err(too_large(" when unpacked").message().to_owned());
    }
    let mut own = Crc::new();
    own.update(&file);
    match own.sum() as usize == check {
        true => Ok(file),
        false => Err(damaged("a checksum is wrong")),
    }
}

/// The little-endian number with this many bytes at this position.
pub(super) fn number<const N: usize>(bytes: &[u8], at: usize) -> Result<usize, Damage> {
    let own = slice(bytes, at, N)?;
    Ok(own
        .iter()
        .rev()
        .fold(0, |all, byte| all << 8 | usize::from(*byte)))
}

pub(super) fn slice(bytes: &[u8], at: usize, length: usize) -> Result<&[u8], Damage> {
    let own = bytes.get(at..).and_then(|rest| rest.get(..length));
    own.ok_or_else(|| damaged("the zip archive is truncated"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An archive of one stored file whose directory entry has its numbers in the ZIP64 field: the
    /// size twice, and the position of the local header.
    fn long(text: &[u8], numbers: [u64; 3]) -> Vec<u8> {
        let mut crc = Crc::new();
        crc.update(text);
        let check = crc.sum().to_le_bytes();
        let mut bytes = b"PK\x03\x04".to_vec();
        bytes.resize(30, 0);
        bytes[26] = 1;
        bytes.push(b'a');
        bytes.extend(text);
        let directory = bytes.len();
        let mut entry = b"PK\x01\x02".to_vec();
        entry.resize(46, 0);
        entry[16..20].copy_from_slice(&check);
        for at in [20, 24, 42] {
            entry[at..at + 4].fill(0xff);
        }
        (entry[28], entry[30]) = (1, 36);
        entry.push(b'a');
        // An unknown field, then that of ZIP64: size, packed size, position.
        entry.extend([9, 0, 4, 0, 1, 2, 3, 4, 1, 0, 24, 0]);
        for number in numbers {
            entry.extend(number.to_le_bytes());
        }
        bytes.extend(&entry);
        let end = bytes.len();
        bytes.extend(b"PK\x05\x06");
        bytes.resize(end + 22, 0);
        bytes[end + 10] = 1;
        bytes[end + 16..end + 20].copy_from_slice(&(directory as u32).to_le_bytes());
        bytes
    }

    #[test]
    fn a_file_with_64_bit_numbers_is_unpacked() {
        let bytes = long(b"t,x,f", [5, 5, 0]);
        let all = entries(&bytes).unwrap();
        assert_eq!(all.len(), 1);
        assert_eq!(unpacked(&bytes, all[0].1, 5).unwrap(), b"t,x,f");
        assert!(unpacked(&bytes, all[0].1, 4).is_err());
        // Cut anywhere, it has no directory.
        for cut in 0..bytes.len() - 22 {
            assert!(entries(&bytes[..cut]).is_err());
        }
    }

    #[test]
    fn a_number_beyond_the_archive_is_an_error() {
        for numbers in [[5, u64::MAX, 0], [5, 5, u64::MAX], [5, 5, 1 << 32]] {
            let bytes = long(b"t,x,f", numbers);
            let all = entries(&bytes).unwrap();
            let error = unpacked(&bytes, all[0].1, 5).unwrap_err();
            assert_eq!(error, "the file is damaged: the zip archive is truncated");
        }
    }

    /// Archives are padded with extra fields that are none.
    #[test]
    fn an_extra_field_is_read_only_for_a_long_number() {
        let mut bytes = long(b"t,x,f", [5, 5, 0]);
        let entry = entries(&bytes).unwrap()[0].1;
        for (at, number) in [(20, 5_u32), (24, 5), (42, 0)] {
            bytes[entry + at..entry + at + 4].copy_from_slice(&number.to_le_bytes());
        }
        bytes[entry + 47..entry + 83].fill(0xff);
        assert_eq!(unpacked(&bytes, entry, 5).unwrap(), b"t,x,f");
    }
}
