//! Elements and texts of an XML part, in order.

use super::{damaged, Failure};
use crate::encoding;
use quick_xml::escape::resolve_xml_entity;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::borrow::Cow;

/// One piece of an XML part. Names have no prefix.
pub(super) enum Piece<'a> {
    Start(&'a str, &'a BytesStart<'a>),
    End(&'a str),
    Text(Cow<'a, str>),
}

fn bad(error: impl std::fmt::Display) -> Failure {
    damaged(error.to_string())
}

/// Passes each piece of a part to `take`.
pub(super) fn pieces(
    part: &[u8],
    mut take: impl FnMut(Piece<'_>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let decoded = encoding::decode(part).map_err(|_| damaged("a part is empty or is not text"))?;
    let mut reader = Reader::from_str(&decoded.text);
    reader.config_mut().expand_empty_elements = true;
    loop {
        match reader.read_event().map_err(bad)? {
            Event::Start(start) => take(Piece::Start(start.local_name().into_inner(), &start))?,
            Event::End(end) => take(Piece::End(end.local_name().into_inner()))?,
            Event::Text(text) => take(Piece::Text(text.into_inner()))?,
            Event::CData(text) => take(Piece::Text(text.into_inner()))?,
            Event::GeneralRef(own) => {
                let name = own.borrow().into_inner();
                let text = match own.resolve_char_ref().map_err(bad)? {
                    Some(letter) => letter.to_string(),
                    None => resolve_xml_entity(&name)
                        .ok_or_else(|| damaged(format!("the entity `{name}` is unknown")))?
                        .to_owned(),
                };
                take(Piece::Text(text.into()))?;
            }
            Event::Eof => return Ok(()),
            _ => {}
        }
    }
}

/// The value of an attribute, by its name without a prefix.
pub(super) fn attribute<'a>(start: &'a BytesStart<'_>, name: &str) -> Option<Cow<'a, str>> {
    let mut all = start.attributes().flatten();
    let own = all.find(|own| own.key.local_name().into_inner() == name)?;
    own.normalized_value(XmlVersion::default()).ok()
}
