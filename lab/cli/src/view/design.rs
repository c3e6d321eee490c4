//! The report of `bowden design`, and its JSON.

use super::layout::{block, heading, prose, Width};
use anstyle::AnsiColor;
use bowden_trials::facts::{above, AdaptiveDesign, Certifies, Designed, PidDesign};
use serde_json::{json, Value};

/// Schema `bowden.design/1`.
///
/// # Errors
/// If a number is not finite, which does not occur in a design.
pub fn json(designed: &Designed) -> Result<String, serde_json::Error> {
    let mut all = serde_json::to_value(designed)?;
    all["schema"] = json!("bowden.design/1");
    all["designed_for"] = serde_json::to_value(&designed.gains.design)?;
    if let Value::Object(adaptive) = &mut all["adaptive"] {
        adaptive.remove("assumed");
    }
    Ok(all.to_string())
}

/// The text: the gains first.
#[must_use]
pub fn text(designed: &Designed, width: Width, verbose: bool) -> String {
    let mut out = String::new();
    answer(&mut out, designed, width);
    block(&mut out, width, "Plant", plant(designed));
    block(&mut out, width, "Limits", limits(designed));
    block(&mut out, width, "Adapt", adaptive(&designed.adaptive));
    out.push('\n');
    block(&mut out, width, "Note", &designed.notes);
    if verbose {
        block(&mut out, width, "Detail", details(designed));
    }
    let compare = match designed.bounds.output {
        Some(_) => "bowden compare --model MODEL.toml --gains GAINS.toml",
        None => "`bowden compare` cannot use this model, because no reference can be derived from its record",
    };
    let compare = match verbose {
        true => compare.to_owned(),
        false => format!("-v · {compare}"),
    };
    block(&mut out, width, "Next", [compare, certifies(designed)]);
    out
}

/// The gains of PI, their margins, and whether a derivative helps.
fn answer(out: &mut String, designed: &Designed, width: Width) {
    let for_ = &designed.gains.design;
    let subject = format!(
        "{} · {} Hz · delay {} s · noise {} N·m rms",
        for_.model, for_.rate, for_.delay, for_.noise
    );
    let colour = match designed.notes.is_empty() {
        true => AnsiColor::Green,
        false => AnsiColor::Yellow,
    };
    let answer = format!("PI: {}", gains(&designed.pi));
    heading(out, width, ("bowden design", &subject), (colour, &answer));
    prose(out, width, &margins(&designed.pi));
    let derivative = &designed.derivative;
    let percent = 100.0 * (derivative.integral_gain - 1.0);
    let words = match derivative.helps {
        true => format!(
            "Derivative action helps: it raises k_i by {percent:.0} %. PID: {}. {}",
            gains(&derivative.pid),
            margins(&derivative.pid)
        ),
        false => format!(
            "Derivative action does not help: it changes k_i by {percent:.0} % and amplifies noise."
        ),
    };
    prose(out, width, &words);
    out.push('\n');
}

/// What becomes of a file of these gains.
fn certifies(designed: &Designed) -> String {
    match designed.certifies() {
        Certifies::Proves => {
            "`bowden certify GAINS.toml` proves the bound, including rounding errors.".to_owned()
        }
        Certifies::NamesWhatFails => {
            "`bowden certify GAINS.toml` names the gain or limit that prevents a proof.".to_owned()
        }
        Certifies::Refuses(why) => {
            format!("`bowden certify` rejects these gains: {why}.")
        }
    }
}

fn gains(own: &PidDesign) -> String {
    let derivative = match own.k_d == 0.0 {
        true => String::new(),
        false => format!(
            ", k_d {} unit·s/(N·m) over {} s",
            short(own.k_d),
            short(own.derivative_time)
        ),
    };
    format!(
        "k_p {} unit/(N·m), k_i {} unit/(N·m·s){derivative}",
        short(own.k_p),
        short(own.k_i)
    )
}

fn margins(own: &PidDesign) -> String {
    let settled = own.settled.map(short);
    let settled = settled.map_or_else(String::new, |s| format!(", settles in {s} s"));
    format!(
        "Gain margin {:.2}, phase margin {:.1} deg, overshoot {:.1} %{settled}.",
        own.margins.gain,
        own.margins.phase,
        100.0 * own.overshoot
    )
}

fn plant(designed: &Designed) -> [String; 3] {
    let slopes = &designed.slopes;
    let plural = if designed.delay_samples == 1 { "" } else { "s" };
    let b = &designed.bounds;
    let rate = match b.reference_rate {
        Some(rate) => format!("up to {} N·m/s", short(rate)),
        None => "no rate is guaranteed".to_owned(),
    };
    let range = match b.output {
        Some([low, high]) => format!("within {} to {} N·m", short(low), short(high)),
        None => "no output torque occurs in both directions of motion, so there is no reference"
            .to_owned(),
    };
    [
        format!(
            "slope {:.4} to {:.4} N·m per N·m of input, designed for {:.4}",
            slopes.least, slopes.greatest, designed.design_slope
        ),
        format!(
            "delay {} sample{plural} incl. hold · drive gain {} N·m/unit · no joint inertia",
            designed.delay_samples, designed.gains.design.drive_gain
        ),
        format!("reference: {range}; {rate}"),
    ]
}

