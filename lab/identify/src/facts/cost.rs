//! Cost of a run of `identify`: counts, which are reproducible, and seconds, which are not
//! reproducible.

use crate::problem::clock::Moment;
use crate::problem::cost::Counts;
use serde::Serialize;

/// Operations and wall time of one run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CostFacts {
    /// Operations over the samples.
    #[serde(flatten)]
    pub counts: Counts,
    /// Wall time of each stage.
    pub seconds: StageSeconds,
}

/// Wall time of each stage \[s\].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct StageSeconds {
    /// Reading files into records.
    pub reading: f64,
    /// Uniform time, filters, grids.
    pub preparing: f64,
    /// The fit of the baseline model.
    pub fitting_baseline: f64,
    /// The search for missing terms.
    pub searching: f64,
    /// The final fit, the exported model, intervals, the verdict.
    pub concluding: f64,
}

/// The stages of a run, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    Reading,
    Preparing,
    FittingDeclared,
    Searching,
    Concluding,
}

impl StageSeconds {
    /// All stages together \[s\].
    #[must_use]
    pub fn total(&self) -> f64 {
        self.before_the_fit() + self.fitting_baseline + self.searching + self.concluding
    }

    /// Reading and preparing \[s\].
    #[must_use]
    pub fn before_the_fit(&self) -> f64 {
        self.reading + self.preparing
    }

    fn of(&mut self, stage: Stage) -> &mut f64 {
        match stage {
            Stage::Reading => &mut self.reading,
            Stage::Preparing => &mut self.preparing,
            Stage::FittingDeclared => &mut self.fitting_baseline,
            Stage::Searching => &mut self.searching,
            Stage::Concluding => &mut self.concluding,
        }
    }
}

/// Measures a run stage by stage. The first stage, reading, begins when the meter starts.
#[derive(Debug, Clone, Copy)]
pub struct Meter {
    before: Counts,
    stage: Stage,
    begun: Moment,
    seconds: StageSeconds,
}

impl Meter {
    /// Starts the measurement, to be called before the records are read.
    #[must_use]
    pub fn start() -> Self {
        Self {
            before: Counts::so_far(),
            stage: Stage::Reading,
            begun: Moment::now(),
            seconds: StageSeconds::default(),
        }
    }

    /// Adds the elapsed time to the current stage, and begins the next stage.
    pub(super) fn begins(&mut self, stage: Stage) {
        let now = Moment::now();
        *self.seconds.of(self.stage) += now.since(self.begun);
        (self.stage, self.begun) = (stage, now);
    }

    /// Follows the messages of a search. The first message begins the fit of the baseline model,
    /// and the second message begins the search itself.
    pub(super) fn told(&mut self) {
        match self.stage {
            Stage::Preparing => self.begins(Stage::FittingDeclared),
            Stage::FittingDeclared => self.begins(Stage::Searching),
            _ => {}
        }
    }

    /// The cost so far.
    pub(super) fn read(mut self) -> CostFacts {
        self.begins(self.stage);
        CostFacts {
            counts: Counts::so_far().since(self.before),
            seconds: self.seconds,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_goes_to_the_stage_that_has_begun_and_stages_sum_to_the_whole() {
        let begun = Moment::now();
        let mut meter = Meter::start();
        meter.begins(Stage::Preparing);
        for told in [Stage::FittingDeclared, Stage::Searching, Stage::Searching] {
            meter.told();
            assert_eq!(meter.stage, told);
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
        meter.begins(Stage::Concluding);
        let CostFacts { seconds, .. } = meter.read();
        let whole = begun.elapsed();
        // A sleep is never shorter than asked for.
        assert!(seconds.searching >= 0.02, "{seconds:?}");
        let all = [
            seconds.reading,
            seconds.preparing,
            seconds.fitting_baseline,
            seconds.searching,
            seconds.concluding,
        ];
        assert!(all.iter().all(|s| *s >= 0.0));
        // The sum of the stages may round up.
        assert!(all.iter().sum::<f64>() <= whole, "{seconds:?}, {whole} s");
    }

    #[test]
    fn the_total_has_each_stage_once() {
        let seconds = StageSeconds {
            reading: 1.0,
            preparing: 2.0,
            fitting_baseline: 4.0,
            searching: 8.0,
            concluding: 16.0,
        };
        assert_eq!((seconds.before_the_fit(), seconds.total()), (3.0, 31.0));
    }
}
