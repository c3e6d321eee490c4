//! A certificate as what other people's tools check from nothing: Coq and Gappa.
//!
//! Neither believes a number of the program, so the numbers here are computed in plain
//! floats, a little on the safe side, and rounded to few bits.

use super::{ExactRegressor, Float, Proof};
use bowden::bound::{Dyadic, Enclosure};
use std::collections::BTreeMap;

/// The theorem over the reals, which a certificate for Coq holds whole.
const BOX: &str = include_str!("../../../../theorems/Box.v");
const COQ: &str = include_str!("certificate.v.in");
const GAPPA: &str = include_str!("certificate.g.in");

/// Bits of a bound, of S and U, and of Z, W and q.
const SHORT: u32 = 15;
const MIDDLE: u32 = 24;
const LONG: u32 = 31;

/// An inequality `low <= expression <= high` with its name in Coq.
struct Range {
    name: String,
    of: String,
    low: Enclosure,
    high: Enclosure,
}

/// All numbers of a certificate.
struct Numbers {
    gains: BTreeMap<&'static str, Enclosure>,
    bounds: BTreeMap<&'static str, Enclosure>,
    ranges: Vec<Range>,
    regressors: usize,
}

/// The certificate as a theorem: `coqc` checks it, or refuses it.
///
/// # Errors
/// One line where a number is so small that it would not fit on one.
pub fn coq(proof: &Proof) -> Result<String, String> {
    let numbers = Numbers::of(proof)?;
    let (names, exact, comp) = sums(numbers.regressors);
    let mut words = Words(BTreeMap::new());
    words.common(proof, &names, &exact);
    words.put("box", BOX.trim_end());
    words.put("comp", comp);
    for (name, number) in numbers.gains.iter().chain(&numbers.bounds) {
        words.put(name, fraction(number.high())?);
    }
    let range = |of: &str, low: Enclosure, high: Enclosure| -> Result<String, String> {
        Ok(format!(
            "{} <= {of} <= {}",
            fraction(low.low())?,
            fraction(high.high())?
        ))
    };
    let bound = |name: &str| numbers.bounds.get(name).copied().unwrap_or(zero());
    let both = |of: &str, name: &str| range(of, zero() - bound(name), bound(name));
    for (place, of, name) in [
        ("Hsm", "sm", "sm"),
        ("Es", "sm - (y - r + lam * z)", "nEs"),
        ("Emove", "move - MOVE", "emove"),
        ("big_move", "move", "move"),
        ("Elaw", "law - (u + MOVE)", "nEl"),
        ("owed_u", "owed u wu", "cu"),
        ("Ewu", "wu - (move + cu)", "ewu"),
        ("Esumu", "law - (u + wu)", "cu"),
        ("Ez", "zn - (z + h * (y - r))", "nEz"),
        ("owed_z", "owed z w", "cz"),
        ("Esumz", "zn - (z + w)", "cz"),
        ("Ew", "w - (inc + carry)", "ew"),
        ("Einc", "inc - h * (y - r)", "einc"),
        ("Hload", "X' + D'", "load"),
        ("Hrn", "r'", "ref"),
    ] {
        words.put(place, both(of, name)?);
    }
    let gain = |name: &str| numbers.gains.get(name).copied().unwrap_or(zero());
    words.put("Ha", range("alpha", gain("alow"), gain("ahigh"))?);
    words.put("Hg", range("alpha * beta", gain("gmin"), gain("gmax"))?);
    let w = format!(
        "(alpha * beta - 1) * (r + (rp - r) / (h * lam)) + (alpha * beta * ({exact}) - X) - D"
    );
    words.put("Hw", both(&w, "W")?);
    let xi = fraction(bound("Xi").high())?;
    words.put(
        "Hxi",
        format!("- (h * {xi}) <= (D' - D) + (X' - X) <= h * {xi}"),
    );
    let mut hypotheses = Vec::new();
    for r in &numbers.ranges {
        hypotheses.push(format!(
            "Hypothesis {} : {}.",
            r.name,
            range(&r.of, r.low, r.high)?
        ));
    }
    words.put("hypotheses", hypotheses.join("\n"));
    let used = numbers.ranges.iter().map(|r| r.name.as_str());
    let used: Vec<&str> = used.filter(|name| !["Hc", "Hcu"].contains(name)).collect();
    words.put("used", used.join(" "));
    let unfolded = names
        .iter()
        .filter(|n| !["y", "carry", "cu"].contains(&n.as_str()));
    words.put("names", unfolded.cloned().collect::<Vec<_>>().join(", "));
    let inputs: Vec<String> = names.iter().map(|name| format!("{name}_")).collect();
    words.put("inputs_", inputs.join(" "));
    let lets = names
        .iter()
        .map(|name| format!("Let {name} := rnd {name}_."));
    words.put("lets", lets.collect::<Vec<_>>().join("\n"));
    Ok(words.filled(COQ))
}

