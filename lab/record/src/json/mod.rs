//! JSON: an array of records, one record per line, or an object of columns.
//!
//! A record is an object. The name of a nested value is its path, such as `pose.x` or `pose.0`. A
//! row is an array, whose names are next to it or in `--names`. The file may contain other data in
//! addition to the table, but only one table. The cells become text, so time stamps, gaps and
//! errors are treated as in any other text. The line number of an error is the number of the
//! record.

mod value;

use super::error::{shown, RecordError, NAME_LENGTH};
use super::limits::PIECES;
use super::scale::counted;
use super::MIN_SAMPLES;
use std::collections::HashMap;
use value::{values, without_nan, Cell, Json};

/// A table of JSON.
#[derive(Default)]
pub(super) struct Table {
    columns: Vec<Column>,
    /// Whether the names of the columns were given.
    pub(super) is_given: bool,
    pub(super) notes: Vec<String>,
}

struct Column {
    /// The whole name, such as `run.signals.x`.
    path: String,
    unit: Option<String>,
    cells: Vec<Cell>,
}

/// Records or rows, and the names of their columns if these are next to them.
struct Rows {
    path: String,
    rows: Vec<Json>,
    names: Vec<String>,
}

/// Whether a text is JSON. Column names do not begin like JSON.
pub(super) fn is_json(text: &str) -> bool {
    let mut signs = text.chars().filter(|c| !c.is_whitespace());
    match signs.next() {
        Some('{') => signs.next() == Some('"'),
        Some('[') => matches!(signs.next(), Some('{' | '[' | '"' | '-' | '0'..='9')),
        _ => false,
    }
}

/// The table of a text. `names` are the column names if the rows have none.
pub(super) fn read(text: &str, names: &[String]) -> Result<Table, RecordError> {
    let mut notes = Vec::new();
    let mut all = values(&without_nan(text), &mut notes)?;
    let mut table = match (all.len(), all.pop()) {
        (1, Some(Json::Object(fields))) => within(fields, names)?,
        (1, Some(Json::List(rows))) => of_rows(Rows::new(String::new(), rows), names)?,
        (_, last) => {
            all.extend(last);
            of_rows(Rows::new(String::new(), all), names)?
        }
    };
    table.notes.extend(notes);
    Ok(table)
}

impl Table {
    /// Name, unit and whole name of each column. A name that two columns share is ignored.
    pub(super) fn names(&self) -> Vec<(String, Option<String>, String)> {
        let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
        let mut count: HashMap<String, usize> = HashMap::new();
        for column in &self.columns {
            *count.entry(last(&column.path)).or_default() += 1;
        }
        let named = |column: &Column| {
            let (path, own) = (column.path.clone(), last(&column.path));
            // `pose.0` is no name without `pose`.
            let is_own = count.get(&own) == Some(&1) && own.parse::<f64>().is_err();
            let name = if is_own { own } else { path.clone() };
            (name, column.unit.clone(), path)
        };
        self.columns.iter().map(named).collect()
    }

    pub(super) fn lengths(&self) -> Vec<usize> {
        self.columns.iter().map(|own| own.cells.len()).collect()
    }

    /// The first rows as text, with `;` between the cells. Unused columns stay blank.
    pub(super) fn text(&self, rows: usize, used: &[usize]) -> String {
        let mut all = String::new();
        for row in 0..rows {
            for (index, column) in self.columns.iter().enumerate() {
                if index > 0 {
                    all.push(';');
                }
                match column.cells.get(row).filter(|_| used.contains(&index)) {
                    Some(Cell::Number(value)) => all += &value.to_string(),
                    Some(Cell::Text(text)) => {
                        let own = text.replace('"', "\"\"").replace(char::is_control, " ");
                        all += &format!("\"{own}\"");
                    }
                    _ => {}
                }
            }
            all.push('\n');
        }
        all
    }
}

