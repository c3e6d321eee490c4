//! The page in a browser, where one is on PATH.

use crate::shell::{example, said, Folder};
use std::path::PathBuf;
use std::process::Command;

fn chromium() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    std::env::split_paths(&path)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|file| file.is_file())
}

/// Runs a page in a window of that width; returns its document afterwards and what was logged.
fn run(browser: &PathBuf, folder: &Folder, page: &str, width: u32) -> (String, String) {
    let output = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
            "--enable-logging=stderr",
            "--v=0",
        ])
        .args([
            format!("--window-size={width},900"),
            format!("--user-data-dir={}", folder.path("profile")),
            "--dump-dom".to_owned(),
            format!("file://{}", folder.path(page)),
        ])
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
    let out = folder.path("page.html");
    said(&["identify", &example("straight.csv"), "--report", &out]);
    let page = folder.read("page.html");
    // A frame of the exact width, since a window is never narrower than the browser allows; what
    // is measured is written into the title.
    for width in [390, 1280] {
        let measure = format!(
            "<!DOCTYPE html><html><head><title>none</title></head><body style='margin:0'>\
             <iframe id='f' style='border:0;width:{width}px;height:900px'></iframe><script>\
             const f = document.getElementById('f');\
             f.onload = () => {{ const d = f.contentDocument.documentElement; \
             document.title = d.scrollWidth + ' ' + d.clientWidth + ' ' + f.contentDocument.querySelectorAll('figure svg[role=img]').length; }};\
             f.srcdoc = decodeURIComponent('{}');</script></body></html>",
            encoded(&page)
        );
        std::fs::write(folder.path("frame.html"), measure).unwrap();
        let (dom, log) = run(&browser, &folder, "frame.html", 1400);
        let title = dom
            .split("<title>")
            .nth(1)
            .and_then(|t| t.split('<').next())
            .unwrap();
        let numbers: Vec<u32> = title.split(' ').map(|n| n.parse().unwrap()).collect();
        assert_eq!(numbers[1], width);
        assert!(
            numbers[0] <= width,
            "{} wide in a window of {width}",
            numbers[0]
        );
        assert!(numbers[2] > 10, "{} figures", numbers[2]);
        assert!(!log.contains("CONSOLE"), "{log}");
    }
    let (dom, log) = run(&browser, &folder, "page.html", 1280);
    assert!(dom.contains("Loop and residual") && dom.contains("id=\"verdict\""));
    assert!(!log.contains("CONSOLE"), "{log}");
}

fn encoded(text: &str) -> String {
    let mut out = String::new();
    for byte in text.bytes() {
        match byte.is_ascii_alphanumeric() {
            true => out.push(char::from(byte)),
            false => out.push_str(&format!("%{byte:02X}")),
        }
    }
    out
}
