//! The time axis: strictly increasing seconds, or row numbers divided by a rate.

use super::error::{shown, Bad, RecordError, NAME_LENGTH, SHOWN};
use super::header::Header;
use super::source::Row;
use super::{clock_time, segments, units, Options};

/// Converts the time stamps of rows to seconds since the first row, and applies the cuts.
pub(super) struct Clock {
    source: Source,
    skip: f64,
    until: f64,
    drop_bad: bool,
    rows: usize,
    cut: usize,
    /// The first good stamp.
    first: Option<f64>,
    last: f64,
    of_day: bool,
    /// Whether the time stamps consist of minutes and seconds only.
    is_minutes: bool,
    /// Whether the time stamps of a column with the name `%time` are nanoseconds.
    is_ros: bool,
    repeated: usize,
    first_repeat: Option<(usize, String)>,
}

/// The result for a row from its time.
pub(super) enum Stamp {
    /// Time \[s\] since the first row.
    Kept(f64),
    /// Before `--start` or after `--end`.
    Cut,
    /// The same time stamp as in the previous row \[s\], if such rows may be omitted.
    Repeats(f64),
    /// A time stamp before that of an earlier row \[s\], and its error.
    Backwards(f64, RecordError),
}

/// Median step without a unit above which milliseconds are suspected \[s\], because two samples per
/// second or fewer do not show hysteresis in motion.
const LONG_STEP: f64 = 0.5;

/// Median step without a unit above which the unit cannot be seconds, if the step is plausible for
/// a logger in a smaller unit \[s\].
const NO_STEP: f64 = 100.0;

/// First time stamp without a unit above which the unit cannot be seconds \[s\]. Seconds since 1970
/// have ten digits, and milliseconds have thirteen digits.
const NO_STAMP: f64 = 1e11;

/// Mean step without a unit below which the unit cannot be seconds \[s\]. Spreadsheets, for
/// example, count days.
const SHORT_STEP: f64 = 1e-6;

