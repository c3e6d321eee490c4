//! The columns of a file as the page shows them, and the reader's messages about the file.

use crate::options::Choices;
use crate::{Answer, File};
use bowden_lab::facts::{excerpt, outline, ColumnPart, Outlined, RecordError, TextLine};
use serde::Serialize;

/// Number of row intervals in a preview, which shows the least and the largest value of each.
const INTERVALS: usize = 240;
/// Lines of the table that are shown before and after a rejected line.
const AROUND: usize = 2;

#[derive(Serialize)]
struct Column<'a> {
    name: &'a str,
    unit: Option<&'a str>,
    /// `time`, `input`, `output`, `channel`, or nothing.
    part: Option<&'static str>,
    channel: Option<&'a str>,
    /// Number of cells that are numbers.
    numbers: usize,
    rows: usize,
    /// Least and largest value of each interval; `null` if the interval has no number.
    preview: Vec<Option<[f64; 2]>>,
}

#[derive(Serialize)]
struct Refusal {
    line: Option<usize>,
    column: Option<String>,
    text: String,
    lines: Vec<Excerpt>,
}

#[derive(Serialize)]
struct Excerpt {
    number: usize,
    cells: Vec<String>,
}

/// If the file is not a record, the answer contains the error message; the request does not fail.
pub(crate) fn look(file: &File, choices: &Choices) -> Result<Answer, String> {
    let asked = choices.asked()?;
    let mut answer = Answer::default();
    if let Ok(found) = outline(&file.bytes, &asked.options) {
        let columns: Vec<Column<'_>> = found.columns.iter().map(column).collect();
        answer.put("columns", columns);
        answer.put("names_line", found.line);
        answer.put("mode", found.mode.map(|mode| mode.name()));
    }
    match asked.read_text_or_refuse(&file.bytes, &file.name) {
        Ok(record) => {
            answer.put("mode", record.mode.name());
            answer.put("samples", record.samples());
            answer.put("duration", record.time.last());
            answer.put("rate", 1.0 / record.step());
            answer.put("notes", &record.notes);
            answer.put("defects", &record.defects);
        }
        Err(error) => answer.put("refusal", refusal(&error, file, choices)?),
    }
    Ok(answer)
}

fn refusal(error: &RecordError, file: &File, choices: &Choices) -> Result<Refusal, String> {
    let options = choices.options()?;
    let lines = match error.line() {
        Some(line) => excerpt(&file.bytes, line, AROUND, &options),
        None => Vec::new(),
    };
    let shown = |line: TextLine| Excerpt {
        number: line.number,
        cells: line.cells,
    };
    Ok(Refusal {
        line: error.line(),
        column: error.column().map(str::to_owned),
        text: error.to_string(),
        lines: lines.into_iter().map(shown).collect(),
    })
}

fn column(own: &Outlined) -> Column<'_> {
    let (part, channel) = match &own.part {
        None => (None, None),
        Some(ColumnPart::Time) => (Some("time"), None),
        Some(ColumnPart::Input) => (Some("input"), None),
        Some(ColumnPart::Output) => (Some("output"), None),
        Some(ColumnPart::Channel(name)) => (Some("channel"), Some(name.as_str())),
    };
    Column {
        name: &own.name,
        unit: own.unit.as_deref(),
        part,
        channel,
        numbers: own.values.iter().filter(|value| value.is_finite()).count(),
        rows: own.values.len(),
        preview: preview(&own.values),
    }
}

fn preview(values: &[f64]) -> Vec<Option<[f64; 2]>> {
    let length = values.len().div_ceil(INTERVALS).max(1);
    let of = |rows: &[f64]| {
        let finite = rows.iter().copied().filter(|value| value.is_finite());
        let add = |all: Option<[f64; 2]>, value: f64| {
            let [least, largest] = all.unwrap_or([value, value]);
            Some([least.min(value), largest.max(value)])
        };
        finite.fold(None, add)
    };
    values.chunks(length).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::preview;

    #[test]
    fn a_preview_keeps_the_peaks_and_the_gaps() {
        let mut values: Vec<f64> = (0..2400).map(|i| f64::from(i % 10)).collect();
        values[15] = 99.0;
        values[20..30].fill(f64::NAN);
        let found = preview(&values);
        assert_eq!(found.len(), 240);
        assert_eq!(found[0], Some([0.0, 9.0]));
        assert_eq!(found[1], Some([0.0, 99.0]));
        assert_eq!(found[2], None);
        assert!(preview(&[]).is_empty());
    }
}
