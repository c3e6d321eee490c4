//! Damaged records: each fault is named with its lines, and nothing else is.
//!
//! The damage is done here, to the cells of generated records, by code of its own.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod habits;
mod rates;
mod spikes;

use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::finding::Finding;
use bowden_lab::conclude::findings::findings;
use bowden_lab::conclude::verdict::{verdict, Verdict};
use bowden_lab::ledger::Ledger;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{parse, Defect, DefectKind, Options, Record};
use bowden_lab::search::close;
use bowden_synth::{generate, Mode, Planted, Recipe};

/// Cells of a record, row by row, without the header.
struct Cells {
    header: String,
    rows: Vec<Vec<f64>>,
}

/// Columns of a generated record in torque mode.
const T: usize = 0;
const TAU_I: usize = 1;
const TAU_O: usize = 2;
const PHI_P: usize = 3;

impl Cells {
    fn of(recipe: &Recipe) -> Self {
        let text = generate(recipe).unwrap().to_csv();
        let mut lines = text.lines();
        let header = lines.next().unwrap().to_owned();
        let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
        Self {
            header,
            rows: lines.map(row).collect(),
        }
    }

    fn text(&self) -> String {
        let row = |row: &Vec<f64>| row.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        let rows: Vec<String> = self.rows.iter().map(row).collect();
        format!("{}\n{}\n", self.header, rows.join("\n"))
    }

    fn read(&self) -> Record {
        let text = self.text();
        parse(text.as_bytes(), "r.csv", &Options::default()).unwrap_or_else(|e| panic!("{e}"))
    }

    /// A column of the record, changed.
    fn with(column: usize, change: impl Fn(f64) -> f64) -> Self {
        let mut cells = Self::of(&recipe());
        let rows = cells.rows.iter_mut();
        rows.for_each(|row| row[column] = change(row[column]));
        cells
    }

    /// The sensor repeats the value of row `from` until row `to`.
    fn freeze(&mut self, column: usize, from: usize, to: usize) {
        let value = self.rows[from][column];
        self.rows[from..=to]
            .iter_mut()
            .for_each(|row| row[column] = value);
    }

    fn low_and_high(&self, column: usize) -> (f64, f64) {
        let values = || self.rows.iter().map(|row| row[column]);
        (
            values().fold(f64::MAX, f64::min),
            values().fold(f64::MIN, f64::max),
        )
    }
}

/// Line of the file in which row `row` stands: the header is line 1.
fn line(row: usize) -> usize {
    row + 2
}

/// Twenty seconds at 500 Hz with an effect to be found.
fn recipe() -> Recipe {
    Recipe {
        rate: 500.0,
        seed: 7,
        effects: vec![Planted::new("viscous")],
        ..Recipe::new(Mode::Torque)
    }
}

fn only(record: &Record) -> &Defect {
    match record.defects.as_slice() {
        [one] => one,
        all => panic!("{all:#?}"),
    }
}

fn assert_named(defect: &Defect, kind: DefectKind, channel: &str) {
    assert_eq!(
        (defect.kind, defect.channel.as_str()),
        (kind, channel),
        "{defect:?}"
    );
    assert!(!defect.message.contains('\n'));
}

/// Pseudo-random in −1…1, by row: the fraction of a large sine (an old trick of shaders).
fn noise(row: usize) -> f64 {
    2.0 * ((row as f64 * 12.9898).sin() * 43758.5453).rem_euclid(1.0) - 1.0
}

fn names(ledger: &Ledger) -> Vec<&str> {
    let rounds = ledger.rounds.iter();
    rounds.map(|r| r.candidate.term.effect.name()).collect()
}

fn verdict_of(data: &Prepared, ledger: &Ledger) -> Verdict {
    verdict(data, ledger, &FinalFit::new(data, ledger))
}

fn closed(record: &Record) -> (Prepared, Ledger) {
    let data = Prepared::new(record, Preparation::default()).unwrap();
    let declared = structure(&["bouc-wen".to_owned()], &data).unwrap();
    let ledger = close(&data, &declared, |_| ()).unwrap();
    (data, ledger)
}

#[test]
fn a_sound_record_has_no_defects_whatever_its_sensors() {
    for mode in [Mode::Torque, Mode::Displacement] {
        for seed in 1..=2 {
            let plain = Recipe {
                seed,
                seconds: 12.0,
                ..Recipe::new(mode)
            };
            let with = |set: fn(&mut Recipe)| {
                let mut recipe = plain.clone();
                set(&mut recipe);
                recipe
            };
            for recipe in [
                plain.clone(),
                with(|r| r.holds = true),
                with(|r| (r.holds, r.noise) = (true, 0.0)),
                with(|r| (r.noise, r.quantisation, r.resolution) = (0.0, 0.0, 0.0)),
                // Ten bits over the range.
                with(|r| (r.noise, r.quantisation) = (0.0, 0.04)),
                with(|r| (r.noise, r.effects) = (0.01, vec![Planted::new("coulomb")])),
                with(|r| (r.rate, r.effects) = (100.0, vec![Planted::new("backlash")])),
            ] {
                let record = Cells::of(&recipe).read();
                assert_eq!(record.defects, [], "{recipe:?}");
            }
        }
    }
}

