//! Which column plays which part.

use super::error::{shown, RecordError, NAME_LENGTH};
use super::header::Header;
use super::{Mode, Options};

/// Indices into the header's columns.
pub(super) struct Roles {
    pub(super) mode: Mode,
    /// `None` where the time comes from the row number.
    pub(super) time: Option<usize>,
    pub(super) input: usize,
    pub(super) output: usize,
    pub(super) channels: Vec<(String, usize)>,
    pub(super) notes: Vec<String>,
}

impl Roles {
    /// The columns to be read, in the order input, output, channels.
    pub(super) fn read(&self) -> impl Iterator<Item = usize> + '_ {
        [self.input, self.output]
            .into_iter()
            .chain(self.channels.iter().map(|(_, index)| *index))
    }
}

fn ends(mode: Mode) -> (&'static str, &'static str) {
    match mode {
        Mode::Torque => ("tau_i", "tau_o"),
        Mode::Displacement => ("x", "f"),
    }
}

fn default_channels(mode: Mode) -> &'static [&'static str] {
    match mode {
        Mode::Torque => &["phi_p", "phi_d", "temperature"],
        Mode::Displacement => &["load", "temperature"],
    }
}

pub(super) fn assign(header: &Header, options: &Options) -> Result<Roles, RecordError> {
    // A name that is not there says more than a mode that does not follow from it.
    for (name, option) in [(&options.input, "--input"), (&options.output, "--output")] {
        if let Some(name) = name {
            find(header, name, &format!("{option} COL names another one"))?;
        }
    }
    let mode = mode(header, options)?;
    let (input, output) = ends(mode);
    let time = match options.rate {
        Some(_) => None,
        None => {
            let name = options.time.as_deref().unwrap_or("t");
            Some(find(
                header,
                name,
                "--time COL names another one, --rate HZ takes time from the row number",
            )?)
        }
    };
    let input = find(
        header,
        options.input.as_deref().unwrap_or(input),
        "--input COL names another one",
    )?;
    let output = find(
        header,
        options.output.as_deref().unwrap_or(output),
        "--output COL names another one",
    )?;
    let refuse = |index: usize, message: String| {
        Err(RecordError::at(header.line, message).on(&header.columns[index].name))
    };
    if input == output {
        return refuse(input, "is both input and output".to_owned());
    }
    if let Some(time) = time.filter(|time| *time == input || *time == output) {
        return refuse(
            time,
            "is the time, it cannot be input or output too".to_owned(),
        );
    }
    let channels = channels(header, options, mode)?;
    if let Some((name, index)) = channels.iter().find(|(_, index)| *index == output) {
        let name = shown(name, NAME_LENGTH);
        return refuse(
            *index,
            format!("is the output, it cannot explain itself as channel `{name}`"),
        );
    }
    let mut roles = Roles {
        mode,
        time,
        input,
        output,
        channels,
        notes: Vec::new(),
    };
    roles.notes.extend(ignored(header, &roles));
    Ok(roles)
}

fn mode(header: &Header, options: &Options) -> Result<Mode, RecordError> {
    if let Some(mode) = options.mode {
        return Ok(mode);
    }
    let ask = |message: String| {
        let message = format!("{message}; state --mode torque or --mode displacement");
        Err(RecordError::at(header.line, message))
    };
    let has = |name: &str| header.find(name).is_some();
    let (mut torque, mut displacement) = (false, false);
    let mapped: Vec<&str> = options
        .input
        .iter()
        .chain(&options.output)
        .map(String::as_str)
        .collect();
    for name in &mapped {
        torque |= matches!(*name, "tau_i" | "tau_o");
        displacement |= matches!(*name, "x" | "f");
    }
    if mapped.is_empty() {
        torque = has("tau_i") && has("tau_o");
        displacement = has("x") && has("f");
        if !torque && !displacement {
            // One end alone tells the mode: then the other one is reported missing.
            torque = has("tau_i") || has("tau_o");
            displacement = has("x") || has("f");
        }
    }
    match (torque, displacement) {
        (true, false) => Ok(Mode::Torque),
        (false, true) => Ok(Mode::Displacement),
        (true, true) => ask("the columns fit both modes".to_owned()),
        (false, false) if !mapped.is_empty() => {
            ask("the mode does not follow from the columns named".to_owned())
        }
        (false, false) => {
            let list = header.list();
            let message = format!(
                "neither `tau_i` and `tau_o` nor `x` and `f` among the columns {list}; \
                 name them with --mode, --input and --output"
            );
            Err(RecordError::at(header.line, message))
        }
    }
}

fn find(header: &Header, name: &str, hint: &str) -> Result<usize, RecordError> {
    header.find(name).ok_or_else(|| {
        let near = header.nearest(name);
        let meant = match near.is_empty() {
            true => String::new(),
            false => format!(" (nearest: {})", near.join(", ")),
        };
        let message = format!("no such column among {}{meant}; {hint}", header.list());
        RecordError::at(header.line, message).on(name)
    })
}

fn channels(
    header: &Header,
    options: &Options,
    mode: Mode,
) -> Result<Vec<(String, usize)>, RecordError> {
    let mut channels: Vec<(String, usize)> = Vec::new();
    for (name, column) in &options.channels {
        let shown = shown(name, NAME_LENGTH);
        let (input, output) = ends(mode);
        let taken = ["", "t", input, output].contains(&name.as_str());
        if taken || name.chars().any(|c| c.is_control() || c.is_whitespace()) {
            return Err(RecordError::new(format!(
                "--channel NAME=COL: `{shown}` cannot be the name of a channel"
            )));
        }
        if channels.iter().any(|(other, _)| other == name) {
            return Err(RecordError::new(format!(
                "--channel NAME=COL: channel `{shown}` is given twice"
            )));
        }
        channels.push((
            name.clone(),
            find(header, column, "--channel NAME=COL names another one")?,
        ));
    }
    for name in default_channels(mode) {
        let given = channels.iter().any(|(other, _)| other == name);
        if let (false, Some(index)) = (given, header.find(name)) {
            // A column that the user gave another part is not a channel as well.
            let free = ![&options.time, &options.input, &options.output]
                .iter()
                .any(|option| {
                    option.as_deref().and_then(|other| header.find(other)) == Some(index)
                });
            let free = free && !channels.iter().any(|(_, other)| *other == index);
            channels.extend(free.then(|| ((*name).to_owned(), index)));
        }
    }
    Ok(channels)
}

fn ignored(header: &Header, roles: &Roles) -> Option<String> {
    let used: Vec<usize> = roles.read().chain(roles.time).collect();
    let unused: Vec<String> = header
        .columns
        .iter()
        .enumerate()
        .filter(|(index, _)| !used.contains(index))
        .map(|(index, column)| match column.name.as_str() {
            "" => format!("number {} (without a name)", index + 1),
            name => format!("`{}`", shown(name, NAME_LENGTH)),
        })
        .collect();
    let more = unused.len().saturating_sub(24);
    let mut list = unused
        .iter()
        .take(24)
        .cloned()
        .collect::<Vec<_>>()
        .join(", ");
    if more > 0 {
        list += &format!(" and {more} more");
    }
    (!unused.is_empty()).then(|| format!("columns not read: {list}"))
}
