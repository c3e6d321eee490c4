//! From bytes to text, and from text to rows of cells.

use super::error::{shown, RecordError};
use csv::{Reader, ReaderBuilder, StringRecord, Terminator};
use std::borrow::Cow;
use std::io::{Chain, Read, Take};

/// A longer line [bytes] is refused: no record has thousands of columns.
const LINE_LIMIT: usize = 1 << 16;
/// No more than this [bytes] is taken in for one row, even if it never ends.
const ROW_LIMIT: usize = 2 * LINE_LIMIT;
/// What the reader takes in ahead of the row [bytes].
const AHEAD: usize = 1 << 13;
const _: () = assert!(ROW_LIMIT > LINE_LIMIT + 2 * AHEAD);

/// The text of a record, from behind its byte-order mark to its last row;
/// every line ends with `\n`, be it behind a `\r`.
pub(super) fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, RecordError> {
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
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let offset = error.valid_up_to();
        let byte = bytes.get(offset).copied().unwrap_or_default();
        let message = format!("byte {offset} (0x{byte:02X}) is not UTF-8; save the file as UTF-8");
        RecordError::at(line_of(offset), message)
    })?;
    let lone_returns = text.contains('\r') && !text.contains('\n');
    let text = text
        .trim_start_matches('\u{feff}')
        .trim_end_matches(['\n', '\r', ' ']);
    Ok(if lone_returns {
        text.replace('\r', "\n").into()
    } else {
        text.into()
    })
}

/// Behind the text: the end of its last line, and one byte that only a cell
/// with an open quote reaches.
const END: &[u8] = b"\n\n";

/// The rows of a text, the header being the first.
pub(super) struct Rows<'a> {
    text: &'a str,
    reader: Reader<Take<Chain<&'a [u8], &'static [u8]>>>,
    cells: StringRecord,
    line: usize,
}

/// One row: a line, or several if a quoted cell holds line ends.
pub(super) struct Row<'a> {
    cells: &'a StringRecord,
    /// The line on which it begins, from 1.
    pub(super) line: usize,
    /// The line on which it ends.
    pub(super) last: usize,
}

impl<'a> Rows<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self::separated_by(separator(text), text)
    }

    fn separated_by(separator: u8, text: &'a str) -> Self {
        let reader = ReaderBuilder::new()
            .delimiter(separator)
            .has_headers(false)
            .flexible(true)
            // With `\r` as a line end too, rows would count as one line early.
            .terminator(Terminator::Any(b'\n'))
            .buffer_capacity(AHEAD)
            .from_reader(text.as_bytes().chain(END).take(0));
        Self {
            text,
            reader,
            cells: StringRecord::new(),
            line: 0,
        }
    }

    /// Line of the row that was read last.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// The next row, unless it is blank, too long or has an open quote.
    pub(super) fn read(&mut self) -> Result<Option<Row<'_>>, RecordError> {
        let start = self.reader.position().byte() as usize;
        let Some(rest) = self.text.get(start..).filter(|rest| !rest.is_empty()) else {
            return Ok(None);
        };
        self.line = self.reader.position().line() as usize;
        self.reader.get_mut().set_limit(ROW_LIMIT as u64);
        let outcome = self.reader.read_record(&mut self.cells);
        let length = self.reader.position().byte() as usize - start;

        let line = rest.split('\n').next().unwrap_or_default();
        let refuse = |message: String| Err(RecordError::at(self.line, message));
        if line.trim().is_empty() {
            // The reader passed over it, to the next row that is not blank.
            return refuse("the line is blank, but rows follow it".to_owned());
        }
        if line.len() > LINE_LIMIT {
            return refuse(format!(
                "the line has {} bytes, at most {LINE_LIMIT} are read",
                line.len()
            ));
        }
        if length > LINE_LIMIT + 1 {
            return refuse(format!(
                "a quote is not closed, or not within {LINE_LIMIT} bytes"
            ));
        }
        if length > rest.len() + 1 {
            return refuse("a quote is not closed before the end of the file".to_owned());
        }
        match outcome {
            Ok(_) => Ok(Some(Row {
                cells: &self.cells,
                line: self.line,
                last: self.reader.position().line() as usize - 1,
            })),
            Err(error) => refuse(shown(&error.to_string(), LINE_LIMIT)),
        }
    }
}

impl<'a> Row<'a> {
    /// Number of cells.
    pub(super) fn len(&self) -> usize {
        self.cells.len()
    }

