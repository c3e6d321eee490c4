//! The columns of a file, and the column that a name refers to.

use super::error::{listed, shown, RecordError, NAME_LENGTH};
use super::text::Rows;
use super::{number, sizes, units};

/// Jaro-Winkler similarity above which one name is suggested instead of another: `x` and `x_mm`
/// have 0.775, `t` and `tau_o` 0.76, `tau_i` and `force` 0.46.
const ALIKE: f64 = 0.77;

/// A column of the header. Its name is empty if the column has no name.
pub(super) struct Named {
    pub(super) name: String,
    pub(super) unit: Option<String>,
    /// The whole cell, `name [unit]`.
    cell: String,
    /// Whether an option specifies the unit. This unit takes precedence over a row of units.
    pub(super) is_given: bool,
}

/// The name that `rostopic echo -p` gives to its time.
const ROS_TIME: &str = "%time";

impl Named {
    /// Whether it has the name of the time in ROS.
    pub(super) fn is_ros(&self) -> bool {
        self.cell == ROS_TIME
    }
}

pub(super) struct Header {
    /// Line of the header; 0 if the file has no lines.
    pub(super) line: usize,
    pub(super) columns: Vec<Named>,
}

impl Header {
    /// Index of the column with this name, with or without its unit. The case of the letters may
    /// differ (`X` for `x`) if the name is still unique.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        let name = name.trim();
        let exact = self.columns.iter().position(|column| {
            !column.name.is_empty() && (column.name == name || column.cell == name)
        });
        // `force_n` is not `force_N`: capitals make another unit.
        let key = |name: &str| match units::ending(name) {
            Some((stem, unit)) => (stem.to_lowercase(), Some(unit)),
            None => (name.to_lowercase(), None),
        };
        let of_key = || {
            let wanted = key(name);
            self.only(|column| key(&column.name) == wanted)
        };
        // The mark of a comment before the first name is no part of it.
        let marked = || Some(without_mark(name)).filter(|own| *own != name);
        exact.or_else(of_key).or_else(|| self.find(marked()?))
    }

    /// Index of the only column whose name is nothing but a unit of time.
    pub(super) fn find_time(&self) -> Option<usize> {
        self.only(|column| units::is_time_alone(&column.name))
    }

    /// Index of the column with a usual name (`t`, `x`), which may contain a unit (`x_mm`).
    pub(super) fn find_usual(&self, name: &str) -> Option<usize> {
        self.find(name).or_else(|| {
            let stem = |column: &Named| {
                units::ending(&column.name).is_some_and(|(stem, _)| stem.to_lowercase() == name)
            };
            self.only(stem)
        })
    }

    /// The only column of that kind.
    fn only(&self, is: impl Fn(&Named) -> bool) -> Option<usize> {
        let named = |column: &&Named| !column.name.is_empty();
        let all = self.columns.iter();
        let mut alike = all.enumerate().filter(|(_, c)| named(c) && is(c));
        let (index, _) = alike.next()?;
        alike.next().is_none().then_some(index)
    }

    /// The columns of a file that is not text, each with its whole name.
    pub(super) fn of(columns: Vec<(String, Option<String>, String)>) -> Result<Self, RecordError> {
        let named = |(name, unit, cell): (String, Option<String>, String)| {
            let (stem, own) = units::split(&name);
            Named {
                unit: unit.map(|unit| sizes::written(&unit)).or(own),
                name: stem.to_owned(),
                cell,
                is_given: false,
            }
        };
        let columns: Vec<Named> = columns.into_iter().map(named).collect();
        Ok(Self::with(0, columns))
    }

    /// The columns of a line. If another name ends in `_out`, the ending `_in` means an input and
    /// not inches.
    fn with(line: usize, mut columns: Vec<Named>) -> Self {
        let ends = |column: &Named, ending: &str| column.name.to_lowercase().ends_with(ending);
        if columns.iter().any(|column| ends(column, "_out")) {
            let by_name = |column: &&mut Named| column.name == column.cell && ends(column, "_in");
            for column in columns.iter_mut().filter(by_name) {
                column.unit = None;
            }
        }
        tell_apart(&mut columns);
        Self { line, columns }
    }

    /// The columns of a text without names. The names are given.
    pub(super) fn given(line: usize, names: &[String]) -> Self {
        Self::with(line, names.iter().map(|name| of_cell(name)).collect())
    }

    /// Sets the unit that an option specifies after the name of a column, as in `--time 'ms [ms]'`,
    /// and returns a note. A column with the whole name takes precedence.
    pub(super) fn take_unit(&mut self, option: &str, text: &str) -> Option<String> {
        if self.find(text).is_some() {
            return None;
        }
        let (name, unit) = units::stated(text)?;
        let (index, unit) = (self.find(name)?, unit?);
        let column = &mut self.columns[index];
        text.trim().clone_into(&mut column.cell);
        column.is_given = true;
        let before = column.unit.replace(unit.clone());
        let name = shown(&column.name, NAME_LENGTH);
        let instead = match before {
            Some(before) if before != unit => {
                format!(" instead of {}", shown(&before, NAME_LENGTH))
            }
            _ => String::new(),
        };
        let unit = shown(&unit, NAME_LENGTH);
        Some(format!("unit of `{name}` from {option}: {unit}{instead}"))
    }

    /// The names that exist, for a message.
    pub(super) fn list(&self) -> String {
        let mut names: Vec<&str> = Vec::new();
        for column in &self.columns {
            let own = column.name.as_str();
            if !own.is_empty() && !names.contains(&own) {
                names.push(own);
            }
        }
        let quoted = |name: &&str| format!("`{}`", shown(name, NAME_LENGTH));
        listed(&names.iter().map(quoted).collect::<Vec<_>>())
    }
}

