//! The page in a browser and the text on a terminal, where the machine has them.

use crate::shell::{example, program, said, text, Folder};
use std::path::PathBuf;
use std::process::{Command, Stdio};

fn chromium() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    std::env::split_paths(&path)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|file| file.is_file())
}

/// Runs a page in a window of that width; returns its document afterwards and what was logged.
fn run(browser: &PathBuf, folder: &Folder, page: &str, width: u32) -> (String, String) {
    let own = [
        format!("--window-size={width},900"),
        format!("--user-data-dir={}", folder.path("profile")),
        format!("file://{}", folder.path(page)),
    ];
    let output = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
        ])
        .args(["--enable-logging=stderr", "--v=0", "--dump-dom"])
        .args(own)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (text(&output.stdout), text(&output.stderr))
}

#[test]
fn the_page_fits_a_telephone_and_a_desk_and_logs_no_error() {
    let Some(browser) = chromium() else {
        println!("skipped: no chromium on PATH");
        return;
    };
    let folder = Folder::new();
    let (record, out) = (example("straight.csv"), folder.path("page.html"));
    said(&format!("identify {record} --report {out}"));
    let page: String = folder.read("page.html").bytes().map(encoded).collect();
    // A frame of the exact width, since a window is never narrower than the browser allows; what
    // is measured is written into the title.
    for width in [390, 1280] {
        let measure = format!(
            "<!DOCTYPE html><html><head><title>none</title></head><body style='margin:0'>\
             <iframe id='f' style='border:0;width:{width}px;height:900px'></iframe><script>\
             const f = document.getElementById('f');\
             f.onload = () => {{ const d = f.contentDocument.documentElement; \
             document.title = d.scrollWidth + ' ' + d.clientWidth + ' ' + f.contentDocument.querySelectorAll('figure svg[role=img]').length; }};\
             f.srcdoc = decodeURIComponent('{page}');</script></body></html>"
        );
        folder.file("frame.html", measure);
        let (dom, log) = run(&browser, &folder, "frame.html", 1400);
        let (_, title) = dom.split_once("<title>").unwrap();
        let title = title.split('<').next().unwrap();
        let numbers: Vec<u32> = title.split(' ').map(|n| n.parse().unwrap()).collect();
        assert_eq!(numbers[1], width);
        assert!(numbers[0] <= width, "{title} in a window of {width}");
        assert!(numbers[2] > 10, "{} figures", numbers[2]);
        assert!(!log.contains("CONSOLE"), "{log}");
    }
    let (dom, log) = run(&browser, &folder, "page.html", 1280);
    assert!(dom.contains("Loop and residual") && dom.contains("id=\"verdict\""));
    assert!(!log.contains("CONSOLE"), "{log}");
}

fn encoded(byte: u8) -> String {
    match byte.is_ascii_alphanumeric() {
        true => char::from(byte).to_string(),
        false => format!("%{byte:02X}"),
    }
}

/// The loop is drawn in signs of braille.
fn has_loop(text: &str) -> bool {
    text.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c))
}

#[test]
fn no_color_is_obeyed_even_where_colours_are_forced_and_a_pipe_gets_no_loop() {
    let identify = |environment: &[(&str, &str)]| {
        let mut program = program("identify --max-terms 0");
        program.envs(environment.iter().copied());
        text(&program.output().unwrap().stdout).to_owned()
    };
    let plain = identify(&[]);
    assert!(!plain.contains('\u{1b}') && !has_loop(&plain));
    let forced = ("CLICOLOR_FORCE", "1");
    assert!(
        identify(&[forced]).contains('\u{1b}'),
        "colours were forced"
    );
    assert_eq!(identify(&[forced, ("NO_COLOR", "1")]), plain);
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
        let program = format!(
            "'{}' close --max-terms 0 {more}",
            env!("CARGO_BIN_EXE_bowden")
        );
        let command = format!("stty cols {columns} rows 50; {program}");
        let mut script = Command::new("script");
        script.args(["-qec", &command, "/dev/null"]);
        let output = script.env("TERM", "xterm").stdin(Stdio::null()).output();
        String::from_utf8_lossy(&output.unwrap().stdout).into_owned()
    };
    let wide = run(100, "");
    assert!(has_loop(&wide), "{wide}");
    assert!(
        wide.contains("% , about") || wide.contains(" %, about "),
        "{wide}"
    );
    assert!(!has_loop(&run(60, "")) && !has_loop(&run(100, "--json")));
}
