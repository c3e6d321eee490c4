//! The actions of a user on the page, and their results.

use crate::browser::Browser;
use crate::{failed, Ended};
use serde_json::Value;
use std::path::PathBuf;

/// Whether the reader has processed all files.
const IS_READ: &str =
    "bowden.state.files.length > 0 && bowden.state.answered === bowden.state.turn";

/// Starts the built-in example.
pub fn example(page: &mut Browser) -> Result<(), Ended> {
    page.value("document.getElementById('example').click()")?;
    page.until(IS_READ)
}

/// Chooses files.
pub fn choose(page: &mut Browser, files: &[PathBuf]) -> Result<(), Ended> {
    let before = page.value("bowden.state.turn")?;
    page.choose("#files", files)?;
    page.until(&format!("bowden.state.turn > {before} && {IS_READ}"))
}

/// Chooses the part of a column by its name.
pub fn part(page: &mut Browser, column: &str, part: &str) -> Result<(), Ended> {
    let script = format!(
        "(() => {{ const k = bowden.state.parts.findIndex((one) => one.name === '{column}');
        const field = document.getElementById(`part-${{k}}`);
        field.value = '{part}'; field.dispatchEvent(new Event('change')); }})()"
    );
    page.value(&script)?;
    page.until(IS_READ)
}

/// Sets the channel name of a column.
pub fn channel(page: &mut Browser, column: &str, name: &str) -> Result<(), Ended> {
    part(page, column, "channel")?;
    let script = format!(
        "(() => {{ const k = bowden.state.parts.findIndex((one) => one.name === '{column}');
        const field = document.getElementById(`channel-${{k}}`);
        field.value = '{name}'; field.dispatchEvent(new Event('change')); }})()"
    );
    page.value(&script)?;
    page.until(IS_READ)
}

/// Starts the identification and waits for the result; returns the time from click to result \[s\].
pub fn identify(page: &mut Browser) -> Result<f64, Ended> {
    page.until("!document.getElementById('identify').disabled")?;
    let script = "(async () => {
        const begun = performance.now();
        const done = new Promise((resolve) => document.addEventListener('answered', resolve, { once: true }));
        document.getElementById('identify').click();
        await Promise.race([done, new Promise((resolve) => setTimeout(resolve, 200000))]);
        return (performance.now() - begun) / 1000; })()";
    let seconds = page.value(script)?;
    let refused = page.value("document.getElementById('refusal').innerText")?;
    match refused.as_str() {
        Some("") => Ok(seconds.as_f64().unwrap_or(f64::NAN)),
        _ => Err(failed(format!("identify: {refused}"))),
    }
}

/// Fills in a form, sends it, and waits for the answer in the state of the page.
pub fn send(
    page: &mut Browser,
    form: &str,
    fields: &[(&str, &str)],
    answer: &str,
) -> Result<(), Ended> {
    for (name, value) in fields {
        page.value(&format!(
            "document.getElementById('{form}').elements['{name}'].value = '{value}'"
        ))?;
    }
    page.value(&format!("bowden.state.{answer} = null"))?;
    page.value(&format!(
        "document.getElementById('{form}').requestSubmit()"
    ))?;
    page.until(&format!(
        "bowden.state.{answer} !== null || document.querySelector('#{form}-answer .refusal') !== null"
    ))?;
    let refused = page.value(&format!(
        "document.querySelector('#{form}-answer .refusal')?.innerText ?? ''"
    ))?;
    match refused.as_str() {
        Some("") => Ok(()),
        _ => Err(failed(format!("{form}: {refused}"))),
    }
}

/// A file of an answer in the state of the page, as text.
pub fn file_of(page: &mut Browser, answer: &str, name: &str) -> Result<String, Ended> {
    let script = format!("new TextDecoder().decode(bowden.state.{answer}.files['{name}'])");
    let text = page.value(&script)?;
    Ok(text.as_str().unwrap_or_default().to_owned())
}

/// The command line of the last result.
pub fn command(page: &mut Browser) -> Result<String, Ended> {
    let line = page.value("bowden.state.result.found.command")?;
    Ok(line.as_str().unwrap_or_default().to_owned())
}

/// A file of the last result, as text.
pub fn file(page: &mut Browser, name: &str) -> Result<String, Ended> {
    let script = format!("new TextDecoder().decode(bowden.state.result.found.files['{name}'])");
    let text = page.value(&script)?;
    Ok(text.as_str().unwrap_or_default().to_owned())
}

/// The JSON of the last result.
pub fn json(page: &mut Browser) -> Result<Value, Ended> {
    Ok(serde_json::from_str(&file(page, "result.json")?)?)
}
