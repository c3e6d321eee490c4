//! JSON: arrays of records, one record a line, objects of columns.

use super::*;

fn cells() -> Vec<[String; 3]> {
    let cells = |row: &String| {
        let cells: Vec<String> = row.split(',').map(str::to_owned).collect();
        cells.try_into().unwrap()
    };
    rows().iter().map(cells).collect()
}

/// One record for each row, with what is put behind its numbers.
fn records(more: &str) -> Vec<String> {
    let of = |[t, x, f]: [String; 3]| format!("{{\"t\": {t}, \"x\": {x}, \"f\": {f}{more}}}");
    cells().into_iter().map(of).collect()
}

/// The cells of a column, each in its form.
fn list(column: usize, form: fn(usize, &str) -> String) -> String {
    let own = cells().into_iter().enumerate();
    let own: Vec<String> = own.map(|(i, row)| form(i, &row[column])).collect();
    own.join(",")
}

fn array(column: usize) -> String {
    format!("[{}]", list(column, |_, cell| cell.to_owned()))
}

#[test]
fn records_and_columns_are_read_wherever_they_are() {
    let own = records(", \"note\": \"a; \\\"b\\\"\", \"ok\": true, \"list\": [1, 2]");
    let all = format!("[{}]", own.join(",\n"));
    let [t, x, f] = [0, 1, 2].map(array);
    let columns = format!("{{\"t\": {t}, \"x\": {x}, \"f\": {f}}}");
    let numbered = |column| list(column, |i, cell| format!("\"{i}\":{cell}"));
    let [nt, nx, nf] = [0, 1, 2].map(numbered);
    let by_index = (0..).zip(&own).map(|(i, own)| format!("\"{i}\":{own}"));
    let by_index: Vec<String> = by_index.collect::<Vec<_>>();
    let split = format!("[{}]", rows().join("],["));
    let names = "[\"t\", \"x\", \"f\"]";
    for text in [
        all.clone(),
        own.join("\n"),
        format!("{{\"rig\": {{\"gains\": [1, 2, 3], \"name\": \"left\"}}, \"samples\": {all}}}"),
        columns.clone(),
        format!("\u{feff}\n{columns}"),
        format!("{{\"run\": {{\"data\": {columns}}}, \"date\": \"now\"}}"),
        format!("{{\"t\":{{{nt}}},\"x\":{{{nx}}},\"f\":{{{nf}}}}}"),
        format!("{{{}}}", by_index.join(",")),
        format!("{{\"columns\": {names}, \"data\": [{split}]}}"),
        // The index that pandas writes next to the rows.
        format!("{{\"columns\": {names}, \"index\": {t}, \"data\": [{split}]}}"),
        format!("[{names}, {split}]"),
        format!("{names}\n{}", split.replace("],[", "]\n[")),
    ] {
        same_numbers(&text, &Options::default());
    }
    for text in [format!("[{split}]"), split.replace("],[", "]\n[")] {
        let record = same_numbers(&text, &named(&["t", "x [mm]", "f"]));
        assert_eq!(units(&record)[0], Some("mm"));
    }
}

#[test]
fn names_of_json_have_units_and_paths() {
    let [t, x, f] = [0, 1, 2].map(array);
    let record = accepted(format!(
        "{{\"t\": {{\"unit\": \"ms\", \"values\": {t}}}, \"x [mm]\": {x}, \"f_N\": {f}}}"
    ));
    assert!((record.time[399] - 0.003_99).abs() < 1e-12);
    assert_eq!(units(&record), [Some("mm"), Some("N")]);
    // Paths count where the last part of a name says nothing.
    let own = cells().into_iter().map(|[t, x, f]| {
        format!("{{\"stamp\": {t}, \"motor\": {{\"x\": [{x}, 0]}}, \"joint\": {{\"x\": [{f}]}}}}")
    });
    let text: Vec<String> = own.collect();
    let mut options = ends("motor.x.0", "joint.x.0");
    options.time = Some("stamp".to_owned());
    let unread = "columns not read: `motor.x.1`";
    same(text.join("\n"), &options, &[unread]);
}

#[test]
fn cells_of_json_are_those_of_a_text() {
    let clock = |i: usize, row: &str| {
        let (x, f) = row[5..].split_once(',').unwrap();
        let (second, part) = (i / 100, i % 100);
        format!("{{\"t\": \"2026-03-01T10:00:0{second}.{part:02}Z\", \"x\": {x}, \"f\": {f}}}")
    };
    let text = changed("", clock);
    let record = accepted(text.trim());
    assert!((record.time[399] - 3.99).abs() < 1e-6);
    assert_eq!(record.notes, ["time stamps are times of day"]);
    // A log that was cut off loses its last record.
    let cut = records("").join("\n");
    let record = accepted(&cut[..cut.len() - 9]);
    assert_eq!(record.samples(), 399);
    let said = "the last line, 400, is truncated and was dropped";
    assert_eq!(record.notes, [said]);
}