fn limits(designed: &Designed) -> [String; 2] {
    let b = &designed.bounds;
    let own = designed.adaptive.settings.and_then(|law| law.limits.slew());
    let own = own.filter(|slew| *slew > b.slew).map(short);
    let own = own.map_or_else(String::new, |slew| format!(" (adaptive {slew})"));
    [
        format!(
            "command {} to {} units · slew rate {} units/s{own}",
            short(b.low),
            short(b.high),
            short(b.slew)
        ),
        format!(
            "longest dt {} s · safe command {} after {} consecutive bad samples",
            short(b.longest_dt),
            short(b.fallback_command),
            b.fallback_after
        ),
    ]
}

fn adaptive(own: &AdaptiveDesign) -> Vec<String> {
    let law = match (&own.settings, &own.refused) {
        (Some(law), _) => law,
        (None, why) => {
            let why = why.as_deref().unwrap_or("the reason is unknown");
            return vec![format!("no admissible gains: {why}")];
        }
    };
    let every = match own.every {
        1 => String::new(),
        every => format!(" on one sample in {every} ({} s)", short(own.step)),
    };
    vec![
        format!(
            "first-order form{every}: k {}, lambda {} 1/s, epsilon {} N·m",
            short(law.gain),
            short(law.lambda),
            short(law.epsilon)
        ),
        format!(
            "beta_hat {} in [{}, {}] unit/(N·m), delta_hat in [{}, {}] N·m",
            short(law.beta.initial),
            short(law.beta.low),
            short(law.beta.high),
            short(law.delta.low),
            short(law.delta.high)
        ),
        match (own.certificate, &own.uncertified) {
            (Some(bound), _) => certificate(own, bound),
            (None, why) => format!("no certificate: {}", why.as_deref().unwrap_or("none")),
        },
    ]
}

/// The bound of the error, and the references for which it holds.
fn certificate(own: &AdaptiveDesign, bound: f64) -> String {
    let bound = above(bound);
    match own.plant.filter(|_| own.proved) {
        Some(known) => format!(
            "certificate (peak-rounded): |e| <= {bound} N·m without noise, for references up to {} N·m at up to {} N·m/s",
            short(known.reference),
            short(known.reference_rate)
        ),
        None => format!("certificate (peak-sampled): |e| <= {bound} N·m without noise"),
    }
}

/// What the gains must satisfy, which others do, and where the limits come from.
fn details(designed: &Designed) -> Vec<String> {
    let (asked, admissible, b) = (&designed.asked, &designed.admissible, &designed.bounds);
    let mut all = vec![
        format!(
            "required: gain margin {} or more, phase margin {} deg or more, overshoot {} % or less, Re L above {}",
            asked.gain_margin,
            asked.phase_margin,
            100.0 * asked.overshoot,
            asked.least_real
        ),
        format!(
            "Re L {:.2}: smallest real part of the open-loop frequency response. If it is above -1, the loop is stable for every sequence of slopes between zero and the design slope (circle criterion)",
            designed.pi.margins.least_real
        ),
        format!(
            "admissible: k_p below {}; k_i up to {} with this k_p, or up to {} without k_p",
            short(admissible.k_p),
            short(admissible.k_i),
            short(admissible.k_i_alone)
        ),
        "the plant model includes the transmission and the delay, but not the inertia or the spring of a joint".to_owned(),
        "reference: no rate is guaranteed if the smallest slope is near zero or negative".to_owned(),
        "slope: between B and B - 2·kappa_eta·sigma·rho, from the Bouc-Wen equation".to_owned(),
        "command limits: the input range of the record. For a faster reference, record faster inputs".to_owned(),
        format!(
            "slew-rate limit: {} units/s for the noise, {} units/s for the fastest input of the record",
            short(b.slew_of_noise),
            short(b.slew_of_record)
        ),
    ];
    let own = &designed.adaptive;
    if own.every > 1 {
        all.push("the adaptive law does not run on every sample, because its first-order form needs a plant that responds within one step".to_owned());
    }
    if let Some(law) = &own.settings {
        all.push(format!(
            "adaptive law: h·lambda·g·(k + delta/epsilon) = {:.2}, which must be at most 1; adaptation gain and leakage: {} and {} 1/s for beta_hat, {} and {} 1/s for delta_hat",
            own.loop_gain,
            short(law.beta.gain),
            short(law.beta.leakage.rate()),
            short(law.delta.gain),
            short(law.delta.leakage.rate())
        ));
        all.push("the certificate assumes a plant that responds within one step".to_owned());
    }
    all
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