/// A cell without the comment mark at its start.
pub(super) fn without_mark(cell: &str) -> &str {
    cell.trim_start_matches(['#', '%']).trim_start()
}

/// A cell of the header, `name [unit]`.
fn of_cell(cell: &str) -> Named {
    let (name, unit) = units::split(cell);
    Named {
        name: name.to_owned(),
        unit,
        cell: cell.to_owned(),
        is_given: false,
    }
}

/// Distinguishes columns such as `Force (V)` and `Force (N)`. If the names are equal but the cells
/// differ, the cell is the name.
fn tell_apart(columns: &mut [Named]) {
    let is_apart = |own: &Named| {
        let alike = columns.iter().filter(|other| other.name == own.name);
        let twins = alike.clone().filter(|other| other.cell == own.cell);
        !own.name.is_empty() && twins.count() == 1 && alike.count() > 1
    };
    let apart: Vec<bool> = columns.iter().map(is_apart).collect();
    for (column, _) in columns.iter_mut().zip(apart).filter(|(_, apart)| *apart) {
        column.name.clone_from(&column.cell);
    }
}

/// Reads the first row as the names of the columns.
pub(super) fn read(rows: &mut Rows<'_>) -> Result<Header, RecordError> {
    let (text, before) = rows.rest();
    let refuse = |what: &str| {
        let message = format!("the {what}, but a header with column names is needed");
        Err(RecordError::at(before + 1, message))
    };
    if text
        .lines()
        .next()
        .is_some_and(|line| line.trim().is_empty())
    {
        return refuse("line has no names");
    }
    let Some(row) = rows.read()? else {
        return refuse("file is blank");
    };
    let line = row.line;
    let is_ros = row.cell(0) == ROS_TIME;
    let mut columns: Vec<Named> = row
        .cells()
        .enumerate()
        .map(|(index, cell)| {
            // `# t,x,f`: the mark of a comment is no part of the first name.
            let cell = match index {
                0 => without_mark(cell),
                _ => cell,
            };
            of_cell(cell)
        })
        .collect();
    if let Some(first) = columns.first_mut().filter(|_| is_ros) {
        ROS_TIME.clone_into(&mut first.cell);
    }
    let mut named = columns
        .iter()
        .filter(|column| !column.name.is_empty())
        .peekable();
    if named.peek().is_none() {
        return refuse("line has no names");
    }
    if named.all(|column| number::is_number(&column.name)) {
        let message = "the line contains numbers, but it must be a header with column names; for a file without a header, use --names t,x,f";
        return Err(RecordError::at(before + 1, message));
    }
    Ok(Header::with(line, columns))
}

/// Index of the column of this name, or the error that lists the existing names.
pub(super) fn require(header: &Header, name: &str, hint: &str) -> Result<usize, RecordError> {
    header.find(name).ok_or_else(|| missing(header, name, hint))
}

/// At most three names that are similar to a missing name, in brackets, for a message.
#[must_use]
pub fn nearest<'a>(name: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let wanted = name.trim().to_lowercase();
    let alike = |name: &str| strsim::jaro_winkler(&wanted, &name.to_lowercase());
    let named = names.into_iter().filter(|name| !name.is_empty());
    let mut near: Vec<(f64, &str)> = named
        .map(|name| (alike(name), name))
        .filter(|(alike, _)| *alike >= ALIKE)
        .collect();
    near.sort_by(|a, b| b.0.total_cmp(&a.0));
    near.dedup();
    near.truncate(3);
    let quoted = |(_, name): &(f64, &str)| format!("`{}`", shown(name, NAME_LENGTH));
    let quoted: Vec<String> = near.iter().map(quoted).collect();
    match quoted.is_empty() {
        true => String::new(),
        false => format!(" (nearest: {})", quoted.join(", ")),
    }
}

/// The error for a name that no column has.
pub(super) fn missing(header: &Header, name: &str, hint: &str) -> RecordError {
    let meant = nearest(name, header.columns.iter().map(|c| c.name.as_str()));
    let message = format!(
        "no such column; the columns are {}{meant}; {hint}",
        header.list()
    );
    RecordError::at(header.line, message).on(name)
}

/// Rejects a name that two columns have, if `counts` selects one of them.
pub(super) fn twice(header: &Header, counts: impl Fn(usize) -> bool) -> Result<(), RecordError> {
    let mut seen = std::collections::HashMap::new();
    let columns = header.columns.iter().enumerate();
    for (index, column) in columns.filter(|(_, column)| !column.name.is_empty()) {
        if let Some(first) = seen.insert(column.name.as_str(), index) {
            if counts(first) || counts(index) {
                let (first, second) = (first + 1, index + 1);
                let own = match header.line {
                    0 => "",
                    _ => "; --names A,B,… gives each column its own name",
                };
                let message = format!("named twice, as columns {first} and {second}{own}");
                return Err(RecordError::at(header.line, message).on(&column.name));
            }
        }
    }
    Ok(())
}
