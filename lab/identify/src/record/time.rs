//! The time axis: strictly increasing seconds, or a row number over a rate.

use super::error::{shown, RecordError, NAME_LENGTH};
use super::header::Header;
use super::text::Row;
use super::{number, units, Options};

/// Turns rows into seconds since the first row, and cuts.
pub(super) struct Clock {
    source: Source,
    skip: f64,
    until: f64,
    rows: usize,
    first: f64,
    last: f64,
    repeated: usize,
    first_repeat: Option<(usize, String)>,
}

/// A median step without a unit from which on milliseconds are suspected \[s\]: two
/// samples a second or fewer say nothing of hysteresis in motion.
const LONG_STEP: f64 = 0.5;

enum Source {
    Column {
        index: usize,
        name: String,
        scale: f64,
        unitless: bool,
    },
    Rate(f64),
}

impl Clock {
    pub(super) fn new(
        header: &Header,
        time: Option<usize>,
        options: &Options,
    ) -> Result<Self, RecordError> {
        let source = match time {
            None => Source::Rate(options.rate.unwrap_or(1.0)),
            Some(index) => {
                let column = &header.columns[index];
                let unit = column.unit.as_deref();
                let scale = units::seconds(unit).ok_or_else(|| {
                    let unit = shown(unit.unwrap_or_default(), NAME_LENGTH);
                    let message = format!(
                        "unit `{unit}` is not a time, one of s, ms, us, ns, min was expected"
                    );
                    RecordError::at(header.line, message).on(&column.name)
                })?;
                Source::Column {
                    index,
                    name: column.name.clone(),
                    scale,
                    unitless: unit.is_none(),
                }
            }
        };
        let until = options.until.unwrap_or(f64::INFINITY);
        Ok(Self {
            source,
            skip: options.skip,
            until,
            rows: 0,
            first: 0.0,
            last: 0.0,
            repeated: 0,
            first_repeat: None,
        })
    }

    /// Time of the next row \[s\] since the first one; `None` where it is cut.
    pub(super) fn stamp(&mut self, row: &Row<'_>) -> Result<Option<f64>, RecordError> {
        let t = match &self.source {
            Source::Rate(rate) => self.rows as f64 / rate,
            Source::Column {
                index, name, scale, ..
            } => {
                let (cell, line) = (row.cell(*index), row.line);
                let stamp = number::read(cell, line, name)? * scale;
                if self.rows == 0 {
                    self.first = stamp;
                }
                let t = stamp - self.first;
                if t < self.last {
                    let message = format!(
                        "time runs backwards, from {} to {stamp} s",
                        self.first + self.last
                    );
                    return Err(RecordError::at(line, message).on(name));
                }
                if self.rows > 0 && t <= self.last {
                    self.repeated += 1;
                    self.first_repeat
                        .get_or_insert_with(|| (line, cell.to_owned()));
                }
                t
            }
        };
        self.rows += 1;
        self.last = t;
        Ok((t >= self.skip && t <= self.until).then_some(t))
    }

    /// Rows seen, those that were cut included.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// Refuses time stamps that repeat, and says what they look like.
    pub(super) fn finish(&self, header: &Header) -> Result<(), RecordError> {
        let (Some((line, cell)), Source::Column { index, .. }) = (&self.first_repeat, &self.source)
        else {
            return Ok(());
        };
        let name = &header.columns[*index].name;
        let cell = shown(cell, 24);
        let message = if self.repeated * 100 >= self.rows && self.last > 0.0 {
            let rate = (self.rows - 1) as f64 / self.last;
            format!(
                "time stands still at {cell}, as at {} of {} rows: the stamps are rounded; \
                 --rate HZ takes time from the row number (about {rate:.1} Hz)",
                self.repeated, self.rows
            )
        } else {
            format!("time stands still at {cell}; --rate HZ takes time from the row number")
        };
        Err(RecordError::at(*line, message).on(name))
    }

    pub(super) fn notes(&self, kept: &[f64]) -> Vec<String> {
        let mut notes = Vec::new();
        if let Source::Rate(rate) = self.source {
            notes.push(format!("time taken from the row number at {rate} Hz"));
        }
        let step = median_step(kept);
        if let Source::Column {
            name,
            unitless: true,
            ..
        } = &self.source
        {
            if step >= LONG_STEP {
                let name = shown(name, NAME_LENGTH);
                notes.push(format!(
                    "column `{name}` states no unit and was read as seconds; its median step is {step} s: is that ms? Then call it `{name} [ms]`"
                ));
            }
        }
        if kept.len() < self.rows {
            notes.push(format!(
                "{} of {} samples cut away",
                self.rows - kept.len(),
                self.rows
            ));
        }
        notes
    }
}

/// Median time between two samples.
pub(super) fn median_step(time: &[f64]) -> f64 {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.is_empty() {
        return 0.0;
    }
    let middle = steps.len() / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}
