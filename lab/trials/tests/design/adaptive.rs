//! The adaptive law in lag form: admitted, certified, and within its certificate.

use super::{cable, design, designed, model, rising, ASKED, QUICK};
use bowden::control::{Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Form, Limits};
use bowden::hysteresis::BoucWenState;
use bowden_rig::{Noise, Reference};
use bowden_trials::design::Question;

#[test]
fn its_gains_are_half_of_what_the_constructor_admits() {
    let mut dice = Noise::new(8);
    for delay in [0.0, 0.0004, 0.003] {
        for _ in 0..20 {
            let asked = Question {
                delay,
                drive_gain: 0.6,
                ..ASKED
            };
            let own = designed(rising(&mut dice), &asked).adaptive;
            let settings = own.settings.expect("admissible");
            assert!(Adaptive::try_new(settings).is_ok());
            let step = settings.largest_step().unwrap();
            assert!((own.step / step - 0.5).abs() < 1e-9, "{own:?}");
            // A step is longer than the delay: the plant answers within one sample.
            assert!(own.step > delay && own.every as f64 / asked.rate == own.step);
            assert_eq!(own.at_the_rate, own.every == 1);
            assert!(settings.epsilon >= settings.delta.high / 40.0);
            let twice = AdaptiveSettings {
                gain: 4.0 * settings.gain,
                ..settings
            };
            assert!(Adaptive::try_new(twice).is_err());
        }
    }
}

#[test]
fn the_certificate_is_the_shipped_one_of_the_plant_that_the_model_describes() {
    use bowden_bound::{Interval, PeakSampled, Plant};
    let term = "[[terms]]\neffect = \"viscous\"\nsource = \"phi_p\"\ngain = -0.1\n";
    let text = model([0.9, 2.0, 0.05, 0.2, 0.6, 2.0], term)
        + "[about.ranges.phi_p]\nposition = [-1.0, 1.0]\nvelocity = [-2.0, 3.0]\nacceleration = [-9.0, 9.0]\n\
           [about.intervals]\ngain = [0.88, 0.92]\nkappa_eta = [1.9, 2.1]\noffset = [0.0, 0.1]\n";
    let own = design(&text, "m.toml", &QUICK).unwrap();
    let law = Adaptive::try_new(own.adaptive.settings.unwrap()).unwrap();
    // f = rho·2·sigma = 0.24, B - kappa_eta·f = 0.42; the viscous share is at most 0.3 N·m.
    let rate = 0.42 * 40.0;
    let plant = Plant {
        alpha: Interval {
            low: 0.88 * 0.98,
            high: 0.92 * 1.02,
        },
        delta_rate: 0.48 / 0.42 * rate + std::f64::consts::TAU * 8.0 * 0.3,
        reference: 0.9 * 20.0 - 2.0 + 0.05,
        reference_rate: rate,
        ..Plant::new(1.0, 2.1 + 0.1 + 0.3)
    };
    // As great a reference as the limits hold against the disturbance and the error; the error
    // that is set aside is that of the record's own reference, a twentieth more here.
    let (reference, error) = (
        own.adaptive.plant.unwrap().reference,
        own.adaptive.certificate.unwrap(),
    );
    let needed = (reference + error + plant.delta) / plant.alpha.low;
    assert!(needed <= 20.0 && needed > 0.98 * 20.0, "{needed}");
    assert!(reference < plant.reference);
    // The proof has the roundings of f32 as well, below a thousandth here.
    let promised = Plant { reference, ..plant };
    let peak = PeakSampled::try_new(&law, &promised).unwrap();
    assert!((error / peak.bound - 1.0).abs() < 1e-3, "{own:?} {peak:?}");
}

