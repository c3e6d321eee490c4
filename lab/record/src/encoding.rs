//! Decodes text in UTF-8, UTF-16 or Windows-1252, with or without a byte-order mark.
//!
//! UTF-8 and UTF-16 can be verified, because bytes in another encoding are almost never valid UTF-8
//! or UTF-16. Otherwise Windows-1252 (which contains Latin-1) is assumed, but only if no non-ASCII
//! character of the file is UTF-8, and never with control codes.

use super::error::RecordError;
use super::limits::PIECES;
use std::borrow::Cow;

/// UTF-16 with one byte order.
#[derive(Clone, Copy)]
struct Utf16 {
    name: &'static str,
    mark: [u8; 2],
    unit: fn([u8; 2]) -> u16,
}

const LITTLE: Utf16 = Utf16 {
    name: "UTF-16LE",
    mark: [0xff, 0xfe],
    unit: u16::from_le_bytes,
};

const BIG: Utf16 = Utf16 {
    name: "UTF-16BE",
    mark: [0xfe, 0xff],
    unit: u16::from_be_bytes,
};

/// The characters 0x80 to 0x9f of Windows-1252. The other characters are the same as in Latin-1.
/// U+0080 to U+009F represent bytes that Windows-1252 does not define.
const WINDOWS_1252: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}',
    '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

/// The text of a record from its byte-order mark to its last row. Every line ends with `\n`,
/// possibly after a `\r`.
pub(super) struct Decoded<'a> {
    pub(super) text: Cow<'a, str>,
    /// A note on the encoding, unless it was UTF-8.
    pub(super) note: Option<String>,
    /// Whether the last line is terminated. Otherwise the file may end within this line.
    pub(super) is_ended: bool,
}

pub(super) fn decode(bytes: &[u8]) -> Result<Decoded<'_>, RecordError> {
    if bytes.is_empty() {
        return Err(RecordError::at(
            1,
            "the file is empty, but a header with column names is needed",
        ));
    }
    let (text, note) = match wide(bytes) {
        Some((own, mark)) => (utf_16(&bytes[mark..], own)?, Some(own.name)),
        None => narrow(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))?,
    };
    Ok(Decoded {
        is_ended: text.ends_with(['\n', '\r']),
        text: lines(text),
        note: note.map(|name| format!("text encoding: {name}")),
    })
}

/// Whether the bytes are UTF-16.
pub(super) fn is_wide(bytes: &[u8]) -> bool {
    wide(bytes).is_some()
}

/// The byte order of UTF-16, and the length of its byte-order mark.
fn wide(bytes: &[u8]) -> Option<(Utf16, usize)> {
    let mut both = [LITTLE, BIG].into_iter();
    let marked = both.find(|own| bytes.starts_with(&own.mark));
    let marked = marked.map(|own| (own, own.mark.len()));
    marked.or_else(|| unmarked(bytes).map(|own| (own, 0)))
}

/// UTF-16 without a mark, for a text that is mostly ASCII. Every other byte is then NUL.
fn unmarked(bytes: &[u8]) -> Option<Utf16> {
    let head = &bytes[..bytes.len().min(PIECES) & !1];
    let nul = |side: usize| {
        head.iter()
            .skip(side)
            .step_by(2)
            .filter(|b| **b == 0)
            .count()
    };
    let pairs = head.len() / 2;
    match (nul(0), nul(1)) {
        _ if pairs < 4 => None,
        (0, high) if 10 * high >= 9 * pairs => Some(LITTLE),
        (high, 0) if 10 * high >= 9 * pairs => Some(BIG),
        _ => None,
    }
}

fn utf_16(bytes: &[u8], own: Utf16) -> Result<Cow<'static, str>, RecordError> {
    let pairs = bytes.chunks_exact(2);
    let half = pairs
        .remainder()
        .first()
        .map(|_| char::REPLACEMENT_CHARACTER);
    let mut damaged = half.is_some();
    let units = pairs.map(|pair| (own.unit)([pair[0], pair[1]]));
    let characters = char::decode_utf16(units).map(|read| {
        damaged |= read.is_err();
        read.unwrap_or(char::REPLACEMENT_CHARACTER)
    });
    let text: String = characters.chain(half).collect();
    let line_of = |text: &str| 1 + text.matches('\n').count();
    if damaged {
        let before = text.split('\u{fffd}').next().unwrap_or_default();
        let message = format!("the file is damaged: a character is not valid {}", own.name);
        return Err(RecordError::at(line_of(before), message));
    }
    match text.find('\0') {
        Some(at) => Err(RecordError::at(
            line_of(&text[..at]),
            "a character is NUL, so the file is neither text nor a known binary format; export it as CSV",
        )),
        None => Ok(Cow::Owned(text)),
    }
}

