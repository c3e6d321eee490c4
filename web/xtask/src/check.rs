//! Tests the page in Chromium: its answers equal the program's, and no data leave the tab.

use crate::browser::Browser;
use crate::native::Native;
use crate::{build, failed, pages, root, serve, Done, Ended};
use serde_json::{json, Value};

/// Maximum difference between two numbers of an answer, relative to the larger one. Elementary
/// functions differ in the last bit between a browser and a C library, and a fit ends where its
/// steps are small.
const SAME: f64 = 1e-6;
/// Widths of a phone and of a desktop screen \[CSS pixels\].
const WIDTHS: [u32; 2] = [390, 1280];

/// Runs every check.
pub fn check() -> Done {
    let dist = root().join("dist");
    let mut page = Browser::start()?;
    build::build(&dist)?;
    let native = Native::build()?;
    let address = serve::in_background(dist.clone())?;
    page.open(&format!("{address}/"))?;

    pages::example(&mut page)?;
    identified(&mut page, &native, "the built-in record")?;
    takes_apart(&mut page)?;
    controls(&mut page, &native)?;
    fits_each_width(&mut page)?;
    page.value("bowden.state.files.splice(0)")?;

    pages::choose(&mut page, &[native.folder().join("rig.csv")])?;
    asks_for_columns(&mut page)?;
    pages::part(&mut page, "motor_Nm", "input")?;
    pages::part(&mut page, "joint_Nm", "output")?;
    pages::channel(&mut page, "motor_rad", "phi_p")?;
    page.value("(() => { const mode = document.getElementById('mode'); mode.value = 'torque'; mode.dispatchEvent(new Event('change', { bubbles: true })); })()")?;
    page.until("!document.getElementById('identify').disabled")?;
    identified(&mut page, &native, "rig.csv with chosen columns")?;
    page.value(
        "(() => { document.getElementById('mode').value = ''; bowden.state.files.splice(0); })()",
    )?;

    for names in [
        &["damper.csv"][..],
        &["vectors.xlsx"],
        &["straight.csv", "bent.csv"],
    ] {
        let files: Vec<_> = names
            .iter()
            .map(|name| native.folder().join(name))
            .collect();
        pages::choose(&mut page, &files)?;
        identified(&mut page, &native, &names.join(" and "))?;
        if files.len() > 1 {
            separate_gains(&mut page, &native)?;
        }
        page.value("bowden.state.files.splice(0)")?;
    }
    pages::choose(&mut page, &[native.folder().join("straight.csv")])?;
    identified(&mut page, &native, "straight.csv")?;
    validates(&mut page, &native)?;
    page.value("bowden.state.files.splice(0)")?;
    marks_the_place(&mut page, &native)?;
    survives_anything(&mut page, &native)?;
    cancels(&mut page, &native)?;
    stays_alone(&mut page, &address)?;

    page.open(&format!(
        "file://{}",
        dist.canonicalize()?.join("bowden.html").display()
    ))?;
    pages::example(&mut page)?;
    pages::identify(&mut page)?;
    println!("bowden.html identifies the built-in record from the disk");
    stays_alone(&mut page, "file://")
}

/// Checks that the page gives the program's answer.
fn identified(page: &mut Browser, native: &Native, what: &str) -> Done {
    let seconds = pages::identify(page)?;
    let command = pages::command(page)?;
    let mut worst = 0.0;
    same(
        &native.run(&command)?,
        &pages::json(page)?,
        what,
        &mut worst,
    )?;
    let report = pages::file(page, "report.html")?;
    let is_same = report_alike(&report, &native.report()?, what)?;
    println!("{what}: {seconds:.2} s, JSON within {worst:.0e}, report {is_same}\n  {command}");
    Ok(())
}

/// Checks that a report has the words of the program's report; says how equal they are.
fn report_alike(own: &str, other: &str, what: &str) -> Result<&'static str, Ended> {
    let mut pieces = own.split('>').zip(other.split('>'));
    if let Some((page, program)) = pieces.find(|(a, b)| words(a) != words(b)) {
        return Err(failed(format!(
            "{what}: the report has {page} where the program's has {program}"
        )));
    }
    Ok(match own == other {
        true => "the same bytes",
        false => "the same but for last digits",
    })
}

/// The text of a page without its numbers.
fn words(html: &str) -> String {
    let is_number = |c: char| c.is_ascii_digit() || ".-+−±eM Lm,".contains(c);
    html.chars().filter(|c| !is_number(*c)).collect()
}

