//! The elements of a MAT-file of version 5 (MATLAB's `save -v6` and `-v7`).
//!
//! Source: MathWorks, *MAT-File Format*, chapter 1, "Version 5". A file consists of a header of 128
//! bytes and data elements. Each element has a type, a length and its bytes. An element may be
//! compressed, and a matrix contains further elements. Every length is checked against the number
//! of bytes.

use crate::limits::{BYTES, DEPTH};
use crate::scale::counted;
use crate::vectors::Value;
use flate2::read::ZlibDecoder;
use std::io::Read;

/// The reason why the bytes are not a MAT-file.
type Damage = String;

fn damaged(what: &str) -> Damage {
    format!("the file is damaged: {what}")
}

/// The byte order.
#[derive(Clone, Copy)]
struct Order {
    little: bool,
}

impl Order {
    fn bytes<const N: usize>(self, bytes: &[u8]) -> [u8; N] {
        let mut own = [0; N];
        for (to, from) in own.iter_mut().zip(bytes) {
            *to = *from;
        }
        if !self.little {
            own.reverse();
        }
        own
    }

    fn u32(self, bytes: &[u8]) -> u32 {
        u32::from_le_bytes(self.bytes(bytes))
    }
}

/// One element: its type and its bytes.
struct Element<'a> {
    kind: u32,
    bytes: &'a [u8],
}

impl Element<'_> {
    fn is_matrix(&self) -> bool {
        self.kind == 14
    }
}

/// The successive elements.
struct Elements<'a> {
    rest: &'a [u8],
    order: Order,
}

impl<'a> Elements<'a> {
    fn next(&mut self) -> Result<Option<Element<'a>>, Damage> {
        // What is left behind the last element is padding.
        let Some((tag, behind)) = self.rest.split_first_chunk::<8>() else {
            self.rest = &[];
            return Ok(None);
        };
        let word = self.order.u32(tag);
        if word >> 16 != 0 {
            // A small element: type and length share four bytes, four of data follow.
            let (kind, length) = (word & 0xffff, (word >> 16) as usize);
            let bytes = self.rest.get(4..4 + length).filter(|_| length <= 4);
            self.rest = behind;
            let bytes = bytes.ok_or_else(|| damaged("a small element is too long"))?;
            return Ok(Some(Element { kind, bytes }));
        }
        let length = self.order.u32(&tag[4..]) as usize;
        let bytes = behind.get(..length);
        let bytes = bytes.ok_or_else(|| damaged("the file ends inside an element"))?;
        let padded = match word {
            // A compressed element.
            15 => length,
            _ => length.next_multiple_of(8),
        };
        self.rest = behind.get(padded..).unwrap_or_default();
        Ok(Some(Element { kind: word, bytes }))
    }

    fn expect(&mut self, what: &str) -> Result<Element<'a>, Damage> {
        self.next()?
            .ok_or_else(|| damaged(&format!("a matrix has no {what}")))
    }
}

/// The variables of a file, in its order.
pub(super) fn variables(file: &[u8]) -> Result<Vec<(String, Value)>, Damage> {
    let (header, rest) = file.split_at(file.len().min(128));
    let order = Order {
        little: header.ends_with(b"IM"),
    };
    let mut elements = Elements { rest, order };
    let mut variables = Vec::new();
    let mut room = BYTES;
    while let Some(element) = elements.next()? {
        let unpacked;
        let element = match element.kind {
            // A compressed element.
            15 => {
                unpacked = unpack(element.bytes, &mut room)?;
                let rest = unpacked.as_slice();
                match (Elements { rest, order }).next()? {
                    Some(element) => element,
                    None => continue,
                }
            }
            _ => element,
        };
        if element.is_matrix() {
            variables.push(matrix(element.bytes, order, 0)?);
        }
    }
    // What the objects hold stands behind the variables, without a name.
    variables.retain(|(name, _)| !name.is_empty());
    Ok(variables)
}

fn unpack(bytes: &[u8], room: &mut u64) -> Result<Vec<u8>, Damage> {
    let mut unpacked = Vec::new();
    let decoder = ZlibDecoder::new(bytes).take(*room + 1);
    let read = { decoder }.read_to_end(&mut unpacked);
    read.map_err(|e| damaged(&format!("a compressed element: {e}")))?;
    let length = unpacked.len() as u64;
    *room = room
        .checked_sub(length)
        .ok_or_else(|| format!("the file is larger than {} MiB when unpacked", BYTES >> 20))?;
    Ok(unpacked)
}