/// The columns, or the one table of records or rows, within an object.
fn within(fields: Vec<(String, Json)>, names: &[String]) -> Result<Table, RecordError> {
    // Records by their number, as pandas writes them.
    let is_numbered = |(name, own): &(String, Json)| {
        name.parse::<usize>().is_ok() && matches!(own, Json::Object(_))
    };
    if fields.len() > 1 && fields.iter().all(is_numbered) {
        let records = fields.into_iter().map(|(_, record)| record).collect();
        return of_rows(Rows::new(String::new(), records), names);
    }
    let (mut columns, mut tables) = (Vec::new(), Vec::new());
    collect("", fields, &mut columns, &mut tables);
    // Lists of a few numbers describe the rig.
    let is_record = |column: &Column| column.cells.len() >= MIN_SAMPLES;
    if columns.iter().any(is_record) || tables.iter().any(|own| own.rows.len() >= MIN_SAMPLES) {
        columns.retain(is_record);
        tables.retain(|own| own.rows.len() >= MIN_SAMPLES);
    }
    match (columns.is_empty(), tables.pop()) {
        (false, None) => Ok(Table {
            columns,
            ..Table::default()
        }),
        (_, Some(rows)) if tables.is_empty() && columns.iter().all(|own| own.cells.len() == rows.count()) => {
            let mut table = of_rows(rows, names)?;
            // Columns next to the rows, as the index that pandas writes.
            table.columns.extend(columns);
            Ok(table)
        }
        (_, None) => Err(RecordError::new(
            "the JSON contains no table; use an array of records, one record per line, or an object of columns",
        )),
        (_, Some(last)) => {
            let paths = tables.iter().chain([&last]).map(|own| own.path.as_str());
            let paths = paths.chain(columns.first().map(|own| own.path.as_str()));
            let paths: Vec<String> = paths
                .take(3)
                .map(|path| format!("`{}`", shown(path, NAME_LENGTH)))
                .collect();
            Err(RecordError::new(format!(
                "the JSON contains several tables ({}); write each to a separate file",
                paths.join(", ")
            )))
        }
    }
}

/// The columns and tables among the fields of an object.
fn collect(
    prefix: &str,
    fields: Vec<(String, Json)>,
    columns: &mut Vec<Column>,
    tables: &mut Vec<Rows>,
) {
    let lists: Vec<Vec<String>> = fields.iter().filter_map(|(_, own)| texts(own)).collect();
    for (name, value) in fields {
        let path = match prefix {
            "" => name,
            _ => format!("{prefix}.{name}"),
        };
        match value {
            Json::List(rows) if rows.iter().all(|row| !matches!(row, Json::Cell(_))) => {
                let mut own = Rows::new(path, rows);
                let width = own.width();
                let names = lists.iter().find(|names| Some(names.len()) == width);
                own.names = names.cloned().unwrap_or_default();
                tables.extend((!own.rows.is_empty()).then_some(own));
            }
            Json::List(values) => columns.extend(column(path, None, values)),
            Json::Object(fields) => match with_unit(&path, fields) {
                Ok(column) => columns.push(column),
                Err(fields) => collect(&path, fields, columns, tables),
            },
            Json::Cell(_) => {}
        }
    }
    // A list of texts that names the columns of a table is no column itself.
    if tables.iter().any(|own| !own.names.is_empty()) {
        columns.retain(|own| own.cells.iter().any(|cell| !matches!(cell, Cell::Text(_))));
    }
}

/// A list of texts.
fn texts(value: &Json) -> Option<Vec<String>> {
    let Json::List(all) = value else { return None };
    let text = |own: &Json| match own {
        Json::Cell(Cell::Text(text)) => Some(text.to_string()),
        _ => None,
    };
    all.iter().map(text).collect()
}

/// A column of scalar values.
fn column(path: String, unit: Option<String>, values: Vec<Json>) -> Option<Column> {
    let cell = |value: Json| match value {
        Json::Cell(cell) => Some(cell),
        _ => None,
    };
    let cells: Vec<Cell> = values.into_iter().map(cell).collect::<Option<_>>()?;
    (cells.len() > 1).then_some(Column { path, unit, cells })
}

/// The column that an object represents. The object contains `values` with their `unit`, or values
/// with their row numbers as keys, as pandas writes them.
fn with_unit(path: &str, mut fields: Vec<(String, Json)>) -> Result<Column, Vec<(String, Json)>> {
    let is_cell = |own: &Json| matches!(own, Json::Cell(_));
    let is_numbered = |(name, own): &(String, Json)| name.parse::<usize>().is_ok() && is_cell(own);
    if fields.len() > 1 && fields.iter().all(is_numbered) {
        let values = fields.into_iter().map(|(_, value)| value).collect();
        return column(path.to_owned(), None, values).ok_or_else(Vec::new);
    }
    let is = |names: [&str; 2], own: &str| names.contains(&own.to_lowercase().as_str());
    let is_values = |(name, own): &(String, Json)| match own {
        Json::List(all) => is(["values", "data"], name) && all.iter().all(is_cell),
        _ => false,
    };
    let unit = fields.iter().find_map(|(name, own)| match own {
        Json::Cell(Cell::Text(unit)) if is(["unit", "units"], name) => Some(unit.to_string()),
        _ => None,
    });
    let Some(at) = fields.iter().position(is_values).filter(|_| unit.is_some()) else {
        return Err(fields);
    };
    match fields.swap_remove(at).1 {
        Json::List(values) => column(path.to_owned(), unit, values).ok_or(fields),
        _ => Err(fields),
    }
}

