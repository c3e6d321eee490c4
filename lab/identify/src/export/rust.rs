//! The model as a Rust file for firmware, in single precision.

use super::{About, ModelFile, Span, TermFile, ROOM};
use bowden::effect::Effect;
use std::collections::BTreeSet;
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

/// As wide as rustfmt lets a line be.
const LINE: usize = 100;

/// A number as firmware has it: the shortest text that reads back to the same `f32`.
fn number(value: f64) -> String {
    format!("{:?}", value as f32)
}

/// The origin of the model, its errors and its excluded parts. `play` is the name of the play
/// operator in the language of the file.
pub(super) fn origin(about: &About, play: &str) -> String {
    let mut out = String::new();
    let (cutoff, rate) = (about.cutoff_hz, about.rate_hz);
    line!(
        out,
        "//! Fitted to a record sampled at {rate} Hz and low-pass filtered at {cutoff} Hz."
    );
    line!(out, "//!");
    if let Some(warning) = about.warning() {
        line!(out, "//! {warning}");
        line!(out, "//!");
    }
    let errors = &about.nrmse;
    line!(
        out,
        "//! Error as a share of the output's standard deviation: fit {}, held-out {}.",
        per_cent(errors.fit),
        per_cent(errors.held_out)
    );
    if let Some(causal) = errors.held_out_causal {
        line!(
            out,
            "//! Held-out error sample by sample, with the time constant below: {}.",
            per_cent(causal)
        );
    }
    if let Some(before) = &about.play {
        line!(
            out,
            "//! The same error with {play} of half-width {} on the input: {}.",
            number(before.half_width),
            per_cent(before.held_out_causal)
        );
    }
    for part in &about.excluded_terms {
        line!(out, "//! Excluded: {} ({}).", part.effect, part.reason);
    }
    if !about.excluded_terms.is_empty() {
        line!(
            out,
            "//! Held-out error with the excluded terms: {}.",
            per_cent(errors.held_out_as_fitted)
        );
    }
    for one in &about.not_identified {
        line!(
            out,
            "//! Not identified: {} ({}).",
            one.parameter,
            one.reason
        );
    }
    out
}

fn per_cent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

impl ModelFile {
    /// The model as a Rust file for firmware: `fixed_model()`, `model()`, `ranges()` for
    /// `Compensator::with_ranges`, and the time constant for `Rates`.
    ///
    /// # Errors
    /// A message if the catalogue has no such effect.
    pub fn rust(&self) -> Result<String, String> {
        let none = About::default();
        let about = self.about.as_ref().unwrap_or(&none);
        let mut out = self.head(about);
        self.imports(&mut out)?;
        line!(out);
        if about.rates_time_constant_s > 0.0 {
            line!(
                out,
                "/// Time constant [s] of `bowden::signal::Rates` for every source."
            );
            line!(out, "#[allow(dead_code)]");
            line!(
                out,
                "pub const RATES_TIME_CONSTANT: f32 = {};",
                number(about.rates_time_constant_s)
            );
            line!(out);
        }
        self.function(about, &mut out)?;
        self.ranges(about, &mut out);
        Ok(out)
    }

    /// What a reader has to know before the numbers.
    fn head(&self, about: &About) -> String {
        let mut out = String::new();
        line!(out, "//! {}.", about.remark());
        line!(out, "//!");
        line!(
            out,
            "//! Input [{}], output [{}], {} mode.",
            about.unit("input"),
            about.unit("output"),
            self.mode
        );
        let channels: Vec<String> = self
            .channels
            .iter()
            .enumerate()
            .map(|(index, name)| format!("{index} {}", about.channel(name)))
            .collect();
        match channels.is_empty() {
            true => line!(out, "//! Channels: none."),
            false => line!(
                out,
                "//! Channels, in the order of `Sample::channels`: {}.",
                channels.join(", ")
            ),
        }
        if self.about.is_some() {
            out.push_str(&origin(about, "`signal::Play`"));
            line!(out, "//! Feed-forward: {}.", about.feed_forward);
            line!(out, "//!");
            line!(
                out,
                "//! Compute the derivatives of each source once per sample, with a `RatesState` for each source:"
            );
            line!(
                out,
                "//! `let motion = Rates::try_new(RATES_TIME_CONSTANT)?.step(&mut state, position, dt).motion;`"
            );
            line!(
                out,
                "//! Feed-forward controller: `Compensator::try_new(&model()?)?.with_ranges(&ranges())?`."
            );
        }
        line!(out);
        out
    }

