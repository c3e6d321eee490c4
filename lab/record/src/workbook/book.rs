//! The parts of a workbook: its sheets, their cells, and what the cells refer to.

use super::styles::{self, Style};
use super::xml::{attribute, pieces, Piece};
use super::{damaged, refused, Failure};
use crate::error::RecordError;
use crate::limits::BYTES;
use crate::zip;
use quick_xml::events::BytesStart;

/// A workbook.
pub(super) struct Book<'a> {
    bytes: &'a [u8],
    /// The names of all parts, and their entries in the directory of the archive.
    parts: Vec<(String, usize)>,
    /// Number of bytes that may still be unpacked.
    left: u64,
    pub(super) sheets: Vec<Named>,
    strings: Vec<String>,
    styles: Vec<Style>,
    is_1904: bool,
}

/// A sheet and its part.
pub(super) struct Named {
    pub(super) name: String,
    part: String,
}

/// A cell that is not empty. Row and column are counted from 0.
pub(super) struct Cell<'a> {
    pub(super) row: usize,
    pub(super) column: usize,
    /// The text without tabs and line ends.
    pub(super) text: &'a str,
}

/// A relationship to another part.
struct Relation {
    id: String,
    kind: String,
    part: String,
}

fn of_zip(damage: String) -> Failure {
    Failure::Refused(RecordError::new(damage))
}

impl<'a> Book<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Failure> {
        let mut book = Self {
            bytes,
            parts: zip::entries(bytes).map_err(of_zip)?,
            left: BYTES,
            sheets: Vec::new(),
            strings: Vec::new(),
            styles: Vec::new(),
            is_1904: false,
        };
        let root = book.relations("")?;
        let main = root.into_iter().find(|own| own.kind == "officeDocument");
        let main = main.ok_or_else(|| damaged("it does not name its main part"))?;
        if main.part.ends_with(".bin") {
            return Err(refused(
                "the file is a binary workbook (.xlsb), which bowden does not read; save it as .xlsx",
            ));
        }
        let relations = book.relations(&main.part)?;
        book.read_main(&main.part, &relations)?;
        for own in relations {
            match own.kind.as_str() {
                "sharedStrings" => book.strings = strings(&book.part(&own.part)?)?,
                "styles" => book.styles = styles::read(&book.part(&own.part)?)?,
                _ => {}
            }
        }
        Ok(book)
    }

    /// The bytes of a part. Names differ in case between writers.
    fn part(&mut self, name: &str) -> Result<Vec<u8>, Failure> {
        let mut all = self.parts.iter();
        let found = all.find(|(own, _)| own.replace('\\', "/").eq_ignore_ascii_case(name));
        let (_, entry) = found.ok_or_else(|| damaged(format!("the part {name} is missing")))?;
        let bytes = zip::unpacked(self.bytes, *entry, self.left).map_err(of_zip)?;
        self.left -= bytes.len() as u64;
        Ok(bytes)
    }

    /// The relationships of a part. An empty name means the package.
    fn relations(&mut self, of: &str) -> Result<Vec<Relation>, Failure> {
        let (folder, name) = of.rsplit_once('/').unwrap_or(("", of));
        let inside = |part: String| part.trim_start_matches('/').to_owned();
        let part = self.part(&inside(format!("{folder}/_rels/{name}.rels")))?;
        let mut all = Vec::new();
        pieces(&part, |piece| {
            if let Piece::Start("Relationship", start) = piece {
                let value = |name| attribute(start, name).unwrap_or_default();
                let target = value("Target");
                all.push(Relation {
                    id: value("Id").into_owned(),
                    kind: value("Type").rsplit('/').next().unwrap_or("").to_owned(),
                    part: match target.strip_prefix('/') {
                        Some(from_root) => from_root.to_owned(),
                        None => inside(format!("{folder}/{target}")),
                    },
                });
            }
            Ok(())
        })?;
        Ok(all)
    }

    fn read_main(&mut self, name: &str, relations: &[Relation]) -> Result<(), Failure> {
        let part = self.part(name)?;
        pieces(&part, |piece| {
            match piece {
                Piece::Start("workbookPr", start) => {
                    let epoch = attribute(start, "date1904").unwrap_or_default();
                    self.is_1904 = matches!(&*epoch, "1" | "true" | "on");
                }
                Piece::Start("sheet", start) => {
                    let id = attribute(start, "id").unwrap_or_default();
                    let own = relations.iter().find(|own| own.id == id);
                    if let Some(own) = own.filter(|own| own.kind == "worksheet") {
                        self.sheets.push(Named {
                            name: attribute(start, "name").unwrap_or_default().into_owned(),
                            part: own.part.clone(),
                        });
                    }
                }
                _ => {}
            }
            Ok(())
        })
    }

    /// Gives each cell of a sheet that is not empty to `take`.
    pub(super) fn cells(
        &mut self,
        sheet: usize,
        mut take: impl FnMut(Cell<'_>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let name = self.sheets[sheet].part.clone();
        let part = self.part(&name)?;
        let (mut place, mut own) = (Place::default(), Written::default());
        pieces(&part, |piece| {
            match piece {
                Piece::Start("row", start) => place.row(attribute(start, "r").as_deref())?,
                Piece::Start("c", start) => {
                    place.cell(attribute(start, "r").as_deref())?;
                    own = Written::of(start);
                }
                Piece::End("c") => {
                    let text = self.text(&own)?;
                    if !text.is_empty() {
                        let (row, column) = (place.row - 1, place.column - 1);
                        take(Cell {
                            row,
                            column,
                            text: &text,
                        })?;
                    }
                }
                other => own.text.take(other),
            }
            Ok(())
        })
    }

    /// A cell as a text without tabs and line ends.
    fn text(&self, cell: &Written) -> Result<String, Failure> {
        let (text, plain) = (cell.text.own.as_str(), |text: &str| {
            let text = text.replace(char::is_control, " ").replace('"', "'");
            text.trim().to_owned()
        });
        Ok(match cell.kind.as_str() {
            "e" => String::new(),
            "s" => {
                let own = text.trim().parse().ok();
                let own = own.and_then(|index: usize| self.strings.get(index));
                plain(own.ok_or_else(|| {
                    damaged("a cell refers to a shared string that does not exist")
                })?)
            }
            "b" | "n" if text.trim().is_empty() => String::new(),
            "n" => {
                let number = text.trim().parse();
                let number =
                    number.map_err(|_| damaged("a numeric cell does not contain a number"))?;
                let style = self.styles.get(cell.style).copied();
                styles::written(number, style.unwrap_or(Style::Number), self.is_1904)
            }
            _ => plain(text),
        })
    }
}

