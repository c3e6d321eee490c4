//! A certificate in the forms that Coq and Gappa check independently of this program.
//!
//! Neither Coq nor Gappa relies on the numbers of the program. The numbers here are therefore
//! computed in plain floats, slightly on the safe side, and rounded to few bits.

use super::{Float, Proof};
use bowden_bound::{Dyadic, Enclosure};
use std::collections::BTreeMap;

/// The theorem over the reals, which a certificate for Coq contains completely.
const BOX: &str = include_str!("../../../../theorems/Box.v");
const COQ: &str = include_str!("certificate.v.in");
const GAPPA: &str = include_str!("certificate.g.in");

/// Number of bits of a bound, of S and U, and of Z, W and q.
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

/// The message for a command limit that may be active, because this theorem is only over the reals.
const AT_THE_LIMIT: &str = "--coq: in this proof the command may saturate, but certificates for Coq cover only inactive limits; theorems/Limit.v contains the theorem, and --json lists all numbers";

/// The certificate as a theorem: `coqc` accepts or rejects it.
///
/// # Errors
/// A message if a number is too small or too large to be written as a fraction, or if the command
/// may reach its limit.
pub fn coq(proof: &Proof) -> Result<String, String> {
    if proof.may_meet_the_limit {
        return Err(AT_THE_LIMIT.to_owned());
    }
    let numbers = Numbers::of(proof)?;
    let (names, exact, comp) = sums(numbers.regressors);
    let mut words = Words(BTreeMap::new());
    words.common(proof, &exact);
    words.put("slew", slew(proof).unwrap_or_default());
    words.put("box", BOX.trim_end());
    words.put("comp", comp);
    for (name, number) in numbers.gains.iter().chain(&numbers.bounds) {
        words.put(name, fraction(number.high)?);
    }
    let range = |of: &str, low: Enclosure, high: Enclosure| -> Result<String, String> {
        Ok(format!(
            "{} <= {of} <= {}",
            fraction(low.low)?,
            fraction(high.high)?
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
    let xi = fraction(bound("Xi").high)?;
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

/// The remark on the slew-rate limit in the header.
fn slew(proof: &Proof) -> Option<String> {
    let sides = proof.slew.as_ref()?;
    Some(format!(
        "\n\n   The slew-rate limit is omitted, because no step within the bounds reaches it: a step moves the\n   command by at most {:e}, and {:e} is allowed (theorems/Slew.v). *)\n(* The theorem over the reals.",
        sides.left.high, sides.right.low
    ))
}

/// The rounding errors of the step as a script for Gappa.
///
/// # Errors
/// The same as [`coq`].
pub fn gappa(proof: &Proof) -> Result<String, String> {
    let numbers = Numbers::of(proof)?;
    let (names, exact, _) = sums(numbers.regressors);
    let mut words = Words(BTreeMap::new());
    words.common(proof, &exact);
    let products = exact.split(" + ").map(|product| format!("({product})"));
    let products = products.collect::<Vec<_>>().join(" + ");
    words.put("comp", format!("comp rnd= {products};"));
    for (place, name) in [("h", "h"), ("lambda", "lambda"), ("k", "k")] {
        let gain = numbers.gains.get(name).copied().unwrap_or(zero());
        words.put(place, binary(gain.high));
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
        words.put(place, binary(bound.high));
    }
    let within = |r: &Range| {
        format!(
            "{} in [{},{}]",
            r.of,
            binary(r.low.low),
            binary(r.high.high)
        )
    };
    let ranges: Vec<String> = numbers.ranges.iter().map(within).collect();
    words.put("hypotheses", ranges.join(" /\\\n  "));
    let lets = names.iter().map(|name| format!("{name} = rnd({name}_);"));
    words.put("lets", lets.collect::<Vec<_>>().join("\n"));
    Ok(words.filled(GAPPA))
}

/// The values for the placeholders of a template.
struct Words(BTreeMap<String, String>);

impl Words {
    fn put(&mut self, place: &str, text: impl Into<String>) {
        self.0.insert(place.to_owned(), text.into());
    }

    fn common(&mut self, proof: &Proof, exact: &str) {
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

/// The inputs of the step, and `theta_hat'x`, exact and rounded.
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
    Enclosure::exactly(x.high.shortened(bits))
}

/// `mantissa*2^exponent` of a float.
fn read(exact: &str) -> Result<f64, String> {
    let parts = exact.split_once("*2^").and_then(|(mantissa, exponent)| {
        let mantissa: i64 = mantissa.parse().ok()?;
        #[allow(clippy::cast_precision_loss)] // of a float: 53 bits at most
        Some(mantissa as f64 * 2_f64.powi(exponent.parse().ok()?))
    });
    parts.ok_or_else(|| format!("{exact} must be a number"))
}

/// A number as Coq reads it.
fn fraction(x: Dyadic) -> Result<String, String> {
    let (mantissa, exponent) = x.parts();
    let too_small = || format!("{x} is too small or too large for a fraction");
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

/// The subject of a certificate, parsed from its exact numbers.
struct Given {
    k: Enclosure,
    lambda: Enclosure,
    step: Enclosure,
    epsilon: Enclosure,
    alpha: [Enclosure; 2],
    beta: [Enclosure; 2],
    delta: Enclosure,
    reference: Enclosure,
    rate: Enclosure,
    /// Largest `|theta'x + D|`, and largest `|theta_hat'x|`.
    load: Enclosure,
    compensation: Enclosure,
    /// Largest `|theta_hat_i|` and `|x_i|`, rounded up.
    terms: Vec<(Enclosure, Enclosure)>,
    unit: Enclosure,
}

impl Given {
    fn of(proof: &Proof) -> Result<Self, String> {
        let number = |exact: &String| read(exact).map(Enclosure::of);
        let ends = |exact: &[String; 2]| Ok::<_, String>([number(&exact[0])?, number(&exact[1])?]);
        let largest = |[a, b]: [Enclosure; 2]| a.abs().max(b.abs());
        let (gains, plant) = (&proof.gains, &proof.plant);
        let (mut terms, mut compensation) = (Vec::new(), zero());
        let mut load = number(&plant.disturbance)?;
        for regressor in &proof.regressors {
            let x = number(&regressor.magnitude)?;
            let estimate = largest(ends(&regressor.theta_hat)?);
            load = load + largest(ends(&regressor.theta)?) * x;
            compensation = compensation + estimate * x;
            terms.push((up(estimate, SHORT), up(x, SHORT)));
        }
        Ok(Self {
            k: number(&gains.k)?,
            lambda: number(&gains.lambda)?,
            step: number(&gains.step)?,
            epsilon: number(&gains.epsilon)?,
            alpha: ends(&plant.alpha)?,
            beta: ends(&gains.beta)?,
            delta: number(&gains.delta[1])?,
            reference: number(&plant.reference)?,
            rate: number(&plant.reference_rate)?,
            load,
            compensation,
            terms,
            unit: Enclosure::of(match proof.float {
                Float::F32 => 2_f64.powi(-24),
                Float::F64 => 2_f64.powi(-53),
            }),
        })
    }

    /// The gains, and the numbers that depend only on them.
    fn gains(&self) -> BTreeMap<&'static str, Enclosure> {
        let (low, high) = (self.alpha[0] * self.beta[0], self.alpha[1] * self.beta[1]);
        let steepest = Enclosure::of(1.0) + self.unit * Enclosure::of(8.0);
        BTreeMap::from([
            ("h", self.step),
            ("lambda", self.lambda),
            ("k", self.k),
            ("alow", self.alpha[0]),
            ("ahigh", self.alpha[1]),
            ("gmin", Enclosure::exactly(low.low)),
            ("gmax", Enclosure::exactly(high.high)),
            ("dmax", self.delta),
            ("q", up(steepest / self.epsilon, LONG)),
        ])
    }

    /// The boxes and the rounding errors. The boxes are a thousandth larger, and the rounding
    /// errors a hundredth larger, than the program needs.
    fn bounds(&self, proof: &Proof) -> BTreeMap<&'static str, Enclosure> {
        let of = Enclosure::of::<f64>;
        let (wider, slack) = (of(1.0 + 2_f64.powi(-10)), of(1.01));
        let s = up(of(proof.s.value) * wider, MIDDLE);
        let z = up(of(proof.z.value) * wider * of(1.0 + 2_f64.powi(-20)), LONG);
        let error = s + self.lambda * z;
        let needed = (self.reference + error + self.load) / self.alpha[0];
        let command = up(needed * of(1.0 + 2_f64.powi(-12)), MIDDLE);
        let rounded = |x: f64| up(of(x) * slack, SHORT);
        let least = |x: f64| up(of(x) * of(1.0 + 2_f64.powi(-40)), LONG);
        let roundings = &proof.roundings;
        let (nes, cz) = (
            rounded(roundings.s.value),
            rounded(roundings.carry_error_z.value),
        );
        let moved_z = self.unit * self.step * error;
        let (einc, ew) = (up(moved_z * of(2.1), SHORT), up(moved_z * of(1.1), SHORT));
        let ubar = self.k * s
            + self.reference
            + (self.rate + z) / self.lambda
            + self.delta
            + self.compensation;
        let way = self.beta[1] * ubar + command;
        let moved = up(self.step * self.lambda * way * slack, SHORT);
        let cu = up(self.unit * (command + moved) * slack, SHORT);
        let emove = rounded(roundings.command.value);
        let ewu = up(self.unit * moved * of(2.1), SHORT);
        BTreeMap::from([
            ("S", s),
            ("Z", z),
            ("U", command),
            ("W", least(proof.w.value)),
            ("Xi", least(proof.xi.value)),
            ("ref", self.reference),
            ("load", Enclosure::exactly(self.load.high)),
            ("sm", up(s + nes, MIDDLE)),
            ("change", up(self.step * self.rate, SHORT)),
            ("seen", up(error, SHORT)),
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
        ])
    }

    /// The ranges of the inputs of the step.
    fn ranges(&self, bounds: &BTreeMap<&'static str, Enclosure>) -> Vec<Range> {
        let range = |name: &str, of: &str, low: Enclosure, high: Enclosure| Range {
            name: name.to_owned(),
            of: of.to_owned(),
            low,
            high,
        };
        let mut ranges = Vec::new();
        for (name, of, bound) in [
            ("Hr", "r", "ref"),
            ("Hrp", "rp - r", "change"),
            ("HE", "y - r", "seen"),
            ("Hz", "z", "Z"),
            ("Hc", "carry", "cz"),
            ("Hcu", "cu", "cu"),
            ("Hu", "u", "U"),
        ] {
            let most = bounds.get(bound).copied().unwrap_or(zero());
            ranges.push(range(name, of, zero() - most, most));
        }
        let one = Enclosure::of(1.0);
        ranges.push(range("Hb", "beta", self.beta[0], self.beta[1]));
        ranges.push(range("Hd", "delta", zero(), self.delta));
        ranges.push(range("Ht", "t", zero() - one, one));
        for (i, (estimate, x)) in (1..).zip(&self.terms) {
            let (theta, x_i) = (format!("th{i}"), format!("x{i}"));
            ranges.push(range(
                &format!("Ht{i}"),
                &theta,
                zero() - *estimate,
                *estimate,
            ));
            ranges.push(range(&format!("Hx{i}"), &x_i, zero() - *x, *x));
        }
        ranges
    }
}

impl Numbers {
    fn of(proof: &Proof) -> Result<Self, String> {
        let given = Given::of(proof)?;
        let bounds = given.bounds(proof);
        Ok(Self {
            gains: given.gains(),
            ranges: given.ranges(&bounds),
            bounds,
            regressors: given.terms.len(),
        })
    }
}
