//! Reads a measured record (CSV, JSON, `.xlsx`, `.mat`, Parquet, `.npz` or `.npy`) into checked
//! columns.
//!
//! A record consists of a time axis, the input and the output of the transmission, and optional
//! channels. Nothing is repaired silently. [`Record::notes`] lists every change by the reader, such
//! as a converted unit or an ignored column. An unreadable record is rejected with one message that
//! names file, line and column.
//!
//! ```
//! use bowden_record::{parse, Options};
//!
//! let mut csv = String::from("t [s],tau_i [N·m],tau_o [N·m]\n");
//! for i in 0..400 {
//!     let t = f64::from(i) * 1e-3;
//!     let torque = 16.0 * (20.0 * t).sin();
//!     csv += &format!("{t},{torque},{}\n", 0.95 * torque);
//! }
//! let record = parse(csv.as_bytes(), "bench.csv", &Options::default())?;
//! assert_eq!(record.output.unit.as_deref(), Some("N·m"));
//!
//! let error = parse(b"t,tau_i\n", "bench.csv", &Options::default()).unwrap_err();
//! assert!(error.to_string().starts_with("bench.csv:1: column `tau_o`: "));
//! # Ok::<(), bowden_record::RecordError>(())
//! ```

mod agree;
mod angles;
mod blanks;
mod checks;
mod clock_time;
mod defects;
mod encoding;
mod error;
mod file;
mod gzip;
mod header;
mod held;
mod json;
mod kept;
mod kind;
mod layout;
mod limits;
#[cfg(feature = "mat")]
mod mat;
mod npz;
mod number;
mod outline;
#[cfg(feature = "parquet")]
mod parquet_file;
mod roles;
mod rows;
mod scale;
mod segments;
mod series;
mod sheet;
mod sizes;
mod source;
mod sparse;
mod text;
mod thousands;
mod time;
mod units;
mod vectors;
#[cfg(feature = "xlsx")]
mod workbook;
mod wrapping;
mod zip;

pub use agree::{agree, is_same_unit, to_unit};
pub use defects::{bridged, Defect, DefectKind, Steps};
pub use error::RecordError;
pub use header::nearest;
pub use outline::{excerpt, outline, Line, Outline, Outlined};
pub use roles::Part;
pub use units::is_velocity;

use encoding::Decoded;
use header::Header;
use kind::Kind;
use roles::Roles;
use series::Series;
use source::Source;
use std::borrow::Cow;
use std::path::Path;

/// The input of the transmission, and the output measured at its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// The input is the proximal torque, and the output is the distal torque: (5) to (7) of the
    /// paper.
    Torque,
    /// The input is a displacement, and the output is a force: (1) and (2) of the paper.
    Displacement,
}

impl Mode {
    /// Its name in files and reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Torque => "torque",
            Self::Displacement => "displacement",
        }
    }
}

/// Minimum number of samples of a record after cutting.
pub const MIN_SAMPLES: usize = 200;

/// How to read a record: the mode, the names of the columns, the cuts.
///
/// The default options read the default names, derive the mode from the columns, and cut nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// The mode; `None` derives it from the columns.
    pub mode: Option<Mode>,
    /// Column of the time; default: `t`.
    pub time: Option<String>,
    /// Column of the input; default: `tau_i` or `x`.
    pub input: Option<String>,
    /// Column of the output; default: `tau_o` or `f`.
    pub output: Option<String>,
    /// Further channels in addition to the default ones, as (name of the channel, column). `A-B`
    /// and `A+B` are the difference and the sum of two columns.
    pub channels: Vec<(String, String)>,
    /// Start \[s\], counted from the first time stamp.
    pub skip: f64,
    /// End \[s\], counted from the first time stamp.
    pub until: Option<f64>,
    /// Sampling rate \[Hz\]; the time column is then not read.
    pub rate: Option<f64>,
    /// Line of the column names, from 1; default: detected.
    pub header_line: Option<usize>,
    /// Segment to read, from 1, of a text in which the column names are repeated. `None` reads all
    /// segments as one record.
    pub segment: Option<usize>,
    /// Column names of a text without names, each with its unit if it has one (`x [mm]`). A column
    /// with an empty name is not read. The list is empty if the text has its own names.
    pub names: Vec<String>,
    /// Sheet of an Excel workbook; default: the first sheet with a table.
    pub sheet: Option<String>,
    /// Omit rows with an empty cell, a NaN or the time stamp of the previous row, instead of
    /// rejecting the record.
    pub drop_bad: bool,
}

/// One measured quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The name of the channel (`phi_d`). For input and output, the name in the file.
    pub name: String,
    /// The unit in the header, if it states one; `rad` if an angle was converted.
    pub unit: Option<String>,
    /// One finite value per sample.
    pub values: Vec<f64>,
    /// The definition from columns, such as `phi_p + phi_d`, if the quantity is not a column
    /// itself.
    pub definition: Option<String>,
}