    fn imports(&self, out: &mut String) -> Result<(), String> {
        let has_ranges = self.about.as_ref().is_some_and(|a| !a.ranges.is_empty());
        let mut all = BTreeSet::new();
        if has_ranges {
            all.insert("bowden::control::BenchRange".to_owned());
        }
        let fixed = self.is_fixed();
        for term in &self.terms {
            let own = variant(term.effect()?.name());
            all.insert(format!("bowden::effect::{own}"));
        }
        let mut add = |used: bool, name: &str| {
            if used {
                all.insert(format!("bowden::{name}"));
            }
        };
        add(has_ranges, "effect::Motion");
        add(!self.terms.is_empty() && !fixed, "effect::Effect");
        let has_source = !self.terms.is_empty() || has_ranges;
        let parts = [
            ("FixedModel", fixed),
            ("Model", true),
            ("Source", has_source),
            ("Term", !self.terms.is_empty()),
        ];
        let used: Vec<&str> = parts.iter().filter(|(_, u)| *u).map(|(n, _)| *n).collect();
        match &used[..] {
            [one] => add(true, &format!("model::{one}")),
            several => add(true, &format!("model::{{{}}}", several.join(", "))),
        }
        add(self.transmission.is_some(), "hysteresis::BoucWen");
        add(self.transmission.is_some(), "transmission::Transmission");
        let mut all: Vec<String> = all.into_iter().collect();
        // As rustfmt has them: modules before types before lists.
        all.sort_by_cached_key(|name| {
            let late = |c: char| [c.is_ascii_uppercase().then_some('z'), Some(c)];
            name.chars().flat_map(late).flatten().collect::<String>()
        });
        for name in all {
            line!(out, "use {name};");
        }
        Ok(())
    }

    /// Whether the effects are types: as many as a [`FixedModel`](bowden::model::FixedModel) holds.
    fn is_fixed(&self) -> bool {
        (1..=ROOM).contains(&self.terms.len())
    }

    /// The types of the terms, and the function that builds any model from the fixed one.
    fn fixed_types(&self, out: &mut String) -> Result<(), String> {
        let terms = self.terms.len();
        line!(
            out,
            "/// The terms of the model, with the type of each effect."
        );
        line!(out, "#[allow(dead_code)]");
        let mut types = Vec::with_capacity(terms);
        for term in &self.terms {
            let own = variant(term.effect()?.name());
            types.push(match term.shapes.is_empty() {
                true => format!("Term<f32, {own}>"),
                false => format!("Term<f32, {own}<f32>>"),
            });
        }
        // As rustfmt has it: on one line where it fits; a tuple of one ends in a comma.
        let last = if terms == 1 { "," } else { "" };
        let line = format!("pub type Terms = ({}{last});", types.join(", "));
        if line.len() <= LINE {
            line!(out, "{line}");
        } else {
            line!(out, "pub type Terms = (");
            for one in types {
                line!(out, "    {one},");
            }
            line!(out, ");");
        }
        line!(out);
        line!(
            out,
            "/// The identified model in a type that can hold any effect, for a `Compensator` or a file."
        );
        line!(out, "///");
        line!(out, "/// # Errors");
        line!(
            out,
            "/// None, because the constructors accept the numbers below."
        );
        line!(out, "#[allow(dead_code)]");
        line!(
            out,
            "pub fn model() -> Result<Model<f32, {terms}>, bowden::Error> {{"
        );
        line!(out, "    Ok(fixed_model()?.to_model())");
        line!(out, "}}");
        line!(out);
        Ok(())
    }

    fn function(&self, about: &About, out: &mut String) -> Result<(), String> {
        if self.is_fixed() {
            self.fixed_types(out)?;
            line!(
                out,
                "/// The identified model. Firmware links only the effects that it names."
            );
        } else {
            line!(out, "/// The identified model.");
        }
        line!(out, "///");
        line!(out, "/// # Errors");
        line!(
            out,
            "/// None, because the constructors accept the numbers below."
        );
        // A fitted number that is near pi is not pi.
        line!(out, "#[allow(dead_code, clippy::approx_constant)]");
        let terms = self.terms.len();
        match self.is_fixed() {
            true => line!(
                out,
                "pub fn fixed_model() -> Result<FixedModel<f32, {terms}, Terms>, bowden::Error> {{"
            ),
            false => line!(
                out,
                "pub fn model() -> Result<Model<f32, {terms}>, bowden::Error> {{"
            ),
        }
        if let Some(t) = &self.transmission {
            line!(out, "    // rho [{}], sigma [1], n [1]", about.unit("rho"));
            line!(
                out,
                "    let shape = BoucWen::try_new({}, {}, {})?;",
                number(t.rho),
                number(t.sigma),
                number(t.n)
            );
            let (gain, offset) = match self.mode.as_str() {
                "torque" => ("B", "T0"),
                _ => ("kappa_x", "offset"),
            };
            line!(
                out,
                "    // {gain} [{}], kappa_eta [{}], {offset} [{}]",
                about.unit("gain"),
                about.unit("kappa_eta"),
                about.unit("offset")
            );
            line!(
                out,
                "    let transmission = Transmission::{}({}, {}, {}, shape)?;",
                self.mode,
                number(t.gain),
                number(t.kappa_eta),
                number(t.offset)
            );
        }
        let transmission = match self.transmission {
            Some(_) => "Some(transmission)",
            None => "None",
        };
        let (open, close, build) = match self.is_fixed() {
            true => (
                "(",
                ")",
                format!("FixedModel::try_new({transmission}, terms)"),
            ),
            false => ("[", "]", format!("Model::try_new({transmission}, &terms)")),
        };
        if self.terms.is_empty() {
            line!(out, "    Model::try_new({transmission}, &[])");
        } else {
            line!(out, "    let terms = {open}");
            for term in &self.terms {
                self.term(term, about, out)?;
            }
            line!(out, "    {close};");
            line!(out, "    {build}");
        }
        line!(out, "}}");
        Ok(())
    }

