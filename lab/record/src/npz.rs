//! NumPy files: `.npz`, a zip archive with one array per file, and `.npy`, a single array.
//!
//! Source: NumPy, *NEP 1: a simple file format for NumPy arrays*. An array of numbers is a vector
//! or a matrix. An array of texts with the same length names the columns of a matrix. The fields of
//! a structured array are vectors. Every length is checked against the number of bytes.

use super::limits::{BYTES, COLUMNS};
use super::scale::counted;
use super::vectors::Value;
use super::zip::{damaged, entries, number, slice, unpacked, Damage};

/// The arrays of an archive, each with its name.
pub(super) fn variables(bytes: &[u8]) -> Result<Vec<(String, Value)>, Damage> {
    let mut left = BYTES;
    let mut all = Vec::new();
    for (name, at) in entries(bytes)? {
        if let Some(own) = name.strip_suffix(".npy") {
            let file = unpacked(bytes, at, left)?;
            left -= file.len() as u64;
            all.push((own.to_owned(), array(&file)?));
        }
    }
    Ok(all)
}

/// The columns of an array that is a file by itself. `names` are the column names of a matrix.
pub(super) fn lone(bytes: &[u8], names: &[String]) -> Result<Vec<(String, Value)>, Damage> {
    let header = Header::read(bytes)?;
    match (header.value(bytes)?, header.shape.as_slice()) {
        (Value::Structures(mut rows), _) if names.is_empty() => Ok(rows.pop().unwrap_or_default()),
        (Value::Structures(_), _) => {
            Err("--names: the fields of the array already have names".to_owned())
        }
        (matrix @ Value::Numbers { .. }, [rows, columns]) => {
            let count = *rows.min(columns);
            if !names.is_empty() && names.len() != count {
                return Err(format!(
                    "the array has {}, but --names lists {}",
                    counted(count, "column"),
                    names.len()
                ));
            }
            let names = Value::Text(names.to_vec());
            Ok(vec![("data".to_owned(), matrix), ("names".to_owned(), names)])
        }
        (Value::Numbers { .. }, [values]) => Err(format!(
            "the array is one column of {values} numbers; save a two-dimensional array, or name the columns with `np.savez`"
        )),
        (_, shape) if shape.len() != 2 && !header.fields.is_empty() => Err(format!(
            "the array has {}, but it must have two, with one column per quantity",
            counted(shape.len(), "dimension")
        )),
        _ => Err("the array does not contain real numbers".to_owned()),
    }
}

/// The array of a file.
fn array(file: &[u8]) -> Result<Value, Damage> {
    Header::read(file)?.value(file)
}

/// Type and shape of an array.
struct Header {
    shape: Vec<usize>,
    /// The types of a cell; empty if one of them is unknown.
    fields: Vec<(String, Kind)>,
    by_column: bool,
    /// Position of the first cell.
    data: usize,
}

impl Header {
    fn read(file: &[u8]) -> Result<Self, Damage> {
        if !file.starts_with(b"\x93NUMPY") {
            return Err(damaged("an array has no header"));
        }
        let (from, length) = match file.get(6) {
            Some(1) => (10, number::<2>(file, 8)?),
            _ => (12, number::<4>(file, 8)?),
        };
        let header = String::from_utf8_lossy(slice(file, from, length)?).into_owned();
        let value = |key: &str| header.split_once(key).map(|(_, rest)| rest.trim_start());
        let shape = value("'shape':").and_then(|rest| rest.strip_prefix('(')?.split_once(')'));
        let shape: Option<Vec<usize>> = shape.and_then(|(list, _)| {
            let sizes = list
                .split(',')
                .map(str::trim)
                .filter(|size| !size.is_empty());
            sizes.map(|size| size.parse().ok()).collect()
        });
        let (Some(shape), Some(kind)) = (shape, value("'descr':")) else {
            return Err(damaged("the header of an array"));
        };
        Ok(Self {
            shape,
            fields: fields(kind),
            by_column: value("'fortran_order':").is_some_and(|own| own.starts_with("True")),
            data: from + length,
        })
    }

    /// The value that the cells of a file represent.
    fn value(&self, file: &[u8]) -> Result<Value, Damage> {
        let Self { shape, fields, .. } = self;
        let data = file.get(self.data..).unwrap_or_default();
        let size: usize = fields.iter().map(|(_, kind)| kind.size).sum();
        let cells = shape
            .iter()
            .try_fold(1_usize, |all, size| all.checked_mul(*size));
        if fields.is_empty() || size == 0 || shape.len() > 2 {
            return Ok(Value::Other);
        }
        let rows =
            cells.and_then(|cells| Some(data.get(..cells.checked_mul(size)?)?.chunks_exact(size)));
        let rows = rows.ok_or_else(|| damaged("an array is truncated"))?;
        if let [(name, kind)] = fields.as_slice() {
            return Ok(match (kind.letter, shape.as_slice()) {
                ('U' | 'S', [_]) => Value::Text(rows.map(|cell| kind.text(cell)).collect()),
                _ if !name.is_empty() => structure(fields, rows),
                (_, shape) => numbers(
                    rows.map(|cell| kind.number(cell)).collect(),
                    shape,
                    self.by_column,
                ),
            });
        }
        Ok(structure(fields, rows))
    }
}

