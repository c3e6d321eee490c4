//! The chip's outputs against the host's, in units in the last place.

use crate::report::Report;
use anyhow::{bail, ensure, Context, Result};
use bowden_cases::Output;

/// The largest distance between chip and host over all samples of a step \[ulp\].
///
/// 0 is bit for bit. A status that differs, or a number that is not finite on one side
/// only, is an error wherever it is.
pub fn distance(step: &str, report: &Report) -> Result<u32> {
    let mut most = 0;
    for (signal, steps) in &report.runs {
        let mut host = Vec::new();
        bowden_cases::run(step, *signal, &mut |output| host.push(output))
            .with_context(|| format!("there is no step {step:?}"))?
            .map_err(|error| anyhow::anyhow!("{error}"))?;
        ensure!(
            host.len() == steps.len(),
            "{}: {} samples on the chip, {} on the host",
            signal.name(),
            steps.len(),
            host.len()
        );
        for (k, (host, chip)) in host.iter().zip(steps).enumerate() {
            let apart = between(host, &chip.output).with_context(|| {
                format!(
                    "{}, sample {k}: {:?} on the host, {:?} on the chip",
                    signal.name(),
                    host,
                    chip.output
                )
            })?;
            most = most.max(apart);
        }
    }
    Ok(most)
}

fn between(host: &Output, chip: &Output) -> Result<u32> {
    ensure!(host.status == chip.status, "another status");
    match (host.value.is_finite(), chip.value.is_finite()) {
        (true, true) => Ok(place(host.value).abs_diff(place(chip.value))),
        _ => bail!("a value that is not finite"),
    }
}

/// The place of a finite float in the order of all of them; both zeros are one.
fn place(value: f32) -> i32 {
    let magnitude = (value.to_bits() & 0x7fff_ffff).cast_signed();
    if value.is_sign_negative() {
        -magnitude
    } else {
        magnitude
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Step;
    use bowden_cases::Signal;

    /// What a chip would report that computes as this host does, with one sample changed.
    fn report(change: impl Fn(&mut Output)) -> Report {
        let run = |signal: Signal| {
            let mut steps = Vec::new();
            let mut take = |output| {
                steps.push(Step {
                    output,
                    instructions: 1,
                    stack: 0,
                });
            };
            bowden_cases::run("pi", signal, &mut take).unwrap().unwrap();
            (signal, steps)
        };
        let mut report = Report {
            runs: Signal::ALL.map(run).to_vec(),
        };
        change(&mut report.runs[1].1[7].output);
        report
    }

    #[test]
    fn the_same_bits_are_no_distance_apart() {
        assert_eq!(distance("pi", &report(|_| {})).unwrap(), 0);
    }

    #[test]
    fn one_bit_of_one_sample_is_seen() {
        let next = |output: &mut Output| output.value = output.value.next_up();
        assert_eq!(distance("pi", &report(next)).unwrap(), 1);
    }

    #[test]
    fn another_status_and_a_nan_are_errors_with_their_sample() {
        let message = |change: fn(&mut Output)| distance("pi", &report(change)).unwrap_err();
        let error = message(|output| output.status = 2);
        assert!(
            format!("{error:#}").contains("noise, sample 7"),
            "{error:#}"
        );
        assert!(format!("{error:#}").contains("another status"), "{error:#}");
        let error = message(|output| output.value = f32::NAN);
        assert!(format!("{error:#}").contains("not finite"), "{error:#}");
    }

    #[test]
    fn a_sample_too_few_is_an_error() {
        let mut short = report(|_| {});
        short.runs[0].1.pop();
        let error = distance("pi", &short).unwrap_err().to_string();
        assert!(
            error.contains("1999 samples on the chip, 2000 on the host"),
            "{error}"
        );
    }

    #[test]
    fn places_pass_through_zero() {
        assert_eq!(place(-0.0), place(0.0));
        assert_eq!(
            place(f32::from_bits(1)).abs_diff(place(-f32::from_bits(1))),
            2
        );
    }
}