    fn term(&self, term: &TermFile, about: &About, out: &mut String) -> Result<(), String> {
        let effect = term.effect()?;
        let own = variant(effect.name());
        let name = match term.source.as_str() {
            "input" => term.effect.clone(),
            channel => format!("{}@{channel}", term.effect),
        };
        let shapes: Vec<String> = term
            .shapes
            .iter()
            .map(|s| format!("{} [{}]", s.name, about.unit(&format!("{name}.{}", s.name))))
            .collect();
        let with = match shapes.is_empty() {
            true => String::new(),
            false => format!("; {}", shapes.join(", ")),
        };
        line!(out, "        // {name}: {}{with}", effect.info().formula);
        line!(out, "        Term {{");
        let values: Vec<String> = term.shapes.iter().map(|s| number(s.value)).collect();
        let built = match values.is_empty() {
            true => own.clone(),
            false => format!("{own}::try_new({})?", values.join(", ")),
        };
        match self.is_fixed() {
            true => line!(out, "            effect: {built},"),
            false => line!(out, "            effect: Effect::from({built}),"),
        }
        let source = self.source(&term.source);
        line!(out, "            // {}", term.source);
        line!(out, "            source: {source},");
        line!(out, "            // [{}]", about.unit(&term.source));
        line!(out, "            origin: {},", number(term.origin));
        line!(out, "            // [{}]", about.unit(&name));
        line!(out, "            gain: {},", number(term.gain));
        line!(out, "        }},");
        Ok(())
    }

    /// A source as Rust has it.
    fn source(&self, name: &str) -> String {
        match self.channels.iter().position(|c| c == name) {
            Some(index) if name != "input" => format!("Source::Channel({index})"),
            _ => "Source::Input".to_owned(),
        }
    }

    fn ranges(&self, about: &About, out: &mut String) {
        if about.ranges.is_empty() {
            return;
        }
        line!(out);
        line!(
            out,
            "/// Recorded range of each source that the model reads, for `Compensator::with_ranges`."
        );
        line!(out, "#[allow(dead_code, clippy::approx_constant)]");
        line!(
            out,
            "pub fn ranges() -> [BenchRange<f32>; {}] {{",
            about.ranges.len()
        );
        line!(out, "    [");
        for (name, span) in &about.ranges {
            let unit = about.unit(name);
            line!(
                out,
                "        // {name}: position [{unit}], velocity [{unit}/s], acceleration [{unit}/s²]"
            );
            line!(out, "        BenchRange {{");
            line!(out, "            source: {},", self.source(name));
            for (bound, end) in [("low", 0), ("high", 1)] {
                motion(span, bound, end, out);
            }
            line!(out, "        }},");
        }
        line!(out, "    ]");
        line!(out, "}}");
    }
}

/// One end of a range.
fn motion(span: &Span, bound: &str, end: usize, out: &mut String) {
    line!(out, "            {bound}: Motion {{");
    for (name, range) in [
        ("position", span.position),
        ("velocity", span.velocity),
        ("acceleration", span.acceleration),
    ] {
        line!(out, "                {name}: {},", number(range[end]));
    }
    line!(out, "            }},");
}

impl TermFile {
    /// The effect that the term names.
    ///
    /// # Errors
    /// A message if the catalogue has no such effect, or not with these shapes.
    pub fn effect(&self) -> Result<Effect<f64>, String> {
        let shapes: Vec<f64> = self.shapes.iter().map(|s| s.value).collect();
        Effect::try_from_name(&self.effect, &shapes)
            .map_err(|e| format!("term {}: {e}", self.effect))
    }
}

/// The name of an effect in the core: `drag-quadratic` is `DragQuadratic`.
fn variant(name: &str) -> String {
    name.split('-')
        .map(|word| {
            let mut letters = word.chars();
            let first = letters.next().map(|c| c.to_ascii_uppercase());
            first.into_iter().chain(letters).collect::<String>()
        })
        .collect()
}
