//! Excel workbooks: each kind of cell, of sheet and of damage.

use super::npz::{no_byte_panics, zip};
use super::*;
use bowden_lab::record::{excerpt, outline, parse};

/// Cell formats by index: general, a date with a time, a time of day, a duration.
const STYLES: &str = r#"<styleSheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main">
<numFmts count="2"><numFmt numFmtId="164" formatCode="hh:mm:ss.000"/><numFmt numFmtId="165" formatCode="[h]:mm:ss"/></numFmts>
<cellXfs count="4"><xf numFmtId="0"/><xf numFmtId="22"/><xf numFmtId="164"/><xf numFmtId="165"/></cellXfs></styleSheet>"#;

/// A cell: `=2:1.5` is the number 1.5 with the format 2, `!` an error, anything else a text or a
/// number.
fn cell(row: usize, column: usize, text: &str) -> String {
    let letter = |index: usize| char::from(b'A' + index as u8);
    let first = (column / 26).checked_sub(1).map(letter);
    let first = first.map_or_else(String::new, String::from);
    let place = format!("{first}{}{}", letter(column % 26), row + 1);
    if text.is_empty() {
        return String::new();
    }
    if let Some((format, value)) = text.strip_prefix('=').and_then(|own| own.split_once(':')) {
        return format!("<c r=\"{place}\" s=\"{format}\"><v>{value}</v></c>");
    }
    if let Some(error) = text.strip_prefix('!') {
        return format!("<c r=\"{place}\" t=\"e\"><v>{error}</v></c>");
    }
    match text.parse::<f64>() {
        Ok(_) => format!("<c r=\"{place}\"><v>{text}</v></c>"),
        Err(_) => format!("<c r=\"{place}\" t=\"inlineStr\"><is><t>{text}</t></is></c>"),
    }
}

/// A workbook of these sheets, each a text with commas.
fn workbook(sheets: &[(&str, &str)]) -> Vec<u8> {
    let main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    let office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let package = "http://schemas.openxmlformats.org/package/2006/relationships";
    let (mut list, mut relations) = (String::new(), String::new());
    let root = format!("<Relationships xmlns=\"{package}\"><Relationship Id=\"rId1\" Type=\"{office}/officeDocument\" Target=\"xl/workbook.xml\"/></Relationships>");
    let mut files = vec![
        ("[Content_Types].xml".to_owned(), "<Types/>".to_owned()),
        ("_rels/.rels".to_owned(), root),
    ];
    for (index, (name, text)) in sheets.iter().enumerate() {
        let number = index + 1;
        list += &format!("<sheet name=\"{name}\" sheetId=\"{number}\" r:id=\"rId{number}\"/>");
        relations += &format!("<Relationship Id=\"rId{number}\" Type=\"{office}/worksheet\" Target=\"worksheets/sheet{number}.xml\"/>");
        let row = |(row, line): (usize, &str)| {
            let cells = line.split(',').enumerate();
            let cells: String = cells.map(|(column, own)| cell(row, column, own)).collect();
            format!("<row r=\"{}\">{cells}</row>", row + 1)
        };
        let data: String = text.lines().enumerate().map(row).collect();
        let sheet =
            format!("<worksheet xmlns=\"{main}\"><sheetData>{data}</sheetData></worksheet>");
        files.push((format!("xl/worksheets/sheet{number}.xml"), sheet));
    }
    let book = format!(
        "<workbook xmlns=\"{main}\" xmlns:r=\"{office}\"><sheets>{list}</sheets></workbook>"
    );
    files.push(("xl/workbook.xml".to_owned(), book));
    relations +=
        &format!("<Relationship Id=\"styles\" Type=\"{office}/styles\" Target=\"styles.xml\"/>");
    let relations = format!("<Relationships xmlns=\"{package}\">{relations}</Relationships>");
    files.push(("xl/_rels/workbook.xml.rels".to_owned(), relations));
    files.push(("xl/styles.xml".to_owned(), STYLES.to_owned()));
    let files: Vec<(&str, Vec<u8>)> = files
        .iter()
        .map(|(name, text)| (name.as_str(), text.clone().into_bytes()))
        .collect();
    zip(&files, true)
}

fn of_sheets(sheets: &[(&str, &str)], options: &Options) -> Result<Record, String> {
    parse(&workbook(sheets), "r.xlsx", options).map_err(|error| error.to_string())
}

/// The numbers of the plain record; a double of days resolves a microsecond, and stamps are read to
/// that.
fn assert_plain(record: &Record) {
    let plain = accepted(plain());
    assert_eq!(record.input.values, plain.input.values);
    assert_eq!(record.output.values, plain.output.values);
    let mut apart = record.time.iter().zip(&plain.time);
    let is_near = apart.all(|(a, b)| (a - b).abs() < 2e-6);
    assert!(is_near, "{:?}", record.time);
}

