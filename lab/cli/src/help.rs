//! `bowden help`: help for a subcommand, or the terms of the output.

use super::{Arguments, Failure};
use crate::view::terms::TERMS;
use clap::{Args, CommandFactory as _};

#[derive(Args)]
pub struct Help {
    /// A subcommand, or `terms`.
    topic: Option<String>,
}

impl Help {
    pub fn run(self) -> Result<(), Failure> {
        let mut all = Arguments::command();
        let Some(topic) = self.topic else {
            return super::say(&all.render_help().ansi().to_string());
        };
        if topic == "terms" {
            return super::say(TERMS.trim_end());
        }
        // Built, so that the usage line names the program.
        all.build();
        match all.find_subcommand_mut(&topic) {
            Some(command) => super::say(&command.render_long_help().ansi().to_string()),
            None => {
                let names: Vec<&str> = all.get_subcommands().map(clap::Command::get_name).collect();
                Err(format!(
                    "help {topic}: unknown topic; allowed are `terms` and {}",
                    names.join(", ")
                ))
            }
        }
    }
}