/// Name and value of a matrix.
fn matrix(bytes: &[u8], order: Order, depth: usize) -> Result<(String, Value), Damage> {
    let mut parts = Elements { rest: bytes, order };
    // An empty element stands for an empty matrix.
    let Some(flags) = parts.next()? else {
        return Ok((String::new(), Value::Other));
    };
    if depth > DEPTH {
        return Ok((String::new(), Value::Other));
    }
    let flags = order.u32(flags.bytes);
    let (class, complex) = (flags & 0xff, flags & 0x0800 != 0);
    // An opaque object (a table, a string) has no dimensions: its name, who made it, its class.
    if class == 17 {
        let name = text(parts.expect("name")?.bytes);
        let _ = parts.expect("system of types")?;
        let class = text(parts.expect("class")?.bytes);
        return Ok((name, Value::Object(class)));
    }
    let dims = parts.expect("dimensions")?.bytes.chunks_exact(4);
    let dims: Vec<usize> = dims.map(|own| order.u32(own) as usize).collect();
    let name = text(parts.expect("name")?.bytes);
    let count = dims
        .iter()
        .try_fold(1_usize, |all, own| all.checked_mul(*own));
    let count = count.ok_or_else(|| damaged("a matrix has an impossible size"))?;
    let value = match class {
        1 => Value::Cells(
            nested(&mut parts, count, depth)?
                .into_iter()
                .map(|(_, value)| value)
                .collect(),
        ),
        2 => Value::Structures(structures(&mut parts, count, depth)?),
        3 => Value::Object(text(parts.expect("class")?.bytes)),
        4 => Value::Text(characters(&parts.expect("text")?, order, &dims)),
        6..=15 if !complex => {
            let values = numbers(&parts.expect("values")?, order)?;
            if values.len() != count {
                return Err(damaged(&format!(
                    "`{}` has {} for {count} places",
                    name.escape_debug(),
                    counted(values.len(), "value")
                )));
            }
            Value::Numbers { dims, values }
        }
        _ => Value::Other,
    };
    Ok((name, value))
}

fn nested(
    parts: &mut Elements<'_>,
    count: usize,
    depth: usize,
) -> Result<Vec<(String, Value)>, Damage> {
    let mut all = Vec::new();
    for _ in 0..count {
        let own = parts.expect("cell or field")?;
        all.push(match own.is_matrix() {
            true => matrix(own.bytes, parts.order, depth + 1)?,
            false => (String::new(), Value::Other),
        });
    }
    Ok(all)
}

fn structures(
    parts: &mut Elements<'_>,
    count: usize,
    depth: usize,
) -> Result<Vec<Vec<(String, Value)>>, Damage> {
    let length = parts.expect("length of names")?.bytes;
    let length = parts.order.u32(length) as usize;
    let names = parts.expect("names of fields")?.bytes;
    let names: Vec<String> = match length {
        0 => Vec::new(),
        _ => names.chunks(length).map(text).collect(),
    };
    if names.is_empty() {
        return Ok(Vec::new());
    }
    let mut all = Vec::new();
    for _ in 0..count {
        let values = nested(parts, names.len(), depth)?.into_iter();
        let fields = names.iter().cloned().zip(values.map(|(_, value)| value));
        all.push(fields.collect());
    }
    Ok(all)
}

/// Text up to its first NUL.
fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0);
    String::from_utf8_lossy(&bytes[..end.unwrap_or(bytes.len())]).into_owned()
}

/// The rows of a character array.
fn characters(element: &Element<'_>, order: Order, dims: &[usize]) -> Vec<String> {
    let letters: Vec<char> = match element.kind {
        // uint16 and UTF-16.
        4 | 17 => {
            let units = element.bytes.chunks_exact(2);
            let units = units.map(|own| u16::from_le_bytes(order.bytes(own)));
            char::decode_utf16(units)
                .map(|c| c.unwrap_or('\u{fffd}'))
                .collect()
        }
        _ => String::from_utf8_lossy(element.bytes).chars().collect(),
    };
    rows_of(&letters, dims)
}

