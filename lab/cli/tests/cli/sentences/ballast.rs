//! A spring that relaxes and has no hysteresis: the declared one must not stay in the model with
//! gains that cancel each other.

use crate::sentences::changed::spring;
use crate::sentences::files::{noise, uniform, Rows};
use crate::shell::{bowden, Folder};

const RATE: f64 = 500.0;

/// Force of a standard linear solid: a spring of 2 N/mm beside one of 3 N/mm that relaxes in half
/// a second. The motion is noise behind four low-passes, begun with a leap.
fn relaxing_spring(seed: usize) -> Rows {
    relaxing_spring_moved_within(1.2, 10.0, seed)
}

/// The same moved within so many hertz and begun with another leap \[mm\].
fn relaxing_spring_moved_within(band: f64, leap: f64, seed: usize) -> Rows {
    let share = 1.0 - (-std::f64::consts::TAU * band / RATE).exp();
    let decay = (-1.0 / RATE / 0.5_f64).exp();
    let (mut stages, mut arm, mut before) = ([0.0; 4], 0.0, None);
    let row = |i: usize| {
        let t = i as f64 / RATE;
        let mut signal = uniform(i + 1000 * seed);
        for stage in &mut stages {
            *stage += share * (signal - *stage);
            signal = *stage;
        }
        let x = 100.0 * signal + leap * (-t / 0.1).exp();
        arm = decay * arm + x - before.unwrap_or(x);
        before = Some(x);
        vec![t, x, 2.0 * x + 3.0 * arm + 0.02 * noise(i)]
    };
    Rows {
        header: "t,x [mm],f [N]".to_owned(),
        rows: (0..20_000).map(row).collect(),
    }
}

#[test]
fn a_hysteresis_that_is_not_needed_is_redundant_and_the_model_holds_elsewhere() {
    let folder = Folder::new();
    let model = folder.path("model.toml");
    let closed = relaxing_spring(11).close(&["--model-out", &model]);
    assert_eq!(closed.names(), ["creep"]);
    let parts = closed.json["redundant"].as_array().unwrap();
    let part = parts
        .iter()
        .find(|part| part["effect"] == "bouc-wen")
        .unwrap();
    let error = |name: &str| part[name].as_f64().unwrap();
    assert!(error("held_out_without") < 1.1 * error("held_out_with"));
    let other = relaxing_spring(12).write(&folder, "other.csv");
    let check = bowden(&["validate", &model, &other]);
    let said = String::from_utf8_lossy(&check.stdout);
    assert!(check.status.success() && said.contains("holds"), "{said}");
}

/// Its force leads its motion, which is the creep and no clock.
#[test]
fn a_spring_that_relaxes_raises_no_question_about_clocks() {
    for seed in [11, 14] {
        let closed = relaxing_spring_moved_within(0.3, 0.0, seed).close(&[]);
        let error = &closed.json["final"]["nrmse"]["held_out"];
        assert!(error.as_f64().unwrap() < 0.02, "{error}");
        assert!(!closed.sentence().contains("the same clock"));
    }
}

#[test]
fn a_hysteresis_that_is_there_stays() {
    let closed = spring((99.0, 0.0), 0).close(&[]);
    let effects = closed.json["final"]["effects"].as_array().unwrap();
    assert!(effects.iter().any(|e| e == "bouc-wen"), "{effects:?}");
    assert!(!closed.sentence().contains("spring and an offset"));
}