impl Rows {
    fn new(path: String, rows: Vec<Json>) -> Self {
        Self {
            path,
            rows,
            names: Vec::new(),
        }
    }

    /// Number of rows below the names.
    fn count(&self) -> usize {
        let has_names = self.names.is_empty() && self.rows.first().and_then(texts).is_some();
        self.rows.len() - usize::from(has_names)
    }

    /// Number of cells in a row, if the first row is an array.
    fn width(&self) -> Option<usize> {
        match self.rows.first()? {
            Json::List(cells) => Some(cells.len()),
            _ => None,
        }
    }
}

/// The columns of records, or of rows with these names.
fn of_rows(mut own: Rows, names: &[String]) -> Result<Table, RecordError> {
    let first = own.rows.first().and_then(texts);
    let mut is_given = false;
    if let Some(width) = own.width() {
        if let Some(first) = first.filter(|_| own.names.is_empty() && names.is_empty()) {
            own.names = first;
            own.rows.remove(0);
        }
        is_given = own.names.is_empty();
        if is_given {
            own.names = names.to_vec();
        }
        if own.names.len() != width {
            let message = match own.names.len() {
                0 => "the rows of the JSON have no names; --names t,x,f names their columns"
                    .to_owned(),
                count => format!(
                    "the row has {}, but there are {count} names",
                    counted(width, "cell")
                ),
            };
            return Err(RecordError::at(1, message));
        }
    }
    let mut table = Table {
        is_given,
        ..Table::default()
    };
    if !own.path.is_empty() {
        let path = shown(&own.path, NAME_LENGTH);
        table.notes.push(format!("table `{path}` of the JSON"));
    }
    let mut places: HashMap<String, usize> = HashMap::new();
    let count = own.rows.len();
    let mut cells = Vec::new();
    for (row, value) in own.rows.into_iter().enumerate() {
        cells.clear();
        match value {
            Json::Object(fields) => flatten("", Json::Object(fields), &mut cells),
            Json::List(values) if values.len() == own.names.len() => {
                for (name, value) in own.names.iter().zip(values) {
                    flatten(name, value, &mut cells);
                }
            }
            Json::List(values) => {
                let message = format!(
                    "the row has {}, but there are {} names",
                    counted(values.len(), "cell"),
                    own.names.len()
                );
                return Err(RecordError::at(row + 1, message));
            }
            Json::Cell(_) => {
                return Err(RecordError::at(
                    row + 1,
                    "this is neither a record nor a row of the JSON",
                ));
            }
        }
        for (path, cell) in cells.drain(..) {
            let place = *places.entry(path).or_insert_with_key(|path| {
                table.columns.push(Column {
                    path: path.clone(),
                    unit: None,
                    cells: Vec::new(),
                });
                table.columns.len() - 1
            });
            let own = &mut table.columns[place].cells;
            own.resize(row, Cell::Empty);
            own.push(cell);
        }
        // Names that change from record to record name no columns.
        if table.columns.len() > PIECES {
            let message = "the records have too many different names for a table";
            return Err(RecordError::at(row + 1, message));
        }
    }
    let columns = table.columns.iter_mut();
    columns.for_each(|own| own.cells.resize(count, Cell::Empty));
    Ok(table)
}

/// The scalar values in a value, each with its path.
fn flatten(path: &str, value: Json, into: &mut Vec<(String, Cell)>) {
    let below = |name: &str| match path {
        "" => name.to_owned(),
        _ => format!("{path}.{name}"),
    };
    match value {
        Json::Cell(cell) => into.push((path.to_owned(), cell)),
        Json::Object(fields) => {
            for (name, value) in fields {
                flatten(&below(&name), value, into);
            }
        }
        Json::List(values) => {
            for (index, value) in values.into_iter().enumerate() {
                flatten(&below(&index.to_string()), value, into);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_is_told_from_names_of_columns() {
        for text in [
            "{\"t\":[0]}",
            " [ {\"t\":0}]",
            "[[0,1]]",
            "[0, 1]\n[1, 2]",
            "\n{ \"t\": 0}\n",
        ] {
            assert!(is_json(text), "{text}");
        }
        for text in ["[t],[x],[f]", "{t},x", "\"t\",\"x\"", "t,x,f", "", "[", "{"] {
            assert!(!is_json(text), "{text}");
        }
    }
}
