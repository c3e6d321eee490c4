//! Gains as a Rust file for firmware, in single precision, checked by the compiler.

use super::Designed;
use bowden::control::{AdaptiveSettings, Estimator, Form, PidSettings};
use std::fmt::Write as _;

/// One more line of the text; writing to a `String` cannot fail.
macro_rules! line {
    ($out:ident) => {
        $out.push('\n')
    };
    ($out:ident, $($text:tt)+) => {{
        let _ = writeln!($out, $($text)+);
    }};
}

/// A number in firmware: the shortest text that parses to the same `f32`.
fn number(value: f64) -> String {
    format!("{:?}", value as f32)
}

/// The gains as statics that the compiler checks: `PI`, `PID` and `ADAPTIVE`, if they were
/// designed.
#[must_use]
pub fn rust(designed: &Designed) -> String {
    let gains = &designed.gains;
    let mut out = head(designed);
    let pid = gains.pid.is_some();
    let law = gains.adaptive.is_some();
    line!(out, "use bowden::constant;");
    let used = [
        ("Adaptive", law),
        ("AdaptiveSettings", law),
        ("DerivativeSource", pid),
        ("Estimator", law),
        ("Fallback", true),
        ("Form", law),
        ("Limits", true),
        ("Pid", true),
        ("PidSettings", true),
    ];
    let used: Vec<&str> = used.iter().filter(|u| u.1).map(|u| u.0).collect();
    let short = format!("use bowden::control::{{{}}};", used.join(", "));
    if short.len() <= 100 {
        line!(out, "{short}");
    } else {
        line!(out, "use bowden::control::{{");
        line!(out, "    {},", used.join(", "));
        line!(out, "}};");
    }
    line!(out);
    bounds(designed, &mut out);
    settings("PI", &gains.pi, &mut out);
    if let Some(own) = &gains.pid {
        settings("PID", own, &mut out);
    }
    if let Some(own) = &gains.adaptive {
        adaptive(own, gains.adaptive_every(), &mut out);
    }
    out
}

fn head(designed: &Designed) -> String {
    let (for_, pi) = (&designed.gains.design, &designed.pi);
    let mut out = String::new();
    line!(out, "//! Gains designed by {} for {}.", for_.by, for_.model);
    line!(out, "//!");
    line!(
        out,
        "//! {} Hz, {} s from a command to its effect on the measured torque, {} N·m per command unit.",
        for_.rate,
        for_.delay,
        for_.drive_gain
    );
    line!(
        out,
        "//! At the slope {:.4}: gain margin {:.2}, phase margin {:.1} deg, overshoot {:.1} %.",
        designed.design_slope,
        pi.margins.gain,
        pi.margins.phase,
        100.0 * pi.overshoot
    );
    for note in &designed.notes {
        line!(out, "//!");
        line!(out, "//! Note: {note}.");
    }
    line!(out);
    out
}

/// An item in the format of rustfmt: on one line if it fits.
fn item(what: &str, value: &str, out: &mut String) {
    let short = format!("{what} = {value};");
    if short.chars().count() <= 100 {
        line!(out, "{short}");
    } else {
        line!(out, "{what} =");
        line!(out, "    {value};");
    }
}

fn bounds(designed: &Designed, out: &mut String) {
    let b = &designed.bounds;
    line!(out, "/// Samples per second [Hz].");
    line!(out, "#[allow(dead_code)]");
    let rate = number(designed.gains.design.rate);
    item("pub const RATE: f32", &rate, out);
    line!(out);
    line!(out, "/// Range of the record [command unit].");
    let (low, high) = (number(b.low), number(b.high));
    let range = format!("constant!(Limits::<f32>::try_new({low}, {high}))");
    item("const RANGE: Limits<f32>", &range, out);
    line!(out);
    line!(
        out,
        "/// The range with the slew-rate limit [command unit/s]."
    );
    let slewed = format!(
        "constant!(Limits::<f32>::with_slew(RANGE, {}))",
        number(b.slew)
    );
    item("pub const LIMITS: Limits<f32>", &slewed, out);
    line!(out);
    let after = b.fallback_after;
    line!(
        out,
        "/// The safe command [command unit] after {after} consecutive bad samples."
    );
    let safe = number(b.fallback_command);
    let fallback = format!("constant!(Fallback::<f32>::try_new({after}, {safe}))");
    item("pub const FALLBACK: Fallback<f32>", &fallback, out);
    line!(out);
    line!(
        out,
        "/// Longest valid `dt` [s]; a sample with a longer `dt` counts as bad."
    );
    item("pub const LONGEST_DT: f32", &number(b.longest_dt), out);
}