/// A cell as it is stored in its part.
#[derive(Default)]
struct Written {
    kind: String,
    style: usize,
    text: Text,
}

impl Written {
    fn of(start: &BytesStart<'_>) -> Self {
        let style = attribute(start, "s").and_then(|own| own.parse().ok());
        Self {
            kind: attribute(start, "t").map_or_else(|| "n".to_owned(), |own| own.into_owned()),
            style: style.unwrap_or(0),
            text: Text::default(),
        }
    }
}

/// A text with or without formats. It includes the text of `v` and `t`, but not of `rPh`
/// (pronunciation).
#[derive(Default)]
struct Text {
    own: String,
    is_inside: bool,
    is_phonetic: bool,
}

impl Text {
    fn take(&mut self, piece: Piece<'_>) {
        match piece {
            Piece::Start("v" | "t", _) => self.is_inside = !self.is_phonetic,
            Piece::End("v" | "t") => self.is_inside = false,
            Piece::Start("rPh", _) => self.is_phonetic = true,
            Piece::End("rPh") => self.is_phonetic = false,
            Piece::Text(text) if self.is_inside => self.own.push_str(&text),
            _ => {}
        }
    }
}

/// Row and column of the last cell, from 1; 0 before the first.
#[derive(Default)]
struct Place {
    row: usize,
    column: usize,
}

impl Place {
    /// Moves to the row with this name or, without a name, to the next row.
    fn row(&mut self, name: Option<&str>) -> Result<(), Failure> {
        self.column = 0;
        self.row = match name {
            Some(name) => whole(name)?,
            None => self.row + 1,
        };
        Ok(())
    }

    /// Moves to the cell with this name, such as `AB12` or, without a name, to the next cell.
    fn cell(&mut self, name: Option<&str>) -> Result<(), Failure> {
        self.column += 1;
        if let Some(name) = name {
            let digits = name
                .find(|c: char| c.is_ascii_digit())
                .unwrap_or(name.len());
            let (letters, digits) = name.split_at(digits);
            let letter = |all: usize, own: u8| {
                let value = own.to_ascii_uppercase().checked_sub(b'A' - 1);
                let value = value.filter(|value| (1..=26).contains(value) && all < 1 << 20);
                value.map(|value| 26 * all + usize::from(value))
            };
            let column = letters.bytes().try_fold(0, letter);
            let column = column.filter(|column| *column > 0);
            self.column = column.ok_or_else(|| damaged("a cell has no column"))?;
            self.row = whole(digits)?;
        }
        match self.row {
            0 => Err(damaged("a cell has no row")),
            _ => Ok(()),
        }
    }
}

/// The number of a row; a sheet has at most 2^20 rows.
fn whole(text: &str) -> Result<usize, Failure> {
    let own = text.parse().ok();
    let own = own.filter(|row| (1..=1 << 20).contains(row));
    own.ok_or_else(|| damaged("a row number is outside 1 to 1048576"))
}

/// The texts of a part `sharedStrings.xml`.
fn strings(part: &[u8]) -> Result<Vec<String>, Failure> {
    let mut all: Vec<Text> = Vec::new();
    pieces(part, |piece| {
        match (piece, all.last_mut()) {
            (Piece::Start("si", _), _) => all.push(Text::default()),
            (piece, Some(last)) => last.take(piece),
            _ => {}
        }
        Ok(())
    })?;
    Ok(all.into_iter().map(|text| text.own).collect())
}