/// The fields of a structured array as vectors.
fn structure<'a>(fields: &[(String, Kind)], rows: impl Iterator<Item = &'a [u8]> + Clone) -> Value {
    let mut from = 0;
    let own = fields.iter().map(|(name, kind)| {
        let at = from;
        from += kind.size;
        let cell = |row: &'a [u8]| kind.number(row.get(at..at + kind.size).unwrap_or_default());
        let values: Option<Vec<f64>> = rows.clone().map(cell).collect();
        let length = values.as_ref().map_or(0, Vec::len);
        (name.clone(), numbers(values, &[length], true))
    });
    Value::Structures(vec![own.collect()])
}

/// Numbers column by column.
fn numbers(values: Option<Vec<f64>>, shape: &[usize], by_column: bool) -> Value {
    let Some(values) = values else {
        return Value::Other;
    };
    let (rows, columns) = match shape {
        [rows, columns] => (*rows, *columns),
        _ => (values.len(), 1),
    };
    let values = match by_column || rows.min(columns) < 2 || rows.min(columns) > COLUMNS {
        true => values,
        false => {
            let column = |k: usize| values.iter().skip(k).step_by(columns).copied();
            (0..columns).flat_map(column).collect()
        }
    };
    Value::Numbers {
        dims: vec![rows, columns],
        values,
    }
}

/// The type of a cell.
struct Kind {
    letter: char,
    size: usize,
    is_big: bool,
}

/// The types of the cells of an array: one type without a name, or the types of its fields. The
/// list is empty if one of them is unknown.
fn fields(kind: &str) -> Vec<(String, Kind)> {
    let own = match kind.strip_prefix('[') {
        // `[('t', '<f8'), ('x', '<f8')]`: quotes around each name and each type.
        Some(rest) => {
            let list = rest.split(']').next().unwrap_or_default();
            let quoted: Vec<&str> = list.split('\'').skip(1).step_by(2).collect();
            let is_plain = list.matches('(').count() * 2 == quoted.len();
            let pairs = quoted.chunks_exact(2).filter(|_| is_plain);
            pairs
                .map(|pair| Some((pair[0].to_owned(), Kind::of(pair[1])?)))
                .collect()
        }
        None => {
            let own = kind.split('\'').nth(1).and_then(Kind::of);
            own.map(|own| vec![(String::new(), own)])
        }
    };
    own.unwrap_or_default()
}

impl Kind {
    fn of(text: &str) -> Option<Self> {
        let own = text.trim_start_matches(['<', '>', '|', '=']);
        let letter = own.chars().next()?;
        let size: usize = own.get(1..)?.parse().ok()?;
        let (size, is_known) = match letter {
            'U' => (size.checked_mul(4)?, true),
            'S' => (size, true),
            'f' => (size, matches!(size, 4 | 8)),
            'i' | 'u' => (size, matches!(size, 1 | 2 | 4 | 8)),
            'b' => (size, size == 1),
            _ => (size, false),
        };
        is_known.then_some(Self {
            letter,
            size,
            is_big: text.starts_with('>'),
        })
    }

    /// The number in a cell; `None` if the type is not numeric.
    fn number(&self, cell: &[u8]) -> Option<f64> {
        let mut bytes = [0; 8];
        for (to, from) in bytes.iter_mut().zip(cell) {
            *to = *from;
        }
        if self.is_big {
            bytes.get_mut(..self.size)?.reverse();
        }
        let whole = u64::from_le_bytes(bytes);
        let unused = 64_u32.checked_sub(8 * u32::try_from(self.size).ok()?)?;
        Some(match (self.letter, self.size) {
            ('f', 4) => f64::from(f32::from_bits(u32::try_from(whole).ok()?)),
            ('f', _) => f64::from_bits(whole),
            ('i', _) => (whole.checked_shl(unused)?.cast_signed() >> unused) as f64,
            ('u' | 'b', _) => whole as f64,
            _ => return None,
        })
    }

    /// The text in a cell.
    fn text(&self, cell: &[u8]) -> String {
        let text: String = match self.letter {
            'S' => cell.iter().map(|byte| char::from(*byte)).collect(),
            _ => {
                let letter = |four: &[u8]| {
                    let mut own: [u8; 4] = four.try_into().ok()?;
                    if self.is_big {
                        own.reverse();
                    }
                    char::from_u32(u32::from_le_bytes(own))
                };
                cell.chunks_exact(4).filter_map(letter).collect()
            }
        };
        text.trim_end_matches('\0').to_owned()
    }
}
