//! The gains that follow: margins by the frequency response, and a loop that is closed with them.

use super::exact::root;
use super::*;
use std::f64::consts::PI;

/// Gain margin, and phase margin in degrees, of a PI on a plant.
fn margins(plant: &Plant, gains: &PiGains<f64>, delay: f64) -> (f64, f64) {
    let size = |w: f64| plant.response(w).0 * gains.k_p.hypot(gains.k_i / w);
    let phase = |w: f64| plant.response(w).1 - w * delay - (gains.k_i / w).atan2(gains.k_p);
    let crossing = root(1e-3, 1e3, |w| phase(w) + PI);
    let unit = root(1e-3, 1e3, |w| size(w) - 1.0);
    (1.0 / size(crossing), (PI + phase(unit)).to_degrees())
}

fn plants() -> Vec<Plant> {
    let mut plants = vec![
        Plant::third_order(),
        Plant::new(0.5, &[1.0, 0.5], 0.2),
        Plant::new(3.0, &[0.3, 0.2, 0.1, 0.05], 0.0),
    ];
    for delay in [0.1, 0.3, 1.0, 3.0, 10.0] {
        plants.push(Plant::new(1.0, &[1.0], delay));
    }
    plants
}

/// The margins of the docs of `PiRule`. The Ziegler-Nichols gains have the least ones on 1/(s + 1)³.
#[test]
fn the_gains_have_the_margins_that_the_docs_state() {
    for plant in plants() {
        let dt = 2.0 * PI / plant.ultimate().1 / 500.0;
        let it = result::<f64>(usual(), &plant, Sampled::every(dt));
        let of = |rule| margins(&plant, &it.pi(rule), 0.5 * dt);
        let (gain, phase) = of(PiRule::TyreusLuyben);
        assert!(gain > 2.5 && phase > 45.0, "{gain} {phase} {it:?}");
        let (fast_gain, fast_phase) = of(PiRule::ZieglerNichols);
        assert!((1.5..gain).contains(&fast_gain), "{fast_gain} {it:?}");
        assert!((15.0..phase).contains(&fast_phase), "{fast_phase} {it:?}");
    }
}

#[test]
fn a_loop_with_these_gains_reaches_its_reference() {
    for plant in plants() {
        let period = 2.0 * PI / plant.ultimate().1;
        let dt = period / 200.0;
        for rule in [PiRule::TyreusLuyben, PiRule::ZieglerNichols] {
            let settings = with(usual(), |s| s.agreement = 0.05);
            let gains = result::<f64>(settings, &plant, Sampled::every(dt)).pi(rule);
            let pi = pid(gains.k_p, gains.k_i, |_| ());
            let (mut state, mut plant) = (PidState::new(), plant.clone());
            for k in 0..40 * 200 {
                let at = PidInput::new(dt, 1.0, plant.output());
                plant.run(pi.step(&mut state, &at).command, dt);
                // The slowest loop, a delay under the cautious rule, has a time constant of T_i/k_p
                // = 5.5 periods: e^(−30/5.5) = 0.4 % is left.
                let error = (plant.output() - 1.0).abs();
                assert!(k < 30 * 200 || error < 0.02, "{error} {rule:?} {period}");
            }
        }
    }
}
