//! The time of the page next to that of the program with one thread.

use crate::browser::Browser;
use crate::native::Native;
use crate::{build, pages, root, serve, Done};
use std::time::Instant;

/// Repetitions; the fastest counts.
const TIMES: usize = 5;

/// Prints sizes and times.
pub fn time() -> Done {
    let dist = root().join("dist");
    build::build(&dist)?;
    let native = Native::build()?;
    let mut page = Browser::start()?;
    let address = serve::in_background(dist)?;
    page.open(&format!("{address}/"))?;
    let paint =
        page.value("performance.getEntriesByName('first-contentful-paint')[0]?.startTime / 1000")?;
    println!("first paint {:.2} s", paint.as_f64().unwrap_or(f64::NAN));
    println!(
        "{:<14} {:>9} {:>10} {:>7}",
        "record", "page [s]", "native [s]", "ratio"
    );
    for name in ["built-in", "straight.csv", "damper.csv"] {
        match name {
            "built-in" => pages::example(&mut page)?,
            _ => pages::choose(&mut page, &[native.folder().join(name)])?,
        }
        let mut there = f64::INFINITY;
        let mut here = f64::INFINITY;
        for _ in 0..TIMES {
            there = there.min(pages::identify(&mut page)?);
            let command = pages::command(&mut page)?;
            let begun = Instant::now();
            native.run(&format!("{command} --trace trace.csv"))?;
            here = here.min(begun.elapsed().as_secs_f64());
        }
        println!("{name:<14} {there:>9.2} {here:>10.2} {:>7.2}", there / here);
        page.value("bowden.state.files.splice(0)")?;
    }
    Ok(())
}
