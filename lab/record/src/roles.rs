//! The role of each column.

use super::error::{listed, shown, RecordError, NAME_LENGTH};
use super::header::{missing, require, twice, Header};
use super::series::{self, Series};
use super::{units, Mode, Options};

/// The role of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// The time.
    Time,
    /// The transmission's input.
    Input,
    /// The transmission's output.
    Output,
    /// A further channel with this name.
    Channel(String),
}

/// Indices of the columns in the header.
pub(super) struct Roles {
    pub(super) mode: Mode,
    /// `None` if the time comes from the row number.
    pub(super) time: Option<usize>,
    pub(super) input: usize,
    pub(super) output: usize,
    pub(super) channels: Vec<(String, Series)>,
    pub(super) notes: Vec<String>,
}

impl Roles {
    /// The series that are read, in the order input, output, channels.
    pub(super) fn series(&self) -> impl Iterator<Item = Series> + '_ {
        [self.input, self.output]
            .into_iter()
            .map(Series::Column)
            .chain(self.channels.iter().map(|(_, series)| *series))
    }

    /// The columns of the sums and differences, channel by channel.
    pub(super) fn parts(&self) -> impl Iterator<Item = Series> + '_ {
        let parts = |(_, series): &(String, Series)| series.parts().map(Series::Column);
        self.channels.iter().flat_map(parts)
    }

    /// The columns that are read, except for the time.
    pub(super) fn read(&self) -> impl Iterator<Item = usize> + '_ {
        self.series().flat_map(Series::columns)
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

/// The role of each column. Two columns with the same name cannot be read. Columns that are not
/// read may have any name.
pub(super) fn assign(header: &mut Header, options: &Options) -> Result<Roles, RecordError> {
    let said = take_units(header, options);
    let mut roles = parts(header, options)?;
    let used: Vec<usize> = roles.read().chain(roles.time).collect();
    twice(header, |index| used.contains(&index))?;
    roles.notes.extend(said);
    if let Some(column) = roles.time.map(|index| &mut header.columns[index]) {
        if column.unit.is_none() {
            column.unit = units::time_in_name(&column.name).map(str::to_owned);
        }
    }
    Ok(roles)
}

/// Gives every column a role, to view a table before the columns have been chosen.
pub(super) fn of_any(header: &mut Header, options: &Options) -> Result<Roles, RecordError> {
    let time = time(header, options).ok();
    let mut others = (0..header.columns.len()).filter(|index| Some(*index) != time);
    let (Some(input), Some(output)) = (others.next(), others.next()) else {
        return Err(RecordError::at(
            header.line,
            "the file has fewer than two columns",
        ));
    };
    Ok(Roles {
        mode: Mode::Torque,
        time,
        input,
        output,
        channels: others
            .map(|index| (header.columns[index].name.clone(), Series::Column(index)))
            .collect(),
        notes: Vec::new(),
    })
}

/// The columns whose role follows from the options or their names, even if not all roles are known.
pub(super) fn likely(header: &Header, options: &Options) -> Vec<(usize, Part)> {
    let given = |name: &Option<String>| name.as_ref().and_then(|name| header.find(name));
    let usual = |names: [&str; 2]| names.into_iter().find_map(|name| header.find_usual(name));
    let ends = [
        (time(header, options).ok(), Part::Time),
        (
            given(&options.input).or_else(|| usual(["tau_i", "x"])),
            Part::Input,
        ),
        (
            given(&options.output).or_else(|| usual(["tau_o", "f"])),
            Part::Output,
        ),
    ];
    let channels = options
        .channels
        .iter()
        .map(|(name, column)| (header.find(column), Part::Channel(name.clone())));
    let names = [Mode::Torque, Mode::Displacement].map(default_channels);
    let usual = names.into_iter().flatten();
    let usual = usual.map(|name| (header.find_usual(name), Part::Channel((*name).to_owned())));
    let mut found: Vec<(usize, Part)> = Vec::new();
    for (index, part) in ends.into_iter().chain(channels).chain(usual) {
        if let Some(index) = index.filter(|index| found.iter().all(|(own, _)| own != index)) {
            found.push((index, part));
        }
    }
    found
}

/// Sets the units that the options specify after column names.
fn take_units(header: &mut Header, options: &Options) -> Vec<String> {
    let ends = [
        ("--time", &options.time),
        ("--input", &options.input),
        ("--output", &options.output),
    ];
    let ends = ends
        .into_iter()
        .filter_map(|(option, text)| Some((option, text.as_deref()?)));
    let channels = options.channels.iter().flat_map(|(_, text)| {
        let parts = series::splits(text)
            .into_iter()
            .flat_map(|(a, _, b)| [a, b]);
        std::iter::once(text.as_str()).chain(parts)
    });
    let channels = channels.map(|text| ("--channel", text));
    ends.chain(channels)
        .filter_map(|(option, text)| header.take_unit(option, text))
        .collect()
}

