//! The example that is to be copied: its log on the chip against the host's lines.

use crate::build;
use crate::emulator;
use crate::target::{Target, TARGETS};
use anyhow::{bail, ensure, Context, Result};
use bowden_firmware_examples::scenario::Scenario;
use bowden_firmware_examples::MODEL;
use defmt_decoder::{DecodeError, Table};
use std::path::Path;

const NAME: &str = "torque-loop";
/// 32 ns an instruction, about what the board would take; asleep, the time goes on at once.
const ICOUNT: &str = "shift=5,sleep=off";

/// The log of the chip, where it is the host's; nothing where it cannot be run here.
pub fn run(root: &Path, skipped: &mut Vec<String>) -> Result<Vec<String>> {
    let [target, ..] = &TARGETS;
    if let Some(reason) = missing(target) {
        skipped.push(format!("{NAME}: {reason}"));
        return Ok(Vec::new());
    }
    let package = "bowden-firmware-examples";
    let images = build::images(root, target, package, &["board"], &[NAME])?;
    let image = images.get(NAME).context("cargo built no torque loop")?;
    let log = emulator::run(target, image, ICOUNT)?;
    let table = Table::parse(&std::fs::read(image)?)?;
    let chip = decoded(&table.context("the image has no table of its log")?, &log)?;
    compare(&chip, &on_the_host()?)?;
    Ok(chip)
}

fn missing(target: &Target) -> Option<String> {
    if !target.is_installed() {
        Some(format!("the target {} is not installed", target.triple))
    } else if !target.has_emulator() {
        Some(format!("{} is not installed", target.emulator))
    } else {
        None
    }
}

/// The messages of a log.
fn decoded(table: &Table, log: &[u8]) -> Result<Vec<String>> {
    let mut decoder = table.new_stream_decoder();
    decoder.received(log);
    let mut lines = Vec::new();
    loop {
        match decoder.decode() {
            Ok(frame) => lines.push(frame.display_message().to_string()),
            Err(DecodeError::UnexpectedEof) => return Ok(lines),
            Err(DecodeError::Malformed) => bail!("line {} of the log is damaged", lines.len() + 1),
        }
    }
}

/// What `cargo run --release --example torque_loop` prints, its last line apart.
fn on_the_host() -> Result<Vec<String>> {
    let mut scenario = Scenario::try_new(MODEL).map_err(|error| anyhow::anyhow!("{error:?}"))?;
    let mut lines = Vec::new();
    while let Some(told) = scenario.tick() {
        lines.extend(told.line.map(|line| line.to_string()));
    }
    Ok(lines)
}

/// Line by line: the same text is the same numbers.
fn compare(chip: &[String], host: &[String]) -> Result<()> {
    for (k, (chip, host)) in chip.iter().zip(host).enumerate() {
        ensure!(
            chip == host,
            "{NAME}, line {}: {chip:?} on the chip, {host:?} on the host",
            k + 1
        );
    }
    ensure!(
        chip.len() == host.len(),
        "{NAME}: {} lines on the chip, {} on the host",
        chip.len(),
        host.len()
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scenario_shows_held_safe_and_a_start_after_the_acknowledgement_alone() {
        let lines = on_the_host().unwrap();
        let at = |time: &str, status: &str| {
            let wanted = format!("{time} ms:");
            let line = lines.iter().find(|line| line.starts_with(&wanted));
            let line = line.unwrap_or_else(|| unreachable!("no line at {time} ms"));
            assert!(line.ends_with(status), "{line}");
        };
        at("3000", "Held(Measured)");
        at("3005", "Good");
        at("5019", "Safe(Measured)");
        // The sensor is good again since 5100, and the acknowledgement at 5050 was refused.
        at("5500", "Safe(Measured)");
        at("6001", "Good");
        // A counter that wrapped is held as well.
        assert!(lines
            .iter()
            .any(|line| line.starts_with("8000 ms:") && line.contains("Held(Dt")));
    }

    #[test]
    fn the_drive_gets_nothing_while_it_is_off_and_starts_from_there() {
        let mut scenario = Scenario::try_new(MODEL).unwrap();
        let told: Vec<_> = std::iter::from_fn(|| scenario.tick()).collect();
        assert!(told[5019..=6000].iter().all(|told| !told.action.enabled));
        assert!(told[5019..=6000]
            .iter()
            .all(|told| told.action.command == 0.0));
        // Refused while the sensor is dead, and nobody asked before or after.
        let asked: Vec<_> = told.iter().filter_map(|told| told.acknowledged).collect();
        assert_eq!(asked, [false, true]);
        assert!(told[6001].action.enabled);
        // One step of the slew rate at most: 2 N·m in a millisecond.
        assert!(told[6001].action.command.abs() <= 2.0);
        // Fed in the fault; not by a tick whose time makes no sense.
        let unfed: Vec<_> = told
            .iter()
            .enumerate()
            .filter(|(_, told)| !told.action.feed)
            .collect();
        assert_eq!(unfed.len(), 1);
        assert_eq!(unfed[0].0, 8000);
    }

    #[test]
    fn a_model_with_one_damaged_bit_does_not_start() {
        let mut damaged = MODEL.to_vec();
        damaged[7] ^= 1;
        assert!(Scenario::try_new(&damaged).is_err());
        assert!(Scenario::try_new(&MODEL[..MODEL.len() - 1]).is_err());
    }

    #[test]
    fn a_line_that_differs_and_a_line_too_few_are_told() {
        let lines = ["a".to_owned(), "b".to_owned()];
        let message = |chip: &[String]| compare(chip, &lines).unwrap_err().to_string();
        assert!(compare(&lines, &lines).is_ok());
        let other = ["a".to_owned(), "c".to_owned()];
        assert_eq!(
            message(&other),
            "torque-loop, line 2: \"c\" on the chip, \"b\" on the host"
        );
        assert_eq!(
            message(&lines[..1]),
            "torque-loop: 1 lines on the chip, 2 on the host"
        );
    }
}
