//! Budgets hold, are tightened and are never loosened.

use super::*;

fn measured() -> Measured {
    let cost = |mean, worst| Cost { mean, worst };
    Measured {
        code: 1000,
        soft_double: false,
        panics: false,
        run: Some(Run {
            stack: 96,
            ulp: 0,
            costs: [cost(100, 110), cost(101, 120), cost(102, 900), cost(90, 95)],
        }),
    }
}

fn with_run(change: impl Fn(&mut Run)) -> Measured {
    let mut measured = measured();
    measured.run.iter_mut().for_each(change);
    measured
}

fn budgets() -> Budgets {
    let mut budgets = Budgets::default();
    budgets.tighten("m4", &[("pi", measured())]);
    budgets
}

#[test]
fn what_was_measured_is_within_its_own_budget() {
    assert_eq!(
        budgets().broken("pi", "m4", &measured()),
        Vec::<String>::new()
    );
}

#[test]
fn each_number_beyond_its_budget_is_told_with_step_and_target() {
    let told = |measured: &Measured| budgets().broken("pi", "m4", measured);
    let code = Measured {
        code: 1021,
        ..measured()
    };
    assert_eq!(told(&code), ["pi on m4: code [B] is 1021, budget 1020"]);
    let double = Measured {
        soft_double: true,
        ..measured()
    };
    assert_eq!(
        told(&double),
        ["pi on m4: soft-float double in the image is 1, budget 0"]
    );
    let panics = Measured {
        panics: true,
        ..measured()
    };
    assert_eq!(
        told(&panics),
        ["pi on m4: a panic in the image is 1, budget 0"]
    );
    let stack = with_run(|run| run.stack = 105);
    assert_eq!(told(&stack), ["pi on m4: stack [B] is 105, budget 104"]);
    let ulp = with_run(|run| run.ulp = 1);
    assert_eq!(
        told(&ulp),
        ["pi on m4: distance from the host [ulp] is 1, budget 0"]
    );
}

#[test]
fn mean_and_worst_are_held_on_each_signal_by_itself() {
    let told = |measured: &Measured| budgets().broken("pi", "m4", measured);
    let sine = with_run(|run| run.costs[0].mean = 103);
    assert_eq!(
        told(&sine),
        ["pi on m4: sine: instructions on average is 103, budget 102"]
    );
    // 900 is within the budget of the jumps, not within that of the faults.
    let faults = with_run(|run| run.costs[3].worst = 900);
    assert_eq!(
        told(&faults),
        ["pi on m4: faults: instructions at worst is 900, budget 97"]
    );
}

#[test]
fn without_an_emulator_the_code_is_still_held() {
    let blind = Measured {
        code: 2000,
        run: None,
        ..measured()
    };
    assert_eq!(budgets().broken("pi", "m4", &blind).len(), 1);
}

#[test]
fn a_step_without_a_budget_and_a_budget_without_a_step_are_both_told() {
    let told = budgets().broken("pi", "m0", &measured());
    assert_eq!(
        told,
        ["pi on m0: no budget (cargo xtask --tighten adds one)"]
    );
    assert!(budgets().without_a_step(&["pi"], &["m4"]).is_empty());
    let stale = budgets().without_a_step(&["pid"], &["m4"]);
    assert_eq!(stale, ["a budget of pi on m4, which is not measured"]);
}

#[test]
fn tightening_lowers_and_never_raises() {
    let mut budgets = budgets();
    let worse = Measured {
        code: 9000,
        soft_double: true,
        ..with_run(|run| run.costs[2].worst = 50)
    };
    budgets.tighten("m4", &[("pi", worse)]);
    let budget = budgets.of("pi", "m4").unwrap();
    assert_eq!((budget.code, budget.soft_double), (1020, false));
    assert_eq!(
        budget.cost(Signal::Jumps),
        Cost {
            mean: 105,
            worst: 52
        }
    );
}

#[test]
fn what_is_written_is_read_again() {
    let text = budgets().text();
    assert_eq!(toml::from_str::<Budgets>(&text).unwrap(), budgets());
    assert!(text.contains("[pi.m4]\ncode = 1020\n"), "{text}");
    assert!(
        text.contains("jumps = { mean = 105, worst = 918 }\n"),
        "{text}"
    );
}

#[test]
fn a_budget_with_a_number_too_many_or_too_few_is_refused() {
    let text = budgets().text();
    let more = text.replace("ulp = 0", "ulp = 0\nflash = 1");
    assert!(toml::from_str::<Budgets>(&more)
        .unwrap_err()
        .to_string()
        .contains("flash"));
    let less = text.replace("ulp = 0\n", "");
    assert!(toml::from_str::<Budgets>(&less)
        .unwrap_err()
        .to_string()
        .contains("ulp"));
}

#[test]
fn the_file_of_this_repository_is_in_the_form_that_is_written() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../budgets.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(Budgets::read(&path).unwrap().text(), text);
}
