//! The contents of a file before every column has a role: names, units, and values as they are.
//!
//! A view shows these contents to a user, who then chooses the columns. A cell without a number is
//! NaN and is not rejected.

use super::encoding::Decoded;
use super::error::RecordError;
use super::header::Header;
use super::kind::{self, Kind};
use super::layout::{self, cells, Table};
use super::roles::{self, Part, Roles};
use super::text::Rows;
#[cfg(feature = "xlsx")]
use super::workbook;
use super::{blanks, clock_time, encoding, gzip, json, sheet, Mode, Options};

/// The columns of a file.
#[derive(Clone, Debug)]
pub struct Outline {
    /// Line of the column names, from 1; 0 for a file without lines.
    pub line: usize,
    /// The mode, if the columns determine it.
    pub mode: Option<Mode>,
    /// All columns, in the order of the file.
    pub columns: Vec<Outlined>,
}

/// A column of the file.
#[derive(Clone, Debug)]
pub struct Outlined {
    /// Its name.
    pub name: String,
    /// Its unit, if the file states one.
    pub unit: Option<String>,
    /// Its role, if its name or an option determines the role.
    pub part: Option<Part>,
    /// One value per row; NaN if the cell is not a number.
    pub values: Vec<f64>,
}

/// A line of a text as cells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Its number, from 1.
    pub number: usize,
    /// Its cells.
    pub cells: Vec<String>,
}

/// The columns of a file in memory, before they have roles.
///
/// # Errors
/// The error for a file without a table, without the name of the file.
pub fn outline(bytes: &[u8], options: &Options) -> Result<Outline, RecordError> {
    match kind::of(bytes)? {
        Kind::Gzip => {
            let unpacked = gzip::unpack(bytes)?;
            of_kind(kind::of(&unpacked)?, &unpacked, options)
        }
        kind => of_kind(kind, bytes, options),
    }
}

/// The lines of a text around one of its lines, at most `around` lines on each side. The list is
/// empty for a file that is not text.
#[must_use]
pub fn excerpt(bytes: &[u8], line: usize, around: usize, options: &Options) -> Vec<Line> {
    let unpacked = match kind::of(bytes) {
        Ok(Kind::Gzip) => gzip::unpack(bytes).unwrap_or_default(),
        Ok(Kind::Text) => bytes.to_vec(),
        #[cfg(feature = "xlsx")]
        Ok(Kind::Xlsx) => match workbook::read(bytes, options) {
            Ok(sheet) => sheet.text().text.into_owned().into_bytes(),
            Err(_) => return Vec::new(),
        },
        _ => return Vec::new(),
    };
    let Ok(decoded) = encoding::decode(&unpacked) else {
        return Vec::new();
    };
    let text = blanks::as_tabs(&decoded.text);
    let separator = match layout::any(&text, options) {
        Ok(table) => table.rows.separator(),
        Err(_) => Rows::new(&text).separator(),
    };
    let first = line.saturating_sub(around).max(1);
    let lines = text.lines().enumerate().skip(first - 1);
    let of = |(index, line): (usize, &str)| Line {
        number: index + 1,
        cells: cells(line, separator)
            .into_iter()
            .map(str::to_owned)
            .collect(),
    };
    lines.take(line + around + 1 - first).map(of).collect()
}

fn of_kind(kind: Kind, bytes: &[u8], options: &Options) -> Result<Outline, RecordError> {
    if kind == Kind::Text {
        return of_text(bytes, options);
    }
    #[cfg(feature = "xlsx")]
    if kind == Kind::Xlsx {
        return of_table(workbook::read(bytes, options)?.text(), options);
    }
    let columns = sheet::of(kind, bytes, options)?;
    let (mut header, values) = columns.all();
    let roles = roles::assign(&mut header, options).ok();
    Ok(Outline::new(&header, roles.as_ref(), values, options))
}

fn of_text(bytes: &[u8], options: &Options) -> Result<Outline, RecordError> {
    let decoded = encoding::decode(bytes)?;
    if json::is_json(&decoded.text) {
        let table = json::read(&decoded.text, &options.names)?;
        let mut header = Header::of(table.names())?;
        let roles = roles::assign(&mut header, options).ok();
        let rows = table.lengths().into_iter().max().unwrap_or(0);
        let used: Vec<usize> = (0..header.columns.len()).collect();
        let text = table.text(rows, &used);
        let values = numbers(Rows::separated_by(b';', &text), &header);
        return Ok(Outline::new(&header, roles.as_ref(), values, options));
    }
    of_table(decoded, options)
}

