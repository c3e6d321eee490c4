//! The results of a run as plain data: names, numbers, sentences and the bytes of files.
//!
//! Each subcommand has one function in this module, which computes every number of the result. A
//! view (terminal, JSON) only reads the fields. Two views therefore cannot print different results.

mod asked;
mod c_file;
mod check;
mod close;
mod cost;
mod figures;
mod hand_over;
mod ledger;
mod model;
mod plan;
mod power;
mod record;
mod round;
mod source;

pub use asked::Asked;
pub use c_file::{model_in_c, prefix_in_c};
pub use check::{check, check_record, CheckFacts, CheckQuestion, Checked, DependsOn, ModelOfFile};
pub use close::{close, Close, Closed, Form, Handed};
pub use cost::{CostFacts, Meter, StageSeconds};
pub use figures::{BlockScores, Dependence, Figures};
pub use hand_over::HandOverFacts;
pub use ledger::{Detail, Facts, RejectedFacts, UnknownFacts};
pub use model::{FinalFacts, GainsOfFile, ModelFacts};
pub use plan::{plan, Plan, Planned};
pub use power::{power, PowerFacts, PowerRow, ShapeFacts};
pub use record::{FileFacts, HeldOutOf, RecordFacts};
pub use round::{RivalFacts, RoundFacts, RoundFit, RoundModel, Size};
pub use source::{read_with_source, Source};

// The plain data of lower rooms that facts are made of.
pub use crate::alteration::{Alteration, Suspicion};
pub use crate::check::{Errors, Outside, Verdict as CheckVerdict, HOLDS};
pub use crate::conclude::by_file::{FileErrors, FileShare, Worse};
pub use crate::conclude::curve::Knot;
pub use crate::conclude::finding::{Finding, Severity, Told};
pub use crate::conclude::intervals::{Parameter, Refusal};
pub use crate::conclude::line::{Fitted, Line};
pub use crate::conclude::mechanisms::{
    across, lacking, Across, Complete, DescribedBy, FileAlone, Lack, LackAlone,
};
pub use crate::conclude::numbers::{number, share, with_interval};
pub use crate::conclude::signals::{File, Part, Segment, Signals, Worst};
pub use crate::conclude::trace::Column;
pub use crate::conclude::unneeded::Unneeded;
pub use crate::conclude::verdict::{percent, Verdict};
pub use crate::export::hand_over::{Calmed, TIED};
pub use crate::export::invertible::{three_digits, FeedForward, Nearest};
pub use crate::export::vector::is_header as is_header_of_vector;
pub use crate::export::{LeftOut, ModelFile};
pub use crate::fit::Segments;
pub use crate::foresight::plan::{Aim, Experiment};
pub use crate::foresight::power::{Answer, Question as PowerQuestion, SHARE, TRIALS, TRIALS_RANGE};
pub use crate::ledger::{FileApart, Gate, Grade, Share};
#[cfg(all(target_family = "wasm", target_os = "unknown"))]
pub use crate::problem::clock::set_clock;
pub use crate::problem::cost::Counts;
pub use crate::record::{
    excerpt, outline, Defect, Line as TextLine, Mode, Options, Outline, Outlined,
    Part as ColumnPart, Record, RecordError,
};
pub use crate::scale::NOISE;
pub use crate::score::autocorrelation::Autocorrelation;
pub use crate::score::binned::{Bin, Mean};
pub use crate::score::blocks::BLOCKS;
pub use crate::score::density::Spectrum;
pub use crate::score::explains::Explained;
pub use crate::search::MOST_NAMES;
