//! The test vector beside each model.

use crate::hand_over::{demo, recipe, Told, STEEP};
use crate::shell::{refused, said, Folder};
use bowden::effect::Motion;
use bowden::model::{Model, ModelState, Sample};
use bowden::Real;
use bowden_lab::export::{vector, ModelFile};
use bowden_synth::{Base, Mode, Recipe};

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

/// The same of a file in single precision.
fn single(file: &ModelFile, csv: &str) -> (f64, f64) {
    replayed::<f32>(&file.model_in().unwrap(), csv, 2)
}

#[test]
fn a_model_steps_through_its_vector_to_the_bit_in_both_precisions() {
    let (file, csv) = (&demo(false).file, &demo(false).vector);
    let motion = |of: &str| format!("{of},{of}.velocity,{of}.acceleration");
    let [input, phi_p, phi_d] = ["input", "phi_p", "phi_d"].map(motion);
    let names = format!("dt,{input},load,{phi_p},{phi_d},output_f32,output_f64");
    assert_eq!(csv.lines().next().unwrap(), names);
    let rows = csv.lines().count() - 1;
    assert!((200..=400).contains(&rows), "{rows}");
    // Thinned evenly over the whole record, which takes 20 s; one row more or less.
    let steps = csv.lines().skip(1).map(|l| l.split(',').next().unwrap());
    let seconds: f64 = steps.map(|dt| dt.parse::<f64>().unwrap()).sum();
    assert!((seconds - 20.0).abs() < 0.06, "{seconds}");
    let (worst, largest) = single(file, csv);
    assert_eq!(worst, 0.0);
    let (double, _) = replayed::<f64>(&file.model_in().unwrap(), csv, 1);
    assert_eq!(double, 0.0);
    // It moves: a model that is wrong in any one number would show.
    assert!(largest > 5.0, "{largest}");
    let mut gain = file.clone();
    gain.terms[0].gain *= 1.01;
    let mut rho = file.clone();
    rho.transmission.as_mut().unwrap().rho *= 1.01;
    for wrong in [gain, rho] {
        let (off, _) = single(&wrong, csv);
        assert!(off > 1e-4 * largest, "{off}");
    }
}

#[test]
fn with_gains_for_each_file_each_has_its_model_and_its_vector() {
    let folder = Folder::new();
    let csv = |name: &str, kappa_eta: f64, seed: u64| {
        let base = Base {
            kappa_eta,
            sigma: 1.2,
            ..STEEP
        };
        let recipe = Recipe {
            base: Some(base),
            ..recipe(Mode::Torque, seed, &[])
        };
        folder.planted(name, &recipe)
    };
    let (one, two) = (csv("straight.csv", 2.0, 1), csv("bent.csv", 4.0, 2));
    let out = Folder::new();
    let model = out.path("model.toml");
    let report = said(&format!(
        "identify {one} {two} --per-file gains --model-out {model}"
    ));
    assert!(report.contains("gains by file"), "{report}");
    let names = ["1.toml", "1.vector.csv", "2.toml", "2.vector.csv"];
    assert_eq!(out.names(), names.map(|name| format!("model-{name}")));
    let files = ["1", "2"].map(|own| -> ModelFile {
        let file = toml::from_str(&out.read(&format!("model-{own}.toml"))).unwrap();
        let csv = out.read(&format!("model-{own}.vector.csv"));
        assert_eq!(single(&file, &csv).0, 0.0);
        file
    });
    // File names only: folders mean nothing where the model goes.
    let names = ["straight.csv", "bent.csv"];
    for (file, name) in files.iter().zip(names) {
        let about = file.about.clone().unwrap();
        assert_eq!(about.records, names);
        assert_eq!(about.gains_of.unwrap(), name);
    }
    let [one, two] = files.map(|file| file.transmission.unwrap());
    assert_eq!(one.rho, two.rho);
    assert_ne!(one.kappa_eta, two.kappa_eta);
}

#[test]
fn where_model_or_vector_cannot_be_written_there_is_neither() {
    for taken in ["model.vector.csv", "model.rs"] {
        let folder = Folder::new();
        // A folder where the file should go: its name cannot be taken.
        std::fs::create_dir(folder.path(taken)).unwrap();
        refused(&format!("identify --model-out {}", folder.path("model.rs")));
        assert_eq!(folder.names(), [taken]);
    }
}

#[test]
fn a_displacement_model_without_channels_steps_through_its_vector_too() {
    let told = Told::new(&recipe(Mode::Displacement, 2, &[]), &["bouc-wen"]);
    let file = &told.hand_over(false).files[0];
    let (worst, largest) = single(file, &vector::csv(&told.data, 0, file).unwrap());
    assert!(worst == 0.0 && largest > 0.0);
}
