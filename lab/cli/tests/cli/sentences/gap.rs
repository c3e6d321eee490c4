//! A spring with slack: the effect of that name, not a curve that matches no effect in the catalogue.

use crate::sentences::files::{noise, uniform, Rows};

const RATE: f64 = 500.0;

/// A spring of 2 N/mm with a millimetre of slack to either side, beside a hysteresis. The motion is
/// noise behind four low-passes, this many times the usual one.
fn slack_spring(times: f64, seed: usize) -> Rows {
    let share = 1.0 - (-std::f64::consts::TAU * 0.8 / RATE).exp();
    let (mut stages, mut z, mut before) = ([0.0; 4], 0.0, 0.0);
    let row = |i: usize| {
        let mut signal = uniform(i + 1000 * seed);
        for stage in &mut stages {
            *stage += share * (signal - *stage);
            signal = *stage;
        }
        let x = 100.0 * times * signal;
        let dx = (x - before) / 10.0;
        before = x;
        for _ in 0..10 {
            z += 8.0 * dx - 8.0 / 1.5 * dx.abs() * z;
        }
        let force = 2.0 * x.signum() * (x.abs() - 1.0).max(0.0) + z;
        vec![i as f64 / RATE, x, force + 0.02 * noise(i)]
    };
    Rows {
        header: "t,x [mm],f [N]".to_owned(),
        rows: (0..20_000).map(row).collect(),
    }
}

/// In the second record a curve over the position promises more, to first order, than slack of any
/// trial width.
#[test]
fn slack_is_named_and_no_curve_stands_in_its_place() {
    for (times, seed) in [(1.0, 1), (0.7, 10)] {
        let closed = slack_spring(times, seed).close(&[]);
        assert_eq!(closed.verdict(), "explained");
        assert_eq!(closed.names(), ["dead-zone"]);
    }
}
