//! The disturbance observer: closed forms, a simulated plant, latency, bad samples.

use super::*;
use bowden::effect::Motion;

const FINE: f64 = 1e-4;

fn plant() -> NominalPlant<f64> {
    NominalPlant::try_new(0.6, 25.5, 0.265).unwrap()
}

fn observer(time_constant: f64, limit: f64) -> DisturbanceObserver<f64> {
    DisturbanceObserver::try_new(plant(), time_constant, limit, 0.01).unwrap()
}

fn at<T>(dt: T, sent: T, measured: T) -> ObserverInput<T> {
    ObserverInput { dt, sent, measured }
}

/// The nominal plant under `u − d`, by Runge-Kutta: nothing of it is shared with the observer.
#[derive(Default)]
struct Simulated {
    y: f64,
    v: f64,
}

impl Simulated {
    fn step(&mut self, input: f64, dt: f64) {
        let (alpha, wn, zeta) = (0.6, 25.5_f64, 0.265);
        let rates = |y: f64, v: f64| (v, wn * wn * (alpha * input - y) - 2.0 * zeta * wn * v);
        let (a, b) = rates(self.y, self.v);
        let (c, d) = rates(self.y + 0.5 * dt * a, self.v + 0.5 * dt * b);
        let (e, f) = rates(self.y + 0.5 * dt * c, self.v + 0.5 * dt * d);
        let (g, h) = rates(self.y + dt * e, self.v + dt * f);
        self.y += dt / 6.0 * (a + 2.0 * c + 2.0 * e + g);
        self.v += dt / 6.0 * (b + 2.0 * d + 2.0 * f + h);
    }
}

/// What goes in: a sum of tones.
fn tones(t: f64) -> f64 {
    20.0 + 8.0 * (2.0 * t).sin() + 5.0 * (12.0 * t).cos()
}

/// Times and estimates along a run, with a command that shows `late` samples later.
fn run(
    observer: &DisturbanceObserver<f64>,
    late: usize,
    disturbance: impl Fn(f64) -> f64,
) -> Vec<(f64, f64)> {
    let (mut simulated, mut state) = (Simulated::default(), ObserverState::new());
    let (mut sent, mut all) = (0.0, Vec::new());
    for k in 0..37_000_usize {
        let t = k as f64 * FINE;
        let out = observer.step(&mut state, &at(FINE, sent, simulated.y));
        assert_eq!(out.status, Status::Good);
        all.push((t, out.command));
        sent = tones(t);
        // Of the commands before the first sample none was given.
        let acts = k.checked_sub(late).map_or(0.0, |k| tones(k as f64 * FINE));
        simulated.step(acts - disturbance(t), FINE);
    }
    all
}

#[test]
fn a_nominal_plant_lacks_nothing() {
    // A step of 20 units at the start is seen half a sample early: 20·h/(2·tau)·1/e, twice.
    for (_, d) in run(&observer(0.016, 100.0), 0, |_| 0.0) {
        near(d, 0.0, 0.1);
    }
}

#[test]
fn a_step_of_the_disturbance_is_seen_through_q() {
    let tau = 0.016;
    let step = |t: f64| if t < 1.0 { 0.0 } else { 7.0 };
    for (t, d) in run(&observer(tau, 100.0), 0, step).split_off(8001) {
        let since = ((t - 1.0) / tau).max(0.0);
        // The step response of 1/(tau·s + 1)². The implicit form lags by half a sample for each of two
        // lags, at a slope of 7/(e·tau): 7·1e-4/(e·0.016) = 0.016.
        near(d, 7.0 * (1.0 - (1.0 + since) * (-since).exp()), 0.02);
    }
}

/// Mean square over one common period of all tones, from 0.5 s on.
fn mean_square(values: &[(f64, f64)], without: impl Fn(f64) -> f64) -> f64 {
    let period = 0.5..0.5 + std::f64::consts::PI;
    let inside = values.iter().filter(|(t, _)| period.contains(t));
    let squares: Vec<f64> = inside.map(|(t, x)| (x - without(*t)).powi(2)).collect();
    squares.iter().sum::<f64>() / squares.len() as f64
}

#[test]
fn friction_is_estimated_without_a_model_of_it() {
    let friction = |t: f64| 4.0 * (4.0 * t).cos().signum();
    let left = mean_square(&run(&observer(0.008, 100.0), 0, friction), friction);
    // Four jumps of 8 in a period, each left as 8·(1 + t/tau)·e^(−t/tau), whose square is
    // 64·1.25·tau over time.
    let jumps = 4.0 * 64.0 * 1.25 * 0.008 / std::f64::consts::PI;
    near(left / jumps, 1.0, 0.02);
    assert!(left < 0.06 * 16.0);
}

