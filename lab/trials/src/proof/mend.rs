//! A change of a rate, a bound or a gain that would satisfy a violated inequality.

use super::form::{Float, Form};
use crate::decimal::{digits, places};
use bowden_bound::{Inequality, Named};

/// The change in one sentence. Its numbers are rounded to three digits, to the safe side.
pub(super) fn words(form: &Form, inequality: &Inequality) -> String {
    let (lambda, step, k) = (form.lambda.0, form.step.0, form.k.0);
    let g = form.plant.alpha.0[1] * form.beta.0[1];
    let (left, right) = (inequality.left.as_f64(), inequality.right.as_f64());
    let coarse = match form.float {
        Float::F32 => "f64, a lower rate or a larger lambda",
        Float::F64 => "a lower rate or a larger lambda",
    };
    match inequality.name {
        Named::Step => format!(
            "a rate of at least {} Hz, or lambda of at most {} 1/s",
            up(lambda),
            down(1.0 / step)
        ),
        Named::Steepness => {
            let rate = format!("a rate of at least {} Hz", up(left / step));
            // What k + delta/epsilon may be.
            let room = 1.0 / (step * lambda * g);
            let slope = form.delta.0[1] / form.epsilon.0;
            let least_k = 1.0 / (lambda * lambda);
            if room > k {
                let epsilon = up(form.delta.0[1] / (room - k));
                let delta = down((room - k) * form.epsilon.0);
                format!("{rate}, epsilon of at least {epsilon} N·m, or bounds of delta_hat up to {delta} N·m")
            } else if room - slope > least_k {
                format!("{rate}, or k of at most {}", down(room - slope))
            } else {
                format!(
                    "{rate}, or k + delta_hat/epsilon of at most {} instead of {k} + {}",
                    down(room),
                    up(slope)
                )
            }
        }
        Named::Stiffness => format!("k above 1/lambda² = {}", up(1.0 / (lambda * lambda))),
        Named::SStays => format!(
            "a larger k or lambda, a higher lower bound of beta_hat, or {coarse}, because k = {k} is too close to 1/lambda² = {}",
            up(1.0 / (lambda * lambda))
        ),
        Named::ZStays | Named::Owed | Named::Slack => format!("{coarse}, because the increment of z is smaller than its rounding error"),
        Named::ZLimit => format!("z_limit of at least {} N·m·s", up(left)),
        Named::Command => format!(
            "a command limit of at least {} instead of {right}, a smaller reference or a smaller disturbance",
            up(left)
        ),
        Named::Reserve => format!(
            "a command limit of at least {} instead of {right}, a smaller reference or a smaller disturbance, because the saturated command must hold the reference against the disturbance",
            up(left)
        ),
        Named::Waiting => format!("a rate of at least {} Hz", up(left / step)),
        Named::Slew => format!(
            "a slew-rate limit of at least {} instead of {}, or no slew-rate limit, because the proof is valid only while this limit is inactive",
            up(1.001 * left / step),
            form.slew.map_or(f64::NAN, |slew| slew.0)
        ),
        Named::Overflow => {
            "a larger epsilon or smaller gains, because a number in the step overflows its float type"
                .to_owned()
        }
    }
}

fn up(x: f64) -> String {
    three_digits(x, f64::ceil)
}

fn down(x: f64) -> String {
    three_digits(x, f64::floor)
}

fn three_digits(x: f64, round: fn(f64) -> f64) -> String {
    let rounded = digits(x, 3, round);
    format!("{rounded:.*}", places(x, 0))
}
