//! The record that is built into the program, stored as the counts of its sensors.
//!
//! Generating it takes longer than identifying it. Therefore the output of
//! [`generate`](crate::generate) for [`stored_recipe`] is stored: for each column except the time,
//! the difference between the counts of successive samples as a zigzag variable-length integer;
//! then the samples that are a negative zero.

use super::{csv, Column, Mode, Planted, Recipe};

const COUNTS: &[u8] = include_bytes!("stored.bin");

/// The recipe of the stored record.
pub fn stored_recipe() -> Recipe {
    Recipe {
        effects: vec![Planted::new("viscous")],
        seed: 7,
        ..Recipe::new(Mode::Torque)
    }
}

/// The stored record as a CSV file, byte for byte as generated.
pub fn stored_csv() -> String {
    csv(&columns(&stored_recipe(), COUNTS))
}

/// Name, unit and count of the columns that are stored.
fn sensors(recipe: &Recipe) -> [(&'static str, &'static str, f64); 4] {
    let (torque, angle) = (recipe.quantisation, recipe.resolution);
    [
        ("tau_i", "N·m", torque),
        ("tau_o", "N·m", torque),
        ("phi_p", "rad", angle),
        ("phi_d", "rad", angle),
    ]
}

fn columns(recipe: &Recipe, stored: &[u8]) -> Vec<Column> {
    let samples = (recipe.seconds * recipe.rate) as usize;
    let time = |k: usize| k as f64 / recipe.rate;
    let mut columns = vec![Column {
        name: "t",
        unit: "s",
        values: (0..samples).map(time).collect(),
    }];
    let mut bytes = stored.iter();
    for (name, unit, count) in sensors(recipe) {
        let mut last = 0;
        let mut next = || {
            let change = number(&mut bytes);
            last += (change >> 1) as i64 ^ -((change & 1) as i64);
            last as f64 * count
        };
        let mut values: Vec<f64> = (0..samples).map(|_| next()).collect();
        let mut sample = 0;
        for _ in 0..number(&mut bytes) {
            sample += number(&mut bytes) as usize;
            if let Some(value) = values.get_mut(sample) {
                *value = -*value;
            }
        }
        columns.push(Column { name, unit, values });
    }
    columns
}

/// Seven bits a byte, the lowest first; the last byte is below 128.
fn number<'a>(bytes: &mut impl Iterator<Item = &'a u8>) -> u64 {
    let mut number = 0;
    for (place, byte) in bytes.by_ref().take(9).enumerate() {
        number |= u64::from(byte & 127) << (7 * place);
        if *byte < 128 {
            break;
        }
    }
    number
}

#[cfg(test)]
mod tests {
    use super::super::generate;
    use super::*;

    fn push(mut number: u64, bytes: &mut Vec<u8>) {
        while number >= 128 {
            bytes.push(number as u8 | 128);
            number >>= 7;
        }
        bytes.push(number as u8);
    }

    fn stored(columns: &[Column], recipe: &Recipe) -> Vec<u8> {
        let mut bytes = Vec::new();
        for (column, (name, _, count)) in columns[1..].iter().zip(sensors(recipe)) {
            assert_eq!(column.name, name);
            let mut last = 0;
            for value in &column.values {
                let now = (value / count).round() as i64;
                let change: i64 = now - last;
                push((change << 1 ^ change >> 63) as u64, &mut bytes);
                last = now;
            }
            let is_minus_zero = |value: f64| value == 0.0 && value.is_sign_negative();
            let all = column.values.iter().enumerate();
            let minus: Vec<usize> = all
                .filter(|(_, v)| is_minus_zero(**v))
                .map(|(k, _)| k)
                .collect();
            push(minus.len() as u64, &mut bytes);
            let mut last = 0;
            for sample in minus {
                push((sample - last) as u64, &mut bytes);
                last = sample;
            }
        }
        bytes
    }

    #[test]
    fn the_stored_record_is_byte_for_byte_what_its_recipe_makes() {
        let made = generate(&stored_recipe()).unwrap();
        // Not assert_eq: a megabyte each would be printed.
        assert!(
            stored_csv() == made.to_csv(),
            "write it anew: cargo test -p bowden-synth --lib stored -- --ignored"
        );
    }

    #[test]
    #[ignore = "rewrites stored.bin, next to this file"]
    fn the_record_is_stored() {
        let recipe = stored_recipe();
        let bytes = stored(&generate(&recipe).unwrap().columns, &recipe);
        let package = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        std::fs::write(package.join("src/stored.bin"), bytes).unwrap();
    }
}