#[test]
fn a_latency_that_is_told_is_no_disturbance() {
    let square =
        |observer: &DisturbanceObserver<f64>| mean_square(&run(observer, 30, |_| 0.0), |_| 0.0);
    // A delay L leaves of a tone 2·sin(w·L/2), and Q passes 1/(1 + (w·tau)²) of that.
    let (late, tau) = (0.003_f64, 0.016_f64);
    let tone = |a: f64, w: f64| a * 2.0 * (0.5 * w * late).sin() / (1.0 + (w * tau).powi(2));
    let expected = 0.5 * (tone(8.0, 2.0).powi(2) + tone(5.0, 12.0).powi(2));
    let silent = square(&observer(tau, 100.0));
    // The command of a sample acts from there on, half a sample of 0.1 ms later in the mean.
    near(silent / expected, 1.0, 0.05);
    let told = square(&observer(tau, 100.0).with_latency(late).unwrap());
    // A lag is the delay to second order: (w·L)²/2 is 0.02 of it.
    assert!(told < 0.001 * silent, "{told} {silent}");
}

#[test]
fn a_bad_sample_holds_and_its_time_is_made_up_for() {
    let observer = observer(0.016, 100.0);
    let mut whole = ObserverState::new();
    observer.step(&mut whole, &at(0.001, 10.0, 3.0));
    let first = whole.estimate();
    near(first, 5.0, 1e-12); // at rest: 10 − 3/0.6
    let mut gappy = whole;
    for (bad, fault) in [
        (at(0.001, 20.0, f64::NAN), Fault::Measured),
        (at(0.001, f64::INFINITY, 4.0), Fault::Command),
        (at(f64::NAN, 20.0, 4.0), Fault::Dt),
        (at(0.0, 20.0, 4.0), Fault::DtNotPositive),
        (at(0.02, 20.0, 4.0), Fault::DtTooLong),
    ] {
        let out = observer.step(&mut whole.clone(), &bad);
        assert_eq!((out.status, out.command), (Status::Held(fault), first));
    }
    // Two bad samples of 1 ms and a good one are one good one of 3 ms.
    observer.step(&mut gappy, &at(0.001, 20.0, f64::NAN));
    observer.step(&mut gappy, &at(0.001, f64::NAN, 4.0));
    let after = observer.step(&mut gappy, &at(0.001, 20.0, 4.0)).command;
    let once = observer.step(&mut whole, &at(0.003, 20.0, 4.0)).command;
    near(after, once, 1e-12);
}

/// A clock that fails once hides at most a sample or two: the estimate must not start anew.
#[test]
fn a_single_bad_time_stamp_makes_no_jump() {
    let observer = observer(0.016, 100.0).with_latency(0.003).unwrap();
    // The largest change from one sample to the next.
    let most = |one: f64| {
        let (mut simulated, mut state) = (Simulated::default(), ObserverState::new());
        let (mut sent, mut last, mut most) = (0.0, 0.0, 0.0_f64);
        for k in 0..3000 {
            let dt = if k == 2000 { one } else { DT };
            let estimate = observer
                .step(&mut state, &at(dt, sent, simulated.y))
                .command;
            if k > 1990 {
                most = most.max((estimate - last).abs());
            }
            last = estimate;
            sent = tones(f64::from(k) * DT);
            (0..10).for_each(|_| simulated.step(sent, FINE));
        }
        most
    };
    for bad in [f64::NAN, -0.001, 4295.0] {
        assert!(most(bad) < 2.0 * most(DT), "{bad} {}", most(bad));
    }
}

#[test]
fn what_overflows_is_no_estimate_and_the_next_sample_begins_anew() {
    let (observer, mut state) = (observer(0.016, 100.0), ObserverState::new());
    let before = observer.step(&mut state, &at(0.001, 10.0, 3.0)).command;
    let out = observer.step(&mut state, &at(0.001, 10.0, -1.7e308));
    assert_eq!(
        (out.status, out.command),
        (Status::Held(Fault::Overflow), before)
    );
    let out = observer.step(&mut state, &at(0.001, 12.0, 3.0));
    assert_eq!(out.status, Status::Good);
    near(out.command, 7.0, 1e-12);
}

