//! The source of a series: a column, or the sum or difference of two columns.

use super::angles::is_angle;
use super::error::{shown, RecordError, NAME_LENGTH};
use super::header::{require, Header};
use super::sizes::factor;
use super::Options;

const HINT: &str = "--channel NAME=COL selects another one";

/// A series of the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Series {
    Column(usize),
    Sum {
        first: usize,
        second: usize,
        /// 1, or −1 for a difference.
        sign: f64,
    },
}

impl Series {
    /// The columns that it reads.
    pub(super) fn columns(self) -> impl Iterator<Item = usize> {
        let (first, second) = match self {
            Self::Column(index) => (index, None),
            Self::Sum { first, second, .. } => (first, Some(second)),
        };
        [Some(first), second].into_iter().flatten()
    }

    /// The columns that are added or subtracted; none if the series is a single column.
    pub(super) fn parts(self) -> impl Iterator<Item = usize> {
        let sum = matches!(self, Self::Sum { .. });
        self.columns().filter(move |_| sum)
    }

    /// A sum or difference in words, such as `phi_p + phi_d`, or `s_p - 0.001 s_d` if the units
    /// differ. Each column has its name in the file, or the name of the channel that is read from
    /// it. The angles of a channel are in radians.
    pub(super) fn definition(
        self,
        header: &Header,
        options: &Options,
    ) -> Result<Option<String>, RecordError> {
        let Some((second, factor)) = self.second(header)? else {
            return Ok(None);
        };
        let name = |index: usize| {
            let own = header.columns[index].name.as_str();
            let mut channels = options.channels.iter();
            channels
                .find(|(_, column)| header.find(column) == Some(index))
                .map_or(own, |(channel, _)| channel)
        };
        let sign = if factor < 0.0 { '-' } else { '+' };
        let unit = header.columns[self.first()].unit.as_deref();
        let size = match factor.abs() {
            other if other != 1.0 && !unit.is_some_and(is_angle) => format!("{other} "),
            _ => String::new(),
        };
        let (first, second) = (name(self.first()), name(second));
        Ok(Some(format!("{first} {sign} {size}{second}")))
    }

    /// The column whose name and unit the series has.
    pub(super) fn first(self) -> usize {
        match self {
            Self::Column(first) | Self::Sum { first, .. } => first,
        }
    }

    /// Factor of the second column that converts its unit to that of the first.
    pub(super) fn second(self, header: &Header) -> Result<Option<(usize, f64)>, RecordError> {
        let Self::Sum {
            first,
            second,
            sign,
        } = self
        else {
            return Ok(None);
        };
        let (a, b) = (&header.columns[first], &header.columns[second]);
        let size = match (&a.unit, &b.unit) {
            (a, b) if a == b => Some(1.0),
            (Some(a), Some(b)) => factor(b, a),
            _ => None,
        };
        let unit = |unit: &Option<String>| match unit {
            Some(unit) => format!("unit {}", shown(unit, NAME_LENGTH)),
            None => "no unit".to_owned(),
        };
        match size {
            Some(size) => Ok(Some((second, sign * size))),
            None => Err(RecordError::at(
                header.line,
                format!(
                    "the column has {}, but it must have {}, as `{}` has, so that the two can be added or subtracted",
                    unit(&b.unit),
                    unit(&a.unit),
                    shown(&a.name, NAME_LENGTH)
                ),
            )
            .on(&b.name)),
        }
    }
}

/// All ways to read a text as `A-B` or `A+B`, with the sign.
pub(super) fn splits(text: &str) -> Vec<(&str, f64, &str)> {
    text.match_indices(['+', '-'])
        .map(|(at, sign)| {
            let sign = if sign == "-" { -1.0 } else { 1.0 };
            (text[..at].trim(), sign, text[at + 1..].trim())
        })
        .filter(|(a, _, b)| !a.is_empty() && !b.is_empty())
        .collect()
}

/// The column with this name, or `A-B` or `A+B` of two columns or of channels that other options
/// define.
pub(super) fn parse(header: &Header, options: &Options, text: &str) -> Result<Series, RecordError> {
    if let Some(index) = header.find(text) {
        return Ok(Series::Column(index));
    }
    let named = |name: &str| options.channels.iter().find(|(own, _)| own == name);
    let column = |name: &str| match named(name) {
        Some((_, column)) => header.find(column),
        None => header.find(name),
    };
    let splits = splits(text);
    let sums: Vec<Series> = splits
        .iter()
        .filter_map(|(a, sign, b)| {
            let (first, second) = (column(a)?, column(b)?);
            Some(Series::Sum {
                first,
                second,
                sign: *sign,
            })
        })
        .collect();
    match (sums.as_slice(), splits.as_slice()) {
        ([one], _) => Ok(*one),
        ([], [(a, _, b)]) => {
            let missing = if column(a).is_none() { a } else { b };
            require(header, missing, HINT).map(Series::Column)
        }
        ([], _) => require(header, text, HINT).map(Series::Column),
        _ => Err(RecordError::new(format!(
            "--channel NAME={} is ambiguous, because it can mean several sums of two columns",
            shown(text, NAME_LENGTH)
        ))),
    }
}
