//! The limit cycle of a continuous relay, exactly: Tsypkin's series, and closed forms.

use super::*;
use std::f64::consts::PI;

/// Where a function with one change of sign is zero, by bisection.
pub fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let above = f(low) > 0.0;
    for _ in 0..200 {
        let middle = (low * high).sqrt();
        *(if (f(middle) > 0.0) == above {
            &mut low
        } else {
            &mut high
        }) = middle;
    }
    low
}

/// Terms of the series: those of 1/(s + 1)³ fall as k⁻⁴ and the rest is below 1e-9; with two lags, as k⁻³,
/// it is below 1e-6.
const TERMS: u32 = 800;

/// The output of a unit square wave that rises at t = 0.
fn periodic(plant: &Plant, w: f64, t: f64) -> f64 {
    let odd = (0..TERMS).map(|k| f64::from(2 * k + 1));
    odd.map(|k| {
        let (size, phase) = plant.response(k * w);
        4.0 / (PI * k) * size * (phase + k * w * t).sin()
    })
    .sum()
}

/// Period and amplitude of the symmetric limit cycle of a unit relay with this hysteresis.
pub fn cycle(plant: &Plant, hysteresis: f64) -> (f64, f64) {
    let (_, ultimate) = plant.ultimate();
    // The relay rises where the output falls below -eps.
    let w = root(0.5 * ultimate, 1.3 * ultimate, |w| {
        periodic(plant, w, 0.0) + hysteresis
    });
    let half = PI / w;
    // 400 points of a half-period know a peak to (pi/800)²/2 of it, 8e-6.
    let points = (0..400).map(|i| periodic(plant, w, half * f64::from(i) / 400.0).abs());
    (2.0 * half, points.fold(0.0, f64::max))
}

/// The same of a first-order lag with unit gain and a delay, in closed form.
pub fn lag_with_delay(tau: f64, delay: f64, hysteresis: f64) -> (f64, f64) {
    // The output passes eps, rises towards 1 for the delay, then falls towards -1 to -eps.
    let peak = 1.0 + (hysteresis - 1.0) * (-delay / tau).exp();
    let half = delay + tau * ((1.0 + peak) / (1.0 - hysteresis)).ln();
    (2.0 * half, peak)
}

#[test]
fn series_and_closed_form_agree() {
    let plant = Plant::new(1.0, &[1.0], 0.5);
    for hysteresis in [0.0, 0.1] {
        let (period, amplitude) = cycle(&plant, hysteresis);
        let (expected, peak) = lag_with_delay(1.0, 0.5, hysteresis);
        // With one lag the terms fall as k⁻²: the rest is 4/(pi·w)/3200 = 1e-4 of 0.39.
        near(period / expected, 1.0, 1e-3);
        // The corner lies between two of 400 points, where the output falls by 1.4·0.83/400.
        near(amplitude, peak, 3e-3);
    }
    let (gain, w) = Plant::third_order().ultimate();
    near(gain, 8.0, 1e-9);
    near(w, 3.0_f64.sqrt(), 1e-9);
}
