//! The variables of a MAT-file of version 7.3, which is an HDF5 file after a MATLAB header.
//!
//! A numeric array is a data set whose dimensions are in reverse order. Its values are therefore in
//! MATLAB's order, column by column. A structure is a group. An array of structures is a group
//! whose fields are lists of references. A cell array is also a list of references. The referenced
//! values are in the group `#refs#`. The attribute `MATLAB_class` states the class.
//!
//! Source: MathWorks, *MAT-File Versions*, "Version 7.3", and the documentation of `hdf5storage`
//! on MATLAB's attributes. The bytes are read by the crate `hdf5-reader`.

use super::elements::rows_of;
use crate::limits::{BYTES, DEPTH, PIECES};
use crate::vectors::Value;
use hdf5_reader::error::Error;
use hdf5_reader::group::Group;
use hdf5_reader::reference::read_object_references;
use hdf5_reader::{Dataset, Datatype, Hdf5File, OpenOptions};
use std::collections::HashMap;

/// Maximum size to which one byte of the file is unpacked \[bytes\], which is the maximum ratio of
/// deflate. A file that states larger arrays cannot contain their data.
const PACKED: usize = 1032;
/// MATLAB's internal groups, which contain the targets of references and objects.
const REFERRED: &str = "#refs#";

/// The targets of references.
enum Object {
    Group(Group),
    Data(Box<Dataset>),
}

struct File {
    /// The targets by address; empty for a file without references.
    referred: HashMap<u64, Object>,
    offset_size: u8,
    /// Number of bytes and objects that may still be read.
    room: usize,
    packed: usize,
    left: usize,
}

/// The variables of a file, in its order: data, then structures.
pub(super) fn variables(bytes: &[u8]) -> Result<Vec<(String, Value)>, String> {
    let told = |e: Error| {
        let what = e.to_string().replace(char::is_control, " ");
        format!("the file is damaged or has unsupported content: {what}; save it in MATLAB with `save -v7`")
    };
    let options = OpenOptions::default()
        .with_max_read_bytes(BYTES as usize)
        // One piece of a compressed array, besides the array itself.
        .with_max_chunk_bytes(BYTES as usize / 8);
    let file = Hdf5File::from_bytes_with_options(bytes, options).map_err(told)?;
    let root = file.root_group().map_err(told)?;
    let mut own = File {
        referred: HashMap::new(),
        offset_size: file.superblock().offset_size,
        room: BYTES as usize,
        packed: bytes.len().saturating_mul(PACKED),
        left: PIECES,
    };
    let (groups, data) = root.members().map_err(told)?;
    if let Some(group) = groups.iter().find(|group| group.name() == REFERRED) {
        let (groups, data) = group.members().map_err(told)?;
        let groups = groups.into_iter().map(|g| (g.address(), Object::Group(g)));
        let data = data
            .into_iter()
            .map(|d| (d.address(), Object::Data(Box::new(d))));
        own.referred = groups.chain(data).collect();
    }
    let groups = groups.into_iter().filter(|g| !g.name().starts_with('#'));
    own.members(groups.collect(), data, 0).map_err(told)
}

impl File {
    fn members(
        &mut self,
        groups: Vec<Group>,
        data: Vec<Dataset>,
        depth: usize,
    ) -> Result<Vec<(String, Value)>, Error> {
        let mut all = Vec::new();
        for own in &data {
            all.push((own.name().to_owned(), self.value(own, depth)?));
        }
        for own in &groups {
            all.push((own.name().to_owned(), self.structure(own, depth)?));
        }
        Ok(all)
    }

    /// Counts an object; an error if there are too many.
    fn counted(&mut self) -> Result<(), Error> {
        let left = self.left.checked_sub(1);
        let many =
            || Error::ResourceLimit(format!("more than {PIECES} variables, fields and cells"));
        self.left = left.ok_or_else(many)?;
        Ok(())
    }

    /// A group as a structure, or as an array of structures.
    fn structure(&mut self, group: &Group, depth: usize) -> Result<Value, Error> {
        self.counted()?;
        let class = group.attribute("MATLAB_class").ok();
        let class = class.and_then(|own| own.read_string().ok());
        // A sparse matrix is a group as well; objects and functions are of other classes.
        let is_sparse = group.attribute("MATLAB_sparse").is_ok();
        if depth >= DEPTH || is_sparse {
            return Ok(Value::Other);
        }
        if let Some(class) = class.filter(|class| class != "struct") {
            return Ok(of_class(class));
        }
        let (groups, data) = group.members()?;
        let is_list = |d: &Dataset| is_reference(d) && class_of(d).is_empty();
        if groups.is_empty() && !data.is_empty() && data.iter().all(is_list) {
            return self.structures(&data, depth);
        }
        let fields = self.members(groups, data, depth + 1)?;
        Ok(Value::Structures(vec![fields]))
    }

