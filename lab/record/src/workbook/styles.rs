//! The meaning of a number in a workbook: a plain number, a date or a duration.

use super::xml::{attribute, pieces, Piece};
use super::Failure;
use crate::clock_time::length;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The style in which a cell shows its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Style {
    Number,
    /// Days since the epoch of the workbook.
    Stamp,
    /// Days, shown as `[h]:mm:ss`.
    Duration,
}

/// The style of each cell format of a part `styles.xml`.
pub(super) fn read(part: &[u8]) -> Result<Vec<Style>, Failure> {
    let (mut own, mut all, mut is_cells) = (BTreeMap::new(), Vec::new(), false);
    pieces(part, |piece| {
        match piece {
            Piece::Start("numFmt", start) => {
                let code = attribute(start, "formatCode");
                if let (Some(id), Some(code)) = (attribute(start, "numFmtId"), code) {
                    own.insert(id.into_owned(), of_code(&code));
                }
            }
            Piece::Start("cellXfs", _) => is_cells = true,
            Piece::End("cellXfs") => is_cells = false,
            Piece::Start("xf", start) if is_cells => {
                let id = attribute(start, "numFmtId").unwrap_or_default();
                let declared = own.get(&*id).copied();
                all.push(declared.unwrap_or_else(|| of_built_in(id.parse().unwrap_or(0))));
            }
            _ => {}
        }
        Ok(())
    })?;
    Ok(all)
}

/// Formats that need no declaration (ECMA-376, 18.8.30).
fn of_built_in(id: u32) -> Style {
    match id {
        46 => Style::Duration,
        14..=22 | 45 | 47 => Style::Stamp,
        _ => Style::Number,
    }
}

/// The style of a format code, from the letters for dates and times outside quotes and brackets.
fn of_code(code: &str) -> Style {
    let mut rest = code.chars();
    while let Some(letter) = rest.next() {
        match letter {
            // The section for negative numbers.
            ';' => break,
            '\\' | '_' | '*' => _ = rest.next(),
            '"' => _ = rest.find(|next| *next == '"'),
            '[' => {
                let inside: String = rest.by_ref().take_while(|next| *next != ']').collect();
                let lower = inside.to_ascii_lowercase();
                let is_made_of = |unit: char| lower.chars().all(|own| own == unit);
                if !lower.is_empty() && ['h', 'm', 's'].into_iter().any(is_made_of) {
                    return Style::Duration;
                }
            }
            'd' | 'm' | 'y' | 'h' | 's' | 'D' | 'M' | 'Y' | 'H' | 'S' => return Style::Stamp,
            _ => {}
        }
    }
    Style::Number
}

/// A number as text. Time stamps have a resolution of one microsecond, which is the resolution of
/// days in a double.
pub(super) fn written(number: f64, style: Style, is_1904: bool) -> String {
    // A day in microseconds.
    let day = 86_400_000_000.0;
    let micros = (number * day).round();
    let days = (micros / day).floor();
    match style {
        Style::Duration => return (micros / 1e6).to_string(),
        // Excel's last day is 9999-12-31.
        Style::Stamp if (0.0..2_958_466.0).contains(&days) => {}
        _ => return number.to_string(),
    }
    let mut text = String::new();
    if days >= 1.0 {
        let (year, month, day) = date(days as i64, is_1904);
        let _ = write!(text, "{year:04}-{month:02}-{day:02}T");
    }
    let micros = (micros - days * day) as u64;
    let seconds = micros / 1_000_000;
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    let _ = write!(
        text,
        "{hours:02}:{minutes:02}:{:02}.{:06}",
        seconds % 60,
        micros % 1_000_000
    );
    text
}

/// The date of a day. Day 1 is 1900-01-01 or 1904-01-02. The calendar that starts in 1900 has a
/// 1900-02-29, which is its day 60.
fn date(days: i64, is_1904: bool) -> (i64, i64, i64) {
    let (mut year, mut left) = match is_1904 {
        true => (1904, days),
        false => (1900, days - 1 - i64::from(days >= 60)),
    };
    let all = |year: i64| 337 + length(year, 2).unwrap_or(28);
    while left >= all(year) {
        left -= all(year);
        year += 1;
    }
    let mut month = 1;
    while let Some(own) = length(year, month).filter(|own| left >= *own) {
        left -= own;
        month += 1;
    }
    (year, month, left + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_format_code_is_a_date_a_duration_or_a_number() {
        for (code, style) in [
            ("General", Style::Number),
            ("0.00E+00", Style::Number),
            ("#,##0.00\\ \"mm\"", Style::Number),
            ("[Red]0.0;[Blue]-0.0", Style::Number),
            ("0.0_d;dd", Style::Number),
            ("yyyy\\-mm\\-dd hh:mm:ss.000", Style::Stamp),
            ("[$-409]h:mm AM/PM", Style::Stamp),
            ("mm:ss.0", Style::Stamp),
            ("[h]:mm:ss", Style::Duration),
            ("[SS].000", Style::Duration),
        ] {
            assert_eq!(of_code(code), style, "{code}");
        }
        assert_eq!([14, 45, 46, 2].map(of_built_in), {
            use Style::{Duration, Number, Stamp};
            [Stamp, Stamp, Duration, Number]
        });
    }

    #[test]
    fn days_are_dates_of_their_epoch() {
        for (days, is_1904, text) in [
            (46_082.5, false, "2026-03-01T12:00:00.000000"),
            (46_082.5, true, "2030-03-02T12:00:00.000000"),
            (1.0, false, "1900-01-01T00:00:00.000000"),
            (59.0, false, "1900-02-28T00:00:00.000000"),
            (61.0, false, "1900-03-01T00:00:00.000000"),
            (2_958_465.0, false, "9999-12-31T00:00:00.000000"),
            (0.25, false, "06:00:00.000000"),
            (2_958_466.0, false, "2958466"),
            (-1.5, false, "-1.5"),
            (f64::NAN, false, "NaN"),
        ] {
            assert_eq!(written(days, Style::Stamp, is_1904), text);
        }
        assert_eq!(written(1.5, Style::Duration, false), "129600");
    }
}
