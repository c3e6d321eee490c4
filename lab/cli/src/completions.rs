//! `bowden completions`: a shell script that completes subcommands and options.

use super::{Arguments, Failure};
use clap::{Args, CommandFactory as _};
use clap_complete::Shell;

#[derive(Args)]
pub struct Completions {
    /// The shell.
    shell: Shell,
}

impl Completions {
    pub fn run(self) -> Result<(), Failure> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut Arguments::command(), "bowden", &mut script);
        super::pour(&script)
    }
}