enum Source {
    Column {
        index: usize,
        name: String,
        scale: f64,
        unitless: bool,
        /// Whether ROS may have written the column. ROS counts nanoseconds since 1970.
        is_ros: bool,
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
                // `[hh:mm:ss]` says how the stamp is written.
                let unit = column.unit.as_deref().filter(|unit| !unit.contains(':'));
                let scale = units::seconds(unit).ok_or_else(|| {
                    units::not_of_time(header.line, &column.name, unit.unwrap_or_default())
                })?;
                Source::Column {
                    index,
                    name: column.name.clone(),
                    scale,
                    unitless: unit.is_none(),
                    is_ros: unit.is_none() && column.is_ros(),
                }
            }
        };
        let until = options.until.unwrap_or(f64::INFINITY);
        Ok(Self {
            source,
            skip: options.skip,
            until,
            drop_bad: options.drop_bad,
            rows: 0,
            cut: 0,
            first: None,
            last: 0.0,
            of_day: false,
            is_minutes: false,
            is_ros: false,
            repeated: 0,
            first_repeat: None,
        })
    }

    /// Time of the next row.
    pub(super) fn stamp(&mut self, row: &Row<'_>) -> Result<Stamp, RecordError> {
        let stamp = self.place(row);
        let is_row = stamp.as_ref().map_or_else(|e| e.bad().is_some(), |_| true);
        self.rows += usize::from(is_row);
        stamp
    }

    fn place(&mut self, row: &Row<'_>) -> Result<Stamp, RecordError> {
        let t = match &self.source {
            Source::Rate(rate) => self.rows as f64 / rate,
            Source::Column {
                index,
                name,
                scale,
                is_ros,
                ..
            } => {
                let (index, line) = (*index, row.line());
                let stamp = match of_day(row, index, self.of_day, self.first.is_none())
                    .map_err(|error| error.on(name))?
                {
                    Some(stamp) => {
                        self.of_day = true;
                        self.is_minutes = row.text(index).is_some_and(clock_time::is_minutes);
                        stamp
                    }
                    None => {
                        let own = row
                            .number(index, name)
                            .map_err(|error| no_stamp(row, index, error))?;
                        if self.first.is_none() {
                            self.is_ros = *is_ros && own > NO_STAMP;
                        }
                        match self.is_ros {
                            true => own * units::seconds(Some("ns")).unwrap_or(*scale),
                            false => own * scale,
                        }
                    }
                };
                let fresh = self.first.is_none();
                let first = *self.first.get_or_insert(stamp);
                let t = stamp - first;
                if t < self.last {
                    let last = first + self.last;
                    if let Some(place) = row.opens() {
                        let error = segments::restarts(place, last, stamp).on(name);
                        return Ok(Stamp::Backwards(t, error));
                    }
                    let cell = row.text(index).filter(|_| self.of_day);
                    let restart = cell.map_or(clock_time::SORT, clock_time::restart);
                    let message = format!("the time decreases from {last} to {stamp} s{restart}");
                    let error = RecordError::at(line, message).on(name);
                    return Ok(Stamp::Backwards(t, error));
                }
                if !fresh && t <= self.last {
                    if self.drop_bad && self.is_kept(t) {
                        return Ok(Stamp::Repeats(t));
                    }
                    self.repeated += 1;
                    let cell = || (line, row.shown(index));
                    self.first_repeat.get_or_insert_with(cell);
                }
                t
            }
        };
        self.last = t;
        if self.is_kept(t) {
            return Ok(Stamp::Kept(t));
        }
        self.cut += 1;
        Ok(Stamp::Cut)
    }

    /// Whether a time \[s\] is within the cuts.
    pub(super) fn is_kept(&self, t: f64) -> bool {
        // Only a column with stamps of its own begins before the first row.
        (t >= self.skip || self.skip <= 0.0) && t <= self.until
    }

    /// Number of rows so far, including rows that were cut.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// Number of rows that were cut.
    pub(super) fn cut(&self) -> usize {
        self.cut
    }

    /// Time of the last row \[s\], since the first one.
    pub(super) fn last(&self) -> f64 {
        self.last
    }

    /// Rejects repeated time stamps, unless they are allowed, and time stamps without a unit that
    /// cannot be seconds.
    pub(super) fn finish(&self, header: &Header, may_repeat: bool) -> Result<(), RecordError> {
        if let Source::Column {
            index,
            unitless: true,
            ..
        } = self.source
        {
            let step = self.last / self.rows.saturating_sub(1).max(1) as f64;
            if step > 0.0 && step < SHORT_STEP {
                let name = &header.columns[index].name;
                let message = format!(
                    "the time has no unit, and in s there would be {:.3e} rows per second; set --time '{name} [d]' for days, '{name} [h]' for hours, or '{name} [s]'",
                    1.0 / step
                );
                return Err(RecordError::at(header.line, message).on(name));
            }
        }
        let (Some((line, cell)), Source::Column { index, .. }) = (&self.first_repeat, &self.source)
        else {
            return Ok(());
        };
        if self.drop_bad || may_repeat {
            return Ok(());
        }
        let name = &header.columns[*index].name;
        let cell = shown(cell, SHOWN);
        // Where most rows would go, what is left is another record.
        let drop = match 2 * self.repeated > self.rows {
            true => "",
            false => "; --drop-bad drops such rows",
        };
        let message = if self.repeated * 100 >= self.rows && self.last > 0.0 {
            let stamps = (self.rows - self.repeated).max(2) as f64;
            let rate = match 2 * self.repeated > self.rows {
                // The last of few stamps stands for as long as the others.
                true => self.rows as f64 / (self.last * stamps / (stamps - 1.0)),
                false => (self.rows - 1) as f64 / self.last,
            };
            format!(
                "the time stamp repeats at {cell}, as in {} of {} rows, so the stamps appear to be rounded; --rate HZ computes the time from the row number (about {rate:.1} Hz){drop}",
                self.repeated, self.rows
            )
        } else {
            format!(
                "the time stamp repeats at {cell}; --rate HZ computes the time from the row number{drop}"
            )
        };
        Err(RecordError::at(*line, message).on(name).from(Bad::Repeated))
    }

    /// Rejects time stamps without a unit that cannot be seconds and may be in milliseconds or a
    /// smaller unit.
    pub(super) fn check_unit(&self, header: &Header, kept: &[f64]) -> Result<(), RecordError> {
        let step = median_step(kept);
        let first = self.first.unwrap_or_default();
        let is_long = step > NO_STEP || first.abs() > NO_STAMP;
        match self
            .asked_for_a_unit(step)
            .filter(|_| is_long && likely_unit(step).is_some())
        {
            Some((name, asked)) => {
                let start = match first.abs() > NO_STAMP {
                    true => format!(
                        "; in s, the first time stamp of {first:.3e} would be thousands of years"
                    ),
                    false => String::new(),
                };
                let shown = shown(name, NAME_LENGTH);
                let message = format!("{asked}, or '{shown} [s]' for seconds{start}");
                Err(RecordError::at(header.line, message).on(name))
            }
            None => Ok(()),
        }
    }

    /// The name of a time column without a unit whose median step is long for seconds, and the
    /// question about its unit.
    fn asked_for_a_unit(&self, step: f64) -> Option<(&str, String)> {
        let Source::Column {
            name,
            unitless: true,
            ..
        } = &self.source
        else {
            return None;
        };
        let (shown, unit) = (shown(name, NAME_LENGTH), likely_unit(step).unwrap_or("ms"));
        (!self.of_day && step >= LONG_STEP).then(|| {
            let asked = format!(
                "the time has no unit and was read as seconds, with a median step of {step} s; set --time '{shown} [{unit}]' if the unit is {unit}"
            );
            (name.as_str(), asked)
        })
    }

    pub(super) fn notes(&self, kept: &[f64]) -> Vec<String> {
        let mut notes = Vec::new();
        if let Source::Rate(rate) = self.source {
            notes.push(format!("time computed from the row number at {rate} Hz"));
        }
        if self.of_day {
            let what = match self.is_minutes {
                true => "minutes and seconds",
                false => "times of day",
            };
            notes.push(format!("time stamps are {what}"));
        }
        if self.is_ros {
            notes.push("time stamps are in ns, as ROS writes them to `%time`".to_owned());
        }
        if let Some((name, asked)) = self.asked_for_a_unit(median_step(kept)) {
            let name = shown(name, NAME_LENGTH);
            notes.push(format!("column `{name}` {asked}"));
        }
        if self.cut > 0 {
            notes.push(format!("{} of {} samples cut", self.cut, self.rows));
        }
        notes
    }
}

