//! Times of day and dates as time stamps: `14:03:21.250`, `2026-03-01T14:03:21.250`; and `03:21.2`,
//! minutes and seconds, as Excel shows times.

/// Seconds of a time stamp since midnight or, with a date, since a fixed day; `None` if the cell is
/// not a time stamp. The year is first or, in a date with points, last. `1/2/2026` is ambiguous and
/// not a time stamp.
pub(super) fn seconds(cell: &str) -> Option<f64> {
    let (date, time) = match cell.find([' ', 'T']) {
        Some(at) => (Some(&cell[..at]), cell[at + 1..].trim_start()),
        None => (None, cell),
    };
    let days = match date {
        // `12:30.5` behind a date may lack seconds or hours.
        Some(_) if is_minutes(time) => return None,
        Some(date) => days(date)?,
        None => 0,
    };
    let (time, ahead) = match date {
        Some(_) => zone(time)?,
        None => (time.strip_suffix('Z').unwrap_or(time), 0.0),
    };
    Some(days as f64 * 86_400.0 + of_day(time)? - ahead)
}

/// A time, and the offset of its zone from UTC in seconds: `14:03:21+01:00`, `14:03:21-0500`,
/// `14:03:21Z`.
fn zone(time: &str) -> Option<(&str, f64)> {
    let Some(at) = time.find(['+', '-']) else {
        return Some((time.strip_suffix('Z').unwrap_or(time), 0.0));
    };
    let (own, sign) = (time[at + 1..].replace(':', ""), &time[at..=at]);
    let is_zone = [2, 4].contains(&own.len()) && own.bytes().all(|b| b.is_ascii_digit());
    let digits = format!("{own:0<4}")
        .parse::<u32>()
        .ok()
        .filter(|_| is_zone)?;
    let (hours, minutes) = (digits / 100, digits % 100);
    let ahead = f64::from(3600 * hours + 60 * minutes);
    (hours < 15 && minutes < 60).then(|| (&time[..at], if sign == "-" { -ahead } else { ahead }))
}

/// Whether a stamp has a date before its time.
pub(super) fn has_date(cell: &str) -> bool {
    cell.contains([' ', 'T'])
}

/// Whether a stamp has no hours.
pub(super) fn is_minutes(stamp: &str) -> bool {
    stamp.matches(':').count() == 1
}

/// What to do if the time decreases.
pub(super) const SORT: &str = "; sort the rows by time, or save each record in a separate file";

/// What to do if times of day decrease.
pub(super) fn restart(stamp: &str) -> &'static str {
    match (has_date(stamp), is_minutes(stamp)) {
        (true, _) => SORT,
        (_, true) => "; if the record spans a full hour, write the hours too, as in 01:59:50.2",
        _ => "; if the record spans midnight, add a date",
    }
}

/// `HH:MM:SS`, with decimals after a point or a comma. `MM:SS` requires decimals, because `12:30`
/// may be hours and minutes.
fn of_day(time: &str) -> Option<f64> {
    let parts: Vec<&str> = time.split(':').collect();
    let (hours, minutes, seconds) = match parts.as_slice() {
        [hours, minutes, seconds] => (*hours, *minutes, *seconds),
        [minutes, seconds] if seconds.contains(['.', ',']) => ("0", *minutes, *seconds),
        _ => return None,
    };
    let whole = |text: &str, below: u32| {
        let digits = (1..=2).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit());
        text.parse().ok().filter(|n: &u32| digits && *n < below)
    };
    let (integer, decimals) = seconds.split_once(['.', ',']).unwrap_or((seconds, "0"));
    let in_range = whole(integer, 61)?;
    if decimals.is_empty() || !decimals.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    let minutes = 60 * whole(hours, 24)? + whole(minutes, 60)?;
    let seconds: f64 = format!("{in_range}.{decimals}").parse().ok()?;
    Some(f64::from(60 * minutes) + seconds)
}

