//! The report of `bowden design`, and its JSON.

use bowden_trials::facts::{above, AdaptiveDesign, Certifies, Designed, PidDesign};
use serde_json::{json, Value};
use std::fmt::Write as _;

/// Schema `bowden.design/1`.
///
/// # Errors
/// Where a number cannot be written, which no design has.
pub fn json(designed: &Designed) -> Result<String, serde_json::Error> {
    let mut all = serde_json::to_value(designed)?;
    all["schema"] = json!("bowden.design/1");
    all["designed_for"] = serde_json::to_value(&designed.gains.design)?;
    if let Value::Object(adaptive) = &mut all["adaptive"] {
        adaptive.remove("assumed");
    }
    Ok(all.to_string())
}

/// For people.
#[must_use]
pub fn text(designed: &Designed) -> String {
    let for_ = &designed.gains.design;
    let mut out = format!(
        "bowden design {}: {} Hz, {} s of delay, noise {} N·m rms, {} N·m for one command unit\n\n",
        for_.model, for_.rate, for_.delay, for_.noise, for_.drive_gain
    );
    let slopes = &designed.slopes;
    let mut row = |name: &str, what: String| {
        let _ = writeln!(out, "{name:<11} {what}");
    };
    row(
        "slope",
        format!(
            "{:.4} to {:.4} N·m of output for 1 N·m of input; designed for {:.4}",
            slopes.least, slopes.greatest, designed.design_slope
        ),
    );
    row(
        "delay",
        format!(
            "a command is measured {} later, hold included",
            match designed.delay_samples {
                1 => "one sample".to_owned(),
                count => format!("{count} samples"),
            }
        ),
    );
    let asked = &designed.asked;
    row(
        "asked",
        format!(
            "gain margin {} or more, phase margin {} deg or more, overshoot {} % or less, Re L above {}",
            asked.gain_margin,
            asked.phase_margin,
            100.0 * asked.overshoot,
            asked.least_real
        ),
    );
    row("pi", gains(&designed.pi));
    let admissible = &designed.admissible;
    row(
        "",
        format!(
            "admissible: k_p below {}, k_i up to {} with this k_p, up to {} without one",
            short(admissible.k_p),
            short(admissible.k_i),
            short(admissible.k_i_alone)
        ),
    );
    let derivative = &designed.derivative;
    let percent = 100.0 * (derivative.integral_gain - 1.0);
    match derivative.helps {
        true => {
            row("derivative", format!("helps: k_i grows by {percent:.0} %"));
            row("pid", gains(&derivative.pid));
        }
        false => row(
            "derivative",
            format!(
                "leave it out: it would change k_i by {percent:.0} %, and it passes the noise on"
            ),
        ),
    }
    bounds(designed, &mut row);
    adaptive(&designed.adaptive, &mut row);
    for note in &designed.notes {
        row("note", note.clone());
    }
    out.push_str(LEGEND);
    out.push_str(match designed.bounds.output {
        Some(_) => {
            ": try the gains\nwith `bowden compare --model MODEL.toml --gains GAINS.toml`.\n"
        }
        None => ".\n`bowden compare` refuses this model: it has no reference for it.\n",
    });
    let _ = writeln!(out, "{}", certifies(designed));
    out
}

const LEGEND: &str = "
slope      between B and B - kappa_eta·rho·max(1, 2·sigma), from the Bouc-Wen equation
Re L       least real part of the open loop: above -1 no sequence of slopes between zero and the
           one it was designed for makes the loop unstable (circle criterion)
reference  a faster one needs inputs that move faster than in the record of the model
The plant is the transmission behind the delay. A joint that swings is not in it\
";

/// What becomes of a file of these gains.
fn certifies(designed: &Designed) -> String {
    match designed.certifies() {
        Certifies::Proves => "`bowden certify GAINS.toml` proves the box of the adaptive law's error, roundings included.".to_owned(),
        Certifies::NamesWhatFails => "`bowden certify GAINS.toml` says which gain or limit stands in the way of a proof of the adaptive law's error.".to_owned(),
        Certifies::Refuses(why) => {
            format!("`bowden certify` refuses a file of these gains: {why}.")
        }
    }
}

