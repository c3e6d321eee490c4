//! The test vector beside each model.

use crate::hand_over::rig::{files, record};
use crate::shell::{args, bowden, said, Folder};
use bowden::effect::Motion;
use bowden::model::{Model, ModelState, Sample};
use bowden::Real;
use bowden_lab::export::ModelFile;
use bowden_synth::{Base, Mode, Recipe};
use std::path::Path;

/// Steps a model through a vector, row by row; the largest difference to a column, and the
/// largest answer.
fn replayed<T: Real>(model: &Model<T, 16>, csv: &str, from_last: usize) -> (f64, f64) {
    let mut state = ModelState::new();
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for line in csv.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        let motion = |at: usize| Motion {
            position: T::from_f64(row[at]),
            velocity: T::from_f64(row[at + 1]),
            acceleration: T::from_f64(row[at + 2]),
        };
        let channels: Vec<Motion<T>> = (5..row.len() - 2).step_by(3).map(motion).collect();
        let sample = Sample {
            dt: T::from_f64(row[0]),
            input: motion(1),
            load: T::from_f64(row[4]),
            channels: &channels,
        };
        // The text of an `f32` is the shortest one that reads back to it, as an `f32`.
        let expected = T::from_f64(row[row.len() - from_last]).as_f64();
        let answer = model.step(&mut state, &sample).as_f64();
        worst = worst.max((answer - expected).abs());
        largest = largest.max(expected.abs());
    }
    (worst, largest)
}

fn model(path: &Path) -> ModelFile {
    toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn a_model_steps_through_its_vector_to_the_bit_in_both_precisions() {
    let folder = Folder::new();
    let path = folder.root().join("model.toml");
    said(&["identify", "--model-out", &path.display().to_string()]);
    assert_eq!(files(folder.root()), ["model.toml", "model.vector.csv"]);
    let csv = folder.read("model.vector.csv");
    assert_eq!(
        csv.lines().next().unwrap(),
        "dt,input,input.velocity,input.acceleration,load,phi_p,phi_p.velocity,phi_p.acceleration,phi_d,phi_d.velocity,phi_d.acceleration,output_f32,output_f64"
    );
    let rows = csv.lines().count() - 1;
    assert!((200..=400).contains(&rows), "{rows}");
    // Thinned evenly over the whole record, which takes 20 s; one row more or less.
    let steps = csv.lines().skip(1).map(|l| l.split(',').next().unwrap());
    let seconds: f64 = steps.map(|dt| dt.parse::<f64>().unwrap()).sum();
    assert!((seconds - 20.0).abs() < 0.06, "{seconds}");
    let file = model(&path);
    let (single, largest) = replayed::<f32>(&file.model_in().unwrap(), &csv, 2);
    assert_eq!(single, 0.0);
    let (double, _) = replayed::<f64>(&file.model_in().unwrap(), &csv, 1);
    assert_eq!(double, 0.0);
    // It moves: a model that is wrong in any one number would show.
    assert!(largest > 5.0, "{largest}");
    let mut wrong = file.clone();
    wrong.terms[0].gain *= 1.01;
    let (off, _) = replayed::<f32>(&wrong.model_in().unwrap(), &csv, 2);
    assert!(off > 1e-4 * largest, "{off}");
    let mut wrong = file;
    wrong.transmission.as_mut().unwrap().rho *= 1.01;
    let (off, _) = replayed::<f32>(&wrong.model_in().unwrap(), &csv, 2);
    assert!(off > 1e-4 * largest, "{off}");
}

#[test]
fn with_gains_for_each_file_each_has_its_model_and_its_vector() {
    let folder = Folder::new();
    let csv = |name: &str, kappa_eta: f64, seed: u64| {
        let base = Base {
            gain: 0.95,
            kappa_eta,
            offset: 0.05,
            rho: 0.3,
            sigma: 1.2,
            n: 1.6,
        };
        let recipe = Recipe {
            base: Some(base),
            seed,
            ..Recipe::new(Mode::Torque)
        };
        let path = folder.root().join(name);
        let text = bowden_synth::generate(&recipe).unwrap().to_csv();
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let (one, two) = (csv("straight.csv", 2.0, 1), csv("bent.csv", 4.0, 2));
    let out = folder.root().join("out");
    std::fs::create_dir(&out).unwrap();
    let path = out.join("model.toml").display().to_string();
    said(&args(&format!(
        "identify {one} {two} --per-file gains --model-out {path}"
    )));
    let names = [
        "model-1.toml",
        "model-1.vector.csv",
        "model-2.toml",
        "model-2.vector.csv",
    ];
    assert_eq!(files(&out), names);
    for own in ["1", "2"] {
        let file = model(&out.join(format!("model-{own}.toml")));
        let csv = std::fs::read_to_string(out.join(format!("model-{own}.vector.csv"))).unwrap();
        let (single, _) = replayed::<f32>(&file.model_in().unwrap(), &csv, 2);
        assert_eq!(single, 0.0);
        let about = file.about.unwrap();
        // File names only: folders mean nothing where the model goes.
        assert_eq!(about.records, ["straight.csv", "bent.csv"]);
    }
    let gains_of = |own: &str| model(&out.join(own)).about.unwrap().gains_of.unwrap();
    assert_eq!(gains_of("model-1.toml"), "straight.csv");
    assert_eq!(gains_of("model-2.toml"), "bent.csv");
}

#[test]
fn where_the_vector_cannot_be_written_there_is_no_model_either() {
    let folder = Folder::new();
    // A folder where the vector should go: its name cannot be taken.
    std::fs::create_dir(folder.root().join("model.vector.csv")).unwrap();
    let path = folder.path("model.rs");
    let output = bowden(&["identify", "--model-out", &path]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(files(folder.root()), ["model.vector.csv"]);
}

#[test]
fn where_the_model_cannot_be_written_there_is_no_vector_either() {
    let folder = Folder::new();
    std::fs::create_dir(folder.root().join("model.rs")).unwrap();
    let path = folder.path("model.rs");
    let output = bowden(&["identify", "--model-out", &path]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(files(folder.root()), ["model.rs"]);
}

#[test]
fn a_displacement_model_without_channels_steps_through_its_vector_too() {
    let recipe = Recipe {
        seed: 2,
        ..Recipe::new(Mode::Displacement)
    };
    let told = crate::hand_over::rig::Told::new(record(&recipe), &["bouc-wen"], None);
    let hand = told.hand_over(false);
    let csv = bowden_lab::export::vector::csv(&told.data, 0, &hand.files[0]).unwrap();
    let (single, largest) = replayed::<f32>(&hand.files[0].model_in().unwrap(), &csv, 2);
    assert!(single == 0.0 && largest > 0.0);
}
