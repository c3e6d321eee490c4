//! The position of the table in a text: preamble, names, units, values.
//!
//! A file whose first line contains the requested names is read from the first line. Otherwise the
//! beginning of the file is searched for rows of numbers, and the rows above the numbers are
//! searched for the requested names. Lines above the names are a preamble. A line between names and
//! numbers is a row of units. Nothing else is guessed. If the names are not found, the first line
//! is rejected as a header.

use super::error::{shown, RecordError, NAME_LENGTH};
use super::header::{self, Header};
use super::number::is_data;
use super::roles::{self, Roles};
use super::scale::counted;
use super::text::Rows;
use super::{clock_time, limits, units, Options};

/// Number of successive rows of numbers that identify a table. A shorter text needs fewer.
pub(super) const TABLE: usize = 3;
/// Maximum number of rows between the names and the numbers.
const ABOVE: usize = 8;

/// A table whose columns have roles. Its rows are below the names and units.
pub(super) struct Table<'a> {
    /// The unchanged line of the names; empty if the names are given.
    pub(super) names: &'a str,
    /// The text below it.
    pub(super) below_names: &'a str,
    pub(super) header: Header,
    pub(super) roles: Roles,
    pub(super) rows: Rows<'a>,
    pub(super) notes: Vec<String>,
}

/// Assigns roles to the columns of a header.
type Assign = fn(&mut Header, &Options) -> Result<Roles, RecordError>;

/// Whether a text with tabs between its cells contains rows of numbers.
#[cfg(feature = "xlsx")]
pub(super) fn has_table(text: &str) -> bool {
    Head::new(text, b'\t').tables().next().is_some()
}

/// Finds a table of numbers with any column names; every column has a role.
pub(super) fn any<'a>(text: &'a str, options: &Options) -> Result<Table<'a>, RecordError> {
    let assign = roles::of_any;
    if !options.names.is_empty() {
        return nameless(text, options, assign);
    }
    let rows = match options.header_line {
        Some(line) => {
            let (start, before) = start_of(text, line)?;
            Rows::new(&text[start..]).after(before)
        }
        None => match below(text, options, (assign, true)) {
            Some(Ok(table)) => return Ok(table),
            _ => Rows::new(text),
        },
    };
    named(rows, options, assign).and_then(with_units)
}

/// Finds the table with the columns that the options request.
pub(super) fn find<'a>(text: &'a str, options: &Options) -> Result<Table<'a>, RecordError> {
    if !options.names.is_empty() {
        return nameless(text, options, roles::assign);
    }
    if let Some(line) = options.header_line {
        let (start, before) = start_of(text, line)?;
        let rows = Rows::new(&text[start..]).after(before);
        return named(rows, options, roles::assign).and_then(with_units);
    }
    match named(Rows::new(text), options, roles::assign) {
        Ok(table) => with_units(table),
        Err(error) => below(text, options, (roles::assign, false)).unwrap_or(Err(error)),
    }
}

/// The position of a line in the text, and the number of lines before it.
fn start_of(text: &str, line: usize) -> Result<(usize, usize), RecordError> {
    let refuse =
        |message: String| Err(RecordError::new(format!("--header-line {line}: {message}")));
    let Some(before) = line.checked_sub(1) else {
        return refuse("lines are counted from 1".to_owned());
    };
    if before == 0 {
        return Ok((0, 0));
    }
    let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
    match ends.map(|(at, _)| at + 1).nth(before - 1) {
        Some(start) => Ok((start, before)),
        None => refuse(format!(
            "the file has only {}",
            counted(text.lines().count(), "line")
        )),
    }
}

/// A table whose first row is the header.
fn named<'a>(
    mut rows: Rows<'a>,
    options: &Options,
    assign: Assign,
) -> Result<Table<'a>, RecordError> {
    let (text, _) = rows.rest();
    let mut header = header::read(&mut rows)?;
    let roles = assign(&mut header, options)?;
    let (below_names, _) = rows.rest();
    Ok(Table {
        names: &text[..text.len() - below_names.len()],
        below_names,
        header,
        roles,
        rows,
        notes: Vec::new(),
    })
}