fn gains(own: &PidDesign) -> String {
    let mut out = format!(
        "k_p {} unit/(N·m), k_i {} unit/(N·m·s)",
        short(own.k_p),
        short(own.k_i)
    );
    if own.k_d != 0.0 {
        let _ = write!(
            out,
            ", k_d {} unit·s/(N·m) over {} s",
            short(own.k_d),
            short(own.derivative_time)
        );
    }
    let _ = write!(
        out,
        "; margins {:.2} and {:.1} deg, overshoot {:.1} %, Re L {:.2}",
        own.margins.gain,
        own.margins.phase,
        100.0 * own.overshoot,
        own.margins.least_real
    );
    if let Some(settled) = own.settled {
        let _ = write!(out, ", settles in {} s", short(settled));
    }
    out
}

fn bounds(designed: &Designed, row: &mut impl FnMut(&str, String)) {
    let b = &designed.bounds;
    row(
        "limits",
        format!(
            "{} to {} units, what the record has covered",
            short(b.low),
            short(b.high)
        ),
    );
    row(
        "slew",
        format!(
            "{} units/s: {} for the noise, {} for the fastest input of the record",
            short(b.slew),
            short(b.slew_of_noise),
            short(b.slew_of_record)
        ),
    );
    let rate = match b.reference_rate {
        Some(rate) => format!("up to {} N·m/s", short(rate)),
        None => "no rate is sure to be followed: the least slope is near zero or below".to_owned(),
    };
    let range = match b.output {
        Some([low, high]) => format!("within {} to {} N·m", short(low), short(high)),
        None => "the record covers none in both directions".to_owned(),
    };
    let own = designed.adaptive.settings.and_then(|law| law.limits.slew());
    if let Some(slew) = own.filter(|slew| *slew > b.slew) {
        row(
            "",
            format!(
                "{} units/s for the adaptive law: its certificate needs it",
                short(slew)
            ),
        );
    }
    row("reference", format!("{rate}; {range}"));
    row(
        "longest dt",
        format!(
            "{} s; after {} bad samples in a row the safe command {}",
            short(b.longest_dt),
            b.fallback_after,
            short(b.fallback_command)
        ),
    );
}

fn adaptive(own: &AdaptiveDesign, row: &mut impl FnMut(&str, String)) {
    let law = match (&own.settings, &own.refused) {
        (Some(law), _) => law,
        (None, why) => {
            let why = why.as_deref().unwrap_or("no reason is known");
            row("adaptive", format!("no admissible gains: {why}"));
            return;
        }
    };
    if own.every > 1 {
        row(
            "adaptive",
            format!(
                "none at this rate: the lag form needs a plant that answers within one sample. On one sample in {} ({} s):",
                own.every,
                short(own.step)
            ),
        );
    }
    row(
        if own.every > 1 { "" } else { "adaptive" },
        format!(
            "lag form, k {}, lambda {} 1/s, epsilon {} N·m; h·lambda·g·(k + delta/epsilon) = {:.2}, at most 1",
            short(law.gain),
            short(law.lambda),
            short(law.epsilon),
            own.loop_gain
        ),
    );
    let estimate = |name: &str, unit: &str, e: &bowden_trials::facts::Estimate| {
        format!(
            "{name} {} in {} to {} {unit}, gain {}, leakage {} 1/s",
            short(e.initial),
            short(e.low),
            short(e.high),
            short(e.gain),
            short(e.leakage.rate())
        )
    };
    row("", estimate("beta_hat", "unit/(N·m)", &law.beta));
    row("", estimate("delta_hat", "N·m", &law.delta));
    row(
        "",
        match (own.certificate, &own.uncertified) {
            (Some(bound), _) => certificate(own, bound),
            (None, why) => format!("no certificate: {}", why.as_deref().unwrap_or("none")),
        },
    );
}

/// What is promised of the error, and of which references.
fn certificate(own: &AdaptiveDesign, bound: f64) -> String {
    let noiseless = "on a plant that answers within the step, without noise";
    let bound = above(bound);
    match own.plant.filter(|_| own.proved) {
        Some(known) => format!(
            "certificate (peak-rounded): |e| <= {bound} N·m for references up to {} N·m at up to {} N·m/s, {noiseless}",
            short(known.reference),
            short(known.reference_rate)
        ),
        None => format!("certificate (peak-sampled): |e| <= {bound} N·m {noiseless}"),
    }
}

/// Four digits.
fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = (3.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.digits$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}
