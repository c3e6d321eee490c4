//! Shapes from the textbook's seven parameters, and from an actuator's data sheet.

use super::*;

const TEXTBOOK: Textbook<f64> = Textbook {
    a: 2.0,
    beta: 1.2,
    gamma: 0.4,
    n: 1.7,
    alpha: 0.2,
    k: 30.0,
    d: 0.5,
};

/// Output of the seven-parameter model, by many Euler steps of its own equation.
fn textbook_output(model: &Textbook<f64>, inputs: &[f64]) -> f64 {
    let (mut z, mut x) = (0.0_f64, 0.0);
    for &next in inputs {
        let parts = 20_000;
        let dx = (next - x) / f64::from(parts);
        for _ in 0..parts {
            let loss = model.beta * dx.abs() * z.abs().powf(model.n - 1.0) * z
                + model.gamma * dx * z.abs().powf(model.n);
            z += (model.a * dx - loss) / model.d;
        }
        x = next;
    }
    model.alpha * model.k * x + (1.0 - model.alpha) * model.d * model.k * z
}

#[test]
fn the_textbooks_seven_parameters_are_five_and_two_that_do_not_matter() {
    let inputs = [0.4, -0.3, 0.1, 0.9, 0.2];
    let report = BoucWen::from_textbook(TEXTBOOK).unwrap();
    assert_eq!((report.class, report.redundant), (Class::I, ["A", "D"]));
    let normalised = report.normalised;
    let (mut eta, mut x) = (0.0, 0.0);
    for next in inputs {
        eta = normalised.shape.advance_four_stage(eta, next - x);
        x = next;
    }
    let ours = normalised.kappa_x * x + normalised.kappa_eta * eta;
    let theirs = textbook_output(&TEXTBOOK, &inputs);
    // kappa_eta = 14: 1e-3 for Euler's 1e-4 relative per part, 3e-3 for four stages' 2e-4.
    assert_abs_diff_eq!(ours, theirs, epsilon = 4e-3);
    assert_abs_diff_eq!(
        textbook_output(&report.equivalent, &inputs),
        theirs,
        epsilon = 4e-3
    );
    let again = BoucWen::from_textbook(report.equivalent)
        .unwrap()
        .normalised;
    assert_abs_diff_eq!(again.shape.rho(), normalised.shape.rho(), epsilon = 1e-13);
    assert_abs_diff_eq!(again.kappa_eta, normalised.kappa_eta, epsilon = 1e-12);
}

#[test]
fn only_the_first_class_of_the_textbook_is_admitted() {
    let with = |a, beta, gamma| Textbook {
        a,
        beta,
        gamma,
        ..TEXTBOOK
    };
    for (model, class) in [
        (with(1.0, 0.2, 0.6), Class::II),
        (with(-1.0, 0.6, 0.2), Class::III),
        (with(-1.0, 0.2, -0.6), Class::IV),
        (with(0.0, 0.6, 0.2), Class::V),
        (with(1.0, -0.6, 0.2), Class::Unbounded),
    ] {
        assert_eq!(model.class(), class);
        assert!(matches!(
            BoucWen::from_textbook(model),
            Err(Error::Inadmissible(_))
        ));
    }
    let wrong = Textbook { d: 0.0, ..TEXTBOOK };
    assert_eq!(
        BoucWen::from_textbook(wrong).unwrap_err(),
        Error::OutOfRange("D")
    );
}

#[test]
fn an_actuator_yields_at_its_yield_torque_and_starts_with_its_stiffness() {
    let actuator = Actuator {
        yield_torque: 2.0,
        stiffness: 100.0,
        post_yield_ratio: 0.1,
        knee: 3.0,
    };
    let joint = BoucWen::from_actuator(actuator).unwrap();
    let output = |x: f64| joint.kappa_x * x + joint.kappa_eta * joint.shape.advance(0.0, x);
    // Stiffness before yield, then the line from the yield point with a tenth of it.
    assert_abs_diff_eq!(output(1e-4), 1e-2, epsilon = 1e-9);
    assert_abs_diff_eq!(output(1.0), 0.1 * 100.0 + 0.9 * 2.0, epsilon = 1e-9);
    let soft = Actuator {
        knee: 0.5,
        ..actuator
    };
    assert_eq!(
        BoucWen::from_actuator(soft).unwrap_err(),
        Error::OutOfRange("knee")
    );
}