/// Takes the units from the row below the names, if it is a row of units.
fn with_units(mut table: Table<'_>) -> Result<Table<'_>, RecordError> {
    let separator = table.rows.separator();
    let (rest, before) = table.rows.rest();
    let mut start = 0;
    for (index, line) in rest.split_inclusive('\n').enumerate() {
        start += line.len();
        let line_of_units = before + index + 1;
        if let Some(said) = units_row(&mut table, &cells(line, separator), line_of_units)? {
            table.notes.extend(said);
            table.rows = Rows::separated_by(separator, &rest[start..]).after(line_of_units);
            break;
        }
        if !is_comment(line) {
            break;
        }
    }
    Ok(table)
}

/// Whether a line, or its first cell, begins with a comment mark.
pub(super) fn is_comment(line: &str) -> bool {
    let line = line.trim_start().trim_start_matches('"');
    ["#", "%", "//"].iter().any(|mark| line.starts_with(mark))
}

/// Takes the units from a row of units, with a note. The result is `None` if a cell is a number, or
/// if no cell under a column that is read is a known unit. An unknown word counts as a unit, except
/// for the time.
fn units_row(
    table: &mut Table<'_>,
    cells: &[&str],
    line: usize,
) -> Result<Option<Vec<String>>, RecordError> {
    let Table { header, roles, .. } = table;
    // `#s,mm,N` below `#t,x,f`.
    let mut cells = cells.to_vec();
    if let Some(first) = cells.first_mut() {
        *first = header::without_mark(first);
    }
    let cell = |index: usize| cells.get(index).copied().unwrap_or_default();
    let is_number = |cell: &&str| cell.parse::<f64>().is_ok() && *cell != "1";
    if cells.iter().any(is_number) {
        return Ok(None);
    }
    let mut stated: Vec<usize> = roles.read().chain(roles.time).collect();
    stated.sort_unstable();
    stated.dedup();
    stated.retain(|index| !cell(*index).is_empty() && !units::is_label(cell(*index)));
    let is_unit = |index: &usize| units::alone(cell(*index)).is_some();
    // `hh:mm:ss` and `ISO 8601` say how the stamps are written.
    let is_form = |cell: &str| cell.contains(':') || cell.to_uppercase().starts_with("ISO");
    let is_time = |index: usize| roles.time == Some(index);
    let is_known = |index: &usize| match units::alone(cell(*index)) {
        Some(unit) if is_time(*index) => {
            units::is_none(&unit) || units::seconds(Some(&unit)).is_some()
        }
        Some(_) => true,
        None => is_time(*index) && is_form(cell(*index)),
    };
    // A letter alone may be a unit or number the channels.
    let is_clear = |index: &usize| {
        let own = cell(*index);
        is_unit(index)
            && match is_time(*index) {
                true => units::seconds(Some(own)).is_some(),
                false => own == "°" || own.chars().count() > 1,
            }
    };
    let strange: Vec<usize> = stated
        .iter()
        .copied()
        .filter(|index| !is_known(index))
        .collect();
    let is_row = match strange.is_empty() {
        true => (0..cells.len()).any(|index| is_unit(&index) && cell(index) != "1"),
        false => stated.iter().any(is_clear),
    };
    if !is_row {
        return Ok(None);
    }
    let mut said = vec![format!("units from line {line}")];
    for (index, (column, cell)) in header.columns.iter_mut().zip(&cells).enumerate() {
        let is_strange = strange.contains(&index);
        if column.is_given {
            continue;
        }
        if is_strange && is_time(index) {
            return Err(units::not_of_time(line, &column.name, cell));
        }
        if is_strange {
            said.push(format!(
                "unit `{}` of `{}` is unknown and was kept",
                shown(cell, NAME_LENGTH),
                shown(&column.name, NAME_LENGTH)
            ));
            column.unit = Some((*cell).to_owned());
        }
        let known = units::alone(cell);
        if let Some(unit) = known.filter(|unit| !units::is_none(unit)) {
            column.unit = Some(unit);
        }
    }
    Ok(Some(said))
}

/// Splits a line into cells. Only numbers matter here, so quotes need no further check.
pub(super) fn cells(line: &str, separator: u8) -> Vec<&str> {
    let cells = line.split(char::from(separator)).map(str::trim);
    let open = |cell: &str| -> Option<usize> {
        let inner = cell.strip_prefix('"')?.strip_suffix('"')?;
        Some(inner.len())
    };
    cells
        .map(|cell| match open(cell) {
            Some(length) => cell[1..=length].trim(),
            None => cell,
        })
        .collect()
}

/// The first lines of a text, with their numbers and names.
struct Head<'a> {
    separator: u8,
    lines: Vec<(usize, Vec<&'a str>)>,
}

impl<'a> Head<'a> {
    fn new(text: &'a str, separator: u8) -> Self {
        let lines = limits::head(text).map(|(at, line)| (at, cells(line, separator)));
        Self {
            separator,
            lines: lines.collect(),
        }
    }

    fn is_blank(&self, line: usize) -> bool {
        self.lines[line].1.iter().all(|cell| cell.is_empty())
    }

    fn is_units(&self, line: usize) -> bool {
        let mut cells = self.lines[line].1.iter().filter(|cell| !cell.is_empty());
        cells.all(|cell| units::alone(cell).is_some() || units::is_label(cell))
    }

    /// Whether a line is a row of at least two numbers.
    fn is_row(&self, line: usize) -> bool {
        let cells = self.lines[line].1.iter().filter(|cell| !cell.is_empty());
        let number =
            |cell: &&&str| is_data(cell, self.separator) || clock_time::seconds(cell).is_some();
        let numbers = cells.clone().filter(number).count();
        numbers >= 2 && 2 * numbers >= cells.count()
    }

    /// The first row of a table. Comments may separate its rows.
    fn behind_comments(&self, mut first: usize, names: usize) -> usize {
        let is_mark = |line: usize| {
            self.lines[line]
                .1
                .first()
                .is_some_and(|own| is_comment(own))
        };
        let width = self.lines[first].1.len();
        let is_row = |line: usize| self.lines[line].1.len() == width && self.is_row(line);
        loop {
            let above = (names + 1..first).rev().find(|line| !is_mark(*line));
            match above.filter(|line| is_row(*line)) {
                Some(line) => first = line,
                None => return first,
            }
        }
    }

    /// The lines on which a table of numbers begins.
    fn tables(&self) -> impl Iterator<Item = usize> + '_ {
        let row = |line: usize, width: usize| {
            self.lines
                .get(line)
                .is_none_or(|(_, cells)| cells.len() == width && self.is_row(line))
        };
        let starts = move |line: &usize| {
            let width = self.lines[*line].1.len();
            self.is_row(*line)
                && (*line..line + TABLE).all(|next| row(next, width))
                && !(*line > 0 && row(line - 1, width))
        };
        (0..self.lines.len()).filter(starts)
    }
}

