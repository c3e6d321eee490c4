//! Stability with a disturbance observer: what is proved, against the controllers that ship on
//! simulated plants.

use super::simulated::{at, One, Simulated, BASE, DT};
use super::*;

fn loops(tau: f64, latency: f64, k_p: f64, k_i: f64) -> (DisturbanceObserver<f64>, Pid<f64>) {
    let plant = NominalPlant::try_new(0.6, 25.5, 0.265).unwrap();
    let observer = DisturbanceObserver::try_new(plant, tau, 1e12, 1.0).unwrap();
    (observer.with_latency(latency).unwrap(), pi(k_p, k_i))
}

/// The largest output of each second, after a push at the start.
fn peaks(
    observer: &DisturbanceObserver<f64>,
    law: &Pid<f64>,
    plant: One,
    seconds: usize,
) -> Vec<f64> {
    let (mut seen, mut state) = (ObserverState::new(), PidState::new());
    let mut simulated = Simulated::new(plant);
    let per_second = (1.0 / DT).round() as usize;
    let mut all = Vec::new();
    for _ in 0..seconds {
        let mut peak = 0.0_f64;
        for _ in 0..per_second {
            let measured = simulated.measured();
            peak = peak.max(measured.abs());
            let (dt, sent) = (DT, simulated.last());
            let estimate = observer.step(&mut seen, &ObserverInput { dt, sent, measured });
            let mut at = PidInput::new(DT, 0.0, measured);
            at.feed_forward = estimate.command;
            simulated.step(law.step(&mut state, &at).command);
        }
        all.push(peak);
        if peak.is_nan() || peak > 1e6 {
            break;
        }
    }
    all
}

/// Whether the loop swings out (the last second below half of the second one) or up.
fn settles(observer: &DisturbanceObserver<f64>, law: &Pid<f64>, plant: One) -> bool {
    let all = peaks(observer, law, plant, 8);
    all.len() == 8 && all[7] < 0.5 * all[1]
}

