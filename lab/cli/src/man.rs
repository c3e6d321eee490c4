//! `bowden man`: the manual pages, generated from the texts of `--help`.

use super::{Arguments, Failure};
use clap::{Args, Command, CommandFactory as _};
use clap_mangen::Man as Page;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Man {
    /// A subcommand [default: the program].
    topic: Option<String>,
    /// Write all pages into an existing folder instead of one page to stdout.
    #[arg(long, value_name = "FOLDER", conflicts_with = "topic")]
    out: Option<PathBuf>,
}

impl Man {
    pub fn run(self) -> Result<(), Failure> {
        let all = Arguments::command();
        if let Some(folder) = &self.out {
            return write_all(all, folder);
        }
        let Some(topic) = self.topic else {
            return super::pour(&page(all)?);
        };
        // The page is called `bowden-identify`, as the files of `--out` are.
        let one = pages(all)
            .into_iter()
            .find(|one| one.get_name().strip_prefix("bowden-") == Some(&topic))
            .ok_or_else(|| format!("man {topic}: no such subcommand"))?;
        super::pour(&page(one)?)
    }
}

/// The program, then its subcommands, each under the name of its page.
fn pages(mut all: Command) -> Vec<Command> {
    // Built, so that the synopsis of a subcommand names the program.
    all.build();
    let subcommands = all.get_subcommands().map(|one| {
        let name = format!("bowden-{}", one.get_name());
        one.clone().name(name.clone()).display_name(name)
    });
    let mut pages: Vec<Command> = subcommands.collect();
    pages.insert(0, all);
    pages
}

fn page(command: Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    let page = Page::new(command).source(concat!("bowden ", env!("CARGO_PKG_VERSION")));
    page.render(&mut text).map_err(|e| format!("man: {e}"))?;
    Ok(text)
}

fn write_all(all: Command, folder: &Path) -> Result<(), Failure> {
    if !folder.is_dir() {
        return Err(format!("--out {}: no such folder", folder.display()));
    }
    for one in pages(all) {
        let path = folder.join(format!("{}.1", one.get_name()));
        super::outputs::write_whole(&path, &page(one)?)?;
    }
    Ok(())
}
