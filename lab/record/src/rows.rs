//! The rows below the header.

use super::error::{Bad, RecordError};
use super::header::Header;
use super::kept::Kept;
use super::layout::passed_over;
use super::roles::Roles;
use super::scale::counted;
use super::source::{Row, Source};
use super::sparse::{self, Lacking};
use super::time::{Clock, Stamp};
use super::{Options, MIN_SAMPLES};

/// The numbers that were kept, and their positions.
pub(super) struct Table {
    /// Time \[s\] since the first sample that was kept.
    pub(super) time: Vec<f64>,
    /// One column per role, in the order of [`Roles::series`], then those of [`Roles::parts`].
    pub(super) values: Vec<Vec<f64>>,
    /// Line of each sample.
    pub(super) lines: Vec<usize>,
    /// Number of rows that were omitted because of their contents.
    pub(super) dropped: usize,
    pub(super) notes: Vec<String>,
}

/// Number of rows that `--drop-bad` has omitted, by reason.
#[derive(Default)]
struct Dropped {
    empty: usize,
    not_numbers: usize,
    repeated: usize,
}

impl Dropped {
    fn count(&mut self, bad: Bad) {
        match bad {
            Bad::Empty => self.empty += 1,
            Bad::NotANumber => self.not_numbers += 1,
            Bad::Repeated => self.repeated += 1,
        }
    }

    fn all(&self) -> usize {
        self.empty + self.not_numbers + self.repeated
    }

    /// "3 rows left out (2 with an empty cell, 1 with NaN)".
    fn note(&self) -> Option<String> {
        let kinds = [
            (self.empty, "with an empty cell"),
            (self.not_numbers, "with NaN"),
            (self.repeated, "with a repeated time stamp"),
        ];
        let some = kinds.iter().filter(|(count, _)| *count > 0);
        let list: Vec<String> = some
            .map(|(count, what)| format!("{count} {what}"))
            .collect();
        let rows = if self.all() == 1 { "row" } else { "rows" };
        (self.all() > 0).then(|| {
            format!(
                "--drop-bad dropped {} {rows}: {}",
                self.all(),
                list.join(", ")
            )
        })
    }
}

/// The contents of one row.
enum Sample {
    At(f64),
    Cut,
    Bad(Bad),
}

/// The cells of a row that are read. For each series, these are the column and the column that is
/// added to it.
struct Reader<'a> {
    header: &'a Header,
    series: Vec<(usize, Option<(usize, f64)>)>,
    drop_bad: bool,
    /// Whether the rows have time stamps. Input and output may have separate time stamps.
    has_stamps: bool,
    /// One more than the last column that is read.
    width: usize,
    /// Number of cells in the first row, if this row is shorter than the header and only columns
    /// that are not read are missing.
    short: Option<usize>,
    /// Rows kept so far.
    kept: usize,
    lacking: Lacking,
    /// The error for the first time stamp that decreases. Such time stamps are allowed if input and
    /// output have separate time stamps.
    backwards: Option<RecordError>,
    /// Number of rows that span several lines.
    carried: usize,
    /// Lines of comments among the rows.
    comments: Vec<usize>,
    /// Cells of the row that was read last.
    cells: usize,
}

impl<'a> Reader<'a> {
    fn new(header: &'a Header, roles: &Roles, options: &Options) -> Result<Self, RecordError> {
        let series = roles
            .series()
            .chain(roles.parts())
            .map(|series| Ok((series.first(), series.second(header)?)))
            .collect::<Result<Vec<_>, RecordError>>()?;
        Ok(Self {
            header,
            series,
            drop_bad: options.drop_bad,
            has_stamps: roles.time.is_some(),
            width: roles.read().chain(roles.time).max().map_or(0, |k| k + 1),
            short: None,
            kept: 0,
            lacking: Lacking::default(),
            backwards: None,
            carried: 0,
            comments: Vec::new(),
            cells: 0,
        })
    }

    /// Notes on the lines and cells of the rows.
    fn said(&self) -> impl Iterator<Item = String> {
        let several = match self.carried {
            0 => None,
            1 => Some("1 row spans several lines within quotes".to_owned()),
            rows => Some(format!("{rows} rows span several lines within quotes")),
        };
        let comments = self
            .comments
            .first()
            .map(|first| match self.comments.len() {
                1 => format!("line {first} ignored because it is a comment"),
                count => format!("{count} comment lines ignored, the first one in line {first}"),
            });
        let columns = &self.header.columns;
        let has_name = |cells: &usize| columns[*cells..].iter().any(|c| !c.name.is_empty());
        let short = self.short.filter(has_name).map(|cells| {
            format!(
                "each row has only {}, but the header has {}; the columns without cells are not read",
                counted(cells, "cell"),
                columns.len()
            )
        });
        several.into_iter().chain(comments).chain(short)
    }

