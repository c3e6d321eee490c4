//! The models in the repository, and the examples that run them.

use crate::shell::Folder;
use bowden::model::Model;
use std::path::Path;

#[allow(dead_code)]
#[path = "../../../../identify/examples/check_vector.rs"]
mod check_vector;
#[allow(dead_code)]
#[path = "../../../../../examples/feed_forward.rs"]
mod feed_forward;

const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/data");

#[test]
fn the_demo_model_as_written_drives_the_compensator_of_the_example() {
    let (worst, most) = feed_forward::run(20.0).unwrap();
    // 16 roundings of f32 of the magnitudes in the equation, see `Inverse::step`: the
    // command, the hysteresis and the output together are below 40 N·m.
    assert!(worst < 16.0 * f32::EPSILON * 40.0, "{worst}");
    assert!(most > 6.5, "{most}");
}

#[test]
fn the_model_in_the_repository_is_one_model_in_three_forms_and_gives_its_vector() {
    let toml = Path::new(DATA).join("demo.toml");
    println!("{}", check_vector::check(&toml).unwrap());
    println!(
        "{}",
        check_vector::check(&toml.with_extension("postcard")).unwrap()
    );
    let read: Model<f32, 1> = toml::from_str(&std::fs::read_to_string(&toml).unwrap()).unwrap();
    assert_eq!(read, feed_forward::demo::model().unwrap());
}

#[test]
fn a_model_that_was_changed_does_not_give_its_vector() {
    let folder = Folder::new();
    let path = folder.root().join("demo.toml");
    let own = |name: &str| Path::new(DATA).join(name);
    let text = std::fs::read_to_string(own("demo.toml")).unwrap();
    let line = text.lines().find(|l| l.starts_with("rho = ")).unwrap();
    std::fs::write(&path, &text).unwrap();
    std::fs::copy(own("demo.vector.csv"), path.with_extension("vector.csv")).unwrap();
    assert!(check_vector::check(&path).is_ok());
    let other: f64 = line.trim_start_matches("rho = ").parse().unwrap();
    let changed = text.replace(line, &format!("rho = {}", 1.001 * other));
    std::fs::write(&path, changed).unwrap();
    let refused = check_vector::check(&path).unwrap_err().to_string();
    assert!(refused.contains("does not give its vector"), "{refused}");
}