/// The first table, whose names are given.
fn nameless<'a>(
    text: &'a str,
    options: &Options,
    assign: Assign,
) -> Result<Table<'a>, RecordError> {
    let names = &options.names;
    let heads = [b'\t', b';', b','].map(|separator| Head::new(text, separator));
    let tables = heads
        .iter()
        .filter_map(|head| Some((head, head.tables().next()?)));
    // Where a decimal comma makes two tables of one, that with the wanted columns counts.
    let (mut first, mut wanted) = (None, None);
    for (head, line) in tables {
        let own = Some((head, line));
        first = first.or(own);
        let fits = head.lines[line].1.len() == names.len();
        wanted = wanted.or(own.filter(|_| fits));
    }
    let Some((head, line)) = wanted else {
        let Some((head, line)) = first else {
            return Err(RecordError::new(
                "--names: no rows of two or more numbers were found",
            ));
        };
        let message = format!(
            "the row has {}, but --names lists {}",
            counted(head.lines[line].1.len(), "cell"),
            names.len()
        );
        return Err(RecordError::at(line + 1, message));
    };
    let mut header = Header::given(line + 1, names);
    let roles = assign(&mut header, options)?;
    let rows = Rows::separated_by(head.separator, &text[head.lines[line].0..]).after(line);
    let above = (line > 0).then(|| passed_over(1, line, "above the values"));
    Ok(Table {
        names: "",
        below_names: "",
        header,
        roles,
        rows,
        notes: above.into_iter().collect(),
    })
}