/// A checked record: at least [`MIN_SAMPLES`] samples, every value finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The path or label of the record, as in messages.
    pub path: String,
    /// The mode.
    pub mode: Mode,
    /// Time \[s\], strictly increasing, 0 at the first sample that was kept.
    pub time: Vec<f64>,
    /// The transmission's input: torque or displacement.
    pub input: Column,
    /// The transmission's output: torque or force.
    pub output: Column,
    /// The other measured channels that are used.
    pub channels: Vec<Column>,
    /// Notes of the reader.
    pub notes: Vec<String>,
    /// Defects of the measurement.
    pub defects: Vec<Defect>,
    /// Rows that were omitted on request ([`Options::drop_bad`]).
    pub dropped: usize,
    /// Columns that the logger sampled and held. A curve replaces their steps and removes their
    /// noise.
    pub held: Vec<String>,
}

impl Record {
    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.time.len()
    }

    /// The channel with this name.
    pub fn channel(&self, name: &str) -> Option<&Column> {
        self.channels.iter().find(|column| column.name == name)
    }

    /// Median time between two samples \[s\].
    pub fn step(&self) -> f64 {
        time::median_step(&self.time)
    }
}

/// Reads a record from a file.
///
/// # Errors
/// A message with file, line and column (see [`RecordError`]).
pub fn read(path: &Path, options: &Options) -> Result<Record, RecordError> {
    let label = path.display().to_string();
    parse(&load(path)?, &label, options)
}

/// The bytes of a file, for [`parse`]. If the format is not supported, only the first bytes are
/// read.
///
/// # Errors
/// A message with the file: see [`RecordError`].
pub fn load(path: &Path) -> Result<Vec<u8>, RecordError> {
    file::load(path, &path.display().to_string())
}

/// Reads a record from bytes in memory. `label` replaces the name of the file.
///
/// # Errors
/// A message with file, line and column (see [`RecordError`]).
pub fn parse(bytes: &[u8], label: &str, options: &Options) -> Result<Record, RecordError> {
    parse_lines(bytes, options)
        .map_err(|error| error.in_file(label))
        .map(|mut record| {
            record.path = label.to_owned();
            record
        })
}

/// Reads a record from columns in memory, like a file that contains columns of numbers. `label`
/// replaces the name of the file.
///
/// The name of a column may contain its unit, as in the header of a text (`tau_i [N·m]`).
///
/// # Errors
/// A message with label, row (from 1) and column: see [`RecordError`].
///
/// ```
/// use bowden_record::{of_columns, parse, Column, Options};
///
/// let torque = |i: u32| 16.0 * (0.02 * f64::from(i)).sin();
/// let column = |name: &str, of: &dyn Fn(u32) -> f64| Column {
///     name: name.to_owned(),
///     unit: None,
///     values: (0..400).map(of).collect(),
///     definition: None,
/// };
/// let mut columns = vec![
///     column("t", &|i| f64::from(i) * 1e-3),
///     column("tau_i [N·m]", &torque),
///     column("tau_o", &|i| 0.95 * torque(i)),
/// ];
/// let record = of_columns(columns.clone(), "arrays", &Options::default())?;
/// assert_eq!(record.input.unit.as_deref(), Some("N·m"));
///
/// let mut csv = String::from("t,tau_i [N·m],tau_o\n");
/// for i in 0..400 {
///     csv += &format!("{},{},{}\n", f64::from(i) * 1e-3, torque(i), 0.95 * torque(i));
/// }
/// assert_eq!(parse(csv.as_bytes(), "arrays", &Options::default())?, record);
///
/// columns[2].values[6] = f64::NAN;
/// let error = of_columns(columns, "arrays", &Options::default()).unwrap_err();
/// assert_eq!((error.file(), error.line(), error.column()), ("arrays", Some(7), Some("tau_o")));
/// # Ok::<(), bowden_record::RecordError>(())
/// ```
pub fn of_columns(
    columns: Vec<Column>,
    label: &str,
    options: &Options,
) -> Result<Record, RecordError> {
    checks::options(options)
        .and_then(|()| sheet::record(sheet::of_columns(columns)?, options))
        .map_err(|error| error.in_file(label))
        .map(|mut record| {
            record.path = label.to_owned();
            record
        })
}

fn parse_lines(bytes: &[u8], options: &Options) -> Result<Record, RecordError> {
    checks::options(options)?;
    match kind::of(bytes)? {
        Kind::Gzip => {
            let unpacked = gzip::unpack(bytes)?;
            let mut record = unpacked_as(kind::of(&unpacked)?, &unpacked, options)?;
            record.notes.insert(0, "gzip file unpacked".to_owned());
            Ok(record)
        }
        kind => unpacked_as(kind, bytes, options),
    }
}