#[test]
fn dry_friction_and_a_switched_input_are_flat_by_nature() {
    let mut switched = Cells::of(&recipe());
    let mut flat = Cells::of(&recipe());
    for row in 0..flat.rows.len() {
        let up = |value: f64| if value > 0.0 { 4.0 } else { -4.0 };
        switched.rows[row][TAU_I] = up((row as f64 / 400.0).sin());
        flat.rows[row][TAU_O] = up(flat.rows[row][PHI_P]);
    }
    assert_eq!(switched.read().defects, []);
    assert_eq!(flat.read().defects, []);
}

/// Also where it dies before the end.
#[test]
fn a_stuck_sensor_is_named_with_its_lines() {
    for (column, name) in [(TAU_I, "tau_i"), (TAU_O, "tau_o"), (PHI_P, "phi_p")] {
        for ranges in [&[[3000, 3199], [6100, 6400]][..], &[[9000, 9999]]] {
            let mut cells = Cells::of(&recipe());
            assert_eq!(cells.rows.len(), 10_000);
            for &[from, to] in ranges {
                cells.freeze(column, from, to);
            }
            let record = cells.read();
            assert_named(only(&record), DefectKind::Stuck, name);
            let lines: Vec<_> = ranges.iter().map(|own| own.map(line)).collect();
            assert_eq!(only(&record).ranges, lines);
        }
    }
}

#[test]
fn mild_clipping_is_a_defect_and_heavy_clipping_a_refusal() {
    let sound = Cells::of(&recipe());
    let (_, high) = sound.low_and_high(TAU_O);
    let level = high - 0.8;
    let cut = |level: f64| Cells::with(TAU_O, |value| value.min(level));
    let samples = sound.rows.len() as f64;
    // What stands above the level is what is clipped, but for noise at its edges.
    let above = sound.rows.iter().filter(|row| row[TAU_O] > level);
    let lost = above.count() as f64 / samples;
    assert!(lost > 0.002 && lost < 0.05, "{lost}");
    let cells = cut(level);
    let record = cells.read();
    let defect = only(&record);
    assert_named(defect, DefectKind::Clipping, "tau_o");
    let named: usize = defect.ranges.iter().map(|[from, to]| to - from + 1).sum();
    let named = named as f64 / samples;
    assert!(named > 0.7 * lost && named <= lost, "{named} of {lost}");
    for [from, to] in &defect.ranges {
        let mut rows = cells.rows[from - 2..=to - 2].iter();
        assert!(rows.all(|row| row[TAU_O] == level));
    }

    let text = cut(0.5 * high).text();
    let error = parse(text.as_bytes(), "r.csv", &Options::default()).unwrap_err();
    let line = error.to_string();
    assert!(line.contains("column `tau_o`: clipped: flat at"), "{line}");
}

#[test]
fn missing_rows_are_named_by_the_lines_around_them() {
    let mut cells = Cells::of(&recipe());
    cells.rows.drain(7000..7250);
    cells.rows.drain(2000..2010);
    let record = cells.read();
    assert_named(only(&record), DefectKind::Gap, "t");
    assert_eq!(
        only(&record).ranges,
        [[line(1999), line(2000)], [line(6989), line(6990)]]
    );
    let (data, ledger) = closed(&record);
    assert_ne!(verdict_of(&data, &ledger), Verdict::DefectiveRecord);
}

#[test]
fn stamps_that_jitter_are_told_from_samples_that_lie_unevenly() {
    // 40 Hz, so that a shift of a third of a step is seen.
    let every = 25;
    let source = Cells::of(&Recipe {
        rate: 1000.0,
        noise: 0.01,
        seconds: 40.0,
        ..recipe()
    });
    let rows = 1..source.rows.len() / every - 1;
    let shift = |k: usize| (8.0 * noise(k)).round() as isize;
    let at = |k: usize, by: isize| &source.rows[(k * every).saturating_add_signed(by)];
    let thinned = |row: &dyn Fn(usize) -> Vec<f64>| Cells {
        header: source.header.clone(),
        rows: rows.clone().map(row).collect(),
    };
    let sound = thinned(&|k| at(k, 0).clone());
    let uneven = thinned(&|k| at(k, shift(k)).clone());
    let jittered = thinned(&|k| {
        let mut row = at(k, 0).clone();
        row[T] = at(k, shift(k))[T];
        row
    });
    assert_eq!(sound.read().defects, []);
    assert_eq!(uneven.read().defects, []);
    let record = jittered.read();
    assert_named(only(&record), DefectKind::Jitter, "t");
    let ranges = &only(&record).ranges;
    let named: usize = ranges.iter().map(|[from, to]| to - from + 1).sum();
    // But for the ends, where there is nothing to compare with.
    assert!(named as f64 > 0.9 * rows.len() as f64, "{ranges:?}");
}

