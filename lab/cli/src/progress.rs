//! The progress bar on stderr: the present step, its share of the whole, and a forecast.
//!
//! The number of rounds of a search is not known in advance. The shares of the steps are a choice,
//! not measured. Each further round of the search gets a third of the remaining part of the search,
//! so the bar never moves backwards and never waits at its end. The forecast is as rough as the
//! shares are.

use crate::bar::{ProgressBar, ProgressStyle};
use std::io::IsTerminal as _;
use std::time::Duration;

/// Length of the bar in its own steps.
const STEPS: u64 = 1000;
/// Where the search begins and ends.
const SEARCH: [f64; 2] = [0.08, 0.80];

/// Share of the work that is complete when a step begins, 0 to 1; `None` for a message that is not
/// a step.
#[must_use]
pub fn share(step: &str) -> Option<f64> {
    if let Some(rest) = step.strip_prefix("searching for missing terms, round ") {
        let turn: i32 = rest.split(',').next()?.parse().ok()?;
        let [from, to] = SEARCH;
        return Some(from + (to - from) * (1.0 - (2.0_f64 / 3.0).powi(turn - 1)));
    }
    if let Some(rest) = step.strip_prefix("testing: ") {
        let mut numbers = rest.split(' ').filter_map(|word| word.parse::<f64>().ok());
        return Some(numbers.next()? / numbers.next()?).filter(|share| share.is_finite());
    }
    Some(match step {
        "reading" => 0.0,
        "fitting the baseline model" => 0.03,
        "searching for alternatives" => SEARCH[1],
        "fitting each file with its own gains" => 0.86,
        "fitting the final model" => 0.88,
        "searching for invertible effects" => 0.90,
        "fitting the exported model" => 0.93,
        "searching for redundant baseline parts" => 0.96,
        _ => return None,
    })
}

/// Shows the present step on the bar.
pub fn telling(bar: &ProgressBar) -> impl Fn(&str) + Sync + '_ {
    |what| {
        bar.set_message(what.to_owned());
        if let Some(share) = share(what) {
            let at = (share.clamp(0.0, 1.0) * STEPS as f64) as u64;
            bar.set_position(at.max(bar.position()));
        }
    }
}

/// A bar on a terminal; nothing elsewhere.
pub fn progress() -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(STEPS);
    // Without colours, whatever the terminal: NO_COLOR has nothing to take away.
    let template = "{elapsed} {bar:24} {percent} %, about {eta} left: {msg}";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("━╸─"));
    }
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn each_step_is_further_than_the_one_before_and_none_is_at_the_end() {
        let turn = |k| format!("searching for missing terms, round {k}, found so far: 2");
        let mut steps = vec![
            "reading".to_owned(),
            "fitting the baseline model".to_owned(),
        ];
        steps.extend((1..30).map(turn));
        steps.extend(
            [
                "searching for alternatives",
                "fitting each file with its own gains",
                "fitting the final model",
                "searching for invertible effects",
                "fitting the exported model",
                "searching for redundant baseline parts",
            ]
            .map(str::to_owned),
        );
        let shares: Vec<f64> = steps.iter().map(|step| share(step).unwrap()).collect();
        assert!(shares.windows(2).all(|w| w[0] < w[1]), "{shares:?}");
        assert!(shares.iter().all(|s| (0.0..1.0).contains(s)));
        assert_eq!(share("testing: 3 of 12 effects"), Some(0.25));
        assert_eq!(share("testing: 0 of 0 effects"), None);
        assert_eq!(share("something else"), None);
    }

    #[test]
    fn a_step_that_is_not_known_leaves_the_bar_where_it_is() {
        let bar = ProgressBar::hidden();
        bar.set_length(STEPS);
        let tell = telling(&bar);
        tell("fitting the final model");
        tell("something else");
        tell("reading");
        assert_eq!(bar.position(), 880);
    }
}
