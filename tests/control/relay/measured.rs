//! What is measured of plants whose limit cycle is known.

use super::exact::{cycle, lag_with_delay};
use super::*;
use std::f64::consts::PI;

/// k_u of an amplitude by the describing function of a unit relay.
fn described(amplitude: f64, hysteresis: f64) -> f64 {
    4.0 / (PI * (amplitude.powi(2) - hysteresis.powi(2)).sqrt())
}

/// Settings under which the last cycles differ by 1e-3: what remains of the start is below that.
fn precise<T: Real>(hysteresis: f64) -> RelaySettings<T> {
    let [hysteresis, agreement] = [hysteresis, 1e-3].map(T::from_f64);
    with(usual(), |s| {
        (s.hysteresis, s.agreement) = (hysteresis, agreement)
    })
}

/// The cycle is the exact one of a continuous relay, but for the sampling and the start.
fn is_the_exact_cycle(it: &Ultimate<f64>, exact: (f64, f64), hysteresis: f64, dt: f64) {
    let (period, amplitude) = exact;
    // Up to one sample late at each of two switches, of which each moves the next by as much: four.
    // The start leaves as much as two of the last cycles may differ.
    let (late, start) = (4.0 * dt, 1e-3 * period);
    let longer = it.period - period;
    assert!(-start < longer && longer < late + start, "{it:?} {exact:?}");
    // While the switch is late the output moves on, at a slope of at most 1 + a for a lag with a
    // delay, and by less for the others.
    let reached = (1.0 + amplitude) * dt;
    let higher = it.amplitude - amplitude;
    let start = 1e-3 * amplitude;
    assert!(
        -start < higher && higher < reached + start,
        "{it:?} {exact:?}"
    );
    // The mean of the duty is 1/2 to the start's 1e-3, and the sine to its square; f32 to 1e-6.
    near(it.gain / described(it.amplitude, hysteresis), 1.0, 1e-5);
    near(it.duty, 0.5, 1e-3);
}

/// In both floats, and with a jitter.
fn finds_the_cycle(plant: &Plant, exact: (f64, f64), hysteresis: f64) {
    let dt = exact.0 / 4000.0;
    let it = result::<f64>(precise(hysteresis), plant, Sampled::every(dt));
    is_the_exact_cycle(&it, exact, hysteresis, dt);
    let jittering = Sampled::every(dt).jittering(0.5);
    let it = result::<f32>(precise(hysteresis), plant, jittering);
    is_the_exact_cycle(&it, exact, hysteresis, 1.5 * dt);
}

#[test]
fn the_limit_cycle_is_that_of_tsypkin() {
    for plant in [
        Plant::third_order(),
        Plant::new(1.0, &[1.0, 0.5], 0.2),
        Plant::new(1.0, &[0.3, 0.2, 0.1, 0.05], 0.0),
    ] {
        for hysteresis in [0.0, 0.02] {
            finds_the_cycle(&plant, cycle(&plant, hysteresis), hysteresis);
        }
    }
}

#[test]
fn the_limit_cycle_of_a_lag_with_delay_is_the_closed_form() {
    for delay in [0.1, 1.0, 10.0] {
        let exact = lag_with_delay(1.0, delay, 0.02);
        let plant = Plant::new(1.0, &[1.0], delay);
        finds_the_cycle(&plant, exact, 0.02);
        let (precise, dt) = (precise(0.02), exact.0 / 4000.0);
        let it = result::<f32>(precise, &plant, Sampled::every(dt));
        is_the_exact_cycle(&it, exact, 0.02, dt);
    }
}

/// What the docs say of the describing function: exact limit cycles against the frequency response.
///
/// To the last digit that they give.
#[test]
fn the_describing_function_has_the_error_that_the_docs_state() {
    let share = |amplitude: f64, plant: &Plant| described(amplitude, 0.0) / plant.ultimate().0;
    let third = Plant::third_order();
    near(share(cycle(&third, 0.0).1, &third), 1.0 - 0.023, 0.005);
    let amplitude = cycle(&third, 0.02).1;
    near(0.02 / amplitude, 0.1, 0.005);
    near(described(amplitude, 0.02) / 8.0, 1.0 - 0.175, 0.0005);
    let of_delay = |delay: f64| {
        let plant = Plant::new(1.0, &[1.0], delay);
        share(lag_with_delay(1.0, delay, 0.0).1, &plant) - 1.0
    };
    near(of_delay(1.0), -0.11, 0.005);
    // 8/pi² − 1 is that of an integrator with delay, 4/pi − 1 that of a pure delay.
    for k in -30..=30 {
        let error = of_delay(10.0_f64.powf(0.1 * f64::from(k)));
        assert!(-0.19 < error && error < 0.28, "{error}");
    }
}

