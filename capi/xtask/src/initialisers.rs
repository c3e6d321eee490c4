//! The macros NAME_INIT of the header: the defaults of each settings struct, as the library has
//! them.

use bowden::*;
use std::error::Error;

/// Adds to the header, behind each settings struct, the macro with its defaults.
pub fn added_to(header: &str) -> Result<String, Box<dyn Error>> {
    let mut text = header.to_owned();
    let defaults = defaults();
    for value in &defaults {
        let name = value.split(' ').next().unwrap_or_default();
        let end = format!("}} {name};\n");
        if text.matches(&end).count() != 1 {
            return Err(format!("the header has no struct {name}").into());
        }
        text = text.replace(&end, &format!("{end}\n{}", initialiser(name, value)));
    }
    // One with a mark and without a macro could not be used.
    let marked = header.matches("    uint32_t init_mark;\n").count();
    if marked != defaults.len() {
        return Err(format!("{marked} settings structs, {} macros", defaults.len()).into());
    }
    Ok(text)
}

/// Every settings struct with its defaults, as Rust writes it for debugging.
fn defaults() -> Vec<String> {
    vec![
        format!("{:?}", bowden_pid_settings_f32::defaults()),
        format!("{:?}", bowden_pid_settings_f64::defaults()),
        format!("{:?}", bowden_adaptive_settings_f32::defaults()),
        format!("{:?}", bowden_adaptive_settings_f64::defaults()),
        format!("{:?}", bowden_estimator_f32::defaults()),
        format!("{:?}", bowden_estimator_f64::defaults()),
        format!("{:?}", bowden_observer_settings_f32::defaults()),
        format!("{:?}", bowden_observer_settings_f64::defaults()),
        format!("{:?}", bowden_iterative_learning_settings_f32::defaults()),
        format!("{:?}", bowden_iterative_learning_settings_f64::defaults()),
        format!("{:?}", bowden_biquad_settings_f32::defaults()),
        format!("{:?}", bowden_biquad_settings_f64::defaults()),
        format!("{:?}", bowden_edge_velocity_settings_f32::defaults()),
        format!("{:?}", bowden_edge_velocity_settings_f64::defaults()),
        format!("{:?}", bowden_plausible_settings_f32::defaults()),
        format!("{:?}", bowden_plausible_settings_f64::defaults()),
        format!("{:?}", bowden_relay_settings_f32::defaults()),
        format!("{:?}", bowden_relay_settings_f64::defaults()),
        format!("{:?}", bowden_rates_settings_f32::defaults()),
        format!("{:?}", bowden_rates_settings_f64::defaults()),
        format!("{:?}", bowden_hysteresis_settings_f32::defaults()),
        format!("{:?}", bowden_hysteresis_settings_f64::defaults()),
        format!("{:?}", bowden_cable_settings_f32::defaults()),
        format!("{:?}", bowden_cable_settings_f64::defaults()),
    ]
}

/// The macro: values in the order of the fields, since C++11 has no designated initialisers.
fn initialiser(name: &str, value: &str) -> String {
    let suffix = if name.ends_with("_f32") { "f" } else { "" };
    let macro_name = format!("{}_INIT", name.to_uppercase());
    let mut fields = Vec::new();
    let (mut depth, mut field, mut now) = (0, String::new(), String::new());
    for word in words(value) {
        match word {
            "{" | "[" => {
                depth += 1;
                if depth > 1 {
                    now.push('{');
                }
            }
            "}" | "]" => {
                depth -= 1;
                if depth > 0 {
                    now.push('}');
                }
            }
            "," if depth == 1 => {
                fields.push(format!("    {now}, /* {field} */"));
                now.clear();
            }
            "," => now.push_str(", "),
            _ if word.ends_with(':') && depth == 1 => {
                field = word.trim_end_matches(':').to_owned();
            }
            _ if word.ends_with(':') => {}
            _ if word.starts_with(|first: char| first.is_ascii_digit() || first == '-') => {
                let is_float = word.contains(['.', 'e']);
                now.push_str(word);
                now.push_str(if is_float { suffix } else { "u" });
            }
            // The name of a type.
            _ => {}
        }
    }
    fields.push(format!("    {now} /* {field} */"));
    format!(
        "// The defaults, in C99 and C++11:\n\
         //\n\
         //     {name} settings = {macro_name};\n\
         #define {macro_name} {{ \\\n{} \\\n}}\n",
        fields.join(" \\\n")
    )
}

/// Names with their colon, numbers, brackets and commas.
fn words(value: &str) -> Vec<&str> {
    let mut words = Vec::new();
    for part in value.split_whitespace() {
        let mut rest = part;
        while let Some(at) = rest.find(['{', '}', '[', ']', ',']) {
            let (word, behind) = rest.split_at(at);
            let (bracket, behind) = behind.split_at(1);
            words.extend([word, bracket].iter().filter(|word| !word.is_empty()));
            rest = behind;
        }
        if !rest.is_empty() {
            words.push(rest);
        }
    }
    words
}
