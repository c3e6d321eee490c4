//! Parsing of the arguments, and the error line for a wrong argument.

use super::{Arguments, Failure};
use clap::{Command, CommandFactory as _, FromArgMatches as _};

/// The arguments of this call. Help and version are printed, and the process ends.
pub fn arguments() -> Result<Arguments, Failure> {
    let matches = command()
        .try_get_matches()
        .and_then(|mut all| Arguments::from_arg_matches_mut(&mut all));
    matches.map_err(|error| match error.use_stderr() {
        true => one_line(&error.render().to_string()),
        false => printed(&error),
    })
}

/// Prints help or version and ends the process; the line where that cannot be written.
fn printed(error: &clap::Error) -> Failure {
    use std::io::Write as _;
    let written = error.print().and_then(|()| std::io::stdout().flush());
    match super::unless_gone(written) {
        Ok(()) => std::process::exit(0),
        Err(line) => line,
    }
}

/// The program's command. The number after an option may be negative: it is then refused as a
/// number, with the allowed values, and not as an unknown option.
fn command() -> Command {
    let may_be_negative = |one: Command| {
        one.mut_args(|argument| match argument.get_action().takes_values() {
            true => argument.allow_negative_numbers(true),
            false => argument,
        })
    };
    Arguments::command().mut_subcommands(may_be_negative)
}

/// The parser's message as one line, without the synopsis after it.
fn one_line(text: &str) -> String {
    let lines = text.lines().map(str::trim);
    let said = lines.take_while(|line| {
        !line.starts_with("Usage:") && !line.starts_with("For more information")
    });
    let mut whole = String::new();
    for line in said.filter(|line| !line.is_empty()) {
        let joint = match whole.chars().last() {
            None => "",
            Some(':') => " ",
            Some(_) => "; ",
        };
        let line = line.strip_prefix("error: ").unwrap_or(line);
        let line = line.strip_prefix("tip: ").unwrap_or(line);
        whole.push_str(joint);
        whole.push_str(line);
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(arguments: &[&str]) -> String {
        let all = [&["bowden"], arguments].concat();
        let error = command().try_get_matches_from(all).unwrap_err();
        one_line(&error.render().to_string())
    }

    #[test]
    fn what_is_wrong_and_what_was_expected_stand_in_one_line() {
        for (arguments, line) in [
            (
                &["identify", "--modle", "torque"][..],
                "unexpected argument '--modle' found; a similar argument exists: '--mode'",
            ),
            (
                &["identify", "--mode", "zzz"],
                "invalid value 'zzz' for '--mode <MODE>'; [possible values: torque, displacement]",
            ),
            (
                &["compare", "--seeds", "-1"],
                "invalid value '-1' for '--seeds <K>': invalid digit found in string",
            ),
            (
                &["validate"],
                "the following required arguments were not provided: <MODEL.toml>; <RECORD>",
            ),
            (
                &["closse"],
                "unrecognized subcommand 'closse'; a similar subcommand exists: 'close'",
            ),
        ] {
            assert_eq!(refused(arguments), line, "{arguments:?}");
        }
    }

    #[test]
    fn a_negative_number_is_a_number() {
        let all = ["bowden", "compare", "--noise", "-1", "--inertia", "-0.5"];
        assert!(command().try_get_matches_from(all).is_ok());
    }
}
