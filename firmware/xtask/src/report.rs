//! Reads what an image prints.

use anyhow::{bail, ensure, Context, Result};
use bowden_cases::{Output, Signal};

/// One sample on the chip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// What the step returned.
    pub output: Output,
    /// Instructions between the two looks at the clock.
    pub instructions: u64,
    /// Bytes of stack below the caller.
    pub stack: u32,
}

/// The samples of each signal, in the order of [`Signal::ALL`].
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// One list a signal.
    pub runs: Vec<(Signal, Vec<Step>)>,
}

/// Instructions of one turn of the loop that the clock is checked with.
const A_TURN: u64 = 2;

impl Report {
    /// Parses an image's output by the first of the rates at which its clock counts what it
    /// should: `ticks` are how many pass with one instruction, as a fraction.
    pub fn parse(text: &str, ticks: &[(u64, u64)]) -> Result<Self> {
        let mut reports = ticks.iter().map(|&ticks| Self::parse_at(text, ticks));
        let first = reports.next().context("a clock has a rate")?;
        first.or_else(|refusal| reports.find_map(Result::ok).ok_or(refusal))
    }

    fn parse_at(text: &str, ticks: (u64, u64)) -> Result<Self> {
        let mut clock = Vec::new();
        let mut runs: Vec<(Signal, Vec<Step>)> = Vec::new();
        let mut ended = false;
        for line in text.lines() {
            ensure!(!ended, "the image prints {line:?} after its end");
            let words: Vec<&str> = line.split_whitespace().collect();
            match words[..] {
                ["clock", loops, time] => clock.push((hex(loops)?, hex(time)?)),
                ["run", name] => {
                    let signal = Signal::ALL.into_iter().find(|signal| signal.name() == name);
                    runs.push((signal.context("an unknown signal")?, Vec::new()));
                }
                [value, status, time, stack] => {
                    let (_, steps) = runs.last_mut().context("a sample before its run")?;
                    steps.push(Step {
                        output: Output {
                            value: f32::from_bits(hex(value)?),
                            status: hex(status)?,
                        },
                        instructions: instructions(hex(time)?, ticks),
                        stack: hex(stack)?,
                    });
                }
                ["end"] => ended = true,
                _ => bail!("the image prints {line:?}"),
            }
        }
        ensure!(ended, "the image did not come to its end");
        check(&clock, ticks)?;
        let signals: Vec<Signal> = runs.iter().map(|(signal, _)| *signal).collect();
        ensure!(signals == Signal::ALL, "the image ran {signals:?}");
        Ok(Self { runs })
    }
}

fn hex(word: &str) -> Result<u32> {
    u32::from_str_radix(word, 16).with_context(|| format!("{word:?} is no number"))
}

/// The count of instructions nearest to a time.
fn instructions(time: u32, (numerator, denominator): (u64, u64)) -> u64 {
    (2 * u64::from(time) * denominator + numerator) / (2 * numerator)
}

/// The two loops differ by a known number of instructions: the clock must say so.
fn check(clock: &[(u32, u32)], ticks: (u64, u64)) -> Result<()> {
    let [(short, begun), (long, ended)] = clock else {
        bail!("the image does not check its clock");
    };
    let expected = A_TURN * u64::from(long - short);
    let counted = instructions(ended.wrapping_sub(*begun), ticks);
    ensure!(
        counted == expected,
        "the emulator's clock counts {counted} instructions where there are {expected}"
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICKS: (u64, u64) = (16, 5);

    /// 4000 instructions are 12800 ticks; a step of 10 is 32.
    const GOOD: &str = "clock 000003e8 00001913 \nclock 00000bb8 00004b13 \n\
        run sine\n3f800000 00000001 00000020 00000068 \nrun noise\nrun jumps\nrun faults\nend\n";

    fn refused(text: &str) -> String {
        Report::parse(text, &[TICKS]).unwrap_err().to_string()
    }

    #[test]
    fn a_sample_is_its_output_its_instructions_and_its_stack() {
        let report = Report::parse(GOOD, &[TICKS]).unwrap();
        let expected = Step {
            output: Output {
                value: 1.0,
                status: 1,
            },
            instructions: 10,
            stack: 0x68,
        };
        assert_eq!(report.runs[0], (Signal::Sine, vec![expected]));
        assert_eq!(report.runs.len(), 4);
    }

    #[test]
    fn a_time_that_is_a_tick_off_gives_the_same_count() {
        for count in [1_u32, 14, 177, 14_302] {
            let ticks = count * 16 / 5;
            assert_eq!(instructions(ticks, TICKS), u64::from(count));
            assert_eq!(instructions(ticks + 1, TICKS), u64::from(count));
        }
    }

    #[test]
    fn a_clock_of_another_rate_is_refused() {
        let error = refused(&GOOD.replace("00004b13", "00004b17"));
        assert!(
            error.contains("counts 4001 instructions where there are 4000"),
            "{error}"
        );
        let error = refused(&GOOD.replace("clock 000003e8 00001913 \n", ""));
        assert!(error.contains("does not check its clock"), "{error}");
    }

    #[test]
    fn a_clock_counts_at_one_of_the_rates_that_are_known() {
        let of = |ticks: &[(u64, u64)]| Report::parse(GOOD, ticks);
        assert_eq!(of(&[(1, 1), TICKS]).unwrap(), of(&[TICKS]).unwrap());
        let error = of(&[(1, 1), (2, 1)]).unwrap_err().to_string();
        assert!(error.contains("counts 12800 instructions"), "{error}");
    }

    #[test]
    fn an_output_that_breaks_off_is_refused() {
        assert!(refused(&GOOD.replace("end\n", "")).contains("did not come to its end"));
        assert!(refused(&GOOD.replace("run faults\n", "")).contains("[Sine, Noise, Jumps]"));
        assert!(refused(&GOOD.replace("3f800000", "3f8x0000")).contains("is no number"));
        assert!(refused(&format!("{GOOD}run sine\n")).contains("after its end"));
    }
}
