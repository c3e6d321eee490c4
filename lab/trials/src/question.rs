//! The input of a comparison.

use super::own_rig::RigChanges;
use super::setup_file::text_of_disk;
use std::path::Path;

/// The input of a comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Question<'a> {
    /// A model for the feed-forward, or one file with gains, rig and model. With `gains` or `rig`,
    /// the rig also has the transmission of the model. Default: the paper's gains and the reference
    /// rig.
    pub setup: Option<&'a Path>,
    /// Gains from `bowden design`, which need the model in `setup`; or a file in the form of
    /// `setup`.
    pub gains: Option<&'a Path>,
    /// Changed parameters of the rig. The drive gain defaults to that of `gains`, if they are from
    /// `bowden design`.
    pub rig: RigChanges,
    /// White noise of the torque sensors \[N·m rms\]; default: that of the setup.
    pub noise: Option<f64>,
    /// Whether the conduit moves.
    pub varying: bool,
    /// Length of a trial \[s\], 8 to 3600.
    pub seconds: f64,
    /// Number of trials, each with its own seed, 1 to 1000.
    pub seeds: u64,
    /// Whether the reference is a gait instead of the paper's.
    pub gait: bool,
    /// The undeclared effect, if there is one.
    pub effect: Option<&'a str>,
    /// Whether to return the signals of the first trial.
    pub traced: bool,
    /// Files in memory, by their paths. All other files are read from the disk.
    pub in_memory: &'a [(&'a Path, &'a str)],
}

impl Default for Question<'_> {
    fn default() -> Self {
        Self {
            setup: None,
            gains: None,
            rig: RigChanges::default(),
            noise: None,
            varying: false,
            seconds: 60.0,
            seeds: 6,
            gait: false,
            effect: None,
            traced: false,
            in_memory: &[],
        }
    }
}

impl Question<'_> {
    /// An error names the option that is out of range.
    pub(crate) fn check(&self) -> Result<(), String> {
        let (seconds, seeds) = (self.seconds, self.seeds);
        if !(8.0..=3600.0).contains(&seconds) {
            return Err(format!("--seconds {seconds} is out of range (8 to 3600)"));
        }
        if !(1..=1000).contains(&seeds) {
            return Err(format!("--seeds {seeds} is out of range (1 to 1000)"));
        }
        self.rig.check()
    }

    /// The text of a file.
    pub(crate) fn text(&self, path: &Path) -> Result<String, String> {
        match self.in_memory.iter().find(|(own, _)| *own == path) {
            Some((_, text)) => Ok((*text).to_owned()),
            None => text_of_disk(path),
        }
    }
}
