//! Splits a text into rows of cells.

use super::error::{shown, RecordError};
use super::limits::PIECES;
use super::number::Notation;
use csv::{Reader, ReaderBuilder, StringRecord, Terminator};
use std::io::{Chain, Read, Take};

/// The bytes after the text: the end of its last line, and one byte that only a cell with an open
/// quote reaches.
const END: &[u8] = b"\n\n";

/// The rows of a text. The header is the first row.
pub(super) struct Rows<'a> {
    text: &'a str,
    reader: Reader<Take<Chain<&'a [u8], &'static [u8]>>>,
    cells: StringRecord,
    separator: u8,
    notation: Notation,
    /// Number of lines of the file before this text.
    before: usize,
    line: usize,
    /// Start of the row that was read last \[bytes\].
    start: usize,
    /// Whether the file may end within its last line.
    may_be_cut: bool,
    /// The segments after this text.
    more: std::vec::IntoIter<Segment<'a>>,
    /// The segment that begins with the next row, unless it is the first segment.
    opens: Option<Place>,
}

/// The rows below one line of names.
#[derive(Clone, Copy)]
pub(super) struct Segment<'a> {
    pub(super) text: &'a str,
    /// Number of lines of the file before the rows of the segment.
    pub(super) before: usize,
    /// Whether the lines between the names and the rows are the same as in the first segment.
    pub(super) is_alike: bool,
    pub(super) place: Place,
}

/// The position of a segment among the segments of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// The line of the names.
    pub(super) names: usize,
    /// Its number, from 1.
    pub(super) number: usize,
    /// The number of segments.
    pub(super) count: usize,
}

/// One row: a line, or several lines if a quoted cell contains line ends.
pub(super) struct Row<'a> {
    cells: &'a StringRecord,
    notation: &'a Notation,
    /// The segment that begins with this row, unless it is the first segment.
    pub(super) opens: Option<Place>,
    /// The line on which it begins, from 1.
    pub(super) line: usize,
    /// The line on which it ends.
    pub(super) last: usize,
    /// Whether the file may end within it.
    pub(super) may_be_cut: bool,
}

impl<'a> Rows<'a> {
    /// The rows of a text whose header is the first line.
    pub(super) fn new(text: &'a str) -> Self {
        Self::separated_by(separator(text), text)
    }

    pub(super) fn separated_by(separator: u8, text: &'a str) -> Self {
        let reader = ReaderBuilder::new()
            .delimiter(separator)
            .has_headers(false)
            .flexible(true)
            // With `\r` as a line end too, rows would count as one line early.
            .terminator(Terminator::Any(b'\n'))
            .from_reader(text.as_bytes().chain(END).take(0));
        Self {
            text,
            reader,
            cells: StringRecord::new(),
            separator,
            notation: Notation::new(separator),
            before: 0,
            line: 0,
            start: 0,
            may_be_cut: false,
            more: Vec::new().into_iter(),
            opens: None,
        }
    }

    /// The rows of these segments, in order.
    pub(super) fn of(mut self, segments: Vec<Segment<'a>>) -> Self {
        let ends = segments
            .last()
            .is_some_and(|own| own.place.number == own.place.count);
        self.may_be_cut &= ends;
        self.more = segments.into_iter();
        self.next_segment();
        self.opens = None;
        self
    }

    /// Continues with the next segment, if there is one.
    fn next_segment(&mut self) -> bool {
        let Some(next) = self.more.next() else {
            return false;
        };
        let fresh = Self::separated_by(self.separator, next.text);
        (self.text, self.reader) = (fresh.text, fresh.reader);
        (self.before, self.opens) = (next.before, Some(next.place));
        true
    }

    /// Whether there are segments after this one.
    pub(super) fn has_more(&self) -> bool {
        self.more.len() > 0
    }

    /// The same rows of a file whose last line is not terminated.
    pub(super) fn cut_off(self) -> Self {
        Self {
            may_be_cut: true,
            ..self
        }
    }

    /// Whether the file may end within the row that was read last.
    pub(super) fn may_be_cut(&self) -> bool {
        self.may_be_cut && !self.has_more() && self.rest().0.is_empty()
    }

    /// The same rows, numbered after this number of lines of the file.
    pub(super) fn after(self, before: usize) -> Self {
        Self { before, ..self }
    }

    pub(super) fn separator(&self) -> u8 {
        self.separator
    }

    /// The notation of the numbers.
    pub(super) fn notation(&self) -> &Notation {
        &self.notation
    }