#[test]
fn a_sheet_is_read_as_its_text_would_be() {
    // Dates, times of day and durations.
    let days = |format: usize, from: f64| {
        stamped("t,x,f", |i| {
            format!("={format}:{}", from + i as f64 * 0.01 / 86_400.0)
        })
    };
    let head = |head: &str| csv(head, &rows());
    for (sheet, unit, note) in [
        (plain(), None, ""),
        (head("t,x [mm],f [N]"), Some("mm"), ""),
        (
            head("Rig 7,,\n,,\nt,x,f\ns,mm,N"),
            Some("mm"),
            "units from line 4",
        ),
        (
            head("# a comment,,,a note\nt,x,f"),
            None,
            "line 1 above the names",
        ),
        (days(1, 46_082.5), None, ""),
        (days(2, 0.5), None, ""),
        (days(3, 2.0), None, ""),
        // A column of text next to the numbers.
        (wider("t,x,f,who", ",Ü"), None, ""),
    ] {
        let record = of_sheets(&[("Sheet1", &sheet)], &Options::default()).unwrap();
        assert_plain(&record);
        assert_eq!(units(&record)[0], unit);
        assert!(record.notes.concat().contains(note), "{:?}", record.notes);
    }
}

#[test]
fn an_error_of_a_sheet_counts_as_an_empty_cell() {
    for cell in ["", "!#DIV/0!"] {
        let sheet = with_line(9, &format!("0.07,{cell},1"));
        let sheets = [("Sheet1", sheet.as_str())];
        assert_eq!(
            of_sheets(&sheets, &Options::default()).unwrap_err(),
            "r.xlsx:9: column `x`: the cell is empty, but it must be a number; --drop-bad drops such rows"
        );
        assert_eq!(of_sheets(&sheets, &drop_bad()).unwrap().dropped, 1);
    }
}

#[test]
fn the_sheet_with_the_columns_is_read_and_the_others_are_named() {
    let own = csv("t,x,f", &rows());
    let other = csv("a,b,c", &rows());
    let words = "Operator,Ann\nRig,7\n";
    let at = |sheet: Option<&str>| with(|o| o.sheet = sheet.map(str::to_owned));
    let read = |sheets: &[(&str, &str)], sheet| of_sheets(sheets, &at(sheet)).map(|own| own.notes);
    let all = [
        ("Notes", words),
        ("Other", &*other),
        ("Run 1", &*own),
        ("Run 2", &*own),
    ];
    assert_eq!(
        read(&all, None).unwrap(),
        ["sheet `Run 1` read; --sheet selects another sheet with a table: `Other`, `Run 2`"]
    );
    assert!(read(&all, Some("Run 2")).unwrap().is_empty());
    assert!(read(&[all[0], all[2]], None).unwrap().is_empty());
    let refusal = |sheets: &[(&str, &str)], sheet| read(sheets, sheet).unwrap_err();
    assert!(refusal(&all, Some("Other")).starts_with("r.xlsx:1: the columns `a`, `b`, `c` "));
    assert_eq!(
        refusal(&all, Some("run 1")),
        "r.xlsx: --sheet run 1: the workbook has no such sheet (nearest: `Run 1`, `Run 2`)"
    );
    assert_eq!(
        refusal(&[("Notes", words)], None),
        "r.xlsx: no sheet contains a table, which is two or more columns of numbers below their names"
    );
    assert_eq!(
        refusal(&[("Run", &own), ("Empty", "")], Some("Empty")),
        "r.xlsx: --sheet Empty: the sheet is empty"
    );
    refused_with(
        own,
        &at(Some("A")),
        " --sheet A: the file is not an Excel workbook",
    );
}

const OFFICE: &str = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";

fn relation(id: &str, kind: &str, target: &str) -> String {
    format!("<Relationship Id=\"{id}\" Type=\"{OFFICE}/{kind}\" Target=\"{target}\"/>")
}

fn relations(all: &[String]) -> String {
    format!("<Relationships>{}</Relationships>", all.concat())
}