    /// An array of structures: each field is a list of references.
    fn structures(&mut self, fields: &[Dataset], depth: usize) -> Result<Value, Error> {
        let mut all: Vec<Vec<(String, Value)>> = Vec::new();
        for field in fields {
            for (index, value) in self.cells(field, depth)?.into_iter().enumerate() {
                if all.len() == index {
                    all.push(Vec::new());
                }
                all[index].push((field.name().to_owned(), value));
            }
        }
        Ok(Value::Structures(all))
    }

    /// The targets of a list of references.
    fn cells(&mut self, list: &Dataset, depth: usize) -> Result<Vec<Value>, Error> {
        self.take(list)?;
        let raw = list.read_raw_bytes()?;
        let mut all = Vec::new();
        for address in read_object_references(&raw, self.offset_size)? {
            self.counted()?;
            // Taken out while it is read: what refers to itself ends here.
            all.push(match self.referred.remove(&address) {
                Some(object) if depth < DEPTH => {
                    let value = match &object {
                        Object::Group(group) => self.structure(group, depth + 1)?,
                        Object::Data(data) => self.value(data, depth + 1)?,
                    };
                    self.referred.insert(address, object);
                    value
                }
                _ => Value::Other,
            });
        }
        Ok(all)
    }

    /// Reserves the memory for a data set.
    fn take(&mut self, data: &Dataset) -> Result<(), Error> {
        let count = usize::try_from(data.num_elements()?).unwrap_or(usize::MAX);
        let stored = count.saturating_mul(data.raw_element_size()?);
        let held = count.saturating_mul(size_of::<f64>());
        let large = || Error::ResourceLimit(format!("more than {} MiB unpacked", BYTES >> 20));
        self.room = self.room.checked_sub(held.max(stored)).ok_or_else(large)?;
        let empty = || Error::InvalidData("an array larger than the file".to_owned());
        self.packed = self.packed.checked_sub(stored).ok_or_else(empty)?;
        Ok(())
    }

    fn value(&mut self, data: &Dataset, depth: usize) -> Result<Value, Error> {
        self.counted()?;
        let class = class_of(data);
        if data.attribute("MATLAB_empty").is_ok() {
            return Ok(Value::Other);
        }
        if class == "cell" && is_reference(data) {
            return Ok(Value::Cells(self.cells(data, depth)?));
        }
        let is_number = matches!(
            class.as_str(),
            "" | "double" | "single" | "logical" | "char"
        ) || class.starts_with("int")
            || class.starts_with("uint");
        if !is_number {
            return Ok(of_class(class));
        }
        let dims = data.shape().iter().rev();
        let dims: Vec<usize> = dims
            .map(|own| usize::try_from(*own).unwrap_or(usize::MAX))
            .collect();
        self.take(data)?;
        let Some(values) = numbers(data)? else {
            return Ok(Value::Other);
        };
        Ok(match class.as_str() {
            "char" => {
                let units = values.iter().map(|unit| *unit as u16);
                let letters = char::decode_utf16(units).map(|c| c.unwrap_or('\u{fffd}'));
                Value::Text(rows_of(&letters.collect::<Vec<char>>(), &dims))
            }
            _ => Value::Numbers { dims, values },
        })
    }
}

fn class_of(data: &Dataset) -> String {
    let class = data.attribute("MATLAB_class").ok();
    class
        .and_then(|own| own.read_string().ok())
        .unwrap_or_default()
}

/// A value that is neither an array nor a structure. It is an object, unless it is a function.
fn of_class(class: String) -> Value {
    match class.as_str() {
        "function_handle" | "cell" | "struct" => Value::Other,
        _ => Value::Object(class),
    }
}

fn is_reference(data: &Dataset) -> bool {
    matches!(data.dtype(), Datatype::Reference { .. })
}

/// The values of a numeric data set; `None` for complex numbers and other data.
fn numbers(data: &Dataset) -> Result<Option<Vec<f64>>, Error> {
    macro_rules! of {
        ($number:ty, $to:expr) => {
            data.read_array::<$number>()?
                .iter()
                .map(|own| $to(*own))
                .collect()
        };
    }
    let values: Vec<f64> = match *data.dtype() {
        Datatype::FloatingPoint { size: 8, .. } => of!(f64, f64::from),
        Datatype::FloatingPoint { size: 4, .. } => of!(f32, f64::from),
        Datatype::FixedPoint { size, signed, .. } => match (size, signed) {
            (1, true) => of!(i8, f64::from),
            (1, false) => of!(u8, f64::from),
            (2, true) => of!(i16, f64::from),
            (2, false) => of!(u16, f64::from),
            (4, true) => of!(i32, f64::from),
            (4, false) => of!(u32, f64::from),
            (8, true) => of!(i64, |n: i64| n as f64),
            (8, false) => of!(u64, |n: u64| n as f64),
            _ => return Ok(None),
        },
        _ => return Ok(None),
    };
    Ok(Some(values))
}
