//! The loop to copy into firmware, on a joint of this test's own: what a fault of the encoder or of the
//! timer does to the torque.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

#[path = "../examples/torque_loop/torque_loop.rs"]
mod torque_loop;

use bowden::control::{Fault, Status};
use bowden::hysteresis::{BoucWen, BoucWenState};
use bowden::transmission::Transmission;
use std::path::Path;
use std::process::Command;
use torque_loop::{Sensors, TorqueLoop, COUNTS};

const MODEL: &[u8] = include_bytes!("../examples/data/demo.postcard");

/// What a run has shown from a tick on.
#[derive(Debug, Default)]
struct Shown {
    /// Greatest error of the torque \[N·m\].
    error: f32,
    /// Greatest change of the command in a tick \[N·m\].
    step: f32,
    statuses: Vec<Status>,
    /// What the command has travelled \[N·m\].
    travel: f32,
}

/// Ten seconds of a joint that swings; `dt` and the shift of the encoder \[rad\] by tick.
fn run(from: u32, dt: impl Fn(u32) -> f32, shift: impl Fn(u32) -> f32) -> Shown {
    let mut control = TorqueLoop::try_new(MODEL).unwrap();
    let shape = BoucWen::try_new(0.5_f32, 0.5, 1.3).unwrap();
    let cable = Transmission::torque(0.93, 1.9, 0.1, shape).unwrap();
    let (mut eta, mut drive, mut torque, mut last) = (BoucWenState::new(), 0.0, 0.0, 0.0);
    let mut shown = Shown::default();
    for k in 0..10_000_u32 {
        let t = k as f32 * 1e-3;
        let wanted = t.min(1.0) * (8.0 + 4.0 * (1.571 * t).sin());
        let (angle, velocity) = (0.5 * (1.571 * t).sin(), 0.7855 * (1.571 * t).cos());
        let turns = ((angle + shift(k)) / std::f32::consts::TAU).rem_euclid(1.0);
        let action = control.tick(&Sensors {
            dt: dt(k),
            wanted,
            torque,
            counts: (turns * COUNTS) as u16,
        });
        if k >= from {
            shown.error = shown.error.max((torque - wanted).abs());
            shown.step = shown.step.max((action.command - last).abs());
            shown.travel += (action.command - last).abs();
            shown.statuses.push(action.status);
        }
        last = action.command;
        assert!(action.enabled);
        drive += 0.5 * (action.command - drive);
        torque = cable.step(&mut eta, drive) - 0.6 * velocity;
    }
    assert!(control.acknowledge());
    shown
}

const STEADY: fn(u32) -> f32 = |_| 1e-3;
const STILL: fn(u32) -> f32 = |_| 0.0;

#[test]
fn an_encoder_that_was_reset_moves_the_torque_by_less_than_the_friction_does() {
    let usual = run(2000, STEADY, STILL);
    assert!(usual.error < 0.15, "{usual:?}");
    // For good, and for one sample; without the bench's ranges the first is 19 N·m off.
    let reset = run(3998, STEADY, |k| if k >= 4000 { 2.0 } else { 0.0 });
    assert!(reset.error < 1.0, "{}", reset.error);
    let glitch = run(3998, STEADY, |k| if k == 4000 { 0.5 } else { 0.0 });
    assert!(glitch.error < 1.0, "{}", glitch.error);
}

#[test]
fn a_timer_that_wrapped_holds_one_sample_and_nothing_jumps() {
    let usual = run(2000, STEADY, STILL);
    for wrong in [4295.0, 0.0, -1.0, f32::NAN] {
        let wrapped = run(2000, |k| if k == 8000 { wrong } else { 1e-3 }, STILL);
        let held = wrapped.statuses.iter().filter(|s| **s != Status::Good);
        assert_eq!(held.count(), 1, "{wrong}");
        assert!(
            wrapped.error < 1.1 * usual.error,
            "{wrong}: {}",
            wrapped.error
        );
    }
    let short = |dt: f32| run(8000, move |k| if k == 8000 { dt } else { 1e-3 }, STILL);
    let (usual, lost) = (short(1e-3), short(4295.0));
    assert_eq!(lost.statuses[0], Status::Held(Fault::DtTooLong));
    // Rates that start anew made a step of 2 N·m of it.
    assert!(
        lost.step < usual.step + 0.05,
        "{} {}",
        lost.step,
        usual.step
    );
}

/// The command follows the friction's reversals, eight of 3 to 4 N·m, and what is wanted: some 50 N·m
/// in eight seconds. It does not take the counts of the encoder for reversals; without the play that made 1900 of it.
#[test]
fn the_command_does_not_chatter_at_the_counts_of_the_encoder() {
    let usual = run(2000, STEADY, STILL);
    assert!(usual.travel < 70.0, "{}", usual.travel);
}

/// The lines of `Cargo.toml` that the loop names at its top.
fn manifest_lines(source: &str) -> String {
    let docs = source.lines().map_while(|line| line.strip_prefix("//!"));
    let block = docs.skip_while(|line| line.trim() != "```toml").skip(1);
    let lines = block.take_while(|line| line.trim() != "```");
    lines
        .map(|line| format!("{}\n", line.trim_start()))
        .collect()
}

/// Copied alone into an empty crate, without a warning; `bowden` is this package, at its path.
#[test]
#[ignore = "slow: bash .ci/run packages"]
fn the_loop_builds_in_an_empty_crate_with_the_dependencies_that_it_names() {
    let Some(cargo) = std::env::var_os("CARGO") else {
        println!("skipped: cargo is not there (the variable CARGO is not set)");
        return;
    };
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let source = package.join("examples/torque_loop/torque_loop.rs");
    let source = std::fs::read_to_string(source).unwrap();
    let lines = manifest_lines(&source);
    assert!(lines.contains("path = \"../bowden\""), "{lines}");
    let lines = lines.replace("\"../bowden\"", &format!("{package:?}"));

    let folder = format!("bowden-torque-loop-{}", std::process::id());
    let folder = std::env::temp_dir().join(folder);
    std::fs::create_dir_all(folder.join("src")).unwrap();
    let head = "[package]\nname = \"user\"\nversion = \"0.0.0\"\nedition = \"2021\"\n\n";
    std::fs::write(folder.join("Cargo.toml"), format!("{head}{lines}")).unwrap();
    let library = "#![no_std]\n#![deny(warnings)]\npub mod torque_loop;\n";
    std::fs::write(folder.join("src/lib.rs"), library).unwrap();
    std::fs::write(folder.join("src/torque_loop.rs"), source).unwrap();

    let built = Command::new(cargo)
        .args(["check", "--offline", "--quiet", "--target-dir"])
        .arg(folder.join("target"))
        .current_dir(&folder)
        .output()
        .unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    let said = String::from_utf8_lossy(&built.stderr);
    assert!(built.status.success(), "{lines}\n{said}");
}