/// The roundings of the step as a script for Gappa.
///
/// # Errors
/// As [`coq`].
pub fn gappa(proof: &Proof) -> Result<String, String> {
    let numbers = Numbers::of(proof)?;
    let (names, exact, _) = sums(numbers.regressors);
    let mut words = Words(BTreeMap::new());
    words.common(proof, &names, &exact);
    let products = exact.split(" + ").map(|product| format!("({product})"));
    let products = products.collect::<Vec<_>>().join(" + ");
    words.put("comp", format!("comp rnd= {products};"));
    for (place, name) in [("h", "h"), ("lambda", "lambda"), ("k", "k")] {
        let gain = numbers.gains.get(name).copied().unwrap_or(zero());
        words.put(place, binary(gain.high()));
    }
    for (place, name) in [
        ("Es", "nEs"),
        ("Emove", "emove"),
        ("Ewu", "ewu"),
        ("Esumu", "cu"),
        ("Einc", "einc"),
        ("Ew", "ew"),
        ("Esumz", "cz"),
    ] {
        let bound = numbers.bounds.get(name).copied().unwrap_or(zero());
        words.put(place, binary(bound.high()));
    }
    let within = |r: &Range| {
        format!(
            "{} in [{},{}]",
            r.of,
            binary(r.low.low()),
            binary(r.high.high())
        )
    };
    let ranges: Vec<String> = numbers.ranges.iter().map(within).collect();
    words.put("hypotheses", ranges.join(" /\\\n  "));
    let lets = names.iter().map(|name| format!("{name} = rnd({name}_);"));
    words.put("lets", lets.collect::<Vec<_>>().join("\n"));
    Ok(words.filled(GAPPA))
}

/// What stands in the places of a template.
struct Words(BTreeMap<String, String>);

impl Words {
    fn put(&mut self, place: &str, text: impl Into<String>) {
        self.0.insert(place.to_owned(), text.into());
    }

    fn common(&mut self, proof: &Proof, _names: &[String], exact: &str) {
        let (bits, least, width) = match proof.float {
            Float::F32 => ("24", "149", "32"),
            Float::F64 => ("53", "1074", "64"),
        };
        self.put("float", proof.float.name());
        self.put("bits", bits);
        self.put("least", least);
        self.put("width", width);
        self.put("exact", exact);
    }

    fn filled(&self, template: &str) -> String {
        let mut text = template.to_owned();
        for (place, word) in &self.0 {
            text = text.replace(&format!("{{{{{place}}}}}"), word);
        }
        text
    }
}

/// The inputs of the step, and `theta_hat'x` as it is and as it is rounded.
fn sums(regressors: usize) -> (Vec<String>, String, String) {
    let fixed = [
        "y", "r", "rp", "z", "carry", "u", "cu", "beta", "delta", "t",
    ];
    let mut names: Vec<String> = fixed.map(str::to_owned).to_vec();
    let (mut exact, mut rounded) = (String::new(), String::new());
    for i in 1..=regressors {
        let product = format!("th{i} * x{i}");
        rounded = match i {
            1 => format!("rnd ({product})"),
            _ => format!("rnd ({rounded} + rnd ({product}))"),
        };
        exact = match i {
            1 => product,
            _ => format!("{exact} + {product}"),
        };
    }
    names.extend((1..=regressors).map(|i| format!("th{i}")));
    names.extend((1..=regressors).map(|i| format!("x{i}")));
    if regressors == 0 {
        (names, "0".to_owned(), "0".to_owned())
    } else {
        (names, exact, rounded)
    }
}

fn zero() -> Enclosure {
    Enclosure::of(0.0)
}

/// Rounded up to few bits.
fn up(x: Enclosure, bits: u32) -> Enclosure {
    Enclosure::exactly(x.high().shortened(bits))
}

/// `mantissa*2^exponent` of a float.
fn read(exact: &str) -> Result<f64, String> {
    let parts = exact.split_once("*2^").and_then(|(mantissa, exponent)| {
        let mantissa: i64 = mantissa.parse().ok()?;
        #[allow(clippy::cast_precision_loss)] // of a float: 53 bits at most
        Some(mantissa as f64 * 2_f64.powi(exponent.parse().ok()?))
    });
    parts.ok_or_else(|| format!("{exact}: a number was expected"))
}

/// A number as Coq reads it.
fn fraction(x: Dyadic) -> Result<String, String> {
    let (mantissa, exponent) = x.parts();
    let too_small = || format!("{x}: too small, or too large, to be written as a fraction");
    let size = exponent.unsigned_abs();
    if size > 120 {
        return Err(too_small());
    }
    if exponent < 0 {
        Ok(format!("({mantissa}/{})", 1_u128 << size))
    } else {
        let whole = mantissa.checked_mul(1_i128 << size);
        Ok(format!("({})", whole.ok_or_else(too_small)?))
    }
}

/// A number as Gappa reads it.
fn binary(x: Dyadic) -> String {
    let (mantissa, exponent) = x.parts();
    format!("{mantissa}b{exponent}")
}

