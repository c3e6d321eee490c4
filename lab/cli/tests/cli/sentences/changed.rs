//! A rig that changed, clocks that are apart, an angle that measures the output, motion that was
//! not seen: what the boss reads must be that.

use crate::sentences::files::{evidence, noise, Closed, Rows};
use crate::shell::{bowden, Folder};

/// A spring with a hysteresis, moved by tones; `slip` is taken from the true motion after the time
/// given, and the force is logged as many samples early.
pub fn spring(slip: (f64, f64), early: usize) -> Rows {
    spring_moved_by(1.0, slip, early)
}

/// The same moved by so many times the tones.
pub fn spring_moved_by(times: f64, slip: (f64, f64), early: usize) -> Rows {
    let (rate, mut z, mut before) = (500.0, 0.0, 0.0);
    let x = |t: f64| {
        times * (2.0 * (5.3 * t).sin() + 1.1 * (2.1 * t + 0.4).sin() + 0.6 * (9.7 * t).sin())
    };
    let mut rows = Vec::new();
    for i in 0..12_000 {
        let t = i as f64 / rate;
        let own = x(t) - if t > slip.0 { slip.1 } else { 0.0 };
        for k in 1..=10 {
            let dx = (own - before) / 10.0;
            z += 0.9 * (dx - 0.8 * dx.abs() * z - 0.2 * dx * z.abs());
            if k == 10 {
                before = own;
            }
        }
        rows.push(vec![t, x(t), 1.5 * own + 4.0 * z + 0.02 * noise(i)]);
    }
    let forces: Vec<f64> = rows.iter().skip(early).map(|row| row[2]).collect();
    rows.truncate(forces.len());
    rows.iter_mut().zip(forces).for_each(|(row, f)| row[2] = f);
    Rows {
        header: "t,x [mm],f [N]".to_owned(),
        rows,
    }
}

#[test]
fn a_rig_that_slips_in_the_held_out_part_does_not_carry_over_from_then_on() {
    // The held-out part begins at 18 s of 24.
    let closed = spring((21.0, 1.5), 0).close(&[]);
    assert_eq!(closed.json["verdict"], "not-transferable");
    closed.says(&[
        "The model does not transfer. Its error is ",
        "(after 21.",
        "Do not use",
    ]);
    let sound = spring((99.0, 0.0), 0).close(&[]);
    assert!(
        !sound.sentence().contains("carry over"),
        "{}",
        sound.sentence()
    );
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn an_output_that_comes_before_its_input_is_a_question_of_clocks() {
    let closed = spring((99.0, 0.0), 5).close(&[]);
    let lead = closed.finding("output-leads").unwrap();
    let seconds = lead["seconds"].as_f64().unwrap();
    // Five samples of 2 ms.
    assert!((seconds - 0.010).abs() < 0.5e-3, "{seconds}");
}

#[test]
fn motion_in_a_gap_is_said_to_act_on() {
    let mut rows = spring((99.0, 0.0), 0);
    rows.rows.drain(4000..4600);
    let closed = rows.close(&[]);
    closed.says(&["The motion of `x` during the gap is unknown"]);
    let sound = spring((99.0, 0.0), 0).close(&[]);
    assert!(!sound.sentence().contains("not measured"));
}

/// A cable of parallel slipping springs, which Bouc-Wen does not quite describe, on a joint with a
/// spring, whose angle is recorded.
fn joint() -> Closed {
    let mut forces = [0.0_f64; 4];
    let mut before = 0.0;
    let row = |i: usize| {
        let t = i as f64 / 500.0;
        let tau_i = 5.0 + 4.0 * (3.1 * t).sin() + 1.5 * (7.3 * t + 1.0).sin();
        let step = tau_i - before;
        before = tau_i;
        for (k, force) in forces.iter_mut().enumerate() {
            let most = 0.25 * (k + 1) as f64;
            *force = (*force + 0.5 * step).clamp(-most, most);
        }
        let tau_o = 0.85 * tau_i - forces.iter().sum::<f64>() + 0.01 * noise(i);
        let phi_d = tau_o / 8.0 + 1e-4 * noise(i + 7);
        vec![t, tau_i, tau_o, phi_d]
    };
    Rows {
        header: "t,tau_i [N·m],tau_o [N·m],phi_d [rad]".to_owned(),
        rows: (0..12_000).map(row).collect(),
    }
    .close(&[])
}

#[test]
fn an_angle_behind_a_spring_is_said_to_stand_for_the_output() {
    let closed = joint();
    closed.says(&[
        "Nearly all of the model's output comes from `phi_d`",
        "Does `phi_d` measure the output, as an angle downstream of a spring does?",
    ]);
}

/// What `validate` says of a model of the spring, on that spring with another factor of its force.
fn checked(of_force: f64) -> serde_json::Value {
    let folder = Folder::new();
    let first = spring((99.0, 0.0), 0).write(&folder, "first.csv");
    let model = folder.path("model.toml");
    let made = bowden(&["identify", &first, "--model-out", &model]);
    assert!(made.status.success(), "{made:?}");
    let mut other = spring((99.0, 0.0), 0);
    for (i, row) in other.rows.iter_mut().enumerate() {
        row[2] = of_force * (row[2] + 0.02 * noise(i + 50_000));
    }
    let other = other.write(&folder, "other.csv");
    let output = bowden(&["validate", &model, &other, "--json"]);
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_sign_that_was_turned_is_named_by_check() {
    let report = checked(-1.0);
    let suspicion = evidence(&report, "logged-differently").unwrap();
    assert_eq!(
        (&suspicion["what"], &suspicion["column"]),
        (&"reversed".into(), &"f".into())
    );
    assert_eq!(checked(1.0)["verdict"], "holds");
}

#[test]
fn a_file_with_another_zero_is_not_the_wrong_input() {
    let folder = Folder::new();
    let mut files: Vec<String> = Vec::new();
    for (index, zero) in [0.0, 0.0, 30.0].into_iter().enumerate() {
        let mut rows = spring((99.0, 0.0), 0);
        for (i, row) in rows.rows.iter_mut().enumerate() {
            row[2] += zero + 0.02 * noise(i + 20_000 * (index + 1));
        }
        files.push(rows.write(&folder, &format!("{index}.csv")));
    }
    let [a, b, c] = [&*files[0], &*files[1], &*files[2]];
    let closed = Closed::of(&[a, b, c]);
    assert_eq!(closed.json["verdict"], "not-transferable");
    closed.says(&[
        "With a gain of 1.00",
        "and an offset of 30.0",
        "2.csv",
        "`--per-file gains`",
    ]);
    // The advice works.
    let mended = Closed::of(&[a, b, c, "--per-file", "gains"]);
    assert_ne!(mended.json["verdict"], "not-transferable");
    assert_ne!(mended.json["verdict"], "no-input-dependence");
}
