//! Cost of a run of `bowden identify`, in one line for a terminal.

use bowden_lab::facts::CostFacts;

/// Total time and the time of each stage.
#[must_use]
pub fn cost_line(cost: &CostFacts) -> String {
    let seconds = &cost.seconds;
    format!(
        "took {:.1} s: reading {:.1}, baseline model {:.1}, search {:.1}, conclusions {:.1}; {} evaluations of the model, {} Jacobians",
        seconds.total(),
        seconds.before_the_fit(),
        seconds.fitting_baseline,
        seconds.searching,
        seconds.concluding,
        cost.counts.evaluations,
        cost.counts.jacobians
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowden_lab::facts::{Counts, StageSeconds};

    #[test]
    fn the_line_has_the_total_and_each_stage() {
        let cost = CostFacts {
            counts: Counts {
                evaluations: 412,
                jacobians: 97,
                ..Counts::default()
            },
            seconds: StageSeconds {
                reading: 0.25,
                preparing: 0.25,
                fitting_baseline: 1.0,
                searching: 2.0,
                concluding: 0.5,
            },
        };
        assert_eq!(
            cost_line(&cost),
            "took 4.0 s: reading 0.5, baseline model 1.0, search 2.0, conclusions 0.5; 412 evaluations of the model, 97 Jacobians"
        );
    }
}
