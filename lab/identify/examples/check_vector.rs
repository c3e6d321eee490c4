//! Steps a model through its test vector, as a firmware's own build of it should.
//!
//! `cargo run -p bowden-lab --example check_vector -- model.toml` (or `model.postcard`) reads
//! `model.vector.csv` beside it; without an argument the repository's own
//! `examples/data/demo.toml`. Prints the largest differences, and fails where one is more
//! than rounding.

use bowden::effect::Motion;
use bowden::model::{Model, ModelState, Sample};
use bowden::Real;
use std::error::Error;
use std::path::{Path, PathBuf};

/// Any capacity that is not smaller than the number of terms.
const TERMS: usize = 16;

/// Of the largest output. Another processor or another `libm` may round otherwise; what a
/// state keeps of that is of this size after 400 samples.
const ROUNDING: f64 = 64.0;

/// The model in single precision, as firmware has it.
fn single(path: &Path) -> Result<Model<f32, TERMS>, Box<dyn Error>> {
    if path.extension().is_some_and(|e| e == "postcard") {
        let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
        let bytes = std::fs::read(path)?;
        return Ok(postcard::from_bytes_crc32(&bytes, crc.digest())?);
    }
    Ok(toml::from_str(&std::fs::read_to_string(path)?)?)
}

/// The largest difference to the expected outputs, and the largest of these.
///
/// Columns: dt; input, its velocity, its acceleration; load; each channel likewise; the
/// output in `f32`, in `f64`. `back` counts from the last one.
fn step_through<T: Real>(
    model: &Model<T, TERMS>,
    vector: &Path,
    back: usize,
) -> Result<(f64, f64), Box<dyn Error>> {
    let mut state = ModelState::new();
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for row in csv::Reader::from_path(vector)?.records() {
        let row = row?;
        let numbers: Result<Vec<f64>, _> = row.iter().map(str::parse::<f64>).collect();
        // All but the last column are texts of `f32`.
        let numbers: Vec<T> = numbers?.into_iter().map(T::from_f64).collect();
        let &[dt, x, v, a, load, ref rest @ ..] = &numbers[..] else {
            return Err("at least seven columns are allowed".into());
        };
        let (channels, expected) = rest.split_at(rest.len().saturating_sub(2));
        let motion = |m: &[T]| Motion {
            position: m[0],
            velocity: m[1],
            acceleration: m[2],
        };
        let channels: Vec<Motion<T>> = channels.chunks_exact(3).map(motion).collect();
        let sample = Sample {
            dt,
            input: motion(&[x, v, a]),
            load,
            channels: &channels,
        };
        let expected = expected.get(2 - back).copied().ok_or("no output")?;
        let output = model.step(&mut state, &sample);
        worst = worst.max((output - expected).abs().as_f64());
        largest = largest.max(expected.abs().as_f64());
    }
    Ok((worst, largest))
}

/// Steps the model through the vector beside it; what it found.
pub fn check(path: &Path) -> Result<String, Box<dyn Error>> {
    let vector = path.with_extension("vector.csv");
    let (worst, largest) = step_through(&single(path)?, &vector, 2)?;
    let mut found = format!("f32: at most {worst:e} of {largest}");
    let allowed = ROUNDING * f64::from(f32::EPSILON) * largest;
    if worst.is_nan() || worst > allowed {
        return Err(format!("the model does not give its vector: {worst:e} > {allowed:e}").into());
    }
    if path.extension().is_some_and(|e| e == "toml") {
        let model: Model<f64, TERMS> = toml::from_str(&std::fs::read_to_string(path)?)?;
        let (worst, _) = step_through(&model, &vector, 1)?;
        found += &format!("; f64: at most {worst:e}");
        let allowed = ROUNDING * f64::EPSILON * largest;
        if worst.is_nan() || worst > allowed {
            return Err(format!("in f64: {worst:e} > {allowed:e}").into());
        }
    }
    Ok(found)
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).map_or_else(
        || {
            PathBuf::from(concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/../../examples/data/demo.toml"
            ))
        },
        PathBuf::from,
    );
    println!("{}: {}", path.display(), check(&path)?);
    Ok(())
}
