//! The format of names with units and of estimates on all pages.

use bowden_lab::facts::{number, with_interval, Parameter};

/// " [N·m]"; empty if the record states no unit.
pub(crate) fn in_brackets(unit: Option<&str>) -> String {
    unit.map_or_else(String::new, |unit| format!(" [{unit}]"))
}

/// A name with its unit.
pub(crate) fn quantity(name: &str, unit: Option<&str>) -> String {
    format!("{name}{}", in_brackets(unit))
}

/// The unit of a parameter behind its number.
pub(crate) fn unit(parameter: &Parameter) -> String {
    match parameter.unit.as_deref() {
        Some("1") | None => String::new(),
        Some(unit) => unit.to_owned(),
    }
}

/// "12.34 ± 0.05", or the remark in its place.
pub(crate) fn value(parameter: &Parameter) -> String {
    match parameter.ci95 {
        Some(_) => with_interval(parameter.value, parameter.ci95),
        None => {
            let reason = parameter
                .not_identified
                .as_ref()
                .map_or("", |r| r.reason.as_str());
            format!(
                "{}, not identified: {reason}",
                number(parameter.value, None)
            )
        }
    }
}