fn settings(name: &str, own: &PidSettings<f64>, out: &mut String) {
    let (k_p, k_i) = (number(own.k_p), number(own.k_i));
    let plain = format!("PidSettings::new({k_p}, {k_i}, LIMITS, LONGEST_DT, FALLBACK)");
    line!(out);
    let unit = "[command unit/(N·m)] and k_i [command unit/(N·m·s)]";
    line!(out, "/// {name}: the first two arguments are k_p {unit}.");
    let what = format!("const {name}_SETTINGS: PidSettings<f32>");
    if own.k_d == 0.0 {
        item(&what, &plain, out);
    } else {
        line!(out, "{what} = PidSettings {{");
        line!(out, "    k_d: {},", number(own.k_d));
        line!(out, "    derivative_time: {},", number(own.derivative_time));
        line!(out, "    damping: DerivativeSource::on_measurement(),");
        line!(out, "    ..{plain}");
        line!(out, "}};");
    }
    line!(out);
    line!(out, "/// {name}, checked.");
    line!(out, "#[allow(dead_code)]");
    let what = format!("pub static {name}: Pid<f32>");
    let checked = format!("constant!(Pid::<f32>::try_new({name}_SETTINGS))");
    item(&what, &checked, out);
}

fn adaptive(own: &AdaptiveSettings<f64, 0>, every: usize, out: &mut String) {
    let Form::FirstOrder { step, plant_gain } = own.form else {
        return;
    };
    line!(out);
    line!(
        out,
        "/// Step [s], and largest gain of the plant [N·m/command unit]."
    );
    line!(out, "const LAG: Form<f32> = Form::FirstOrder {{");
    line!(out, "    step: {},", number(step));
    line!(out, "    plant_gain: {},", number(plant_gain));
    line!(out, "}};");
    estimator("BETA", "beta_hat [command unit/(N·m)]", &own.beta, out);
    estimator("DELTA", "delta_hat [N·m]", &own.delta, out);
    line!(out);
    for (name, what, value) in [
        ("K", "k", own.gain),
        ("LAMBDA", "lambda [1/s]", own.lambda),
        ("EPSILON", "epsilon [N·m]", own.epsilon),
        (
            "LONGEST_STEP",
            "Longest valid step of the law [s]; a longer step counts as bad",
            own.longest_dt,
        ),
    ] {
        line!(out, "/// {what}.");
        item(&format!("const {name}: f32"), &number(value), out);
        line!(out);
    }
    limits_of_steps(own, out);
    line!(out, "/// The settings of the law.");
    line!(
        out,
        "const ADAPTIVE_SETTINGS: AdaptiveSettings<f32, 0> = AdaptiveSettings {{"
    );
    line!(out, "    beta: BETA,");
    line!(out, "    delta: DELTA,");
    line!(out, "    z_limit: {},", number(own.z_limit));
    line!(
        out,
        "    ..AdaptiveSettings::new(LAG, K, LAMBDA, EPSILON, STEPS_LIMITS, LONGEST_STEP, STEPS_FALLBACK)"
    );
    line!(out, "}};");
    line!(out);
    line!(
        out,
        "/// The adaptive law in first-order form, without regressors."
    );
    line!(out, "///");
    match every {
        1 => line!(out, "/// Call it once per sample."),
        _ => line!(
            out,
            "/// Call `step` only on one sample in {every}, because the plant must respond within one step of the law."
        ),
    }
    line!(out, "#[allow(dead_code)]");
    item(
        "pub static ADAPTIVE: Adaptive<f32, 0>",
        "constant!(Adaptive::<f32, 0>::try_new(ADAPTIVE_SETTINGS))",
        out,
    );
}

/// The fallback and the limits of the adaptive law, which counts steps instead of samples.
fn limits_of_steps(own: &AdaptiveSettings<f64, 0>, out: &mut String) {
    let (after, safe) = (own.fallback.after(), own.fallback.command().unwrap_or(0.0));
    line!(
        out,
        "/// The safe command [command unit] after {after} consecutive bad steps of the law."
    );
    let fallback = format!(
        "constant!(Fallback::<f32>::try_new({after}, {}))",
        number(safe)
    );
    item("const STEPS_FALLBACK: Fallback<f32>", &fallback, out);
    line!(out);
    let slew = own.limits.slew().unwrap_or(f64::INFINITY);
    line!(
        out,
        "/// The range with the slew-rate limit that the certificate needs [command unit/s]."
    );
    let slewed = format!(
        "constant!(Limits::<f32>::with_slew(RANGE, {}))",
        number(slew)
    );
    item("const STEPS_LIMITS: Limits<f32>", &slewed, out);
    line!(out);
}

fn estimator(name: &str, what: &str, own: &Estimator<f64>, out: &mut String) {
    line!(out);
    line!(
        out,
        "/// Estimate {what}: start, bounds, gain, leakage [1/s]."
    );
    line!(out, "const {name}: Estimator<f32> = Estimator {{");
    line!(out, "    prior: {},", number(own.prior));
    let start = format!("..Estimator::fixed({})", number(own.initial));
    let within = format!(".within({}, {})", number(own.low), number(own.high));
    let (gain, leakage) = (number(own.gain), number(own.leakage.rate()));
    let adapting = format!(".adapting({gain}, {leakage})");
    // rustfmt keeps a chain of up to 60 characters on one line.
    if start.len() - 2 + within.len() + adapting.len() <= 60 {
        line!(out, "    {start}{within}{adapting}");
    } else {
        line!(out, "    {start}");
        line!(out, "        {within}");
        line!(out, "        {adapting}");
    }
    line!(out, "}};");
}
