//! The model as a C header that needs only the library: its bytes, and the functions that load
//! them.

use super::c_names::{macros, prefix};
use super::firmware::{bytes_in_double, postcard, CHECKSUM};
use super::{About, ModelFile, Span, ROOM};
use std::fmt::Write as _;

/// Bytes on a line.
const ON_A_LINE: usize = 16;

/// Writes a line; a `String` takes any.
macro_rules! line {
    ($out:expr, $($what:tt)*) => {{ let _ = writeln!($out, $($what)*); }};
}

impl ModelFile {
    /// The model as a C header: the bytes in `f32` and `f64`, functions `NAME_load_f32` and
    /// `NAME_compensator_f32` (and `_f64`), the indices of the channels, the ranges, and the time
    /// constant for `bowden_rates_settings_f32` (and `_f64`). `name` is the stem of its file, see
    /// [`prefix`].
    ///
    /// # Errors
    /// A message if the name results in no prefix, the core refuses a part, or the model exceeds
    /// the capacity of the C interface.
    pub fn c(&self, name: &str) -> Result<String, String> {
        let none = About::default();
        let about = self.about.as_ref().unwrap_or(&none);
        let lower = prefix(name)?;
        self.check_room()?;
        let (single, double) = (postcard(self)?, bytes_in_double(self)?);
        let upper = lower.to_uppercase();
        let mut body = "#include \"bowden.h\"\n\n".to_owned();
        self.places(about, &upper, &mut body);
        if about.rates_time_constant_s > 0.0 {
            let tau = about.rates_time_constant_s;
            line!(
                body,
                "/* Set time_constant [s] to this value after BOWDEN_RATES_SETTINGS_F32_INIT or _F64_INIT, for every source. */"
            );
            line!(
                body,
                "#define {upper}_RATES_TIME_CONSTANT_F32 {}",
                number(tau, true)
            );
            line!(
                body,
                "#define {upper}_RATES_TIME_CONSTANT_F64 {}\n",
                number(tau, false)
            );
        }
        if let Some(play) = &about.play {
            line!(
                body,
                "/* Half-width for bowden_play_init, which is applied to the input [{}]. */",
                commented(about.unit("input"))
            );
            for (suffix, is_single) in [("F32", true), ("F64", false)] {
                let half_width = number(play.half_width, is_single);
                line!(
                    body,
                    "#define {upper}_PLAY_HALF_WIDTH_{suffix} {half_width}"
                );
            }
            line!(body, "");
        }
        for (is_single, bytes) in [(true, single), (false, double)] {
            self.in_one_precision(about, &lower, is_single, &bytes, &mut body);
        }
        Ok(self.c_head(about, name, &lower) + &guarded(&upper, &body))
    }

    fn check_room(&self) -> Result<(), String> {
        let terms = self.terms.len();
        if terms > ROOM {
            return Err(format!(
                "the model has {terms} terms, but the C interface allows at most {ROOM}"
            ));
        }
        for term in &self.terms {
            let place = self.channels.iter().position(|name| *name == term.source);
            if place.is_some_and(|place| place >= ROOM) {
                return Err(format!(
                    "{} reads channel {}, but the C interface allows at most {ROOM} channels",
                    term.effect, term.source
                ));
            }
        }
        Ok(())
    }

    /// What a reader has to know before the numbers.
    fn c_head(&self, about: &About, name: &str, lower: &str) -> String {
        let mut text = format!("{}.\n\n", about.remark());
        let (input, output) = (about.unit("input"), about.unit("output"));
        line!(
            text,
            "Input [{input}], output [{output}], {} mode.",
            self.mode
        );
        if self.about.is_some() {
            // The lines of the Rust file, without its marks of a comment.
            for line in super::rust::origin(about, "bowden_play").lines() {
                line!(text, "{}", line.trim_start_matches("//!").trim_start());
            }
            line!(text, "Feed-forward: {}.", about.feed_forward);
        }
        line!(text, "");
        let upper = lower.to_uppercase();
        line!(
            text,
            "The prefix {lower}_ (of macros {upper}_) comes from the file name {name:?}."
        );
        line!(text, "");
        line!(text, "bowden_model_f32 model;");
        line!(text, "if ({lower}_load_f32(&model, NULL) < 0) ...");
        let mut out = String::new();
        for (index, line) in text.lines().enumerate() {
            let mark = if index == 0 { "/*" } else { " *" };
            line!(out, "{}", format!("{mark} {}", commented(line)).trim_end());
        }
        line!(out, " */");
        out
    }

