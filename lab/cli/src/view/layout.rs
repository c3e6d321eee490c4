//! Layout of text: blocks with a label, wrapped prose, tables that drop columns.

use anstyle::{AnsiColor, Style};
#[cfg(not(target_family = "wasm"))]
use comfy_table::Table;
use std::fmt::Write as _;

/// Columns of the label of a block.
const LABEL: usize = 8;

/// Most columns of prose: longer lines are hard to read.
const MOST: usize = 100;

/// Most files, stretches or seeds that are listed; the JSON has all.
pub(super) const LISTED: usize = 3;

/// The width to lay out for; `None` wraps nothing and drops no column, as for a pipe.
#[derive(Debug, Clone, Copy)]
pub struct Width(Option<usize>);

impl Width {
    /// A terminal with this number of columns.
    #[must_use]
    pub fn of(columns: u16) -> Self {
        Self(Some(usize::from(columns).min(MOST)))
    }

    /// The terminal on stdout, or no limit if stdout is none.
    #[must_use]
    pub fn of_stdout() -> Self {
        super::terminal_width().map_or(Self::unlimited(), Self::of)
    }

    /// The terminal on stderr, or no limit if stderr is none.
    #[must_use]
    pub fn of_stderr() -> Self {
        // A web page has no terminal.
        #[cfg(target_family = "wasm")]
        let width = None;
        #[cfg(not(target_family = "wasm"))]
        let width = Table::new().use_stderr().width();
        width.map_or(Self::unlimited(), Self::of)
    }

    /// No limit.
    #[must_use]
    pub const fn unlimited() -> Self {
        Self(None)
    }

    fn columns(self) -> usize {
        self.0.unwrap_or(usize::MAX)
    }
}

/// The form of a report.
#[derive(Debug, Clone, Copy)]
pub struct Report {
    /// The width of the layout.
    pub width: Width,
    /// Whether to include the tests of each term, rejected terms and the experiments that separate
    /// alternatives.
    pub verbose: bool,
    /// Whether the user has chosen the cut-off frequency.
    pub chosen_cutoff: bool,
}

/// `text` in lines of at most `width`, each but the first behind `indent` blanks. Words are kept
/// whole.
fn wrapped(text: &str, width: usize, indent: usize, out: &mut String) {
    let mut used = indent;
    let mut first = true;
    for word in text.split(' ') {
        let length = word.chars().count();
        if !first && used + 1 + length > width {
            let _ = write!(out, "\n{:indent$}", "");
            used = indent;
        } else if !first {
            out.push(' ');
            used += 1;
        }
        out.push_str(word);
        used += length;
        first = false;
    }
    out.push('\n');
}

/// The command with its subject, and below it the answer in a few words.
pub(super) fn heading(
    out: &mut String,
    width: Width,
    (command, subject): (&str, &str),
    (colour, answer): (AnsiColor, &str),
) {
    let bold = Style::new().bold();
    let mut title = String::new();
    let text = format!("{command} · {subject}");
    wrapped(&text, width.columns(), 0, &mut title);
    let title = title.replacen(command, &format!("{bold}{command}{bold:#}"), 1);
    let mut lines = String::new();
    wrapped(answer, width.columns(), 2, &mut lines);
    let style = bold.fg_color(Some(colour.into()));
    let _ = writeln!(out, "{title}\n  {style}{}{style:#}", lines.trim_end());
}

/// A block: its label, then its lines, wrapped; nothing if there are none.
pub(super) fn block<L: AsRef<str>>(
    out: &mut String,
    width: Width,
    label: &str,
    lines: impl IntoIterator<Item = L>,
) {
    for (index, line) in lines.into_iter().enumerate() {
        let label = if index == 0 { label } else { "" };
        let _ = write!(out, "{label:LABEL$}");
        wrapped(line.as_ref(), width.columns(), LABEL, out);
    }
}

/// Prose behind two blanks.
pub(super) fn prose(out: &mut String, width: Width, text: &str) {
    out.push_str("  ");
    wrapped(text, width.columns(), 2, out);
}

/// A cell without a number.
pub(super) const NONE: &str = "–";

/// A table: a header and rows of the same number of cells, the first left-aligned, the others
/// right-aligned. A row of two cells has a remark instead of numbers. A column without a number is
/// not printed.
pub(super) struct Columns {
    /// Header and rows.
    rows: Vec<Vec<String>>,
    /// Columns that go first where the width is too small, in this order.
    droppable: &'static [usize],
}

impl Columns {
    pub(super) fn new(header: &[&str], droppable: &'static [usize]) -> Self {
        let header = header.iter().map(|&cell| cell.to_owned()).collect();
        Self {
            rows: vec![header],
            droppable,
        }
    }