/// Checks that names and words are equal, and that numbers differ by at most [`SAME`]. The cost is
/// not compared, because it depends on the machine.
fn same(own: &Value, other: &Value, at: &str, worst: &mut f64) -> Done {
    let differ = || {
        Err(failed(format!(
            "{at}: the program has {own}, the page {other}"
        )))
    };
    match (own, other) {
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (
                a.as_f64().unwrap_or(f64::NAN),
                b.as_f64().unwrap_or(f64::NAN),
            );
            let share = (a - b).abs() / a.abs().max(b.abs()).max(1e-9);
            *worst = f64::max(*worst, share);
            if share <= SAME {
                Ok(())
            } else {
                differ()
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => a
            .iter()
            .zip(b)
            .enumerate()
            .try_for_each(|(k, (a, b))| same(a, b, &format!("{at}/{k}"), worst)),
        (Value::Object(a), Value::Object(b)) if a.keys().eq(b.keys()) => a
            .iter()
            .filter(|(name, _)| *name != "cost")
            .try_for_each(|(name, a)| same(a, &b[name], &format!("{at}/{name}"), worst)),
        _ if own == other => Ok(()),
        _ => differ(),
    }
}

/// Checks that a second record, validated against the model of the first, gets the program's
/// answer.
fn validates(page: &mut Browser, native: &Native) -> Done {
    let model = pages::file(page, "model.toml")?;
    native.write("model.toml", model.as_bytes())?;
    page.choose("#second", &[native.folder().join("straight_later.csv")])?;
    page.until("bowden.state.validated !== null")?;
    let own = "new TextDecoder().decode(bowden.state.validated.files['result.json'])";
    let own = page.value(own)?;
    let own: Value = serde_json::from_str(own.as_str().unwrap_or_default())?;
    let command = page.value("bowden.state.validated.command")?;
    let command = command.as_str().unwrap_or_default();
    let mut worst = 0.0;
    same(&native.run(command)?, &own, "validate", &mut worst)?;
    println!("validate: JSON within {worst:.0e}\n  {command}");
    Ok(())
}

/// Checks that gains for the model, and controllers with these gains on the simulated rig, get the
/// program's answers.
fn controls(page: &mut Browser, native: &Native) -> Done {
    let model = pages::file(page, "model.toml")?;
    native.write("model.toml", model.as_bytes())?;
    let fields = [("rate", "1000"), ("delay", "0.004"), ("noise", "0.05")];
    pages::send(page, "design", &fields, "designed")?;
    answers_alike(page, native, ("design", "designed"))?;
    let gains = pages::file_of(page, "designed", "gains.toml")?;
    let own = std::fs::read_to_string(native.folder().join("gains.toml"))?;
    if words(&gains) != words(&own) {
        return Err(failed(format!(
            "gains.toml of the page:\n{gains}\nand of the program:\n{own}"
        )));
    }
    native.write("gains.toml", gains.as_bytes())?;
    let fields = [("seconds", "10"), ("seeds", "2")];
    pages::send(page, "compare", &fields, "compared")?;
    answers_alike(page, native, ("compare", "compared"))?;
    let report = pages::file_of(page, "compared", "report.html")?;
    report_alike(&report, &native.report()?, "compare").map(drop)
}

/// Checks that separate gains for each file give the program's answer, and one model for each file.
fn separate_gains(page: &mut Browser, native: &Native) -> Done {
    page.value("document.getElementById('per_file').click()")?;
    identified(page, native, "separate gains")?;
    page.value("document.getElementById('per_file').click()")?;
    let command = pages::command(page)?;
    native.run(&format!("{command} --model-out model.toml"))?;
    for name in ["model-1.toml", "model-2.toml"] {
        let own = std::fs::read_to_string(native.folder().join(name))?;
        let shown = pages::file(page, name)?;
        if words(&own) != words(&shown) {
            return Err(failed(format!(
                "{name} of the page:\n{shown}\nand of the program:\n{own}"
            )));
        }
    }
    let choice = page.value("[...document.getElementById('model').options].length")?;
    match choice == json!(2) {
        true => Ok(()),
        false => Err(failed(format!("{choice} models to choose from"))),
    }
}

/// Checks that JSON and text of an answer are the program's.
fn answers_alike(page: &mut Browser, native: &Native, (what, answer): (&str, &str)) -> Done {
    let command = page.value(&format!("bowden.state.{answer}.command"))?;
    let command = command.as_str().unwrap_or_default();
    let own: Value = serde_json::from_str(&pages::file_of(page, answer, "result.json")?)?;
    let mut worst = 0.0;
    same(&native.run(command)?, &own, what, &mut worst)?;
    // The page wraps lines; a pipe does not.
    let flat = |text: &str| -> String { text.split_whitespace().collect() };
    let shown = pages::file_of(page, answer, "result.txt")?;
    let program = native.text(command)?;
    if words(&flat(&shown)) != words(&flat(&program)) {
        return Err(failed(format!(
            "{what}: the page says\n{shown}\nand the program\n{program}"
        )));
    }
    println!("{what}: JSON within {worst:.0e}, the same text\n  {command}");
    Ok(())
}

/// Checks that the error rises without a part, and returns to its value with the part.
fn takes_apart(page: &mut Browser) -> Done {
    let error = "Number(/held-out ([0-9.]+)/.exec(document.querySelector('.error').innerText)[1])";
    let click = "document.querySelectorAll('.explore input[type=checkbox]')";
    let before = page.value(error)?;
    page.value(&format!(
        "(() => {{ const all = {click}; all[all.length - 1].click(); }})()"
    ))?;
    let without = page.value(error)?;
    page.value(&format!(
        "(() => {{ const all = {click}; all[all.length - 1].click(); }})()"
    ))?;
    let after = page.value(error)?;
    if before != after || without.as_f64() <= before.as_f64() {
        return Err(failed(format!(
            "errors with, without and with a part: {before}, {without}, {after}"
        )));
    }
    println!("without the last part the held-out error is {without} % instead of {before} %");
    Ok(())
}

/// Checks that no width needs horizontal scrolling.
fn fits_each_width(page: &mut Browser) -> Done {
    for width in WIDTHS {
        page.resize(width, 900)?;
        let wide = page.value("document.documentElement.scrollWidth")?;
        let inner = page.value("[...document.querySelectorAll('iframe.report')].every((own) => own.contentDocument.documentElement.scrollWidth <= own.clientWidth)")?;
        if wide.as_u64() > Some(u64::from(width)) || inner != json!(true) {
            return Err(failed(format!(
                "{width} pixels: the page has {wide}; report fits: {inner}"
            )));
        }
    }
    page.resize(1280, 900)
}

/// Checks that the page asks for the columns that their names do not identify.
fn asks_for_columns(page: &mut Browser) -> Done {
    let note = page.value("document.getElementById('columns-note').innerText")?;
    if note != json!("Choose the column for the input and for the output.") {
        return Err(failed(format!("rig.csv: the page says {note}")));
    }
    Ok(())
}

/// Checks that the page shows the program's error line and marks the cell in the table.
fn marks_the_place(page: &mut Browser, native: &Native) -> Done {
    let text = std::fs::read_to_string(native.folder().join("straight.csv"))?;
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    lines[99] = lines[99].replacen(',', ",oops", 1);
    let path = native.write("broken.csv", lines.join("\n").as_bytes())?;
    pages::choose(page, &[path])?;
    let line = page.value("document.querySelector('.refusal').innerText")?;
    let cell = page.value("document.querySelector('td.marked').innerText")?;
    let own = native.refusal("bowden identify broken.csv")?;
    let is_marked = cell.as_str().is_some_and(|cell| cell.starts_with("oops"));
    if line.as_str() != Some(own.as_str()) || !is_marked {
        return Err(failed(format!(
            "the page says {line} and marks {cell}; the program says {own}"
        )));
    }
    println!("refusal: {own}");
    page.value("bowden.state.files.splice(0)")?;
    Ok(())
}

/// Checks that the page answers any file with a record or one line, on the reader's fuzz corpus.
fn survives_anything(page: &mut Browser, native: &Native) -> Done {
    let mut files = Vec::new();
    for seed in std::fs::read_dir(root().join("../fuzz/seeds/record"))? {
        let bytes = std::fs::read(seed?.path())?;
        // The first byte of a seed selects options.
        let name = format!("seed-{}", files.len());
        files.push(native.write(&name, bytes.get(1..).unwrap_or_default())?);
    }
    pages::choose(page, &files)?;
    let lines = page.value(
        "[...bowden.state.looks.values()].filter((own) => own.samples > 0 || /^[^\\n]+$/.test(own.refusal.text)).length",
    )?;
    if lines != json!(files.len()) {
        let said = page.value("document.getElementById('refusal').innerText")?;
        return Err(failed(format!(
            "{lines} of {} files have an answer: {said}",
            files.len()
        )));
    }
    println!("{lines} files of the reader's fuzz corpus: a record or one line");
    page.value("bowden.state.files.splice(0)")?;
    Ok(())
}

/// Checks that the page answers as before after a cancelled search.
fn cancels(page: &mut Browser, native: &Native) -> Done {
    pages::choose(page, &[native.folder().join("straight.csv")])?;
    page.until("!document.getElementById('identify').disabled")?;
    page.value("document.getElementById('identify').click()")?;
    page.until("document.getElementById('bar').value > 0")?;
    page.value("document.getElementById('cancel').click()")?;
    page.until("document.getElementById('refusal').innerText.startsWith('Cancelled')")?;
    identified(
        page,
        native,
        "straight.csv after a search that was cancelled",
    )
}

/// Checks that all requests went to the page's own server and that the console shows no error.
fn stays_alone(page: &mut Browser, address: &str) -> Result<(), Ended> {
    page.value("1")?;
    let is_own = |url: &String| {
        ["blob:", "data:", "about:", address]
            .iter()
            .any(|own| url.starts_with(own))
    };
    if let Some(other) = page.requests.iter().find(|url| !is_own(url)) {
        return Err(failed(format!("the page requested {other}")));
    }
    if let Some(error) = page.errors.first() {
        return Err(failed(format!("the console shows {error}")));
    }
    println!(
        "{} requests, all to {address} or within the page; no error on the console",
        page.requests.len()
    );
    page.requests.clear();
    Ok(())
}