/// For single plants what is proved and what swings lie together: within 8 % of the way to the edge
/// and a sample of delay.
#[test]
fn of_single_plants_the_edge_of_the_proof_is_the_edge_of_stability() {
    type Along = (&'static str, fn(&mut One, f64), f64);
    let along: [Along; 3] = [
        ("gain", |p, x| p.gain = 0.6 * x, 100.0),
        ("wn, downwards", |p, x| p.wn = 25.5 / x, 3.0),
        ("delay", |p, x| p.late = (15.0 * x) as usize, 20.0),
    ];
    for (k_p, k_i) in [(12.0, 60.0), (6.0, 60.0), (12.0, 0.0)] {
        let (observer, law) = loops(0.016, 0.003, k_p, k_i);
        for (name, change, high) in along {
            let plant = |x: f64| with(BASE, |p| change(p, x));
            let proved = |x| ObserverStability::try_new(&observer, &law, &at(plant(x))).is_ok();
            assert!(proved(1.0) && !proved(high), "{name} {k_p}");
            let (mut good, mut bad) = (1.0, high);
            while bad - good > 0.002 {
                let x = 0.5 * (good + bad);
                *(if proved(x) { &mut good } else { &mut bad }) = x;
            }
            // Whole samples of delay are two or three hundredths of it.
            let inside = plant(1.0 + (good - 1.0) * 0.92);
            let outside = plant(1.0 + (good - 1.0) * 1.08 + 0.04);
            let named = format!("{name} {k_p} {good} {inside:?} {outside:?}");
            assert!(settles(&observer, &law, inside), "{named}");
            let grown = peaks(&observer, &law, outside, 8);
            assert!(
                grown.len() < 8 || grown[7] > 1.2 * grown[1],
                "{named} {grown:?}"
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    /// Of a whole range the plants at its corners, and any other, settle.
    #[test]
    fn what_is_proved_settles(
        tau in 0.008..0.04_f64,
        latency in 0.0..0.006_f64,
        k_p in 0.0..15.0_f64,
        k_i in 5.0..80.0_f64,
        spread in (0.05..0.4_f64, 0.02..0.2_f64, 0.05..0.5_f64),
        late in (0_usize..10, 0_usize..10),
        flattest in 0.2..1.0_f64,
        pick in prop::collection::vec((0.0..=1.0_f64, 0.0..=1.0_f64, 0.0..=1.0_f64, 0.0..=1.0_f64), 2),
    ) {
        let (observer, law) = loops(tau, latency, k_p, k_i);
        let around = |x: f64, by: f64| between(x * (1.0 - by), x * (1.0 + by));
        let samples = |n: usize| (n as f64 + 0.5) * DT;
        let (least, most) = (late.0.min(late.1), late.0.max(late.1));
        let range = PlantRange {
            gain: around(0.6, spread.0),
            natural_frequency: around(25.5, spread.1),
            damping_ratio: around(0.265, spread.2),
            joint: between(0.001, 0.004),
            slope: between(flattest, 1.1),
            latency: between(samples(least), samples(most)),
        };
        prop_assume!(ObserverStability::try_new(&observer, &law, &range).is_ok());
        let within = |of: Interval<f64>, share: f64| of.low + share * (of.high - of.low);
        let corners = [(0.0, 0.0, 0.0, 1.0), (1.0, 0.0, 0.0, 1.0), (1.0, 1.0, 0.0, 0.0)];
        for (gain, wn, zeta, joint) in corners.into_iter().chain(pick) {
            for (late, slope) in [(least, 1.0), (most, 0.0), (most, 1.0)] {
                let plant = One {
                    gain: within(range.gain, gain),
                    wn: within(range.natural_frequency, wn),
                    zeta: within(range.damping_ratio, zeta),
                    joint: within(range.joint, joint),
                    slope: within(range.slope, slope),
                    late,
                };
                let all = peaks(&observer, &law, plant, 8);
                // Near the edge it swings long: it must not swing up.
                prop_assert!(all.len() == 8 && all[7] <= 1.02 * all[1] + 1e-9, "{plant:?} {all:?}");
            }
        }
    }
}

#[test]
fn what_is_no_range_or_no_loop_is_refused_by_name() {
    let (observer, law) = loops(0.016, 0.003, 12.0, 60.0);
    let good = at(One { late: 10, ..BASE });
    let refused = |law: &Pid<f64>, spoil: fn(&mut PlantRange)| {
        ObserverStability::try_new(&observer, law, &with(good, spoil)).err()
    };
    assert_eq!(refused(&law, |_| {}), None);
    let one_sign = "gain and nominal gain must have the same sign";
    type Change = fn(&mut PlantRange);
    #[rustfmt::skip]
    let cases: [(Error, Change); 7] = [
        (Error::OutOfRange("gain"), |r| r.gain.low = -0.1),
        (Error::OutOfRange("natural_frequency"), |r| r.natural_frequency.low = r.natural_frequency.high + 1.0),
        (Error::OutOfRange("damping_ratio"), |r| r.damping_ratio.low = -0.1),
        (Error::NonFinite("joint"), |r| r.joint.low = f64::NAN),
        (Error::OutOfRange("slope"), |r| r.slope.low = 0.0),
        (Error::OutOfRange("latency"), |r| r.latency.low = -1e-3),
        (Error::Inadmissible(one_sign), |r| r.gain = between(-0.7, -0.5)),
    ];
    for (error, spoil) in cases {
        assert_eq!(refused(&law, spoil), Some(error));
    }
    let damped = with(*law.settings(), |s| {
        (s.k_d, s.derivative_time) = (1.0, 0.01)
    });
    // Routh: 2·zeta/wn·(1 + alpha·k_p) against alpha·k_i/wn².
    let unstable = "the nominal loop without latency must be stable";
    for (law, condition) in [
        (Pid::try_new(damped).unwrap(), "the law must be a P or a PI"),
        (pi(12.0, 300.0), unstable),
    ] {
        assert_eq!(refused(&law, |_| {}), Some(Error::Inadmissible(condition)));
    }
}

#[test]
fn the_reference_rig_has_room_where_the_nominal_wn_is_low_rather_than_high() {
    let (observer, law) = loops(0.0159, 0.003, 12.0, 60.0);
    let proved = |low: f64, high: f64| {
        let range = with(at(BASE), |r| {
            r.natural_frequency = between(25.5 * low, 25.5 * high)
        });
        ObserverStability::try_new(&observer, &law, &range).is_ok()
    };
    assert!(proved(0.95, 1.3) && !proved(0.8, 1.0));
}

/// 3 ms of lead in the joint make up for 3 ms of latency: without it the same loop swings up.
#[test]
fn the_joints_damping_is_what_the_latency_needs() {
    let (observer, law) = loops(0.0159, 0.003, 12.0, 60.0);
    let without = One { joint: 0.0, ..BASE };
    let proved = |plant| ObserverStability::try_new(&observer, &law, &at(plant)).is_ok();
    assert!(proved(BASE) && settles(&observer, &law, BASE));
    let grown = peaks(&observer, &law, without, 8);
    assert!(!proved(without) && (grown.len() < 8 || grown[7] > grown[1]));
}