/// Decodes UTF-8 or, if this fails, Windows-1252.
fn narrow(bytes: &[u8]) -> Result<(Cow<'_, str>, Option<&'static str>), RecordError> {
    let line_of = |offset: usize| {
        1 + bytes[..offset]
            .iter()
            .filter(|byte| **byte == b'\n')
            .count()
    };
    if let Some(offset) = bytes.iter().position(|byte| *byte == 0) {
        let message = format!("byte {offset} is NUL, so the file is neither text nor a known binary format; export it as CSV");
        return Err(RecordError::at(line_of(offset), message));
    }
    let error = match std::str::from_utf8(bytes) {
        Ok(text) => return Ok((Cow::Borrowed(text), None)),
        Err(error) => error,
    };
    let offset = error.valid_up_to();
    let byte = bytes.get(offset).copied().unwrap_or_default();
    let refuse = |at: usize, message: String| Err(RecordError::at(line_of(at), message));
    if !bytes[..offset].is_ascii() {
        return refuse(
            offset,
            format!("byte {offset} (0x{byte:02X}) is not UTF-8, unlike earlier characters; save the file as UTF-8"),
        );
    }
    let control = |byte: &u8| matches!(byte, 0x01..=0x08 | 0x0e..=0x1f | 0x7f | 0x81 | 0x8d | 0x8f | 0x90 | 0x9d);
    if let Some(at) = bytes.iter().position(control) {
        return refuse(
            at,
            format!(
                "byte {at} (0x{:02X}) is invalid in UTF-8 and in Windows-1252; save the file as UTF-8",
                bytes[at]
            ),
        );
    }
    let character = |byte: &u8| match byte {
        0x80..=0x9f => WINDOWS_1252[usize::from(byte - 0x80)],
        own => char::from(*own),
    };
    let text: String = bytes.iter().map(character).collect();
    Ok((Cow::Owned(text), Some("Windows-1252 (Latin-1)")))
}

/// Ends every line with `\n`. Rows that contain only separators, which spreadsheets leave at the
/// end, are removed.
fn lines(text: Cow<'_, str>) -> Cow<'_, str> {
    let cut = |text: &str| -> (usize, usize) {
        let start = text.len() - text.trim_start_matches('\u{feff}').len();
        let mut end = text.trim_end_matches(['\n', '\r', ' ']).len();
        while let Some(last) = text[..end].rfind(['\n', '\r']) {
            let separators = [';', ',', '\t', ' ', '\r', '\n'];
            if !text[last..end].trim_matches(separators).is_empty() {
                break;
            }
            end = text[..last].trim_end_matches(['\n', '\r', ' ']).len();
        }
        (start.min(end), end)
    };
    let lone_returns = text.contains('\r') && !text.contains('\n');
    let (start, end) = cut(&text);
    match text {
        Cow::Borrowed(text) if !lone_returns => Cow::Borrowed(&text[start..end]),
        text if lone_returns => Cow::Owned(text[start..end].replace('\r', "\n")),
        text => Cow::Owned(text[start..end].to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(bytes: &[u8]) -> (String, Option<String>) {
        let decoded = decode(bytes).unwrap();
        (decoded.text.into_owned(), decoded.note)
    }

    fn utf_16(text: &str, order: fn(u16) -> [u8; 2]) -> Vec<u8> {
        text.encode_utf16().flat_map(order).collect()
    }

    #[test]
    fn the_encoding_is_recognised_with_and_without_a_mark() {
        let text = "t;Weg [µm];Kraft ü\n0;1;2";
        let own = |note: &str| (text.to_owned(), Some(format!("text encoding: {note}")));
        assert_eq!(said(text.as_bytes()), (text.to_owned(), None));
        assert_eq!(
            said(&[b"\xef\xbb\xbf", text.as_bytes()].concat()),
            (text.to_owned(), None)
        );
        for mark in ["", "\u{feff}"] {
            let marked = format!("{mark}{text}");
            assert_eq!(said(&utf_16(&marked, u16::to_le_bytes)), own("UTF-16LE"));
            assert_eq!(said(&utf_16(&marked, u16::to_be_bytes)), own("UTF-16BE"));
        }
        let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
        assert_eq!(said(&latin), own("Windows-1252 (Latin-1)"));
        assert_eq!(said(b"a\x80\x8a\x94\x9f\xa0\xff").0, "a€Š”Ÿ\u{a0}ÿ");
    }

    #[test]
    fn what_is_no_text_is_not_guessed() {
        let line = |bytes: &[u8]| decode(bytes).err().unwrap().to_string();
        assert!(line(
            "µ\n1"
                .as_bytes()
                .iter()
                .chain(b"\xb5")
                .copied()
                .collect::<Vec<_>>()
                .as_slice()
        )
        .contains(":2: byte 4 (0xB5) is not UTF-8, unlike earlier characters"));
        assert!(line(b"a\n\xb5\x02").contains(":2: byte 3 (0x02) is invalid in"));
        assert!(line(b"a\n\x81").contains(":2: byte 2 (0x81) is invalid in"));
        // A surrogate without its other half.
        assert!(line(b"\xff\xfea\0\n\0\x00\xd8b\0")
            .contains(":2: the file is damaged: a character is not valid UTF-16LE"));
        assert!(line(b"\xff\xfea\0\n\0\0\0b\0").contains(":2: a character is NUL"));
        // Half a character at the end.
        assert!(line(b"\xff\xfea\0b\0c")
            .contains(":1: the file is damaged: a character is not valid UTF-16LE"));
    }

    #[test]
    fn rows_of_separators_alone_are_cut_from_the_end() {
        assert_eq!(said(b"a;b\n1;2\n;;\n;\n").0, "a;b\n1;2");
        assert_eq!(said(b"a;b\r\n1;\r\n;;\r\n").0, "a;b\r\n1;");
        assert_eq!(said(b",,\n").0, ",,");
        assert_eq!(said(b"a,b\r1,2\r,,\r").0, "a,b\n1,2");
    }
}