fn parts(header: &Header, options: &Options) -> Result<Roles, RecordError> {
    // A name that is not there says more than a mode that does not follow from it.
    for (name, option) in [(&options.input, "--input"), (&options.output, "--output")] {
        if let Some(name) = name {
            require(header, name, &format!("{option} COL selects another one"))?;
        }
    }
    let mode = mode(header, options)?;
    let (input, output) = ends(mode);
    let time = match options.rate {
        Some(_) => None,
        None => Some(time(header, options)?),
    };
    let end = |given: &Option<String>, usual: &str, hint: &str| match given {
        Some(name) => require(header, name, hint),
        None => match header.find_usual(usual) {
            Some(index) => Ok(index),
            None => require(header, usual, hint),
        },
    };
    let input = end(&options.input, input, "--input COL selects another one")?;
    let output = end(&options.output, output, "--output COL selects another one")?;
    let refuse = |index: usize, message: String| {
        Err(RecordError::at(header.line, message).on(&header.columns[index].name))
    };
    if input == output {
        return refuse(
            input,
            "this column cannot be both input and output".to_owned(),
        );
    }
    if let Some(time) = time.filter(|time| *time == input || *time == output) {
        return refuse(
            time,
            "this column is the time, so it cannot also be input or output".to_owned(),
        );
    }
    let channels = channels(header, options, mode)?;
    let explains = |series: &Series| series.columns().any(|index| index == output);
    if let Some((name, _)) = channels.iter().find(|(_, series)| explains(series)) {
        let name = shown(name, NAME_LENGTH);
        return refuse(
            output,
            format!("this column is the output, so it cannot also be channel `{name}`"),
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

/// Usual names of the time column. The first name that exists is used.
const TIMES: [&str; 3] = ["t", "time", "timestamp"];

/// The time column. `T` without a unit is not used, because it may be a temperature.
fn time(header: &Header, options: &Options) -> Result<usize, RecordError> {
    let hint = "--time COL selects another one; --rate HZ computes the time from the row number";
    let usual = |index: &usize| {
        let column = &header.columns[*index];
        let unit = column.unit.as_deref();
        column.name == "t"
            || TIMES[1..]
                .iter()
                .any(|name| column.name.eq_ignore_ascii_case(name))
            || unit.is_some_and(|unit| unit.contains(':') || units::seconds(Some(unit)).is_some())
    };
    match &options.time {
        Some(name) => require(header, name, hint),
        None => {
            let known = TIMES
                .iter()
                .find_map(|name| header.find_usual(name).filter(usual));
            match known.or_else(|| header.find_time()) {
                Some(index) => Ok(index),
                None => Err(missing(header, "t", hint)),
            }
        }
    }
}

fn mode(header: &Header, options: &Options) -> Result<Mode, RecordError> {
    if let Some(mode) = options.mode {
        return Ok(mode);
    }
    let ask = |message: String| {
        let message = format!("{message}; set --mode torque or --mode displacement");
        Err(RecordError::at(header.line, message))
    };
    // Exact names first: `X` next to `tau_i` and `tau_o` does not make a second mode.
    let exact = ["tau_i", "tau_o", "x", "f"]
        .iter()
        .any(|name| header.columns.iter().any(|column| column.name == *name));
    let has = |name: &str| match exact {
        true => header.columns.iter().any(|column| column.name == name),
        false => header.find_usual(name).is_some(),
    };
    let (mut torque, mut displacement) = (false, false);
    let mapped: Vec<&str> = options
        .input
        .iter()
        .chain(&options.output)
        .map(|text| units::stated(text).map_or(text.as_str(), |(name, _)| name))
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
            ask("the named columns do not determine the mode".to_owned())
        }
        (false, false) => {
            let list = header.list();
            let message = format!(
                "the columns {list} include neither `tau_i` and `tau_o` nor `x` and `f`; set --mode, and name the columns with --input and --output"
            );
            Err(RecordError::at(header.line, message))
        }
    }
}

fn channels(
    header: &Header,
    options: &Options,
    mode: Mode,
) -> Result<Vec<(String, Series)>, RecordError> {
    let mut channels: Vec<(String, Series)> = Vec::new();
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
        channels.push((name.clone(), series::parse(header, options, column)?));
    }
    for name in default_channels(mode) {
        let given = channels.iter().any(|(other, _)| other == name);
        if let (false, Some(index)) = (given, header.find_usual(name)) {
            // A column that the user gave another part is not a channel as well.
            let free = ![&options.time, &options.input, &options.output]
                .iter()
                .any(|option| {
                    option.as_deref().and_then(|other| header.find(other)) == Some(index)
                });
            let own = Series::Column(index);
            let free = free && !channels.iter().any(|(_, other)| *other == own);
            channels.extend(free.then(|| ((*name).to_owned(), own)));
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
    (!unused.is_empty()).then(|| format!("columns not read: {}", listed(&unused)))
}