fn unpacked_as(kind: Kind, bytes: &[u8], options: &Options) -> Result<Record, RecordError> {
    if let Some(sheet) = options.sheet.as_ref().filter(|_| kind != Kind::Xlsx) {
        let sheet = error::shown(sheet, error::NAME_LENGTH);
        let message = format!("--sheet {sheet}: the file is not an Excel workbook");
        return Err(RecordError::new(message));
    }
    match kind {
        Kind::Text => text_record(bytes, options),
        #[cfg(feature = "xlsx")]
        Kind::Xlsx => {
            let sheet = workbook::read(bytes, options)?;
            let mut record = table_record(sheet.text(), options)?;
            record.notes.splice(0..0, sheet.note);
            Ok(record)
        }
        _ => sheet::record(sheet::of(kind, bytes, options)?, options),
    }
}

fn text_record(bytes: &[u8], options: &Options) -> Result<Record, RecordError> {
    let decoded = encoding::decode(bytes)?;
    if json::is_json(&decoded.text) {
        return sheet::of_json(&decoded.text, options);
    }
    table_record(decoded, options)
}

/// The record of a text that is a table.
fn table_record(decoded: Decoded<'_>, options: &Options) -> Result<Record, RecordError> {
    let text = blanks::as_tabs(&decoded.text);
    let mut table = layout::find(&text, options)?;
    if !decoded.is_ended {
        table.rows = table.rows.cut_off();
    }
    let table = segments::of(table, options)?;
    let mut notes: Vec<String> = decoded.note.into_iter().collect();
    if matches!(text, Cow::Owned(_)) {
        notes.push("columns are separated by spaces".to_owned());
    }
    notes.extend(table.notes);
    let rows = Source::Text(Box::new(table.rows));
    let mut record = record(&table.header, table.roles, rows, options)?;
    notes.append(&mut record.notes);
    record.notes = notes;
    Ok(record)
}

/// The record from its rows.
fn record(
    header: &Header,
    roles: Roles,
    mut rows: Source<'_>,
    options: &Options,
) -> Result<Record, RecordError> {
    let mut table = rows::read(&mut rows, header, &roles, options)?;
    checks::record(&table, header, &roles)?;
    let mut values = std::mem::take(&mut table.values).into_iter();
    let mut column = |name: &str, series: Series| -> Result<Column, RecordError> {
        Ok(Column {
            name: name.to_owned(),
            unit: header.columns[series.first()].unit.clone(),
            values: values.next().unwrap_or_default(),
            definition: series.definition(header, options)?,
        })
    };
    let name = |index: usize| header.columns[index].name.as_str();
    let mut input = column(name(roles.input), Series::Column(roles.input))?;
    let mut output = column(name(roles.output), Series::Column(roles.output))?;
    let mut channels = roles
        .channels
        .iter()
        .map(|(name, series)| column(name, *series))
        .collect::<Result<Vec<Column>, RecordError>>()?;
    // None of these is a sum, so that no parts go with it.
    channels.retain(|channel| !sparse::is_empty(&channel.values));
    let mut mended = unwrapped(&mut input, &output, &mut channels);
    let (held, said) = without_stairs(&table.time, &mut input, &mut output, &mut channels);
    mended.extend(said);
    let parts = roles
        .channels
        .iter()
        .filter(|(name, _)| channels.iter().any(|own| own.name == *name))
        .map(|(_, series)| values.by_ref().take(series.parts().count()).collect())
        .collect();
    let defects = defects::find(&defects::Measured {
        table: &table,
        // Rows that are left out leave a gap in time taken from the row number too.
        clock: roles
            .time
            .map(name)
            .or((table.dropped > 0).then_some("row number")),
        columns: [&input, &output].into_iter().chain(&channels).collect(),
        parts,
    });
    // Last, so that what is said of the file has the file's numbers.
    let angles = angles::in_radians(roles.mode, &mut input, &mut channels);
    let mut notes = roles.notes;
    notes.extend(table.notes);
    notes.extend(mended);
    notes.extend(angles);
    Ok(Record {
        path: String::new(),
        mode: roles.mode,
        time: table.time,
        input,
        output,
        channels,
        notes,
        defects,
        dropped: table.dropped,
        held,
    })
}

/// Removes the jumps from angles that wrap around, and returns notes.
fn unwrapped(input: &mut Column, output: &Column, channels: &mut [Column]) -> Vec<String> {
    let own = wrapping::unwrap(&input.name, &mut input.values, &[&output.values]);
    let others: [&[f64]; 2] = [&input.values, &output.values];
    let channels = channels
        .iter_mut()
        .filter_map(|channel| wrapping::unwrap(&channel.name, &mut channel.values, &others));
    own.into_iter().chain(channels).collect()
}

/// Removes the steps from columns that are sampled and held, and returns their names and notes.
fn without_stairs(
    time: &[f64],
    input: &mut Column,
    output: &mut Column,
    channels: &mut [Column],
) -> (Vec<String>, Vec<String>) {
    let step = time::median_step(time);
    let all = [input, output].into_iter().chain(channels);
    all.filter_map(|column| {
        let said = held::smooth(&column.name, &mut column.values, step)?;
        Some((column.name.clone(), said))
    })
    .unzip()
}
