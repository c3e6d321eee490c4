//! Gains as a Rust file for firmware, in single precision, checked by its compiler.

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

/// A number as firmware has it: the shortest text that reads back to the same `f32`.
fn number(value: f64) -> String {
    format!("{:?}", value as f32)
}

/// The gains as statics that the compiler checks: `PI`, `PID` and `ADAPTIVE`, as far as they
/// were designed.
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
        ("Damping", pid),
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
    line!(out, "//! Gains that {} designed for {}.", for_.by, for_.model);
    line!(out, "//!");
    line!(
        out,
        "//! {} Hz, {} s from the command to its measured torque, {} N·m for one command unit.",
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

fn bounds(designed: &Designed, out: &mut String) {
    let b = &designed.bounds;
    line!(out, "/// Samples a second [Hz].");
    line!(out, "#[allow(dead_code)]");
    line!(out, "pub const RATE: f32 = {};", number(designed.gains.design.rate));
    line!(out);
    line!(out, "/// Range [command unit] that the record has covered, and slew rate [command unit/s].");
    line!(out, "pub const LIMITS: Limits<f32> = constant!(constant!(Limits::<f32>::const_new(");
    line!(out, "    {},", number(b.low));
    line!(out, "    {}", number(b.high));
    line!(out, "))");
    line!(out, ".const_with_slew({}));", number(b.slew));
    line!(out);
    line!(
        out,
        "/// The safe command [command unit] after {} bad samples in a row.",
        b.fallback_after
    );
    line!(out, "pub const FALLBACK: Fallback<f32> =");
    line!(
        out,
        "    constant!(Fallback::<f32>::const_new({}, {}));",
        b.fallback_after,
        number(b.fallback_command)
    );
    line!(out);
    line!(out, "/// A longer `dt` is a bad sample [s].");
    line!(out, "pub const LONGEST_DT: f32 = {};", number(b.longest_dt));
}

fn settings(name: &str, own: &PidSettings<f64>, out: &mut String) {
    line!(out);
    line!(
        out,
        "/// {name}: k_p [command unit/(N·m)] and k_i [command unit/(N·m·s)] first."
    );
    line!(out, "#[allow(dead_code)]");
    line!(
        out,
        "pub static {name}: Pid<f32> = constant!(Pid::<f32>::const_new(PidSettings {{"
    );
    if own.k_d != 0.0 {
        line!(out, "    k_d: {},", number(own.k_d));
        line!(out, "    derivative_time: {},", number(own.derivative_time));
        line!(out, "    damping: Damping::on_measurement(),");
    }
    line!(
        out,
        "    ..PidSettings::new({}, {}, LIMITS, LONGEST_DT, FALLBACK)",
        number(own.k_p),
        number(own.k_i)
    );
    line!(out, "}}));");
}

fn adaptive(own: &AdaptiveSettings<f64, 0>, every: usize, out: &mut String) {
    let Form::Lag { step, plant_gain } = own.form else {
        return;
    };
    line!(out);
    line!(out, "/// Adaptive law, lag form, without regressors; beta_hat and delta_hat adapt.");
    line!(out, "///");
    match every {
        1 => line!(out, "/// Call it once a sample."),
        _ => line!(out, "/// Call it on every {every}th sample: it needs a plant that answers within its step."),
    }
    line!(out, "#[allow(dead_code)]");
    line!(
        out,
        "pub static ADAPTIVE: Adaptive<f32, 0> = constant!(Adaptive::<f32, 0>::const_new(AdaptiveSettings {{"
    );
    estimator("beta", &own.beta, out);
    estimator("delta", &own.delta, out);
    line!(out, "    z_limit: {},", number(own.z_limit));
    line!(out, "    ..AdaptiveSettings::new(");
    line!(
        out,
        "        Form::Lag {{ step: {}, plant_gain: {} }},",
        number(step),
        number(plant_gain)
    );
    for value in [own.gain, own.lambda, own.epsilon] {
        line!(out, "        {},", number(value));
    }
    line!(out, "        LIMITS,");
    line!(out, "        {},", number(own.longest_dt));
    line!(out, "        FALLBACK,");
    line!(out, "    )");
    line!(out, "}}));");
}

fn estimator(name: &str, own: &Estimator<f64>, out: &mut String) {
    line!(out, "    {name}: Estimator {{");
    line!(out, "        prior: {},", number(own.prior));
    line!(out, "        ..Estimator::fixed({})", number(own.initial));
    line!(
        out,
        "            .within({}, {})",
        number(own.low),
        number(own.high)
    );
    line!(
        out,
        "            .adapting({}, {})",
        number(own.gain),
        number(own.leakage.rate())
    );
    line!(out, "    }},");
}