    /// A cell, trimmed and without its quotes; empty where there is none.
    pub(super) fn cell(&self, index: usize) -> &'a str {
        let cell = self.cells.get(index).unwrap_or_default().trim();
        // Quotes behind a blank, `t, "x"`, are none to the CSV standard.
        cell.strip_prefix('"')
            .and_then(|inner| inner.strip_suffix('"'))
            .map_or(cell, str::trim)
    }

    pub(super) fn cells(&self) -> impl Iterator<Item = &'a str> + '_ {
        (0..self.len()).map(|index| self.cell(index))
    }
}

/// The separator that the header uses: of tab, `;` and `,` the one that gives
/// it the most cells, and that leaves no quotes in them.
fn separator(text: &str) -> u8 {
    let fit = |separator: &u8| match Rows::separated_by(*separator, text).read() {
        Ok(Some(row)) => (!row.cells.iter().any(|cell| cell.contains('"')), row.len()),
        // An open quote: rather reported than taken for a part of a name.
        _ => (false, usize::MAX),
    };
    // Of equals, the last.
    [b'\t', b';', b',']
        .into_iter()
        .max_by_key(fit)
        .unwrap_or(b',')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> Vec<Vec<String>> {
        let text = decode(text.as_bytes()).unwrap();
        let mut rows = Rows::new(&text);
        let mut all = Vec::new();
        while let Some(row) = rows.read().unwrap() {
            all.push(row.cells().map(str::to_owned).collect());
        }
        all
    }

    #[test]
    fn a_quoted_cell_keeps_its_separator() {
        assert_eq!(rows("a,\"b,c\" ,,d"), [["a", "b,c", "", "d"]]);
        assert_eq!(rows("a, \"b\" ,\" c \""), [["a", "b", "c"]]);
        assert_eq!(rows("a,\"b \"\"c\"\" d\""), [["a", "b \"c\" d"]]);
    }

    #[test]
    fn the_separator_is_the_one_the_header_uses() {
        assert_eq!(separator("t;x;f"), b';');
        assert_eq!(separator("t\tx\tf"), b'\t');
        assert_eq!(separator("t,x,f"), b',');
        assert_eq!(separator("t"), b',');
        assert_eq!(separator("t;\"x, mm\";\"f, a, N\""), b';');
        assert_eq!(separator("t;\"x,\""), b';');
        assert_eq!(separator("\"t\", \"x\", \"f;g\""), b',');
    }

    #[test]
    fn lines_end_with_any_newline_and_trailing_blanks_are_dropped() {
        for text in ["a\nb\n", "a\r\nb\r\n\r\n", "a\rb\r", "a\nb\n \n\n"] {
            assert_eq!(rows(text), [["a"], ["b"]], "{text:?}");
        }
        for text in ["\n \r\n", "\u{feff}\u{feff}\n"] {
            assert!(rows(text).is_empty(), "{text:?}");
        }
    }

    #[test]
    fn a_row_counts_from_its_first_line_whatever_ends_it() {
        for end in ["\n", "\r\n", "\r"] {
            let text = ["a,b", "1,\"2", "3\"", "4,5", "\"6\",\"7\""].join(end);
            let text = decode(text.as_bytes()).unwrap();
            let mut rows = Rows::new(&text);
            let mut lines = Vec::new();
            while let Some(row) = rows.read().unwrap() {
                lines.push((row.line, row.last, row.len()));
            }
            assert_eq!(
                lines,
                [(1, 1, 2), (2, 3, 2), (4, 4, 2), (5, 5, 2)],
                "{end:?}"
            );
            assert_eq!(rows.line(), 5);
        }
    }

    #[test]
    fn a_row_that_does_not_end_is_not_taken_in() {
        for row in ["x".repeat(1 << 22), format!("\"{}", "x\n".repeat(1 << 22))] {
            let text = format!("a,b\n{row}");
            let mut rows = Rows::new(&text);
            assert!(rows.read().is_ok() && rows.read().is_err());
            assert!(rows.cells.as_byte_record().as_slice().len() <= ROW_LIMIT + AHEAD);
        }
    }

    #[test]
    fn the_longest_row_is_read_at_any_place_in_the_buffer() {
        for before in [1, AHEAD - 1, AHEAD, AHEAD + 1] {
            let (first, long) = ("x".repeat(before), "\u{e9}".repeat(LINE_LIMIT / 2));
            assert_eq!(rows(&format!("{first}\n{long}\n{first}")).len(), 3);
        }
        let text = format!("a\n{}", "\u{e9}".repeat(LINE_LIMIT));
        let mut rows = Rows::new(&text);
        assert!(rows.read().is_ok());
        let error = rows.read().err().unwrap();
        assert_eq!(
            error.message(),
            "the line has 131072 bytes, at most 65536 are read"
        );
    }
}
