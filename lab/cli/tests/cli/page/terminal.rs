//! What a terminal gets and a pipe does not.

use std::process::Command;

fn close(environment: &[(&str, &str)]) -> String {
    let mut program = Command::new(env!("CARGO_BIN_EXE_bowden"));
    let output = program
        .args(["identify", "--max-terms", "0"])
        .envs(environment.iter().copied())
        .output();
    String::from_utf8(output.unwrap().stdout).unwrap()
}

#[test]
fn no_color_is_obeyed_even_where_colours_are_forced() {
    let plain = close(&[]);
    assert!(!plain.contains('\u{1b}'));
    assert!(
        close(&[("CLICOLOR_FORCE", "1")]).contains('\u{1b}'),
        "colours were forced"
    );
    assert_eq!(close(&[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")]), plain);
}

#[test]
fn a_pipe_gets_no_loop_in_dots() {
    assert!(!close(&[])
        .chars()
        .any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)));
}

/// On a terminal of 100 columns, by `script`, where the machine has it.
#[test]
fn a_terminal_gets_the_loop_and_a_bar_with_a_forecast() {
    let has = Command::new("script").arg("--version").output();
    if !has.is_ok_and(|o| String::from_utf8_lossy(&o.stdout).contains("util-linux")) {
        println!("skipped: no `script` of util-linux on PATH");
        return;
    }
    let run = |columns: u32, more: &str| {
        let program = env!("CARGO_BIN_EXE_bowden");
        let command =
            format!("stty cols {columns} rows 50; '{program}' close --max-terms 0 {more}");
        let mut script = Command::new("script");
        let output = script
            .args(["-qec", &command, "/dev/null"])
            .env("TERM", "xterm")
            .stdin(std::process::Stdio::null())
            .output();
        String::from_utf8_lossy(&output.unwrap().stdout).into_owned()
    };
    let dots = |text: &str| text.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c));
    let wide = run(100, "");
    assert!(dots(&wide), "{wide}");
    assert!(
        wide.contains("% , about") || wide.contains(" %, about "),
        "{wide}"
    );
    assert!(!dots(&run(60, "")) && !dots(&run(100, "--json")));
}
