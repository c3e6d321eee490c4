//! Plants of the form that the certificates of a loop are of, simulated: nothing of them is shared
//! with the proofs.

use bowden_bound::{Interval, PlantRange};

/// Sampling of the loop \[s\]; its hold is half a sample of latency.
pub const DT: f64 = 2e-4;

/// One plant: alpha, wn, zeta, c/K, slope, and samples of delay.
#[derive(Debug, Clone, Copy)]
pub struct One {
    pub gain: f64,
    pub wn: f64,
    pub zeta: f64,
    pub joint: f64,
    pub slope: f64,
    pub late: usize,
}

/// The reference rig's plant.
pub const BASE: One = One {
    gain: 0.6,
    wn: 25.5,
    zeta: 0.265,
    joint: 0.0033,
    slope: 1.0,
    late: 15,
};

/// `f·alpha·(1 + c/K·s)/(f·s²/wn² + (f·2·zeta/wn + c/K)·s + 1)` behind samples of delay, pushed at the
/// start; by steps that are a tenth as long.
pub struct Simulated {
    plant: One,
    x: f64,
    v: f64,
    sent: Vec<f64>,
}

impl Simulated {
    pub fn new(plant: One) -> Self {
        Self {
            plant,
            x: 1.0,
            v: 0.0,
            sent: vec![0.0; plant.late + 1],
        }
    }

    pub fn measured(&self) -> f64 {
        self.plant.slope * self.plant.gain * (self.x + self.plant.joint * self.v)
    }

    /// The last command.
    pub fn last(&self) -> f64 {
        self.sent[self.plant.late]
    }

    pub fn step(&mut self, command: f64) {
        let plant = self.plant;
        self.sent.remove(0);
        self.sent.push(command);
        let input = self.sent[0];
        for _ in 0..10 {
            let h = 0.1 * DT;
            let rate = plant.slope * 2.0 * plant.zeta / plant.wn + plant.joint;
            self.v += h * plant.wn * plant.wn / plant.slope * (input - self.x - rate * self.v);
            self.x += h * self.v;
        }
    }
}

/// This plant alone.
pub fn at(plant: One) -> PlantRange {
    let latency = (plant.late as f64 + 0.5) * DT;
    PlantRange {
        gain: Interval::exactly(plant.gain),
        natural_frequency: Interval::exactly(plant.wn),
        damping_ratio: Interval::exactly(plant.zeta),
        joint: Interval::exactly(plant.joint),
        slope: Interval::exactly(plant.slope),
        latency: Interval::exactly(latency),
    }
}
