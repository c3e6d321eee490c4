//! From bytes to lines, and from a line to its cells.

use super::error::RecordError;

/// A longer line [bytes] is refused: no record has thousands of columns.
const LINE_LIMIT: usize = 1 << 16;

/// The text of a record without its byte-order mark.
pub(super) fn decode(bytes: &[u8]) -> Result<&str, RecordError> {
    if bytes.is_empty() {
        return Err(RecordError::at(
            1,
            "the file is empty, a header with column names was expected",
        ));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(RecordError::at(1, "the text is UTF-16, UTF-8 was expected"));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let line_of = |offset: usize| {
        1 + bytes[..offset]
            .iter()
            .filter(|byte| **byte == b'\n')
            .count()
    };
    if let Some(offset) = bytes.iter().position(|byte| *byte == 0) {
        let message = format!("byte {offset} is NUL: a binary file, CSV text was expected");
        return Err(RecordError::at(line_of(offset), message));
    }
    std::str::from_utf8(bytes).map_err(|error| {
        let offset = error.valid_up_to();
        let byte = bytes.get(offset).copied().unwrap_or_default();
        let message = format!("byte {offset} (0x{byte:02X}) is not UTF-8; save the file as UTF-8");
        RecordError::at(line_of(offset), message)
    })
}

/// The lines of a text with their numbers; blank lines at the end are no lines.
pub(super) struct Lines<'a> {
    rest: Option<&'a str>,
    newline: char,
    number: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let newline = if text.contains('\n') { '\n' } else { '\r' };
        let text = text.trim_end_matches(['\n', '\r', ' ']);
        Self {
            rest: (!text.is_empty()).then_some(text),
            newline,
            number: 0,
        }
    }

    /// Number of the line that was read last.
    pub(super) fn number(&self) -> usize {
        self.number
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Result<&'a str, RecordError>;

    fn next(&mut self) -> Option<Self::Item> {
        let rest = self.rest?;
        let (line, rest) = match rest.split_once(self.newline) {
            Some((line, rest)) => (line, Some(rest)),
            None => (rest, None),
        };
        self.rest = rest;
        self.number += 1;
        if line.len() > LINE_LIMIT {
            let message = format!(
                "the line has {} bytes, at most {LINE_LIMIT} are read",
                line.len()
            );
            return Some(Err(RecordError::at(self.number, message)));
        }
        Some(Ok(line.strip_suffix('\r').unwrap_or(line)))
    }
}

/// The separator that a header uses: the most frequent of tab, `;` and `,`.
pub(super) fn separator(header: &str) -> char {
    let count = |separator: char| cells(header, separator).count();
    let mut best = ',';
    for candidate in [';', '\t'] {
        if count(candidate) > count(best) {
            best = candidate;
        }
    }
    best
}

/// The cells of a line, trimmed and without their quotes.
pub(super) fn cells(line: &str, separator: char) -> impl Iterator<Item = &str> {
    let mut rest = Some(line);
    std::iter::from_fn(move || {
        let text = rest?;
        let mut quoted = false;
        let end = text.char_indices().find(|(_, c)| {
            quoted ^= *c == '"';
            *c == separator && !quoted
        });
        let cell = match end {
            Some((at, _)) => {
                rest = Some(&text[at + separator.len_utf8()..]);
                &text[..at]
            }
            None => {
                rest = None;
                text
            }
        };
        let cell = cell.trim();
        Some(
            cell.strip_prefix('"')
                .and_then(|inner| inner.strip_suffix('"'))
                .map_or(cell, str::trim),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quoted_cell_keeps_its_separator() {
        assert_eq!(
            cells("a, \"b,c\" ,,d", ',').collect::<Vec<_>>(),
            ["a", "b,c", "", "d"]
        );
        assert_eq!(cells("", ',').collect::<Vec<_>>(), [""]);
        assert_eq!(cells("\"", ',').collect::<Vec<_>>(), ["\""]);
    }

    #[test]
    fn the_separator_is_the_one_the_header_uses() {
        assert_eq!(separator("t;x;f"), ';');
        assert_eq!(separator("t\tx\tf"), '\t');
        assert_eq!(separator("t,x,f"), ',');
        assert_eq!(separator("t"), ',');
    }

    #[test]
    fn lines_end_with_any_newline_and_trailing_blanks_are_dropped() {
        for text in ["a\nb\n", "a\r\nb\r\n\r\n", "a\rb\r", "a\nb\n \n\n"] {
            let lines: Vec<_> = Lines::new(text).map(|line| line.unwrap()).collect();
            assert_eq!(lines, ["a", "b"], "{text:?}");
        }
    }
}