    /// The channels' places in a sample.
    fn places(&self, about: &About, upper: &str, out: &mut String) {
        line!(out, "/* Minimum number of channels in a sample. */");
        line!(
            out,
            "#define {upper}_CHANNELS {}",
            self.channels.len().min(ROOM)
        );
        let channels = self.channels.iter().take(ROOM);
        for (index, (name, own)) in channels.zip(macros(&self.channels)).enumerate() {
            let channel = commented(&about.channel(name));
            line!(out, "#define {upper}_CHANNEL_{own} {index} /* {channel} */");
        }
        line!(out, "");
    }

    fn in_one_precision(
        &self,
        about: &About,
        lower: &str,
        is_single: bool,
        bytes: &[u8],
        out: &mut String,
    ) {
        let (kind, suffix) = if is_single {
            ("float", "f32")
        } else {
            ("double", "f64")
        };
        line!(
            out,
            "/* The model in {kind} with its checksum, for bowden_model_load_{suffix}. */"
        );
        line!(
            out,
            "static const uint8_t {lower}_bytes_{suffix}[{}] = {{",
            bytes.len()
        );
        for some in bytes.chunks(ON_A_LINE) {
            let some: Vec<String> = some.iter().map(|byte| format!("0x{byte:02x},")).collect();
            line!(out, "    {}", some.join(" "));
        }
        line!(out, "}};\n");
        let (mut ranges, mut count) = ("NULL".to_owned(), 0);
        if !about.ranges.is_empty() {
            count = about.ranges.len();
            ranges = format!("{lower}_ranges_{suffix}");
            line!(
                out,
                "/* Range of each source in the fitted record: position, velocity, acceleration. */"
            );
            line!(
                out,
                "static const bowden_range_{suffix} {ranges}[{count}] = {{"
            );
            for (name, span) in &about.ranges {
                let place = self.channels.iter().position(|channel| channel == name);
                let source = match place {
                    Some(place) if name != "input" => place.to_string(),
                    _ => "BOWDEN_SOURCE_INPUT".to_owned(),
                };
                let (low, high) = (end(span, 0, is_single), end(span, 1, is_single));
                line!(
                    out,
                    "    {{{source}, {low}, {high}}}, /* {} */",
                    commented(name)
                );
            }
            line!(out, "}};\n");
        }
        line!(
            out,
            "/* Loads the model with its hysteresis at zero; `about` may be NULL. */"
        );
        line!(
            out,
            "static inline bowden_result {lower}_load_{suffix}(bowden_model_{suffix} *model, bowden_about *about) {{\n    \
             return bowden_model_load_{suffix}(model, {lower}_bytes_{suffix}, sizeof {lower}_bytes_{suffix}, 0, about);\n}}\n"
        );
        line!(
            out,
            "/* Inverts the loaded model, within the ranges of the fitted record. */"
        );
        line!(
            out,
            "static inline bowden_result {lower}_compensator_{suffix}(bowden_compensator_{suffix} *compensator,\n    \
             const bowden_model_{suffix} *model, {kind} longest_dt, bowden_about *about) {{\n    \
             return bowden_compensator_init_{suffix}(compensator, model, longest_dt, {ranges}, {count}, about);\n}}\n"
        );
    }
}

/// One end of a range.
fn end(span: &Span, end: usize, is_single: bool) -> String {
    let of = |range: [f64; 2]| number(range[end], is_single);
    let (position, velocity) = (of(span.position), of(span.velocity));
    format!("{{{position}, {velocity}, {}}}", of(span.acceleration))
}

/// The shortest text that reads back to the same number.
fn number(value: f64, is_single: bool) -> String {
    if is_single {
        format!("{:?}f", value as f32)
    } else {
        format!("{value:?}")
    }
}

/// The include guard; a second header with the same prefix and other contents is an error.
fn guarded(upper: &str, body: &str) -> String {
    let guard = format!("BOWDEN_MODEL_{upper}_H");
    // Of all that follows: a model of the same bytes may have other channels or ranges.
    let own = format!("0x{:08x}u", CHECKSUM.checksum(body.as_bytes()));
    let mut out = String::new();
    line!(out, "#ifdef {guard}");
    line!(out, "#if {guard} != {own}");
    line!(
        out,
        "#error \"two headers of different models have the prefix {upper}_: export one under another file name\""
    );
    line!(out, "#endif");
    line!(out, "#else");
    line!(
        out,
        "#define {guard} {own} /* CRC-32 of the text below */\n"
    );
    out += body;
    line!(out, "#endif /* {guard} */");
    out
}

/// A text that neither ends a comment of C nor opens another.
fn commented(text: &str) -> String {
    let plain = text.chars().map(|c| if c.is_control() { ' ' } else { c });
    let mut plain: String = plain.collect();
    while plain.contains("*/") || plain.contains("/*") {
        plain = plain.replace("*/", "* /").replace("/*", "/ *");
    }
    plain
}