impl Numbers {
    fn of(proof: &Proof) -> Result<Self, String> {
        let number = |exact: &String| read(exact).map(Enclosure::of);
        let ends = |exact: &[String; 2]| Ok::<_, String>([number(&exact[0])?, number(&exact[1])?]);
        let (gains, plant) = (&proof.gains, &proof.plant);
        let (k, lambda, h) = (
            number(&gains.k)?,
            number(&gains.lambda)?,
            number(&gains.step)?,
        );
        let (alpha, beta) = (ends(&plant.alpha)?, ends(&gains.beta)?);
        let delta = ends(&gains.delta)?[1];
        let (r, rate) = (number(&plant.reference)?, number(&plant.reference_rate)?);
        let mut terms = Vec::new();
        let mut load = number(&plant.disturbance)?;
        let mut summed = zero();
        for ExactRegressor {
            theta_hat,
            theta,
            magnitude,
            ..
        } in &proof.regressors
        {
            let largest = |[a, b]: [Enclosure; 2]| a.abs().max(b.abs());
            let (estimate, x) = (largest(ends(theta_hat)?), number(magnitude)?);
            load = load + largest(ends(theta)?) * x;
            summed = summed + estimate * x;
            terms.push((up(estimate, SHORT), up(x, SHORT)));
        }
        // A thousandth more room than the program needs, and a hundredth more rounding.
        let (one, of) = (Enclosure::of(1.0), Enclosure::of::<f64>);
        let wider = of(1.0 + 2_f64.powi(-10));
        let slack = of(1.01);
        let s = up(of(proof.s.value) * wider, MIDDLE);
        let z = up(of(proof.z.value) * wider * of(1.0 + 2_f64.powi(-20)), LONG);
        let error = s + lambda * z;
        let command = up(
            (r + error + load) / alpha[0] * of(1.0 + 2_f64.powi(-12)),
            MIDDLE,
        );
        let unit = of(match proof.float {
            Float::F32 => 2_f64.powi(-24),
            Float::F64 => 2_f64.powi(-53),
        });
        let rounded = |x: f64| up(of(x) * slack, SHORT);
        let roundings = &proof.roundings;
        let (nes, cz) = (
            rounded(roundings.s.value),
            rounded(roundings.owed_by_z.value),
        );
        let einc = up(unit * h * error * of(2.1), SHORT);
        let ew = up(unit * h * error * of(1.1), SHORT);
        let ubar = k * s + r + (rate + z) / lambda + delta + summed;
        let moved = up(h * lambda * (beta[1] * ubar + command) * slack, SHORT);
        let cu = up(unit * (command + moved) * slack, SHORT);
        let emove = rounded(roundings.command.value);
        let ewu = up(unit * moved * of(2.1), SHORT);
        let epsilon = number(&gains.epsilon)?;
        let w = up(of(proof.w.value) * of(1.0 + 2_f64.powi(-40)), LONG);
        let xi = up(of(proof.xi.value) * of(1.0 + 2_f64.powi(-40)), LONG);
        let g = [alpha[0] * beta[0], alpha[1] * beta[1]];
        let mut ranges: Vec<Range> = Vec::new();
        let mut range = |name: &str, of: &str, low: Enclosure, high: Enclosure| {
            let (name, of) = (name.to_owned(), of.to_owned());
            ranges.push(Range {
                name,
                of,
                low,
                high,
            });
        };
        let change = up(h * rate, SHORT);
        let seen = up(error, SHORT);
        for (name, of, most) in [
            ("Hr", "r", r),
            ("Hrp", "rp - r", change),
            ("HE", "y - r", seen),
            ("Hz", "z", z),
            ("Hc", "carry", cz),
            ("Hcu", "cu", cu),
            ("Hu", "u", command),
        ] {
            range(name, of, zero() - most, most);
        }
        range("Hb", "beta", beta[0], beta[1]);
        range("Hd", "delta", zero(), delta);
        range("Ht", "t", zero() - one, one);
        for (i, (estimate, x)) in (1..).zip(&terms) {
            range(
                &format!("Ht{i}"),
                &format!("th{i}"),
                zero() - *estimate,
                *estimate,
            );
            range(&format!("Hx{i}"), &format!("x{i}"), zero() - *x, *x);
        }
        let low = |x: Enclosure| Enclosure::exactly(x.low());
        let gains = BTreeMap::from([
            ("h", h),
            ("lambda", lambda),
            ("k", k),
            ("alow", alpha[0]),
            ("ahigh", alpha[1]),
            ("gmin", low(g[0])),
            ("gmax", Enclosure::exactly(g[1].high())),
            ("dmax", delta),
            ("q", up((one + unit * of(8.0)) / epsilon, LONG)),
        ]);
        let bounds = BTreeMap::from([
            ("S", s),
            ("Z", z),
            ("U", command),
            ("W", w),
            ("Xi", xi),
            ("ref", r),
            ("load", Enclosure::exactly(load.high())),
            ("sm", up(s + nes, MIDDLE)),
            ("nEs", nes),
            ("emove", emove),
            ("move", moved),
            ("ewu", ewu),
            ("cu", cu),
            ("cz", cz),
            ("einc", einc),
            ("ew", ew),
            ("nEl", emove + ewu + cu + cu),
            ("nEz", einc + ew + cz + cz),
        ]);
        Ok(Self {
            gains,
            bounds,
            ranges,
            regressors: terms.len(),
        })
    }
}
