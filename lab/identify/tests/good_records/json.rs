//! JSON: arrays of records, one record a line, objects of columns.

use super::{accepted, csv, rows};
use bowden_lab::record::{parse, Options, Record};

fn cells() -> Vec<Vec<String>> {
    let cells = |row: &String| row.split(',').map(str::to_owned).collect();
    rows().iter().map(cells).collect()
}

/// One record for each row, with names and what is put behind them.
fn records(names: [&str; 3], more: &str) -> Vec<String> {
    let of = |row: Vec<String>| {
        let fields: Vec<String> = names
            .iter()
            .zip(row)
            .map(|(name, cell)| format!("\"{name}\": {cell}"))
            .collect();
        format!("{{{}{more}}}", fields.join(", "))
    };
    cells().into_iter().map(of).collect()
}

fn list(of: &str) -> String {
    let column = ["t", "x", "f"].iter().position(|name| *name == of).unwrap();
    let own: Vec<String> = cells().iter().map(|row| row[column].clone()).collect();
    format!("[{}]", own.join(","))
}

fn same(text: &str, options: &Options) -> Record {
    let plain = accepted(csv("t,x,f", &rows()));
    let record = parse(text.as_bytes(), "r.json", options)
        .unwrap_or_else(|error| panic!("{error}: {text:.60}"));
    assert_eq!(record.time, plain.time, "{text:.60}");
    assert_eq!(record.input.values, plain.input.values, "{text:.60}");
    assert_eq!(record.output.values, plain.output.values, "{text:.60}");
    record
}

#[test]
fn records_and_columns_are_read_wherever_they_are() {
    let own = records(
        ["t", "x", "f"],
        ", \"note\": \"a; \\\"b\\\"\", \"ok\": true, \"list\": [1, 2]",
    );
    let array = format!("[{}]", own.join(",\n"));
    let columns = format!(
        "{{\"t\": {}, \"x\": {}, \"f\": {}}}",
        list("t"),
        list("x"),
        list("f")
    );
    let numbered = |name: &str| {
        let list = list(name);
        let values = list.trim_matches(['[', ']']).split(',').enumerate();
        let fields: Vec<String> = values
            .map(|(i, value)| format!("\"{i}\":{value}"))
            .collect();
        format!("\"{name}\":{{{}}}", fields.join(","))
    };
    let pandas = format!("{{{},{},{}}}", numbered("t"), numbered("x"), numbered("f"));
    let split: Vec<String> = rows().iter().map(|row| format!("[{row}]")).collect();
    let split = split.join(",");
    for text in [
        array.clone(),
        own.join("\n"),
        format!("{{\"rig\": {{\"gains\": [1, 2, 3], \"name\": \"left\"}}, \"samples\": {array}}}"),
        columns.clone(),
        format!("\u{feff}\n{columns}"),
        format!("{{\"run\": {{\"data\": {columns}}}, \"date\": \"now\"}}"),
        pandas,
        format!(
            "{{{}}}",
            own.iter()
                .enumerate()
                .map(|(i, own)| format!("\"{i}\":{own}"))
                .collect::<Vec<_>>()
                .join(",")
        ),
        format!("{{\"columns\": [\"t\", \"x\", \"f\"], \"data\": [{split}]}}"),
        // The index that pandas writes next to the rows.
        format!(
            "{{\"columns\": [\"t\", \"x\", \"f\"], \"index\": {}, \"data\": [{split}]}}",
            list("t")
        ),
        format!("[[\"t\", \"x\", \"f\"], {split}]"),
        format!("[\"t\", \"x\", \"f\"]\n{}", split.replace("],[", "]\n[")),
    ] {
        same(&text, &Options::default());
    }
    let named = Options {
        names: ["t", "x [mm]", "f"].map(str::to_owned).to_vec(),
        ..Options::default()
    };
    for text in [format!("[{split}]"), split.replace("],[", "]\n[")] {
        let record = same(&text, &named);
        assert_eq!(record.input.unit.as_deref(), Some("mm"));
    }
}

#[test]
fn names_of_json_have_units_and_paths() {
    let units = format!(
        "{{\"t\": {{\"unit\": \"ms\", \"values\": {}}}, \"x [mm]\": {}, \"f_N\": {}}}",
        list("t"),
        list("x"),
        list("f")
    );
    let record = accepted(units);
    assert!((record.time[399] - 0.003_99).abs() < 1e-12);
    assert_eq!(record.input.unit.as_deref(), Some("mm"));
    assert_eq!(record.output.unit.as_deref(), Some("N"));
    // Paths count where the last part of a name says nothing.
    let own = cells().into_iter().map(|row| {
        let [t, x, f] = [0, 1, 2].map(|index| row[index].clone());
        format!("{{\"stamp\": {t}, \"motor\": {{\"x\": [{x}, 0]}}, \"joint\": {{\"x\": [{f}]}}}}")
    });
    let text: Vec<String> = own.collect();
    let options = Options {
        mode: Some(bowden_lab::record::Mode::Displacement),
        time: Some("stamp".to_owned()),
        input: Some("motor.x.0".to_owned()),
        output: Some("joint.x.0".to_owned()),
        ..Options::default()
    };
    let record = same(&text.join("\n"), &options);
    assert_eq!(record.notes, ["columns not read: `motor.x.1`"]);
}

#[test]
fn cells_of_json_are_those_of_a_text() {
    let own = records(["t", "x", "f"], "");
    let clock = |(i, own): (usize, &String)| {
        let stamp = format!("\"2026-03-01T10:00:0{}.{:02}Z\"", i / 100, i % 100);
        let old = format!("\"t\": {}", cells()[i][0]);
        own.replace(&old, &format!("\"t\": {stamp}"))
    };
    let stamped: Vec<String> = own.iter().enumerate().map(clock).collect();
    let record = accepted(stamped.join("\n"));
    assert!((record.time[399] - 3.99).abs() < 1e-6);
    assert_eq!(record.notes, ["time stamps are times of day"]);
    // A log that was cut off loses its last record.
    let cut = own.join("\n");
    let record = accepted(&cut[..cut.len() - 9]);
    assert_eq!(record.samples(), 399);
    assert_eq!(
        record.notes,
        ["the last line, 400, is truncated and was dropped"]
    );
}
