//! Text whose columns are separated by spaces, as `numpy.savetxt`, MATLAB's `save -ascii` and
//! gnuplot write it.
//!
//! In such a text, spaces separate the numbers, and the rows contain no tab, `;` or `,`. The text
//! is then read as if tabs separated the columns. Names may contain spaces. A unit in brackets
//! belongs to the name before it. If this rule does not give one name for each column, two spaces
//! separate the names.

use super::layout::TABLE;
use super::limits::head;
use super::number::is_data;
use std::borrow::Cow;

/// The separator that represents blanks.
const TAB: u8 = b'\t';

/// The text with a tab instead of the blanks between columns, if blanks separate the columns.
/// Otherwise the text is unchanged. The line numbers stay the same.
pub(super) fn as_tabs(text: &str) -> Cow<'_, str> {
    match width(text) {
        Some(width) => Cow::Owned(tabbed(text, width)),
        None => Cow::Borrowed(text),
    }
}

/// Number of columns, if blanks separate them.
fn width(text: &str) -> Option<usize> {
    let (mut rows, mut width) = (0, 0);
    for (_, line) in head(text) {
        match numbers(line) {
            Some(count) if count == width => rows += 1,
            Some(count) => (rows, width) = (1, count),
            None => rows = 0,
        }
        if rows == TABLE {
            return Some(width);
        }
    }
    (rows > 0).then_some(width)
}

/// Number of cells in a row of at least two numbers that only blanks separate.
fn numbers(line: &str) -> Option<usize> {
    if line.contains(['\t', ';', ',']) {
        return None;
    }
    let cells = line.split_whitespace();
    let count = cells.clone().count();
    (count >= 2 && cells.clone().all(|cell| is_data(cell, TAB))).then_some(count)
}

fn tabbed(text: &str, width: usize) -> String {
    let mut all = String::with_capacity(text.len());
    // Lines above the first row: behind it only the same names are names, and the rest comments.
    let (mut above, mut is_below) = (Vec::new(), false);
    for (index, line) in text.split('\n').enumerate() {
        if index > 0 {
            all.push('\n');
        }
        let is_row = line.bytes().next().is_some_and(|b| b != b'#' && b != b'%')
            && line.split_whitespace().all(|cell| is_data(cell, TAB));
        let is_comment = line.trim_start().starts_with(['#', '%']);
        match is_row {
            true => {
                is_below = true;
                push(&mut all, line.split_whitespace());
            }
            false if is_below && is_comment && !above.contains(&line) => all.push_str(line),
            false => match names(line, width) {
                Some(names) => {
                    if !is_below {
                        above.push(line);
                    }
                    push(&mut all, names.iter().map(String::as_str));
                }
                None => all.push_str(line),
            },
        }
    }
    all
}

fn push<'a>(all: &mut String, cells: impl Iterator<Item = &'a str>) {
    for (index, cell) in cells.enumerate() {
        if index > 0 {
            all.push('\t');
        }
        all.push_str(cell);
    }
}

/// A line as the given number of names, `Time (s) Force (N)`.
fn names(line: &str, width: usize) -> Option<Vec<String>> {
    let line = line.trim().trim_start_matches(['#', '%']).trim_start();
    let mut single: Vec<String> = Vec::new();
    for word in line.split_whitespace() {
        match single.last_mut().filter(|_| word.starts_with(['(', '['])) {
            Some(name) => *name = format!("{name} {word}"),
            None => single.push(word.to_owned()),
        }
    }
    if single.len() == width {
        return Some(single);
    }
    let apart = line.split("  ").map(str::trim);
    let apart: Vec<String> = apart
        .filter(|name| !name.is_empty())
        .map(str::to_owned)
        .collect();
    (apart.len() == width).then_some(apart)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blanks_between_numbers_become_tabs_and_names_keep_theirs() {
        let rows = "  0.0   1.0e+00  -2\n 0.1 2 3\n0.2 3 NaN\n";
        let tabs = "0.0\t1.0e+00\t-2\n0.1\t2\t3\n0.2\t3\tNaN\n";
        for (names, tabbed) in [
            ("t x f", "t\tx\tf"),
            ("# t x f", "t\tx\tf"),
            ("Time (s)  Weg [mm] f", "Time (s)\tWeg [mm]\tf"),
            ("run time  motor angle   f", "run time\tmotor angle\tf"),
            ("a preamble of words", "a preamble of words"),
        ] {
            let text = format!("{names}\n{rows}");
            assert_eq!(as_tabs(&text), format!("{tabbed}\n{tabs}"));
        }
        assert_eq!(as_tabs(rows), tabs);
    }

    #[test]
    fn a_text_with_another_separator_stays_as_it_is() {
        for text in [
            "t,x f\n0, 1\n1, 2\n2, 3",
            "t;x\n0 ;1\n1 ;2\n2 ;3",
            "t\tx\n0\t1 \n1\t2\n2\t3",
            "t x\n0,0 1,0\n1,0 2,0\n2,0 3,0",
            "one 1 two\nthree four 4",
            "",
        ] {
            assert!(matches!(as_tabs(text), Cow::Borrowed(same) if same == text));
        }
    }
}