/// The unit smaller than a second in which this step is plausible for a logger, if there is one.
fn likely_unit(step: f64) -> Option<&'static str> {
    let units = [("ms", 1e-3), ("µs", 1e-6), ("ns", 1e-9)];
    let own = units.iter().find(|(_, seconds)| step * seconds < LONG_STEP);
    own.map(|(unit, _)| *unit)
}

/// The time of day in a cell, if the first cell is a time of day. All other cells must then also be
/// times of day.
fn of_day(row: &Row<'_>, index: usize, all: bool, first: bool) -> Result<Option<f64>, RecordError> {
    if !(all || first) {
        return Ok(None);
    }
    let Some(cell) = row.text(index) else {
        return Ok(None);
    };
    match clock_time::seconds(cell) {
        None if all && !cell.is_empty() => {
            let message = format!(
                "`{}` is not a time of day, unlike the cells above",
                shown(cell, SHOWN)
            );
            Err(RecordError::at(row.line(), message))
        }
        stamp => Ok(stamp),
    }
}

/// The error for a cell that is neither a number nor a time. If the cell looks like a time, the
/// error states the accepted forms.
fn no_stamp(row: &Row<'_>, index: usize, error: RecordError) -> RecordError {
    let cell = row.text(index).unwrap_or_default();
    match clock_time::expected(cell) {
        Some(expected) => error.but(format!(
            "`{}` is neither a number nor a time in a known format; {expected}",
            shown(cell, SHOWN)
        )),
        None => error,
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
