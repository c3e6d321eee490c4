//! The values of a JSON text, in order.

use super::super::error::{shown, RecordError, NAME_LENGTH};
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use std::borrow::Cow;
use std::fmt;

/// One value with its contents.
pub(super) enum Json {
    Cell(Cell),
    List(Vec<Json>),
    Object(Vec<(String, Json)>),
}

/// A scalar value.
#[derive(Clone, Default)]
pub(super) enum Cell {
    #[default]
    Empty,
    Number(f64),
    Text(Box<str>),
}

/// The successive values of a text. If there are several values, the last one may be incomplete.
pub(super) fn values(text: &str, notes: &mut Vec<String>) -> Result<Vec<Json>, RecordError> {
    let mut all = Vec::new();
    for value in serde_json::Deserializer::from_str(text).into_iter::<Json>() {
        match value {
            Ok(value) => all.push(value),
            Err(error) if error.is_eof() && all.len() > 1 => {
                let line = all.len() + 1;
                notes.push(format!(
                    "the last line, {line}, is truncated and was dropped"
                ));
            }
            Err(error) => {
                let place = format!(" at line {} column {}", error.line(), error.column());
                let why = error.to_string().replace(&place, "");
                let why = shown(&why, 2 * NAME_LENGTH);
                let message =
                    format!("the file begins as JSON, but the JSON is invalid here: {why}");
                return Err(RecordError::at(error.line(), message));
            }
        }
    }
    Ok(all)
}

/// The text with `null` instead of `NaN`, which Python writes although JSON does not allow it.
pub(super) fn without_nan(text: &str) -> Cow<'_, str> {
    const NAN: &str = "NaN";
    let (mut all, mut copied) = (String::new(), 0);
    let (mut is_quoted, mut is_escaped) = (false, false);
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            _ if is_escaped => is_escaped = false,
            b'\\' => is_escaped = is_quoted,
            b'"' => is_quoted = !is_quoted,
            b'N' if !is_quoted && text[at..].starts_with(NAN) => {
                all += &text[copied..at];
                all += "null";
                copied = at + NAN.len();
            }
            _ => {}
        }
    }
    match copied {
        0 => Cow::Borrowed(text),
        _ => Cow::Owned(all + &text[copied..]),
    }
}

impl<'de> Deserialize<'de> for Json {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(Values)
    }
}

struct Values;

impl<'de> Visitor<'de> for Values {
    type Value = Json;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_unit<E>(self) -> Result<Json, E> {
        Ok(Json::Cell(Cell::Empty))
    }

    fn visit_bool<E>(self, value: bool) -> Result<Json, E> {
        Ok(Json::Cell(Cell::Number(f64::from(u8::from(value)))))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Json, E> {
        Ok(Json::Cell(Cell::Number(value as f64)))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Json, E> {
        Ok(Json::Cell(Cell::Number(value as f64)))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Json, E> {
        Ok(Json::Cell(Cell::Number(value)))
    }

    fn visit_str<E>(self, value: &str) -> Result<Json, E> {
        Ok(Json::Cell(Cell::Text(value.into())))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut from: A) -> Result<Json, A::Error> {
        let mut all = Vec::new();
        while let Some(value) = from.next_element()? {
            all.push(value);
        }
        Ok(Json::List(all))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut from: A) -> Result<Json, A::Error> {
        let mut all = Vec::new();
        while let Some(field) = from.next_entry()? {
            all.push(field);
        }
        Ok(Json::Object(all))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_is_replaced_outside_of_texts_alone() {
        assert_eq!(
            without_nan(r#"{"NaN": NaN, "\"NaN": [NaN,1]}"#),
            r#"{"NaN": null, "\"NaN": [null,1]}"#
        );
        assert!(matches!(without_nan("[1,2]"), Cow::Borrowed(_)));
    }
}