/// Noise up to the hysteresis: the relay does not chatter, and a is too high by one noise at most.
#[test]
fn noise_within_the_hysteresis_leaves_the_result() {
    let plant = Plant::third_order();
    let noise = 0.01;
    for dt in [0.004, 0.005, 0.006] {
        let settings = with(usual(), |s| (s.hysteresis, s.agreement) = (noise, 0.1));
        let quiet = result::<f64>(settings, &plant, Sampled::every(dt));
        let sampled = Sampled::every(dt).noisy(noise).jittering(0.3);
        let it = result::<f64>(settings, &plant, sampled);
        // The noise switches the relay early, by 2·noise of a slope of a·w: the cycle is shorter than
        // with the hysteresis alone, by 2·noise/(a·w) at each of two switches and as much again.
        let early = 8.0 * noise / (quiet.amplitude * 2.0 * PI / quiet.period);
        near(it.period, quiet.period, early);
        near(it.amplitude, quiet.amplitude, 2.0 * noise);
    }
}

/// Without the sine a load would make k_u too high. With it, what the even harmonics add to a makes
/// k_u too low: two outputs half a period apart differ by the odd harmonics alone.
#[test]
fn a_load_makes_the_halves_unequal_and_the_result_cautious() {
    let symmetric = result::<f64>(usual(), &Plant::third_order(), Sampled::every(0.002));
    for load in [-0.3, 0.2, 0.3] {
        let plant = Plant::third_order().with_load(load);
        let loaded = result::<f64>(usual(), &plant, Sampled::every(0.002));
        assert!((loaded.duty - 0.5) * load < 0.0, "{loaded:?}");
        let share = loaded.gain / symmetric.gain;
        // 5 % at D = 0.62, as the docs say.
        assert!(0.945 < share && share < 1.0, "{share} {loaded:?}");
        let uncorrected = share / (PI * loaded.duty).sin();
        assert!(uncorrected > 1.0, "{uncorrected} {loaded:?}");
    }
}

#[test]
fn the_mean_command_as_the_next_centre_makes_the_halves_equal() {
    let plant = Plant::third_order().with_load(-0.3);
    let (mut centre, mut off) = (0.0, 0.5);
    for _ in 0..6 {
        let settings = with(usual(), |s| s.centre = centre);
        let duty = result(settings, &plant, Sampled::every(0.002)).duty;
        // Each repetition takes away more than half of the difference.
        assert!((duty - 0.5).abs() < 0.5 * off + 1e-3, "{duty} {off}");
        off = (duty - 0.5).abs();
        centre += 2.0 * duty - 1.0;
    }
    // Equal halves need the command that carries the load.
    near(centre, 0.3, 0.01);
}

/// The sign of the amplitude is that of the plant's gain, and the result has it. A scale of the output
/// and of the command changes k_u by their ratio, and a period not at all.
#[test]
fn a_result_has_the_units_and_the_sign_of_the_plant() {
    let sampled = || Sampled::every(0.002);
    let lags = [1.0, 0.5, 0.2];
    let plus = result::<f64>(usual(), &Plant::new(2.0, &lags, 0.0), sampled());
    let reversed = with(usual(), |s| s.amplitude = -1.0);
    let minus = result(reversed, &Plant::new(-2.0, &lags, 0.0), sampled());
    assert!(minus.gain < 0.0);
    near(-minus.gain / plus.gain, 1.0, 1e-9);
    near(plus.period, minus.period, 1e-9);
    let scaled = with(usual(), |s| (s.amplitude, s.most_deviation) = (2.0, 1000.0));
    let one = result::<f64>(usual(), &Plant::third_order(), sampled());
    let other = result(scaled, &Plant::new(50.0, &[1.0; 3], 0.0), sampled());
    near(other.gain * 50.0 / one.gain, 1.0, 1e-9);
    near(other.amplitude / (100.0 * one.amplitude), 1.0, 1e-9);
    near(other.period, one.period, 1e-9);
}