/// The rows of letters that are stored column by column.
pub(super) fn rows_of(letters: &[char], dims: &[usize]) -> Vec<String> {
    let rows = dims.first().copied().unwrap_or(0).min(letters.len());
    let row = |row: usize| {
        let own: String = letters.iter().skip(row).step_by(rows).collect();
        own.trim_end_matches(['\0', ' ']).to_owned()
    };
    (0..rows).map(row).collect()
}

/// Numbers, which may be stored in a smaller type than their class.
fn numbers(element: &Element<'_>, order: Order) -> Result<Vec<f64>, Damage> {
    fn all<const N: usize>(bytes: &[u8], order: Order, of: impl Fn([u8; N]) -> f64) -> Vec<f64> {
        let chunks = bytes.chunks_exact(N);
        chunks.map(|own| of(order.bytes(own))).collect()
    }
    let bytes = element.bytes;
    Ok(match element.kind {
        1 => all(bytes, order, |b| f64::from(i8::from_le_bytes(b))),
        2 => all(bytes, order, |b| f64::from(u8::from_le_bytes(b))),
        3 => all(bytes, order, |b| f64::from(i16::from_le_bytes(b))),
        4 => all(bytes, order, |b| f64::from(u16::from_le_bytes(b))),
        5 => all(bytes, order, |b| f64::from(i32::from_le_bytes(b))),
        6 => all(bytes, order, |b| f64::from(u32::from_le_bytes(b))),
        7 => all(bytes, order, |b| f64::from(f32::from_le_bytes(b))),
        9 => all(bytes, order, f64::from_le_bytes),
        12 => all(bytes, order, |b| i64::from_le_bytes(b) as f64),
        13 => all(bytes, order, |b| u64::from_le_bytes(b) as f64),
        kind => return Err(damaged(&format!("numbers of type {kind}"))),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn element(kind: u32, data: &[u8]) -> Vec<u8> {
        let mut own = [kind.to_be_bytes(), (data.len() as u32).to_be_bytes()].concat();
        own.extend(data);
        own.resize(own.len().next_multiple_of(8), 0);
        own
    }

    fn words(words: &[u32]) -> Vec<u8> {
        words.iter().flat_map(|word| word.to_be_bytes()).collect()
    }

    #[test]
    fn big_endian_bytes_and_numbers_stored_small_are_read() {
        let matrix = |count: u32| {
            let parts = [
                element(6, &words(&[6, 0])),
                element(5, &words(&[1, count])),
                // A small element: the length stands in the upper half of the first word.
                words(&[0x0001_0001, 0x7800_0000]),
                element(4, &[0, 7, 1, 0, 255, 255]),
            ];
            let mut file = vec![b' '; 124];
            file.extend(b"\x01\x00MI");
            file.extend(element(14, &parts.concat()));
            file
        };
        let value = Value::Numbers {
            dims: vec![1, 3],
            values: vec![7.0, 256.0, 65_535.0],
        };
        assert_eq!(variables(&matrix(3)), Ok(vec![("x".to_owned(), value)]));
        assert_eq!(
            variables(&matrix(4)).unwrap_err(),
            "the file is damaged: `x` has 3 values for 4 places"
        );
    }

    #[test]
    fn an_object_has_a_name_and_a_class_and_what_it_holds_is_no_variable() {
        let object = [
            element(6, &words(&[17, 0])),
            element(1, b"out"),
            element(1, b"MCOS"),
            element(1, b"timeseries"),
        ];
        let held = [
            element(6, &words(&[9, 0])),
            element(5, &words(&[1, 300])),
            element(1, b""),
            element(2, &[7; 300]),
        ];
        let mut file = vec![b' '; 124];
        file.extend(b"\x01\x00MI");
        file.extend(element(14, &object.concat()));
        file.extend(element(14, &held.concat()));
        let class = Value::Object("timeseries".to_owned());
        assert_eq!(variables(&file), Ok(vec![("out".to_owned(), class)]));
        assert_eq!(
            super::super::read(&file)
                .err()
                .map(|e| e.message().to_owned()),
            Some(
                "no vector of real numbers among the variables `out` (an object: timeseries); each column must be one vector, on its own or as a field of a structure; only MATLAB can read its objects (tables, time series, Simulink outputs); extract the vectors, as in `t = out.tout; save('r.mat', 't', …)`"
                    .to_owned()
            )
        );
    }
}