#[test]
fn coarse_steps_are_a_defect_only_where_they_matter() {
    for (column, name) in [(TAU_I, "tau_i"), (TAU_O, "tau_o"), (PHI_P, "phi_p")] {
        let counted = |counts: f64| {
            let (low, high) = Cells::of(&recipe()).low_and_high(column);
            let step = (high - low) / counts;
            Cells::with(column, |value| (value / step).round() * step).read()
        };
        let record = counted(10.0);
        assert_named(only(&record), DefectKind::Quantisation, name);
        assert_eq!(only(&record).ranges, [[line(0), line(9999)]]);
        // Ten bits.
        assert_eq!(counted(1024.0).defects, []);
    }
}

#[test]
fn what_is_concluded_from_a_stuck_input_is_a_data_defect() {
    let mut cells = Cells::of(&recipe());
    cells.freeze(TAU_I, 2500, 3300);
    let (data, ledger) = closed(&cells.read());
    assert_eq!(verdict_of(&data, &ledger), Verdict::DefectiveRecord);
    let done = FinalFit::new(&data, &ledger);
    let found = findings(&data, &ledger, &done, Verdict::DefectiveRecord);
    let is_stuck = |f: &Finding| match f {
        Finding::DefectiveMeasurement { defects } => {
            let mut all = defects.iter();
            all.any(|d| (d.kind, &*d.channel) == (DefectKind::Stuck, "tau_i"))
        }
        _ => false,
    };
    assert!(found.iter().any(is_stuck), "{found:#?}");
}

#[test]
fn a_short_dropout_of_the_output_is_left_out_and_changes_no_name() {
    let sound = closed(&Cells::of(&recipe()).read());
    let mut cells = Cells::of(&recipe());
    cells.freeze(TAU_O, 2500, 2650);
    cells.freeze(TAU_O, 8800, 8900);
    let (data, ledger) = closed(&cells.read());
    assert_eq!(names(&ledger), names(&sound.1));
    assert_eq!(verdict_of(&data, &ledger), verdict_of(&sound.0, &sound.1));
    // On the rows that are left both models are as good: the dropped stretches, bridged,
    // are off by whole N·m, the noise behind the filter by 0.01.
    let rms = |residual: &[f64], rows: &[usize]| {
        let squares: f64 = rows.iter().map(|&i| residual[i].powi(2)).sum();
        (squares / rows.len() as f64).sqrt()
    };
    for rows in [&data.split.fit, &data.split.held_out] {
        let with = rms(&ledger.last().residual, rows);
        let without = rms(&sound.1.last().residual, rows);
        assert!((with / without - 1.0).abs() < 0.05, "{with} {without}");
    }
}

#[test]
fn a_stuck_channel_that_nothing_reads_leaves_the_verdict() {
    let mut cells = Cells::of(&recipe());
    cells.freeze(4, 2500, 3300);
    let record = cells.read();
    assert_named(only(&record), DefectKind::Stuck, "phi_d");
    let (data, ledger) = closed(&record);
    assert_ne!(verdict_of(&data, &ledger), Verdict::DefectiveRecord);
}

/// Two encoders that turn against each other, and their sum as channel `stretch`: `b` flickers
/// but for rows 3000 to 3400, where it follows to the last bit.
fn counter_rotating(frozen: Option<(usize, usize)>) -> Record {
    let mut cells = Cells::of(&recipe());
    let added = cells.rows[0].len();
    cells.header += ",a [rad],b [rad]";
    for (index, row) in cells.rows.iter_mut().enumerate() {
        let a = (200.0 * row[PHI_P]).round() / 200.0;
        let still = (3000..=3400).contains(&index);
        let flicker = if still {
            0.0
        } else {
            0.005 * noise(index).round()
        };
        row.extend([a, flicker - a]);
    }
    if let Some((from, to)) = frozen {
        cells.freeze(added + 1, from, to);
    }
    let options = Options {
        channels: vec![("stretch".into(), "a+b".into())],
        ..Options::default()
    };
    parse(cells.text().as_bytes(), "r.csv", &options).unwrap()
}

#[test]
fn a_sum_that_rests_while_its_columns_move_is_not_stuck() {
    let record = counter_rotating(None);
    let stretch = record.channel("stretch").unwrap();
    assert_eq!(stretch.definition.as_deref(), Some("a + b"));
    let rests = |range: std::ops::Range<usize>| {
        let of = &stretch.values[range];
        of.iter().all(|value| *value == of[0])
    };
    assert!(rests(3000..3400) && !rests(2900..3000));
    assert_eq!(record.defects, []);
    // Where the sensor of one of them is stuck, so is the sum.
    let record = counter_rotating(Some((5000, 5200)));
    let stuck = only(&record);
    assert_named(stuck, DefectKind::Stuck, "stretch");
    assert_eq!(stuck.ranges, [[line(5000), line(5200)]]);
    let message = &stuck.message;
    assert!(
        message.starts_with("the second column of a + b is stuck once"),
        "{message}"
    );
}