#[test]
fn slow_lags_in_f32_arrive_at_a_fast_rate() {
    // 50 kHz and 0.1 Hz: a share of 1.3e-5 of the way, below which a plain f32 lag stops at
    // half an ulp over the share, 0.15 of 50.
    let plant = NominalPlant::try_new(1.0_f32, 25.0, 0.5).unwrap();
    let observer = DisturbanceObserver::try_new(plant, 1.6, 100.0, 0.001).unwrap();
    let mut state = ObserverState::new();
    observer.step(&mut state, &at(2e-5, 0.0, 0.0));
    for _ in 0..2_000_000 {
        observer.step(&mut state, &at(2e-5, 50.0, 30.0));
    }
    near(f64::from(state.estimate()), 20.0, 1e-3);
}

#[test]
fn the_feed_forward_is_the_plant_turned_round() {
    // y = A·sin(w·t): alpha·u = (1 − w²/wn²)·y + 2·zeta·w/wn·A·cos(w·t).
    let (w, (s, c)) = (7.0_f64, (7.0 * 0.4_f64).sin_cos());
    let wanted = Motion {
        position: 3.0 * s,
        velocity: 3.0 * w * c,
        acceleration: -3.0 * w * w * s,
    };
    let (a, b) = (1.0 - (w / 25.5).powi(2), 2.0 * 0.265 * w / 25.5);
    near(
        plant().feed_forward(&wanted),
        3.0 * (a * s + b * c) / 0.6,
        1e-12,
    );
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    use Error::{NonFinite, OutOfRange};
    for (gain, wn, zeta, error) in [
        (0.0, 25.0, 0.3, Some(OutOfRange("gain"))),
        (1e-320, 25.0, 0.3, Some(OutOfRange("gain"))),
        (f64::NAN, 25.0, 0.3, Some(NonFinite("gain"))),
        (1.0, 0.0, 0.3, Some(OutOfRange("natural_frequency"))),
        (1.0, 1e-200, 0.3, Some(OutOfRange("natural_frequency"))),
        (1.0, 25.0, -0.1, Some(OutOfRange("damping_ratio"))),
        (-1.0, 25.0, 0.0, None), // a drive that turns the other way
    ] {
        assert_eq!(NominalPlant::try_new(gain, wn, zeta).err(), error);
    }
    for (inertia, damping, stiffness, error) in [
        (0.0, 1.0, 1.0, OutOfRange("inertia")),
        (1.0, -1.0, 1.0, OutOfRange("damping")),
        (1.0, 1.0, f64::INFINITY, NonFinite("stiffness")),
    ] {
        let plant = NominalPlant::of_mechanics(1.0, inertia, damping, stiffness);
        assert_eq!(plant, Err(error));
    }
    for (tau, limit, longest, error) in [
        (0.0, 1.0, 1.0, OutOfRange("time_constant")),
        (1e-200, 1.0, 1.0, OutOfRange("time_constant")),
        (0.1, -1.0, 1.0, OutOfRange("limit")),
        (0.1, 1.0, f64::NAN, NonFinite("longest_dt")),
    ] {
        let observer = DisturbanceObserver::try_new(plant(), tau, limit, longest);
        assert_eq!(observer, Err(error));
    }
    let late = observer(0.1, 100.0).with_latency(-1e-3);
    assert_eq!(late, Err(OutOfRange("latency")));
}

#[test]
fn it_can_live_in_flash() {
    const PLANT: NominalPlant<f32> = constant!(NominalPlant::<f32>::try_new(0.6, 25.5, 0.265));
    in_flash!(f32:
        NominalPlant::try_new(0.6, 25.5, 0.265);
        DisturbanceObserver::try_new(PLANT, 0.0159, 30.0, 0.005).with_latency(0.003);
    );
    assert_eq!(PLANT.gain(), f32::from_f64(0.6));
}

#[cfg(feature = "serde")]
#[test]
fn what_is_stored_is_checked_when_it_is_read() {
    let observer = observer(0.016, 100.0).with_latency(0.002).unwrap();
    reads_back(&observer, &[("0.016", "-1.0"), ("latency", "latenz")]);
    let mut state = ObserverState::new();
    observer.step(&mut state, &at(0.001, 1.0, 0.5));
    let gap = ("\"gap\":0.0", "\"gap\":-1.0");
    // JSON has no NaN, but this overflows.
    let estimate = ("\"estimate\":", "\"estimate\":1e999,\"was\":");
    reads_back(&state, &[gap, estimate]);
}