    /// The text from the row that was read last to the end.
    pub(super) fn here(&self) -> &'a str {
        self.text.get(self.start..).unwrap_or_default()
    }

    /// The text after the row that was read last, and the number of lines of the file before this
    /// text.
    pub(super) fn rest(&self) -> (&'a str, usize) {
        let position = self.reader.position();
        let rest = self.text.get(position.byte() as usize..);
        (
            rest.unwrap_or_default(),
            self.before + position.line() as usize - 1,
        )
    }

    /// Line of the row that was read last.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// The next row. A row that is blank, too long or has an open quote is an error.
    pub(super) fn read(&mut self) -> Result<Option<Row<'_>>, RecordError> {
        let is_over = |own: &Self| own.reader.position().byte() as usize >= own.text.len();
        while is_over(self) && self.next_segment() {}
        let start = self.reader.position().byte() as usize;
        let Some(rest) = self.text.get(start..).filter(|rest| !rest.is_empty()) else {
            return Ok(None);
        };
        let opens = self.opens.take();
        self.start = start;
        self.line = self.before + self.reader.position().line() as usize;
        // Of a row that never ends, the longest line and what the reader takes in ahead.
        self.reader.get_mut().set_limit(2 * PIECES as u64);
        let outcome = self.reader.read_record(&mut self.cells);
        let length = self.reader.position().byte() as usize - start;

        let line = rest.split('\n').next().unwrap_or_default();
        let refuse = |message: String| Err(RecordError::at(self.line, message));
        if line.trim().is_empty() {
            // The reader passed over it, to the next row that is not blank.
            return refuse("the line is blank, although rows follow".to_owned());
        }
        if line.len() > PIECES {
            return refuse(format!(
                "the line has {} bytes, but at most {PIECES} are allowed",
                line.len()
            ));
        }
        if length > PIECES + 1 {
            return refuse(format!("a quote is not closed within {PIECES} bytes"));
        }
        if length > rest.len() + 1 {
            return refuse("a quote is not closed before the end of the file".to_owned());
        }
        let may_be_cut = self.may_be_cut();
        match outcome {
            Ok(_) => Ok(Some(Row {
                may_be_cut,
                cells: &self.cells,
                opens,
                line: self.line,
                last: self.before + self.reader.position().line() as usize - 1,
                notation: &self.notation,
            })),
            Err(error) => refuse(shown(&error.to_string(), PIECES)),
        }
    }
}

impl<'a> Row<'a> {
    /// Number of cells.
    pub(super) fn len(&self) -> usize {
        self.cells.len()
    }

    /// A cell, trimmed and without its quotes. The text is empty if the cell does not exist.
    pub(super) fn cell(&self, index: usize) -> &'a str {
        let cell = self.cells.get(index).unwrap_or_default().trim();
        // In the CSV standard, quotes after a space (`t, "x"`) are part of the cell.
        cell.strip_prefix('"')
            .and_then(|inner| inner.strip_suffix('"'))
            .map_or(cell, str::trim)
    }

    /// The number in a cell.
    pub(super) fn number(&self, index: usize, column: &str) -> Result<f64, RecordError> {
        self.notation
            .read_in(index, self.cell(index), self.line, column)
    }

    pub(super) fn cells(&self) -> impl Iterator<Item = &'a str> + '_ {
        (0..self.len()).map(|index| self.cell(index))
    }
}

/// The separator of the header. Among tab, `;` and `,`, this is the sign that gives the most cells
/// and leaves no quotes in them.
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
    use super::super::encoding::decode;
    use super::*;

    fn rows(text: &str) -> Vec<Vec<String>> {
        let text = decode(text.as_bytes()).unwrap().text;
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
            let text = decode(text.as_bytes()).unwrap().text;
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

    /// Size of the read-ahead buffer [bytes].
    const AHEAD: usize = 1 << 13;

    #[test]
    fn a_row_that_does_not_end_is_not_taken_in() {
        for row in ["x".repeat(1 << 22), format!("\"{}", "x\n".repeat(1 << 22))] {
            let text = format!("a,b\n{row}");
            let mut rows = Rows::new(&text);
            assert!(rows.read().is_ok() && rows.read().is_err());
            assert!(rows.cells.as_byte_record().as_slice().len() <= 2 * PIECES + AHEAD);
        }
    }

    #[test]
    fn the_longest_row_is_read_at_any_place_in_the_buffer() {
        for before in [1, AHEAD - 1, AHEAD, AHEAD + 1] {
            let (first, long) = ("x".repeat(before), "\u{e9}".repeat(PIECES / 2));
            assert_eq!(rows(&format!("{first}\n{long}\n{first}")).len(), 3);
        }
        let text = format!("a\n{}", "\u{e9}".repeat(PIECES));
        let mut rows = Rows::new(&text);
        assert!(rows.read().is_ok());
        let error = rows.read().err().unwrap();
        assert_eq!(
            error.message(),
            "the line has 131072 bytes, but at most 65536 are allowed"
        );
    }
}