    pub(super) fn add(&mut self, row: impl IntoIterator<Item = String>) {
        self.rows.push(row.into_iter().collect());
    }

    /// The rows, as wide as their cells. No cell is broken: columns are dropped instead.
    pub(super) fn text(&self, width: Width) -> String {
        let length = |cell: &String| cell.chars().count();
        let columns = self.rows[0].len();
        let is_whole = |row: &&Vec<String>| row.len() == columns;
        let cells = |k: usize| {
            let rows = self.rows.iter().filter(move |row| k == 0 || is_whole(row));
            rows.filter_map(move |row| row.get(k))
        };
        let widths: Vec<usize> = (0..columns)
            .map(|k| cells(k).map(length).max().unwrap_or(0))
            .collect();
        let is_empty = |k: usize| k > 0 && cells(k).skip(1).all(|cell| cell == NONE);
        let mut kept: Vec<usize> = (0..columns).filter(|&k| !is_empty(k)).collect();
        let total = |kept: &[usize]| kept.iter().map(|&k| widths[k] + 3).sum::<usize>() - 3;
        for &dropped in self.droppable {
            if total(&kept) <= width.columns() {
                break;
            }
            kept.retain(|&k| k != dropped);
        }
        let mut out = String::new();
        for row in &self.rows {
            let mut line = String::new();
            if let ([name, remark], true) = (&row[..], columns > 2) {
                let wide = widths[0];
                let _ = writeln!(out, "{name:wide$}   {remark}");
                continue;
            }
            for &k in &kept {
                let (cell, wide) = (&row[k], widths[k]);
                let _ = match k {
                    0 => write!(line, "{cell:wide$}"),
                    _ => write!(line, "   {cell:>wide$}"),
                };
            }
            let _ = writeln!(out, "{}", line.trim_end());
        }
        out
    }
}

/// Short items side by side in two columns where they fit, else one below the other.
pub(super) fn two_columns(items: &[String], width: Width) -> Vec<String> {
    let widest = |from: usize| {
        let own = items.iter().skip(from).step_by(2);
        own.map(|item| item.chars().count()).max().unwrap_or(0)
    };
    let (left, right) = (widest(0), widest(1));
    if LABEL + left + 3 + right > width.columns().min(MOST) {
        return items.to_vec();
    }
    let pairs = items.chunks(2);
    pairs
        .map(|pair| match pair {
            [one, other] => format!("{one:left$}   {other}"),
            _ => pair.concat(),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prose_is_wrapped_between_words_and_words_are_kept_whole() {
        let mut out = String::new();
        prose(
            &mut out,
            Width::of(20),
            "one two three four five averyveryverylongword six",
        );
        assert_eq!(
            out,
            "  one two three four\n  five\n  averyveryverylongword\n  six\n"
        );
        let mut out = String::new();
        prose(&mut out, Width::unlimited(), &"word ".repeat(99));
        assert_eq!(out.lines().count(), 1);
    }

    #[test]
    fn a_table_drops_its_columns_in_their_order_and_breaks_no_cell() {
        let mut table = Columns::new(&["name", "fit", "selection", "held-out"], &[2, 1]);
        table.add(["baseline", "0.1018", "0.1913", "0.0885"].map(str::to_owned));
        let header = |width| {
            table
                .text(Width::of(width))
                .lines()
                .next()
                .unwrap_or("")
                .to_owned()
        };
        assert_eq!(header(80), "name          fit   selection   held-out");
        assert_eq!(header(39), "name          fit   held-out");
        assert_eq!(header(20), "name       held-out");
        // Nothing more to drop: the cells stay whole.
        assert_eq!(
            table.text(Width::of(5)).lines().nth(1),
            Some("baseline     0.0885")
        );
    }

    #[test]
    fn a_remark_takes_no_column_and_a_column_without_a_number_is_not_printed() {
        let mut table = Columns::new(&["name", "fit", "noise"], &[]);
        table.add(["a", "1.0", NONE].map(str::to_owned));
        table.add(["longer", "ran away at 0.31 s"].map(str::to_owned));
        assert_eq!(
            table.text(Width::of(80)),
            "name     fit\na        1.0\nlonger   ran away at 0.31 s\n"
        );
    }

    #[test]
    fn items_stand_in_two_columns_where_both_fit() {
        let items = ["a 1", "bb 22", "c 3"].map(str::to_owned);
        assert_eq!(two_columns(&items, Width::of(80)), ["a 1   bb 22", "c 3"]);
        assert_eq!(two_columns(&items, Width::of(14)), items);
    }
}
