//! The first line: which columns there are.

use super::error::{shown, RecordError, NAME_LENGTH};
use super::text::Rows;
use super::{number, units};

/// At most this many names are listed in a message.
const LISTED: usize = 24;

/// Jaro-Winkler similarity from which on one name may be meant for another: `x` and `x_mm`
/// have 0.775, `t` and `tau_o` 0.76, `tau_i` and `force` 0.46.
const ALIKE: f64 = 0.77;

/// A column as the header names it; the name is empty where it has none.
pub(super) struct Named {
    pub(super) name: String,
    pub(super) unit: Option<String>,
    /// The whole cell, `name [unit]`.
    cell: String,
}

pub(super) struct Header {
    pub(super) line: usize,
    pub(super) columns: Vec<Named>,
}

impl Header {
    /// Index of the column of that name, given with or without its unit.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        let name = name.trim();
        self.columns.iter().position(|column| {
            !column.name.is_empty() && (column.name == name || column.cell == name)
        })
    }

    /// At most three names that are much like one that does not exist, for a message.
    pub(super) fn nearest(&self, name: &str) -> Vec<String> {
        let wanted = name.trim().to_lowercase();
        let alike = |column: &Named| strsim::jaro_winkler(&wanted, &column.name.to_lowercase());
        let mut near: Vec<(f64, &Named)> = self
            .columns
            .iter()
            .filter(|column| !column.name.is_empty())
            .map(|column| (alike(column), column))
            .filter(|(alike, _)| *alike >= ALIKE)
            .collect();
        near.sort_by(|a, b| b.0.total_cmp(&a.0));
        near.truncate(3);
        let quoted =
            |(_, column): &(f64, &Named)| format!("`{}`", shown(&column.name, NAME_LENGTH));
        near.iter().map(quoted).collect()
    }

    /// The names that exist, for a message.
    pub(super) fn list(&self) -> String {
        let names: Vec<_> = self
            .columns
            .iter()
            .filter(|column| !column.name.is_empty())
            .collect();
        let quoted = |column: &&Named| format!("`{}`", shown(&column.name, NAME_LENGTH));
        let mut list = names
            .iter()
            .take(LISTED)
            .map(quoted)
            .collect::<Vec<_>>()
            .join(", ");
        if names.len() > LISTED {
            list += &format!(" and {} more", names.len() - LISTED);
        }
        list
    }
}

pub(super) fn read(text: &str) -> Result<(Header, Rows<'_>), RecordError> {
    let refuse = |what: &str| {
        let message = format!("the {what}, a header with column names was expected");
        Err(RecordError::at(1, message))
    };
    if text
        .lines()
        .next()
        .is_some_and(|line| line.trim().is_empty())
    {
        return refuse("line has no names");
    }
    let mut rows = Rows::new(text);
    let Some(row) = rows.read()? else {
        return refuse("file is blank");
    };
    let line = row.line;
    let columns: Vec<Named> = row
        .cells()
        .map(|cell| {
            let (name, unit) = units::split(cell);
            Named {
                name: name.to_owned(),
                unit,
                cell: cell.to_owned(),
            }
        })
        .collect();
    let mut named = columns
        .iter()
        .filter(|column| !column.name.is_empty())
        .peekable();
    if named.peek().is_none() {
        return refuse("line has no names");
    }
    if named.all(|column| number::is_number(&column.name)) {
        return refuse("line holds numbers");
    }
    twice(&columns, line)?;
    Ok((Header { line, columns }, rows))
}

fn twice(columns: &[Named], line: usize) -> Result<(), RecordError> {
    let mut seen = std::collections::HashMap::new();
    for (index, column) in columns
        .iter()
        .enumerate()
        .filter(|(_, column)| !column.name.is_empty())
    {
        if let Some(first) = seen.insert(column.name.as_str(), index) {
            let message = format!("named twice, as columns {} and {}", first + 1, index + 1);
            return Err(RecordError::at(line, message).on(&column.name));
        }
    }
    Ok(())
}
