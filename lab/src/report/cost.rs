//! What a run of `bowden close` cost: counts, which repeat, and seconds, which do not.

use crate::problem::cost::Counts;
use serde::Serialize;
use std::time::Instant;

/// The part `cost` of the JSON.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Cost {
    #[serde(flatten)]
    counts: Counts,
    seconds: Seconds,
}

/// Wall time of each stage \[s\].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
struct Seconds {
    reading: f64,
    preparing: f64,
    fitting_declared: f64,
    searching: f64,
    concluding: f64,
}

/// The stages of a run, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Files become records.
    Reading,
    /// Uniform time, filters, grids.
    Preparing,
    /// The fit of the declared model.
    FittingDeclared,
    /// Everything that looks for what the declared model lacks.
    Searching,
    /// The final fit, what is handed over, intervals, the verdict, the report.
    Concluding,
}

impl Seconds {
    fn of(&mut self, stage: Stage) -> &mut f64 {
        match stage {
            Stage::Reading => &mut self.reading,
            Stage::Preparing => &mut self.preparing,
            Stage::FittingDeclared => &mut self.fitting_declared,
            Stage::Searching => &mut self.searching,
            Stage::Concluding => &mut self.concluding,
        }
    }
}

/// Runs along with `close` and is told where a stage begins.
#[derive(Debug, Clone, Copy)]
pub struct Meter {
    before: Counts,
    stage: Stage,
    begun: Instant,
    seconds: Seconds,
}

impl Meter {
    /// Begins, with the reading.
    #[must_use]
    pub fn start() -> Self {
        Self {
            before: Counts::so_far(),
            stage: Stage::Reading,
            begun: Instant::now(),
            seconds: Seconds::default(),
        }
    }

    /// From here on it is that stage's time.
    pub fn begins(&mut self, stage: Stage) {
        let now = Instant::now();
        *self.seconds.of(self.stage) += (now - self.begun).as_secs_f64();
        (self.stage, self.begun) = (stage, now);
    }

    /// Takes in what a search says of itself: with its first message it begins the fit of
    /// the declared model, with the second it goes beyond that.
    pub fn told(&mut self) {
        match self.stage {
            Stage::Preparing => self.begins(Stage::FittingDeclared),
            Stage::FittingDeclared => self.begins(Stage::Searching),
            _ => {}
        }
    }

    /// What it has cost so far.
    #[must_use]
    pub fn read(mut self) -> Cost {
        self.begins(self.stage);
        Cost {
            counts: Counts::so_far().since(self.before),
            seconds: self.seconds,
        }
    }
}

impl Cost {
    /// In one line, for whoever has waited: "1.3 s (0.2 declared model, 0.9 search, …)".
    #[must_use]
    pub fn line(&self) -> String {
        let Seconds {
            reading,
            preparing,
            fitting_declared,
            searching,
            concluding,
        } = self.seconds;
        let before = reading + preparing;
        format!(
            "took {:.1} s: reading {before:.1}, declared model {fitting_declared:.1}, search {searching:.1}, conclusions {concluding:.1}; {} evaluations of the model, {} Jacobians",
            before + fitting_declared + searching + concluding,
            self.counts.evaluations,
            self.counts.jacobians
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_goes_to_the_stage_that_has_begun_and_stages_sum_to_the_whole() {
        let begun = Instant::now();
        let mut meter = Meter::start();
        meter.begins(Stage::Preparing);
        for told in [Stage::FittingDeclared, Stage::Searching, Stage::Searching] {
            meter.told();
            assert_eq!(meter.stage, told);
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
        meter.begins(Stage::Concluding);
        let Cost { seconds, .. } = meter.read();
        let whole = begun.elapsed().as_secs_f64();
        // A sleep is never shorter than asked for.
        assert!(seconds.searching >= 0.02, "{seconds:?}");
        let all = [
            seconds.reading,
            seconds.preparing,
            seconds.fitting_declared,
            seconds.searching,
            seconds.concluding,
        ];
        assert!(all.iter().all(|s| *s >= 0.0));
        assert!(all.iter().sum::<f64>() <= whole, "{seconds:?}, {whole} s");
    }

    #[test]
    fn the_line_has_the_total_and_each_stage() {
        let cost = Cost {
            counts: Counts {
                evaluations: 412,
                jacobians: 97,
                ..Counts::default()
            },
            seconds: Seconds {
                reading: 0.25,
                preparing: 0.25,
                fitting_declared: 1.0,
                searching: 2.0,
                concluding: 0.5,
            },
        };
        assert_eq!(
            cost.line(),
            "took 4.0 s: reading 0.5, declared model 1.0, search 2.0, conclusions 0.5; 412 evaluations of the model, 97 Jacobians"
        );
    }
}
