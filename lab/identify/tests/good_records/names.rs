//! Names of columns as data acquisition programs write them.

use super::{csv, rows};
use bowden_lab::record::{parse, Mode, Options, Record};

fn ends(input: &str, output: &str) -> Options {
    Options {
        mode: Some(Mode::Displacement),
        input: Some(input.to_owned()),
        output: Some(output.to_owned()),
        ..Options::default()
    }
}

fn read(text: &str, options: &Options) -> Record {
    parse(text.as_bytes(), "r.csv", options).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn columns_of_one_name_that_are_not_read_may_have_it() {
    let wide: Vec<String> = rows().iter().map(|row| format!("{row},0,0")).collect();
    let text = csv("t,x,f,Not selected,Not selected", &wide);
    let record = read(&text, &Options::default());
    assert_eq!(
        record.notes,
        ["columns not read: `Not selected`, `Not selected`"]
    );
}

/// Of each channel its time and its values, with the names behind a label.
#[test]
fn pairs_of_time_and_value_are_read_by_the_rate_or_by_given_names() {
    let pairs = |row: &String| {
        let cells: Vec<&str> = row.split(',').collect();
        format!("{},{},{},{}", cells[0], cells[2], cells[0], cells[1])
    };
    let head = "Started,2026-03-01,Started,2026-03-01\nChannel,\"Force\",Channel,\"Travel\"\nUnit,\"N\",Unit,\"mm\"";
    let text = csv(head, &rows().iter().map(pairs).collect::<Vec<_>>());
    let rate = Options {
        rate: Some(100.0),
        ..ends("Travel", "Force")
    };
    let named = Options {
        names: ["t", "f [N]", "", "x [mm]"].map(str::to_owned).to_vec(),
        ..Options::default()
    };
    for options in [rate, named] {
        let record = read(&text, &options);
        assert_eq!(record.input.unit.as_deref(), Some("mm"));
        assert_eq!(record.output.unit.as_deref(), Some("N"));
        assert!((record.time[399] - 3.99).abs() < 1e-12);
    }
    let twice = Options {
        time: Some("Channel".to_owned()),
        ..ends("Travel", "Force")
    };
    let line = parse(text.as_bytes(), "r.csv", &twice)
        .unwrap_err()
        .to_string();
    assert_eq!(
        line,
        "r.csv:2: column `Channel`: named twice, as columns 1 and 3; --names A,B,… gives each column its own name"
    );
}

/// The second row has the names of the channels, and the unit of the time.
#[test]
fn names_of_channels_in_the_row_of_units_are_names() {
    let of = |row: &String| {
        let (t, values) = row.split_once(',').unwrap();
        format!("{},{values},0,0", 1e3 * t.parse::<f64>().unwrap())
    };
    let head = "Axis1\nTime,Analog 1,Analog 2,Analog 3,Analog 4\nms,Droop,Torque,Not selected,Not selected";
    let text = csv(head, &rows().iter().map(of).collect::<Vec<_>>());
    for options in [ends("Droop", "Torque"), ends("Analog 1", "Analog 2")] {
        let record = read(&text, &options);
        assert!((record.time[399] - 3.99).abs() < 1e-9);
    }
    let line = parse(text.as_bytes(), "r.csv", &Options::default())
        .unwrap_err()
        .to_string();
    assert!(
        line.starts_with(
            "r.csv:3: the columns `ms`, `Droop`, `Torque`, `Not selected` include neither"
        ),
        "{line}"
    );
}
