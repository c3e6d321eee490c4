//! The page or the individual figure that `identify` and `validate` draw.

use bowden_lab::facts::{Figures, Source};
use bowden_page::{figure, Figure, Provenance};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub enum FigureName {
    /// The output versus the input: measured and both models.
    Loop,
    /// The residuals of both models over time.
    Residual,
    /// The output over time: measured and both models.
    Trace,
    /// The size of each part of the model.
    Shares,
}

#[derive(Args, Default)]
pub struct Drawing {
    /// Write the results as one self-contained HTML page: summary, signals, loop, residuals with
    /// intervals, tables, parameters and method.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    /// Write one figure as SVG, chosen by --figure.
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// The figure for --plot [default: the loop].
    #[arg(long, value_enum, requires = "plot", value_name = "FIGURE")]
    figure: Option<FigureName>,
}

impl FigureName {
    fn figure(self) -> Figure {
        match self {
            Self::Loop => Figure::Loop,
            Self::Residual => Figure::Residual,
            Self::Trace => Figure::Trace,
            Self::Shares => Figure::Shares,
        }
    }
}

impl Drawing {
    /// Whether anything is drawn.
    pub fn is_wanted(&self) -> bool {
        self.report.is_some() || self.plot.is_some()
    }

    /// Whether a page is requested, which needs its sources.
    pub fn is_page(&self) -> bool {
        self.report.is_some()
    }

    /// The given options, with their files.
    pub fn outputs(&self) -> impl Iterator<Item = (&'static str, &Path)> {
        let both = [("--report", &self.report), ("--plot", &self.plot)];
        both.into_iter()
            .filter_map(|(option, path)| Some((option, path.as_deref()?)))
    }

    /// The page and the figure, each with its file.
    pub fn files(
        &self,
        figures: &Figures,
        page: impl FnOnce() -> String,
    ) -> Vec<(PathBuf, Vec<u8>)> {
        let mut files = Vec::new();
        if let Some(path) = &self.report {
            files.push((path.clone(), page().into_bytes()));
        }
        if let Some(path) = &self.plot {
            let which = self.figure.map_or(Figure::Loop, FigureName::figure);
            files.push((path.clone(), figure(figures, which).into_bytes()));
        }
        files
    }
}

/// The origin of a page: the command line and the files that were read.
pub fn provenance(sources: Vec<Source>) -> Provenance {
    let mut command = "bowden".to_owned();
    for argument in std::env::args_os().skip(1) {
        command.push(' ');
        command.push_str(&quoted(&argument.to_string_lossy()));
    }
    Provenance {
        command,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        sources,
    }
}

/// An argument, quoted for a shell.
#[must_use]
pub fn quoted(argument: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_=.,:/@+%".contains(c);
    match !argument.is_empty() && argument.chars().all(plain) {
        true => argument.to_owned(),
        false => format!("'{}'", argument.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn arguments_are_quoted_where_a_shell_would_part_or_read_them() {
        assert_eq!(quoted("--channel=phi_p=motor"), "--channel=phi_p=motor");
        assert_eq!(quoted("a record.csv"), "'a record.csv'");
        assert_eq!(quoted("it's"), "'it'\\''s'");
        assert_eq!(quoted(""), "''");
        assert_eq!(quoted("$HOME"), "'$HOME'");
    }
}