fn of_table(decoded: Decoded<'_>, options: &Options) -> Result<Outline, RecordError> {
    let text = blanks::as_tabs(&decoded.text);
    let (table, is_known) = match layout::find(&text, options) {
        Ok(table) => (table, true),
        Err(_) => (layout::any(&text, options)?, false),
    };
    let Table {
        header,
        roles,
        rows,
        ..
    } = table;
    let values = numbers(rows, &header);
    let roles = is_known.then_some(&roles);
    Ok(Outline::new(&header, roles, values, options))
}

/// The values of all columns, up to the first line that is not a row.
fn numbers(mut rows: Rows<'_>, header: &Header) -> Vec<Vec<f64>> {
    let mut values = vec![Vec::new(); header.columns.len()];
    while let Ok(Some(row)) = rows.read() {
        for (index, (own, column)) in values.iter_mut().zip(&header.columns).enumerate() {
            let number = row.number(index, &column.name).ok();
            let value = number.or_else(|| clock_time::seconds(row.cell(index)));
            own.push(value.unwrap_or(f64::NAN));
        }
    }
    values
}

impl Outline {
    fn new(
        header: &Header,
        roles: Option<&Roles>,
        values: Vec<Vec<f64>>,
        options: &Options,
    ) -> Self {
        let parts = match roles {
            Some(roles) => parts(roles),
            None => roles::likely(header, options),
        };
        let columns = header.columns.iter().zip(values).enumerate();
        let column = |(index, (named, values)): (usize, (&super::header::Named, Vec<f64>))| {
            let part = parts.iter().find(|(own, _)| *own == index);
            Outlined {
                name: named.name.clone(),
                unit: named.unit.clone(),
                part: part.map(|(_, part)| part.clone()),
                values,
            }
        };
        Self {
            line: header.line,
            mode: roles.map(|roles| roles.mode),
            columns: columns.map(column).collect(),
        }
    }
}

/// The roles of columns that are read without change.
fn parts(roles: &Roles) -> Vec<(usize, Part)> {
    let ends = [(roles.input, Part::Input), (roles.output, Part::Output)];
    let time = roles.time.map(|index| (index, Part::Time));
    let channels = roles
        .channels
        .iter()
        .map(|(name, series)| (series.first(), Part::Channel(name.clone())));
    ends.into_iter().chain(time).chain(channels).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn text(head: &str) -> String {
        let rows = (0..300).map(|i| format!("{},{},{},n/a\n", 0.01 * f64::from(i), i % 7, i % 5));
        rows.fold(head.to_owned(), |all, row| all + &row)
    }

    #[test]
    fn columns_of_any_name_are_shown_with_their_units_and_known_parts() {
        let bytes = text("Rig 7, Monday\n\ntime,motor,joint,note\ns,N·m,N·m,-\n").into_bytes();
        let found = outline(&bytes, &Options::default()).unwrap();
        assert_eq!((found.line, found.mode, found.columns.len()), (3, None, 4));
        let parts: Vec<_> = found.columns.iter().map(|own| own.part.clone()).collect();
        assert_eq!(parts, [Some(Part::Time), None, None, None]);
        assert_eq!(found.columns[1].unit.as_deref(), Some("N·m"));
        assert_eq!(found.columns[2].values.len(), 300);
        assert!(found.columns[3].values.iter().all(|value| value.is_nan()));
    }

    #[test]
    fn parts_follow_the_names_and_the_options_as_in_a_record() {
        let bytes = text("t,tau_i,tau_o,note\n").into_bytes();
        let found = outline(&bytes, &Options::default()).unwrap();
        assert_eq!(found.mode, Some(Mode::Torque));
        assert_eq!(found.columns[1].part, Some(Part::Input));
        let bytes = text("t,motor,joint,note\n").into_bytes();
        let options = Options {
            mode: Some(Mode::Torque),
            input: Some("joint".to_owned()),
            output: Some("motor".to_owned()),
            ..Options::default()
        };
        let found = outline(&bytes, &options).unwrap();
        assert_eq!(found.columns[1].part, Some(Part::Output));
    }

    #[test]
    fn an_excerpt_has_the_lines_next_to_one() {
        let bytes = text("t,tau_i,tau_o,note\n").into_bytes();
        let found = excerpt(&bytes, 2, 1, &Options::default());
        let numbers: Vec<usize> = found.iter().map(|line| line.number).collect();
        assert_eq!(numbers, [1, 2, 3]);
        assert_eq!(found[0].cells, ["t", "tau_i", "tau_o", "note"]);
        assert!(excerpt(b"SQLite format 3\0", 1, 1, &Options::default()).is_empty());
    }
}
