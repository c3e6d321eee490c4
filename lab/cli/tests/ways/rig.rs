//! One rig, recorded several times, and the program that reads its records.

use bowden_synth::{generate, Base, Mode, Planted, Recipe};
use std::process::{Command, Output};

/// A transmission in the paper's range.
pub const CABLE: Base = Base {
    gain: 0.95,
    kappa_eta: 4.0,
    offset: 0.05,
    rho: 0.3,
    sigma: 1.2,
    n: 1.6,
};

/// The same for displacement mode.
pub const SPRING: Base = Base {
    gain: 2.0,
    kappa_eta: 8.0,
    offset: 0.3,
    rho: 0.5,
    sigma: 1.2,
    n: 1.6,
};

pub fn on(mode: Mode, seed: u64) -> Recipe {
    Recipe {
        base: Some(match mode {
            Mode::Torque => CABLE,
            Mode::Displacement => SPRING,
        }),
        seed,
        ..Recipe::new(mode)
    }
}

/// An effect of that gain, whatever the motion.
pub fn with_gain(effect: &str, gain: f64) -> Planted {
    Planted {
        gain: Some(gain),
        ..Planted::new(effect)
    }
}

pub fn bowden(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bowden"))
        .args(arguments)
        .output()
        .unwrap()
}

pub fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

/// What the program prints where all is well.
pub fn said(arguments: &[&str]) -> String {
    let output = bowden(arguments);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{arguments:?}: {}",
        text(&output.stderr)
    );
    text(&output.stdout).to_owned()
}

/// Exit 2, nothing on stdout, and exactly one line on stderr.
pub fn refused(arguments: &[&str]) -> String {
    let output = bowden(arguments);
    assert_eq!(
        output.status.code(),
        Some(2),
        "{arguments:?}: {}",
        text(&output.stdout)
    );
    assert!(output.stdout.is_empty(), "{arguments:?}");
    let line = text(&output.stderr).trim_end().to_owned();
    assert_eq!(line.lines().count(), 1, "{line}");
    line
}

/// A folder with files that the program reads and writes.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> String {
        self.0.path().join(name).display().to_string()
    }

    pub fn file(&self, name: &str, bytes: impl AsRef<[u8]>) -> String {
        let path = self.path(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    pub fn record(&self, name: &str, recipe: &Recipe) -> String {
        self.file(name, generate(recipe).unwrap().to_csv())
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    pub fn names(&self) -> Vec<String> {
        let names = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> = names
            .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}