#[test]
fn the_error_on_a_plant_that_answers_within_the_step_stays_within_the_certificate() {
    let mut dice = Noise::new(9);
    let mut certified = 0;
    for _ in 0..12 {
        let numbers = rising(&mut dice);
        let own = designed(numbers, &QUICK);
        let law = own.adaptive.settings.unwrap();
        let Some(bound) = own.adaptive.certificate else {
            continue;
        };
        certified += 1;
        // The certificate holds where no limit is met.
        let free = AdaptiveSettings {
            limits: Limits::unlimited(),
            ..law
        };
        let law = Adaptive::try_new(free).unwrap();
        let mut state = AdaptiveState::new(&law);
        let (cable, mut cable_state) = (cable(numbers), BoucWenState::new());
        let rate = own.bounds.reference_rate.unwrap();
        let [low, high] = own.bounds.output.unwrap();
        let reference = Reference::paper().between(0.6 * low, 0.6 * high);
        // So slow that its rate is what the certificate allows.
        let pace = rate / (0.3 * (high - low) * 2.2);
        let (mut u, mut worst) = (0.0, 0.0_f64);
        for k in 0..20_000 {
            let t = 1e-3 * f64::from(k);
            let at = |t: f64| reference.at(pace * t);
            let y = cable.step(&mut cable_state, u);
            let input = AdaptiveInput {
                next_reference: at(t + 1e-3),
                ..AdaptiveInput::new(1e-3, at(t), y, [])
            };
            u = law.step(&mut state, &input).command;
            if t > 2.0 {
                worst = worst.max((y - at(t)).abs());
            }
        }
        assert!(worst <= bound, "{numbers:?}: {worst} > {bound}");
    }
    assert!(certified > 6, "{certified}");
}

#[test]
fn the_boxes_are_the_intervals_of_the_model_and_what_is_assumed_is_said() {
    let numbers = [0.9, 2.0, 0.05, 0.2, 0.6, 2.0];
    let plain = designed(numbers, &ASKED);
    assert_eq!(plain.adaptive.assumed, ["gain", "kappa_eta", "offset"]);
    assert!(plain.notes.iter().any(|n| n.contains("±10 % was assumed")));
    let text = model(numbers, "")
        + "[about.intervals]\ngain = [0.88, 0.92]\nkappa_eta = [1.9, 2.1]\noffset = [0.0, 0.1]\n";
    let told = design(&text, "m.toml", &ASKED).unwrap();
    assert!(told.adaptive.assumed.is_empty());
    let law = told.adaptive.settings.unwrap();
    // The drive's gain is known to 2 %.
    assert!((law.beta.low - 1.0 / (0.92 * 1.02)).abs() < 1e-12);
    assert!((law.beta.high - 1.0 / (0.88 * 0.98)).abs() < 1e-12);
    assert!((law.delta.high - 2.2).abs() < 1e-12);
    let Form::FirstOrder { plant_gain, .. } = law.form else {
        panic!()
    };
    assert!((plant_gain - 0.92 * 1.02).abs() < 1e-12);
}

#[test]
fn where_no_gain_is_admissible_it_says_why() {
    let numbers = [0.9, 2.0, 0.05, 0.2, 0.6, 2.0];
    let asked = Question {
        rate: 2.0,
        delay: 0.4,
        ..ASKED
    };
    let slow = designed(numbers, &asked);
    assert!(slow.adaptive.settings.is_none() && slow.gains.adaptive.is_none());
    let why = slow.adaptive.refused.unwrap();
    assert!(why.contains("h·lambda <= 1 cannot both hold"), "{why}");
    let text = model(numbers, "") + "[about.intervals]\ngain = [-0.1, 1.9]\n";
    let open = design(&text, "m.toml", &ASKED).unwrap().adaptive;
    let why = open.refused.unwrap();
    assert!(why.contains("B includes values down to -0.1"), "{why}");
    // A cable that turns back has gains and no certificate.
    let back = designed([0.9, 2.0, 0.05, 0.4, 3.0, 1.0], &ASKED);
    assert!(back.slopes.least < 0.0 && back.adaptive.settings.is_some());
    let why = back.adaptive.uncertified.unwrap();
    assert!(why.contains("smallest slope"), "{why}");
    assert!(back.bounds.reference_rate.is_none());
    let said = |note: &String| note.contains("the output moves against the input");
    assert!(back.notes.iter().any(said));
}
