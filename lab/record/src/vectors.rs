//! Converts named variables to columns.
//!
//! A column is a vector, a field of a structure, a column of a matrix, or the `Data` of a structure
//! with a `Name` (as in exported traces). The name of a matrix column is in a list of names next to
//! the matrix. Otherwise the name has the form `data(:,2)`.

use super::error::{RecordError, SHOWN};
use super::limits::{COLUMNS, DEPTH};

/// A column with all its possible names.
pub(super) struct Vector {
    /// The last part of its name.
    pub(super) name: String,
    /// The whole name, such as `run.signals(2).x`.
    pub(super) path: String,
    pub(super) unit: Option<String>,
    pub(super) values: Vec<f64>,
}

/// The value of a variable.
// Only files of MATLAB's have cells and objects.
#[cfg_attr(not(feature = "mat"), allow(dead_code))]
#[derive(Debug, PartialEq)]
pub(super) enum Value {
    /// Real numbers, column by column.
    Numbers {
        dims: Vec<usize>,
        values: Vec<f64>,
    },
    /// The rows of a character array.
    Text(Vec<String>),
    Cells(Vec<Value>),
    /// An array of structures, each with its fields.
    Structures(Vec<Vec<(String, Value)>>),
    /// A MATLAB object of this class, such as a table or a time series.
    Object(String),
    /// Complex or sparse numbers, or functions.
    Other,
}

/// The columns of variables, or the reason why there are none.
pub(super) fn vectors(
    variables: Result<Vec<(String, Value)>, String>,
) -> Result<Vec<Vector>, RecordError> {
    let variables = variables.map_err(RecordError::new)?;
    let mut found = Vec::new();
    fields("", &variables, 0, &mut found);
    if found.is_empty() {
        let names: Vec<String> = variables
            .iter()
            .filter(|(name, _)| !name.is_empty())
            .map(|(name, value)| match value {
                Value::Object(class) => {
                    let (name, class) = (name.escape_debug(), class.escape_debug());
                    format!("`{name}` (an object: {class})")
                }
                _ => format!("`{}`", name.escape_debug()),
            })
            .take(SHOWN)
            .collect();
        let among = match names.is_empty() {
            true => String::new(),
            false => format!(" among the variables {}", names.join(", ")),
        };
        let objects = match has_objects(&variables) {
            true => {
                "; only MATLAB can read its objects (tables, time series, Simulink outputs); extract the vectors, as in `t = out.tout; save('r.mat', 't', …)`"
            }
            false => "",
        };
        return Err(RecordError::new(format!(
            "no vector of real numbers{among}; each column must be one vector, on its own or as a field of a structure{objects}"
        )));
    }
    // A name that two have says nothing.
    let names: Vec<String> = found.iter().map(|vector| vector.name.clone()).collect();
    for (index, vector) in found.iter_mut().enumerate() {
        let mut others = names.iter().enumerate();
        if others.any(|(other, name)| other != index && *name == vector.name) {
            vector.name.clone_from(&vector.path);
        }
    }
    Ok(found)
}

/// Whether the variables or their fields include a MATLAB object.
fn has_objects(all: &[(String, Value)]) -> bool {
    all.iter().any(|(_, value)| match value {
        Value::Object(_) => true,
        Value::Structures(elements) => elements.iter().any(|own| has_objects(own)),
        _ => false,
    })
}

/// The vectors among variables or fields.
fn fields(prefix: &str, all: &[(String, Value)], depth: usize, found: &mut Vec<Vector>) {
    for (name, value) in all {
        let path = match prefix.is_empty() {
            true => name.clone(),
            false => format!("{prefix}.{name}"),
        };
        match value {
            Value::Numbers { dims, values } => {
                let [rows, columns] = dims.as_slice() else {
                    continue;
                };
                if *rows.min(columns) == 1 && values.len() > 1 {
                    found.push(Vector {
                        name: name.clone(),
                        path,
                        unit: None,
                        values: values.clone(),
                    });
                } else {
                    matrix((name, &path), (*rows, *columns), values, all, found);
                }
            }
            Value::Structures(elements) if depth < DEPTH => {
                for (index, own) in elements.iter().enumerate() {
                    let path = match elements.len() {
                        1 => path.clone(),
                        _ => format!("{path}({})", index + 1),
                    };
                    if !trace(&path, own, found) {
                        fields(&path, own, depth + 1, found);
                    }
                }
            }
            _ => {}
        }
    }
}

/// The columns of a matrix, whose longer side is the time.
fn matrix(
    (name, path): (&str, &str),
    (rows, columns): (usize, usize),
    values: &[f64],
    beside: &[(String, Value)],
    found: &mut Vec<Vector>,
) {
    let count = rows.min(columns);
    if !(2..=COLUMNS).contains(&count) || rows == columns {
        return;
    }
    let mut lists = beside.iter().filter_map(|(_, value)| names(value));
    let list = lists.find(|names| names.len() == count);
    // Two lists of as many names: neither is taken.
    let list = list.filter(|own| !lists.any(|other| other.len() == count && other != *own));
    for index in 0..count {
        let (index_of, values): (String, Vec<f64>) = match columns == count {
            true => (
                format!("(:,{})", index + 1),
                values
                    .iter()
                    .skip(index * rows)
                    .take(rows)
                    .copied()
                    .collect(),
            ),
            false => (
                format!("({},:)", index + 1),
                values.iter().skip(index).step_by(rows).copied().collect(),
            ),
        };
        let own = list.as_ref().and_then(|names| names.get(index));
        found.push(Vector {
            name: own.cloned().unwrap_or_else(|| format!("{name}{index_of}")),
            path: format!("{path}{index_of}"),
            unit: None,
            values,
        });
    }
}

/// A list of names: a cell array of texts, or a character array with one row for each name.
fn names(value: &Value) -> Option<Vec<String>> {
    match value {
        Value::Text(rows) => Some(rows.clone()),
        Value::Cells(cells) => cells.iter().map(one_text).collect(),
        _ => None,
    }
}

fn one_text(value: &Value) -> Option<String> {
    match value {
        Value::Text(rows) => match rows.as_slice() {
            [one] => Some(one.clone()),
            _ => None,
        },
        _ => None,
    }
}

/// Reads a structure with a name and one vector as a column with this name.
fn trace(path: &str, own: &[(String, Value)], found: &mut Vec<Vector>) -> bool {
    let field = |names: &[&str]| {
        let is = |(name, _): &&(String, Value)| names.contains(&name.to_lowercase().as_str());
        own.iter().find(is).map(|(_, value)| value)
    };
    let name = field(&["name", "label"]).and_then(one_text);
    let values = field(&["data", "values"]);
    let (Some(name), Some(Value::Numbers { dims, values })) = (name, values) else {
        return false;
    };
    if name.is_empty() || dims.len() != 2 || !dims.contains(&1) || values.len() < 2 {
        return false;
    }
    let unit = field(&["unit", "units"]).and_then(one_text);
    found.push(Vector {
        name,
        path: path.to_owned(),
        unit: unit.filter(|unit| !unit.is_empty()),
        values: values.clone(),
    });
    true
}
