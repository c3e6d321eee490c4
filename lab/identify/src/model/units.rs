//! Units of fitted parameters, derived from those of the columns.

/// A product of units with whole exponents.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Unit {
    factors: Vec<(String, i32)>,
    unknown: bool,
}

impl Unit {
    /// The unit of a dimensionless number.
    #[must_use]
    pub fn one() -> Self {
        Self::default()
    }

    /// A named unit to a power; `None` makes the product unknown where the power counts.
    #[must_use]
    pub fn times(mut self, unit: Option<&str>, exponent: i32) -> Self {
        if exponent == 0 {
            return self;
        }
        let Some(unit) = unit.map(str::trim).filter(|u| !u.is_empty()) else {
            self.unknown = true;
            return self;
        };
        if unit == "1" || unit == "-" {
            return self;
        }
        match self.factors.iter_mut().find(|(name, _)| name == unit) {
            Some((_, power)) => *power += exponent,
            None => self.factors.push((unit.to_owned(), exponent)),
        }
        self.factors.retain(|(_, power)| *power != 0);
        self
    }

    /// As text: "N·s/mm"; "1" without dimension; `None` if a column has no unit.
    #[must_use]
    pub fn text(&self) -> Option<String> {
        if self.unknown {
            return None;
        }
        let part = |sign: i32| -> Vec<String> {
            self.factors
                .iter()
                .filter(|(_, power)| power.signum() == sign)
                .map(|(name, power)| match power.abs() {
                    1 => name.clone(),
                    p => format!(
                        "{}{}",
                        if name.contains('·') {
                            format!("({name})")
                        } else {
                            name.clone()
                        },
                        superscript(p)
                    ),
                })
                .collect()
        };
        let (over, under) = (part(1), part(-1));
        let numerator = if over.is_empty() {
            "1".to_owned()
        } else {
            over.join("·")
        };
        Some(match under.len() {
            0 => numerator,
            1 if !under[0].contains('·') => format!("{numerator}/{}", under[0]),
            _ => format!("{numerator}/({})", under.join("·")),
        })
    }
}

fn superscript(power: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    power
        .to_string()
        .chars()
        .filter_map(|c| c.to_digit(10))
        .map(|d| DIGITS[d as usize])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_multiply_cancel_and_print() {
        let force = Some("N");
        let damping = Unit::one()
            .times(force, 1)
            .times(Some("mm"), -1)
            .times(Some("s"), 1);
        assert_eq!(damping.text().as_deref(), Some("N·s/mm"));
        assert_eq!(
            Unit::one()
                .times(force, 1)
                .times(force, -1)
                .text()
                .as_deref(),
            Some("1")
        );
        assert_eq!(
            Unit::one().times(Some("N·m"), -1).text().as_deref(),
            Some("1/(N·m)")
        );
        assert_eq!(
            Unit::one()
                .times(force, 1)
                .times(Some("mm"), -2)
                .times(Some("s"), 2)
                .text()
                .as_deref(),
            Some("N·s²/mm²")
        );
        assert_eq!(Unit::one().times(None, 1).text(), None);
        assert_eq!(Unit::one().times(None, 0).text().as_deref(), Some("1"));
    }
}