/// The first table below the first line with the requested names. Otherwise the error says why the
/// names above the first table do not match. If any names are allowed, a row of units is not a row
/// of names.
fn below<'a>(
    text: &'a str,
    options: &Options,
    (assign, is_any): (Assign, bool),
) -> Option<Result<Table<'a>, RecordError>> {
    // Of the row just above the first table, units apart: it was meant to have the names.
    let mut refused: Option<Option<RecordError>> = None;
    for separator in [b'\t', b';', b','] {
        let head = Head::new(text, separator);
        for first in head.tables() {
            for names in (first.saturating_sub(ABOVE)..first).rev() {
                if head.is_blank(names) || is_any && head.is_units(names) {
                    continue;
                }
                let own = Rows::separated_by(separator, &text[head.lines[names].0..]);
                match named(own.after(names), options, assign) {
                    Ok(table) => {
                        let first = head.behind_comments(first, names);
                        let rows = &text[head.lines[first].0..];
                        let rows = Rows::separated_by(separator, rows).after(first);
                        let found = units_between(table, &head, (names, first));
                        return Some(found.map(|table| Table { rows, ..table }));
                    }
                    Err(_) if head.is_units(names) => {}
                    Err(error) => {
                        refused.get_or_insert((names > 0).then_some(error));
                    }
                }
            }
        }
    }
    refused.flatten().map(Err)
}

/// Takes the units from the rows between its line of names and its first line of numbers.
fn units_between<'a>(
    mut table: Table<'a>,
    head: &Head<'_>,
    (names, first): (usize, usize),
) -> Result<Table<'a>, RecordError> {
    if names > 0 {
        table.notes.push(passed_over(1, names, "above the names"));
    }
    let (mut units, mut others) = (None, Vec::new());
    for between in names + 1..first {
        let (cells, line) = (&head.lines[between].1, between + 1);
        if units.is_none() {
            units = units_row(&mut table, cells, line)?;
            if units.is_some() {
                continue;
            }
        }
        others.push(line.to_string());
    }
    table.notes.extend(units.into_iter().flatten());
    if !others.is_empty() {
        let lines = if others.len() == 1 { "line" } else { "lines" };
        let list = others.join(", ");
        let note = format!("{lines} {list} between names and values ignored");
        table.notes.push(note);
    }
    Ok(table)
}

/// "lines 2–7 above the names passed over".
pub(super) fn passed_over(from: usize, to: usize, place: &str) -> String {
    match from == to {
        true => format!("line {from} {place} ignored"),
        false => format!("lines {from}–{to} {place} ignored"),
    }
}

/// Whether only text follows. No line is then a row of the table. Each line that is not blank has
/// letters, and has no number at the position of the first number of a row.
pub(super) fn only_text(rest: &str, separator: u8, used: &[usize]) -> bool {
    let text = |line: &str| {
        let cells = cells(line, separator);
        let cell = |index: &usize| cells.get(*index).copied().unwrap_or_default();
        let number = |cell: &str| is_data(cell, separator) || clock_time::seconds(cell).is_some();
        let numbers = used.iter().filter(|index| number(cell(index))).count();
        cells.iter().all(|cell| cell.is_empty())
            || (numbers < 2
                && !used.first().is_some_and(|index| number(cell(index)))
                && !number(cells.first().copied().unwrap_or_default())
                && line.contains(char::is_alphabetic))
    };
    rest.split('\n').all(text)
}
