//! Checks for invalid options, and for columns without a measurement.

use super::defects::heavy;
use super::error::RecordError;
use super::header::Header;
use super::roles::Roles;
use super::rows::Table;
use super::scale::range;
use super::Options;

/// Rejects options that are invalid for every record.
pub(super) fn options(options: &Options) -> Result<(), RecordError> {
    let refuse = |message: String| Err(RecordError::new(message));
    if !(options.skip.is_finite() && options.skip >= 0.0) {
        return refuse(format!(
            "--start {} is out of range (0 s or more)",
            options.skip
        ));
    }
    if let Some(until) = options.until {
        if until.is_nan() || until <= options.skip {
            return refuse(format!(
                "--end {until} is out of range; it must be above --start {}",
                options.skip
            ));
        }
    }
    if options.header_line.is_some() && !options.names.is_empty() {
        return refuse(
            "--names and --header-line cannot be combined: --names is for a file without column names"
                .to_owned(),
        );
    }
    match options.rate {
        Some(rate) if !(1e-9..=1e12).contains(&rate) => refuse(format!(
            "--rate {rate} is out of range; it must be positive"
        )),
        _ => Ok(()),
    }
}

/// Rejects an input or output that is constant or heavily clipped, and a swap of the two.
pub(super) fn record(table: &Table, header: &Header, roles: &Roles) -> Result<(), RecordError> {
    let [input, output, ..] = table.values.as_slice() else {
        return Ok(());
    };
    let name = |index: usize| header.columns[index].name.as_str();
    let ends = [
        ("input", roles.input, input, output),
        ("output", roles.output, output, input),
    ];
    for (role, index, values, _) in ends {
        let (low, high) = range(values);
        if high - low <= 1e-12 * low.abs().max(high.abs()) {
            let line = table.lines.first().copied().unwrap_or(header.line);
            let message = format!("the {role} is {low} in every sample, but it must vary");
            return Err(RecordError::at(line, message).on(name(index)));
        }
    }
    if input == output {
        let message = format!(
            "the output equals the input `{}` in every sample, but it must be the resulting force or torque",
            name(roles.input)
        );
        let line = table.lines.first().copied().unwrap_or(header.line);
        return Err(RecordError::at(line, message).on(name(roles.output)));
    }
    for (_, index, values, other) in ends {
        if let Some((first, message)) = heavy(values, other) {
            let line = table.lines.get(first).copied().unwrap_or(header.line);
            return Err(RecordError::at(line, message).on(name(index)));
        }
    }
    Ok(())
}