/// The required form of a cell that looks like a time but is not a valid time stamp; otherwise
/// `None`.
pub(super) fn expected(cell: &str) -> Option<&'static str> {
    let digits = cell.starts_with(|c: char| c.is_ascii_digit());
    let upper = cell.to_uppercase();
    if !digits || !cell.contains([':', '/', '-']) || cell.parse::<f64>().is_ok() {
        return None;
    }
    Some(if cell.contains('/') {
        "1/2/2026 is ambiguous; write 2026-02-01T23:59:50.250 (ISO 8601) or 1.2.2026 23:59:50.250"
    } else if upper.ends_with('M') {
        "write hours from 0 to 23 without AM or PM, as in 23:59:50.250"
    } else {
        "write seconds, 23:59:50.250, 2026-02-01T23:59:50.250 (ISO 8601) or 1.2.2026 23:59:50.250"
    })
}

/// Number of the day of a date in the Gregorian calendar.
fn days(date: &str) -> Option<i64> {
    let parts = |separator: char| -> Option<[i64; 3]> {
        let parts: Vec<i64> = date
            .split(separator)
            .map(|part| {
                let digits = part.len() <= 4 && part.bytes().all(|b| b.is_ascii_digit());
                part.parse().ok().filter(|_| digits)
            })
            .collect::<Option<_>>()?;
        parts.try_into().ok()
    };
    let [year, month, day] = match (parts('-'), parts('.')) {
        (Some(date), _) => date,
        (_, Some([day, month, year])) => [year, month, day],
        _ => return None,
    };
    if !(1000..=9999).contains(&year) || !(1..=length(year, month)?).contains(&day) {
        return None;
    }
    // March is the first month of the year here, so that a leap day is its last one.
    let (year, month) = match month {
        1 | 2 => (year - 1, month + 9),
        _ => (year, month - 3),
    };
    let of_years = 365 * year + year / 4 - year / 100 + year / 400;
    // From a day near the year 2000, so that a double of seconds has 0.1 µs left.
    Some(of_years + (153 * month + 2) / 5 + day - 730_000)
}

/// Number of days in a month; `None` if there is no such month.
pub(super) fn length(year: i64, month: i64) -> Option<i64> {
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    match month {
        2 => Some(if leap { 29 } else { 28 }),
        4 | 6 | 9 | 11 => Some(30),
        1..=12 => Some(31),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_count_in_seconds_over_midnights_and_leap_days() {
        let apart = |a: &str, b: &str| seconds(b).unwrap() - seconds(a).unwrap();
        assert_eq!(seconds("00:01:02"), Some(62.0));
        assert_eq!(
            apart("2026-03-29T01:59:59.5+01:00", "2026-03-29T03:00:00+02:00"),
            0.5
        );
        assert_eq!(
            apart("2026-03-29 01:00:00-0530", "2026-03-29T06:30:00Z"),
            0.0
        );
        for stamp in [
            "2026-03-29T01:59:59+1",
            "2026-03-29T01:59:59+01:75",
            "01:59:59+01:00",
        ] {
            assert_eq!(seconds(stamp), None, "{stamp}");
        }
        assert_eq!(seconds("1:00:00,5"), Some(3600.5));
        assert_eq!(seconds("59:50.2"), Some(3590.2));
        assert_eq!(
            apart("2024-02-28T23:59:59", "2024-03-01 00:00:00Z"),
            86_401.0
        );
        assert_eq!(
            apart("2000-02-29 00:00:00", "2000-03-01 00:00:00"),
            86_400.0
        );
        assert_eq!(apart("31.12.2025 23:59:59,5", "1.1.2026 00:00:00"), 0.5);
        assert_eq!(
            apart("2023-12-31 12:00:00", "2024-12-31 12:00:00"),
            366.0 * 86_400.0
        );
    }

    #[test]
    fn what_could_be_two_days_or_no_time_is_none() {
        for cell in [
            "1/2/2026 10:00:00",
            "12:00",
            "60:00.0",
            "2026-03-01 12:30.5",
            "25:00:00",
            "10:60:00",
            "10:00:61",
            "10:00:00.",
            "1:2:3:4",
            "+1:00:00",
            "2026-13-01 00:00:00",
            "2026-00-01 00:00:00",
            "2026-01-00 00:00:00",
            "2026-01-32 00:00:00",
            "2026-02-29 00:00:00",
            "2026-02-31 00:00:00",
            "2024-02-30 00:00:00",
            "2100-02-29 00:00:00",
            "31.4.2026 00:00:00",
            "1,5",
            "",
            ":",
        ] {
            assert_eq!(seconds(cell), None, "{cell}");
        }
    }
}