    /// Returns the time of a row, and writes its values to `into`.
    fn read(
        &mut self,
        row: &Row<'_>,
        clock: &mut Clock,
        into: &mut Vec<f64>,
    ) -> Result<Sample, RecordError> {
        self.cells = row.len();
        self.fits(row)?;
        match self.numbers(row, clock, into) {
            Err(error) => match error.bad().filter(|_| self.drop_bad) {
                Some(bad) => Ok(Sample::Bad(bad)),
                None => Err(error),
            },
            sample => sample,
        }
    }

    fn numbers(
        &mut self,
        row: &Row<'_>,
        clock: &mut Clock,
        into: &mut Vec<f64>,
    ) -> Result<Sample, RecordError> {
        let t = match clock.stamp(row)? {
            Stamp::Kept(t) => t,
            Stamp::Cut => return Ok(Sample::Cut),
            Stamp::Repeats(t) => {
                self.lacking.repeats.push(self.kept);
                t
            }
            Stamp::Backwards(t, error) => {
                let mut ends = self.series.iter().take(2);
                let name = |index: usize| &self.header.columns[index].name;
                if ends.all(|(index, _)| row.number(*index, name(*index)).is_ok()) {
                    return Err(error);
                }
                self.backwards.get_or_insert(error);
                if !clock.is_kept(t) {
                    return Ok(Sample::Cut);
                }
                t
            }
        };
        into.clear();
        let number = |index: usize| row.number(index, &self.header.columns[index].name);
        for (k, (column, added)) in self.series.iter().enumerate() {
            let value = match added {
                None => number(*column),
                Some((second, factor)) => {
                    number(*column).and_then(|value| Ok(value + factor * number(*second)?))
                }
            };
            // A channel may lack; of input and output all rows tell whether they may.
            let waits = k >= 2 || self.has_stamps && !row.may_be_cut();
            let bad = value.as_ref().err().and_then(RecordError::bad);
            match (value, bad) {
                (Ok(value), _) => into.push(value),
                (Err(error), Some(bad)) if waits => {
                    self.lacking.add(self.kept, k, bad, error);
                    into.push(f64::NAN);
                }
                (Err(error), _) => return Err(error),
            }
        }
        self.kept += 1;
        Ok(Sample::At(t))
    }

    /// Whether an error is due to an incomplete row: missing cells, or an incomplete last cell.
    fn lacks_its_end(&self, error: &RecordError) -> bool {
        let columns = &self.header.columns;
        let last = self.cells.checked_sub(1).and_then(|last| columns.get(last));
        self.cells < columns.len()
            || last.is_some_and(|last| error.column() == Some(last.name.as_str()))
    }

    /// A note on the lines after an error, if they are not rows. Otherwise the result is the first
    /// error.
    fn below(
        &self,
        error: RecordError,
        rows: &Source<'_>,
        clock: &Clock,
        used: &[usize],
    ) -> Result<String, RecordError> {
        let first = rows.line();
        let text = rows.text_below(used).filter(|_| clock.rows() > 0);
        if let Some(text) = text {
            return Ok(passed_over(first, first + text - 1, "below the table"));
        }
        if rows.may_be_cut() && self.lacks_its_end(&error) {
            return Ok(format!(
                "the last line, {first}, is truncated and was dropped"
            ));
        }
        // Thousands in the stamps let time run backwards.
        rows.check(self.header)?;
        let before = self.lacking.fault(self.kept);
        Err(before.filter(|_| !self.drop_bad).unwrap_or(error))
    }

    /// Checks the number of cells. Missing cells are allowed only in columns without a name, or if
    /// the first row also lacks them. Extra cells must be empty.
    fn fits(&mut self, row: &Row<'_>) -> Result<(), RecordError> {
        let Row::Text(row) = row else {
            return Ok(());
        };
        let columns = &self.header.columns;
        self.carried += usize::from(row.last > row.line);
        // What every row lacks is no cell that was lost.
        let is_first = self.kept == 0 && self.short.is_none();
        if is_first && (self.width..columns.len()).contains(&row.len()) {
            self.short = Some(row.len());
        }
        if row.len() == columns.len()
            || self.short == Some(row.len())
            || (columns.iter().skip(row.len()).all(|c| c.name.is_empty())
                && row.cells().skip(columns.len()).all(str::is_empty))
        {
            return Ok(());
        }
        let mut message = format!(
            "the row has {}, but the header has {}",
            counted(row.len(), "cell"),
            columns.len()
        );
        if row.last > row.line {
            message += &format!("; a quote extends the row to line {}", row.last);
        }
        Err(RecordError::at(row.line, message))
    }
}

