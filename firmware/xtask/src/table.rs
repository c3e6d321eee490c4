//! What is measured beside what is allowed, as text.

use crate::budget::Budgets;
use crate::design::Design;
use crate::measured::{Cost, Measured};
use crate::target::{Target, TARGETS};
use anyhow::{Context, Result};
use bowden_cases::Signal;
use std::process::Command;

/// Which compiler and which emulators the figures are of.
pub fn versions() {
    let mut programs: Vec<&str> = TARGETS.iter().map(|target| target.emulator).collect();
    programs.dedup();
    for program in std::iter::once("rustc").chain(programs) {
        let Ok(output) = Command::new(program).arg("--version").output() else {
            continue;
        };
        let text = String::from_utf8_lossy(&output.stdout);
        println!("{}", text.lines().next().unwrap_or_default());
    }
    println!("f32, opt-level 3, fat LTO, one codegen unit, panic = abort");
}

/// Prints both tables of a target.
pub fn print(target: &Target, steps: &[(&str, Measured)], budgets: &Budgets, design: &Design) {
    let triple = target.triple;
    println!("\n{triple}: instructions a step, on average (at worst)");
    line("step", "signal", ["measured", "budget", "goal", "before"]);
    for (step, measured) in steps {
        let (budget, figures) = (budgets.of(step, triple), design.of(step, triple));
        let Some(run) = &measured.run else { continue };
        for (signal, cost) in Signal::ALL.into_iter().zip(run.costs) {
            let name = if signal == Signal::ALL[0] { step } else { "" };
            let allowed = budget.map_or("none".to_owned(), |budget| both(budget.cost(signal)));
            let figure = figures.cost(signal);
            line(
                name,
                signal.name(),
                [&both(cost), &allowed, &figure.goal, &figure.before],
            );
        }
    }
    println!("\n{triple}: bytes, with all that a step pulls in");
    line("step", "", ["measured", "budget", "goal", "before"]);
    for (step, measured) in steps {
        let (budget, figures) = (budgets.of(step, triple), design.of(step, triple));
        let allowed = |number: Option<u64>| number.map_or("none".to_owned(), |n| n.to_string());
        let code = &figures.code;
        line(
            step,
            "code",
            [
                &measured.code.to_string(),
                &allowed(budget.map(|budget| budget.code)),
                &code.goal,
                &code.before,
            ],
        );
        if let Some(run) = &measured.run {
            let stack = &figures.stack;
            line(
                "",
                "stack",
                [
                    &run.stack.to_string(),
                    &allowed(budget.map(|budget| budget.stack.into())),
                    &stack.goal,
                    &stack.before,
                ],
            );
        }
    }
    println!("\n{triple}: outputs against the host's, and what is in the image");
    for (step, measured) in steps {
        println!("{step:<NAME$}{}", remarks(measured));
    }
}

/// Columns of a step's name: the longest one and a space.
const NAME: usize = 34;

fn line(step: &str, what: &str, [measured, budget, goal, before]: [&str; 4]) {
    let text = format!("{step:<NAME$}{what:<7}{measured:>15}{budget:>15}{goal:>12}{before:>14}");
    println!("{}", text.trim_end());
}

fn both(Cost { mean, worst }: Cost) -> String {
    format!("{mean} ({worst})")
}

fn remarks(measured: &Measured) -> String {
    let mut parts = Vec::new();
    if let Some(run) = &measured.run {
        parts.push(match run.ulp {
            0 => "the host's bits".to_owned(),
            ulp => format!("{ulp} ulp from the host"),
        });
    }
    if measured.soft_double {
        parts.push("soft-float double".to_owned());
    }
    if measured.panics {
        parts.push("can panic".to_owned());
    }
    parts.join(", ")
}

/// Where the table stands in `firmware/README.md`.
const BEGIN: &str = "<!-- cargo xtask --markdown -->\n";
const END: &str = "<!-- end -->";

/// A text with its table replaced by what is measured.
pub fn with_table(text: &str, steps: &[(&str, Measured)]) -> Result<String> {
    let parts = text.split_once(BEGIN).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(END)?;
        Some((before, after))
    });
    let (before, after) = parts.context("no place for the table")?;
    let mut table = String::from(
        "| step | sine | noise | jumps | faults | flash \\[B\\] | stack \\[B\\] |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for (step, measured) in steps {
        let run = measured
            .run
            .as_ref()
            .context("the table needs an emulator")?;
        let costs = run.costs.map(both).join(" | ");
        let (code, stack) = (measured.code, run.stack);
        table += &format!("| {step} | {costs} | {code} | {stack} |\n");
    }
    Ok([before, BEGIN, &table, END, after].concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::Run;

    #[test]
    fn no_name_runs_into_the_next_column() {
        assert!(bowden_cases::NAMES.iter().all(|name| name.len() < NAME));
    }

    #[test]
    fn remarks_say_what_is_and_not_what_is_not() {
        let cost = Cost { mean: 1, worst: 2 };
        let run = |ulp| {
            Some(Run {
                stack: 0,
                ulp,
                costs: [cost; 4],
            })
        };
        let mut measured = Measured {
            code: 0,
            soft_double: false,
            panics: false,
            run: run(0),
        };
        assert_eq!(remarks(&measured), "the host's bits");
        measured.soft_double = true;
        measured.run = run(3);
        assert_eq!(remarks(&measured), "3 ulp from the host, soft-float double");
        measured.run = None;
        measured.panics = true;
        assert_eq!(remarks(&measured), "soft-float double, can panic");
    }
    #[test]
    fn a_table_takes_the_place_of_the_one_before() {
        let cost = Cost { mean: 1, worst: 2 };
        let measured = Measured {
            code: 30,
            soft_double: false,
            panics: false,
            run: Some(Run {
                stack: 40,
                ulp: 0,
                costs: [cost; 4],
            }),
        };
        let text = format!("a\n{BEGIN}old\n{END}\nb\n");
        let new = with_table(&text, &[("pi", measured.clone())]).unwrap();
        let row = "| pi | 1 (2) | 1 (2) | 1 (2) | 1 (2) | 30 | 40 |\n";
        assert!(new.contains(row), "{new}");
        assert!(!new.contains("old") && new.starts_with("a\n") && new.ends_with("\nb\n"));
        assert_eq!(with_table(&new, &[("pi", measured.clone())]).unwrap(), new);
        assert!(with_table("a\nb\n", &[("pi", measured)]).is_err());
    }
}