/// Names with a prefix, targets from the root, texts in a part of their own with formats and a
/// pronunciation, cells and rows without a place, and dates from 1904.
#[test]
fn what_other_writers_do_is_read() {
    let row = |(i, row): (usize, &String)| {
        let days = 44_620.0 + i as f64 * 0.01 / 86_400.0;
        let cells = row.split(',').skip(1);
        let cells: String = cells
            .map(|own| format!("<x:c><x:v>{own}</x:v></x:c>"))
            .collect();
        format!(
            "<x:row><x:c s=\"1\"><x:v>{days}</x:v></x:c>{cells}<x:c t=\"b\"><x:v>1</x:v></x:c></x:row>"
        )
    };
    let data: String = rows().iter().enumerate().map(row).collect();
    let names =
        ["t", "s", "s"]
            .iter()
            .zip(["<x:is><x:t>t</x:t></x:is>", "<x:v>1</x:v>", "<x:v>0</x:v>"]);
    let names: String = names
        .map(|(kind, own)| match *kind {
            "t" => format!("<x:c t=\"inlineStr\">{own}</x:c>"),
            kind => format!("<x:c t=\"{kind}\">{own}</x:c>"),
        })
        .collect();
    let names = names + "<x:c t=\"str\"><x:v>is &#x2713; &amp; on</x:v></x:c>";
    let files = [
        ("_rels/.rels", relations(&[relation("a", "officeDocument", "/xl/book.xml")])),
        (
            "xl/_rels/book.xml.rels",
            relations(&[
                relation("b", "worksheet", "/xl/Run.xml"),
                relation("c", "sharedStrings", "texts.xml"),
                relation("d", "styles", "styles.xml"),
            ]),
        ),
        (
            "xl/book.xml",
            "<x:workbook xmlns:r=\"r\"><x:workbookPr date1904=\"1\"/><x:sheets>\
             <x:sheet name=\"A &amp; B\" sheetId=\"1\" r:id=\"b\"/></x:sheets></x:workbook>"
                .to_owned(),
        ),
        (
            "xl/texts.xml",
            "<sst><si><r><t>f</t></r><r><rPr/><t xml:space=\"preserve\"> [N]</t></r>\
             <rPh><t>eff</t></rPh></si><si><t><![CDATA[x]]></t></si></sst>"
                .to_owned(),
        ),
        ("xl/styles.xml", STYLES.to_owned()),
        (
            "xl/run.xml",
            format!("<x:worksheet><x:sheetData><x:row>{names}</x:row>{data}</x:sheetData></x:worksheet>"),
        ),
    ];
    let files: Vec<(&str, Vec<u8>)> = files
        .iter()
        .map(|(name, text)| (*name, text.clone().into_bytes()))
        .collect();
    let record = parse(&zip(&files, true), "r.xlsx", &Options::default()).unwrap();
    assert_plain(&record);
    assert_eq!(units(&record)[1], Some("N"));
    let names: Vec<String> = outline(&zip(&files, true), &Options::default())
        .unwrap()
        .columns
        .into_iter()
        .map(|own| own.name)
        .collect();
    assert_eq!(names, ["t", "x", "f", "is ✓ & on"]);
}

#[test]
fn a_binary_workbook_is_named() {
    let binary = [(
        "_rels/.rels",
        relations(&[relation("a", "officeDocument", "xl/workbook.bin")]),
    )];
    let binary = binary.map(|(name, text)| (name, text.into_bytes()));
    assert_eq!(
        parse(&zip(&binary, true), "r.xlsb", &Options::default()).unwrap_err().to_string(),
        "r.xlsb: the file is a binary workbook (.xlsb), which bowden does not read; save it as .xlsx"
    );
}

#[test]
fn damage_to_a_workbook_is_refused() {
    let whole = workbook(&[("Sheet1", &plain())]);
    let refusal = |bytes: &[u8]| {
        parse(bytes, "r.xlsx", &Options::default())
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        refusal(&whole[..whole.len() / 2]),
        "r.xlsx: the file is damaged: the zip archive is truncated"
    );
    let document = zip(&[("[Content_Types].xml", b"<Types/>".to_vec())], false);
    let line = refusal(&document);
    assert!(
        line.starts_with("r.xlsx: the workbook is damaged: ") && !line.contains('\n'),
        "{line}"
    );
    assert_eq!(
        refusal(&zip(&[("_rels/.rels", Vec::new())], false)),
        "r.xlsx: the workbook is damaged: a part is empty or is not text"
    );
    let wide = format!("t,x,f\n\n{}1", ",".repeat(256));
    assert_eq!(
        refusal(&workbook(&[("S", &wide)])),
        "r.xlsx: row 3 of sheet `S` has a cell in column 257, but a sheet may have at most 256 columns"
    );
    no_byte_panics(&whole, 97);
}

#[test]
fn a_view_shows_the_columns_and_lines_of_a_sheet() {
    let bytes = workbook(&[("Sheet1", &csv("motor,joint,note", &rows()))]);
    let found = outline(&bytes, &Options::default()).unwrap();
    assert_eq!((found.line, found.columns.len()), (1, 3));
    assert_eq!(found.columns[1].values.len(), 400);
    let lines = excerpt(&bytes, 1, 1, &Options::default());
    assert_eq!(lines[0].cells, ["motor", "joint", "note"]);
}
