use super::*;
use crate::problem::{Preparation, MOST_RECORDS};
use crate::record::{Column, Mode, Record};
use bowden::model::Source;

/// A record whose input moves in two tones.
fn data() -> Prepared {
    let time: Vec<f64> = (0..4000).map(|i| f64::from(i) * 0.005).collect();
    let column = |name: &str, of: fn(f64) -> f64| Column {
        name: name.to_owned(),
        unit: None,
        values: time.iter().map(|&t| of(t)).collect(),
        definition: None,
    };
    let record = Record {
        path: "made".to_owned(),
        mode: Mode::Torque,
        input: column("tau_i", |t| (2.0 * t).sin() + 0.5 * (0.7 * t).cos()),
        output: column("tau_o", f64::cos),
        channels: Vec::new(),
        notes: Vec::new(),
        defects: Vec::new(),
        dropped: 0,
        time,
    };
    let cutoff = Some(5.0);
    Prepared::new(&record, Preparation { cutoff }).unwrap()
}

fn term(name: &str, shapes: &[f64]) -> FitTerm {
    FitTerm {
        effect: Effect::try_from_name(name, shapes).unwrap(),
        source: Source::Input,
        origin: 0.1,
        start: [0.05; MOST_RECORDS],
    }
}

/// A state that stays away from ±1, and how it moves with a parameter.
fn eta(data: &Prepared) -> (Vec<f64>, Vec<f64>) {
    let at = |i: usize| 0.9 * (0.03 * i as f64 + 0.2).sin();
    let moves = |i: usize| 0.4 + (0.017 * i as f64).cos();
    let all = 0..data.work_len();
    (all.clone().map(at).collect(), all.map(moves).collect())
}

/// Central differences are off by a sixth of their step squared: at most 2e-9, of a tone after 20 s,
/// whose phase moves by 1.3e-4. Rounding over the step is 1e-11 of numbers up to a hundred times
/// the slope.
fn assert_close(own: &[f64], expected: &[f64], what: &str) {
    let largest = expected.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    assert!(largest > 1e-3, "{what} moves nothing");
    assert_eq!(own.len(), expected.len());
    for (i, (a, b)) in own.iter().zip(expected).enumerate() {
        assert!(
            (a - b).abs() < 1e-7 * largest,
            "{what} at {i}: {a}, not {b}"
        );
    }
}

#[test]
fn closed_slopes_are_the_limits_of_differences() {
    let data = data();
    let (eta, _) = eta(&data);
    let id = crate::model::structure::Terms::default().push(term("offset", &[]));
    for (name, shapes) in [
        ("coulomb", &[0.6][..]),
        ("position-friction", &[0.6]),
        ("load-friction", &[0.6]),
        ("drive-friction", &[0.6]),
        ("back-drive-friction", &[0.6]),
        ("stribeck", &[1.2, 1.3]),
        ("pinching", &[0.4]),
        ("ripple", &[3.0, 0.4]),
        ("tone", &[0.1, 0.2]),
        ("gravity", &[0.5]),
        ("creep", &[0.4]),
        ("presliding-dahl", &[0.7]),
    ] {
        let term = term(name, shapes);
        let column = effect_column(&data, &term, &eta).unwrap();
        let mut closed = Slopes::of(&data, &term, &eta, &column).unwrap();
        let mut roles: Vec<Role> = (0..shapes.len())
            .map(|index| Role::Shape { term: id, index })
            .collect();
        if term.has_past() {
            roles.push(Role::Start {
                term: id,
                record: 0,
            });
        }
        for role in roles {
            let value = match role {
                Role::Shape { index, .. } => shapes[index],
                _ => 0.05,
            };
            let by = Variation::of(id, role).unwrap();
            let own = closed.take(&data, &by).unwrap();
            let expected = by.slope(&data, &term, value, &eta).unwrap();
            assert_close(&own, &expected, &format!("{name}, {role:?}"));
        }
    }
    // No closed form of what has a corner.
    let hinge = term("hinge", &[0.2]);
    assert!(Slopes::of(&data, &hinge, &eta, &eta).is_none());
}

#[test]
fn closed_slopes_in_eta_are_the_limits_of_differences() {
    let data = data();
    let (eta, moves) = eta(&data);
    for (name, shapes) in [
        ("rate", &[][..]),
        ("rate-symmetric", &[]),
        ("position-hysteresis", &[]),
        ("asymmetry-eta", &[]),
        ("asymmetry-eta-squared", &[]),
        ("pinching", &[0.4]),
    ] {
        let term = term(name, shapes);
        let direct = closed::in_eta(&data, &term, &eta).unwrap();
        let own: Vec<f64> = direct.iter().zip(&moves).map(|(a, b)| a * b).collect();
        let expected = eta_derivative(&data, &term, &eta, &moves).unwrap();
        assert_close(&own, &expected, name);
    }
    let degradation = term("degradation", &[1.0]);
    assert!(closed::in_eta(&data, &degradation, &eta).is_none());
}