/// Reads the rows. Values in rows that are cut are ignored.
pub(super) fn read(
    rows: &mut Source<'_>,
    header: &Header,
    roles: &Roles,
    options: &Options,
) -> Result<Table, RecordError> {
    let mut clock = Clock::new(header, roles.time, options)?;
    let mut reader = Reader::new(header, roles, options)?;
    let mut kept = Kept::new(reader.series.len());
    let (mut dropped, mut below) = (Dropped::default(), None);
    let mut sample = Vec::new();
    let used: Vec<usize> = roles.time.into_iter().chain(roles.read()).collect();
    loop {
        let read = match rows.read() {
            Ok(None) => break,
            Ok(Some(row)) if row.is_comment(&used) => {
                reader.comments.push(row.line());
                continue;
            }
            Ok(Some(row)) => reader.read(&row, &mut clock, &mut sample),
            Err(error) => Err(error),
        };
        match read {
            Ok(Sample::Cut) => {}
            Ok(Sample::Bad(bad)) => dropped.count(bad),
            Ok(Sample::At(t)) => kept.push(t, rows.line(), &sample),
            Err(error) => {
                below = Some(reader.below(error, rows, &clock, &used)?);
                break;
            }
        }
    }
    rows.check(header)?;
    let has_own_stamps = kept.has_own_stamps();
    let all = kept.time.len();
    let lacking = reader
        .lacking
        .mended(all, has_own_stamps, options.drop_bad)?;
    let is_apart = lacking.is_apart && has_own_stamps;
    if let Some(error) = reader.backwards.take() {
        if !is_apart {
            return Err(error);
        }
        kept.sort();
    }
    clock.finish(header, is_apart)?;
    lacking.out.iter().for_each(|(_, bad)| dropped.count(*bad));
    kept.leave_out(lacking.out.iter().map(|(row, _)| *row));
    let readings = [0, 1].map(|end| kept.readings(end));
    let mut filled = sparse::fill(
        &lacking.filled,
        &mut kept.values,
        &kept.time,
        header,
        roles,
        options,
    )?;
    if lacking.is_apart {
        filled.push(kept.on_one_grid(&readings, header, roles));
    }
    let Kept {
        mut time,
        values,
        lines,
    } = kept;
    let why = why_left(dropped.all(), lacking.is_apart);
    long_enough(time.len(), &clock, why, rows.line())?;
    clock.check_unit(header, &time)?;
    let mut notes: Vec<String> = rows.note().into_iter().collect();
    notes.extend(clock.notes(&time));
    let start = time.first().copied().unwrap_or_default();
    time.iter_mut().for_each(|t| *t -= start);
    notes.extend(unit_of_time(header, roles));
    notes.extend(reader.said());
    notes.extend(below);
    notes.extend(dropped.note());
    notes.extend(filled);
    Ok(Table {
        time,
        values,
        lines,
        dropped: dropped.all(),
        notes,
    })
}

/// The original unit of the time, if it was converted.
fn unit_of_time(header: &Header, roles: &Roles) -> Option<String> {
    let unit = header.columns[roles.time?].unit.as_deref()?;
    (!unit.contains(':') && unit != "s").then(|| format!("time converted from {unit} to s"))
}

/// A possible reason why so few rows are left.
fn why_left(dropped: usize, is_apart: bool) -> &'static str {
    match (dropped, is_apart) {
        (0, true) => "at the stamps of the column with the fewest numbers",
        (0, false) => "after cutting",
        _ => "after cutting and --drop-bad",
    }
}

fn long_enough(left: usize, clock: &Clock, why: &str, line: usize) -> Result<(), RecordError> {
    if left >= MIN_SAMPLES {
        return Ok(());
    }
    let all = clock.rows();
    let samples = if left == 1 { "sample" } else { "samples" };
    let cut = match left < all {
        true => format!(" of {all} remain {why}"),
        false => String::new(),
    };
    // An option in the file's own stamps, which may be seconds since 1970.
    let counts = match all > 0 && clock.cut() == all {
        true => format!(
            "; --start and --end are in seconds after the first time stamp, and the last time stamp is at {:.3} s",
            clock.last()
        ),
        false => String::new(),
    };
    let message = format!(
        "the record is too short: {left} {samples}{cut}; the minimum is {MIN_SAMPLES}{counts}"
    );
    Err(RecordError::at(line, message))
}
