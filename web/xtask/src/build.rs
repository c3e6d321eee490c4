//! Builds a folder of static files, and one file that needs no server, from the sources.

use crate::{failed, root, Done, Ended};
use flate2::write::GzEncoder;
use flate2::Compression;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

const TARGET: &str = "wasm32-unknown-unknown";
/// Stack size of the program in a tab \[bytes\]; the linker's default is 1 MiB.
const STACK: u32 = 4 << 20;
/// Each package has inlined what is hot by itself: across packages only small functions are inlined,
/// which takes 5 % off the size.
const INLINING: &str = "-inline-threshold=30 -inlinehint-threshold=150";
/// Maximum compressed size of the page \[bytes\].
const LARGEST: usize = 2_000_000;

/// The modules of the page, ordered so that each uses only modules before it.
const MODULES: [&str; 7] = [
    "dom.js",
    "plot.js",
    "engine.js",
    "result.js",
    "explore.js",
    "control.js",
    "app.js",
];

/// Builds the page.
pub fn build(out: &Path) -> Done {
    let program = std::fs::read(program()?)?;
    let page = root().join("page");
    std::fs::create_dir_all(out)?;
    std::fs::write(out.join("bowden.wasm"), &program)?;
    let mut total = compressed(&program)?.len();
    println!(
        "{:>9} bytes, {total:>7} gzipped  bowden.wasm",
        program.len()
    );
    for name in MODULES
        .into_iter()
        .chain(["index.html", "style.css", "worker.js"])
    {
        let bytes = std::fs::read(page.join(name))?;
        let packed = compressed(&bytes)?.len();
        total += packed;
        println!("{:>9} bytes, {packed:>7} gzipped  {name}", bytes.len());
        std::fs::write(out.join(name), bytes)?;
    }
    println!("{total:>25} gzipped  in all");
    let single = single(&page, &program)?;
    println!(
        "{:>9} bytes                   bowden.html, which needs no server",
        single.len()
    );
    std::fs::write(out.join("bowden.html"), single)?;
    if total > LARGEST {
        return Err(failed(format!(
            "the page has more than {LARGEST} bytes gzipped"
        )));
    }
    println!("{}", out.display());
    Ok(())
}

/// Compiles the program; returns its path.
fn program() -> Result<PathBuf, Ended> {
    require_target()?;
    let flags = format!("-C target-feature=+simd128 -C link-arg=-zstack-size={STACK}");
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .current_dir(root())
        .env("RUSTFLAGS", flags)
        .args(["rustc", "--release", "--locked", "--package", "bowden-web"])
        .args(["--target", TARGET, "--lib", "--crate-type", "cdylib"])
        .args(["--message-format", "json-render-diagnostics"])
        .args(["--", "-C", &format!("llvm-args={INLINING}")])
        .stderr(std::process::Stdio::inherit())
        .output()?;
    if !output.status.success() {
        return Err(failed("the program does not compile"));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let mut names = text.lines().filter_map(|line| {
        let message: serde_json::Value = serde_json::from_str(line).ok()?;
        let names = message["filenames"].as_array()?;
        let wasm = names.iter().filter_map(|name| name.as_str());
        wasm.map(PathBuf::from)
            .find(|name| name.ends_with("bowden_web.wasm"))
    });
    names
        .next_back()
        .ok_or_else(|| failed("no program was built"))
}

/// Requires the compiler's libraries for the target; rustup installs them if possible.
fn require_target() -> Done {
    let libraries = Command::new("rustc")
        .args(["--print", "target-libdir", "--target", TARGET])
        .output()?;
    let folder = PathBuf::from(String::from_utf8_lossy(&libraries.stdout).trim());
    if folder.exists() {
        return Ok(());
    }
    let added = Command::new("rustup")
        .args(["target", "add", TARGET])
        .status();
    match added {
        Ok(status) if status.success() => Ok(()),
        _ => Err(Ended::Skipped(format!(
            "the target {TARGET} is not installed (rustup target add {TARGET})"
        ))),
    }
}

fn compressed(bytes: &[u8]) -> Result<Vec<u8>, Ended> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    Ok(encoder.finish()?)
}

/// The page as one file: a browser refuses to load modules and workers from a disk, unless the page
/// contains them.
fn single(page: &Path, program: &[u8]) -> Result<String, Ended> {
    let read = |name: &str| std::fs::read_to_string(page.join(name));
    let mut script = String::new();
    for name in MODULES {
        for line in read(name)?
            .lines()
            .filter(|line| !line.starts_with("import "))
        {
            script.push_str(line.strip_prefix("export ").unwrap_or(line));
            script.push('\n');
        }
    }
    let html = read("index.html")?;
    let policy = html
        .split_once("content=\"default-src")
        .and_then(|(_, rest)| rest.split_once('"'))
        .map(|(policy, _)| format!("default-src{policy}"))
        .ok_or_else(|| failed("index.html has no security policy"))?;
    // The single file contains everything, so it needs no connection.
    let stricter = policy
        .replace("script-src 'self'", "script-src 'unsafe-inline'")
        .replace("connect-src 'self'; ", "");
    let program = format!(
        "<script type=\"text/plain\" id=\"program\">{}</script>\n<script type=\"text/plain\" id=\"worker\">{}</script>\n",
        base64(&compressed(program)?),
        read("worker.js")?
    );
    let mut whole = html;
    for (from, to) in [
        (policy, stricter),
        (
            "<link rel=\"stylesheet\" href=\"style.css\">".to_owned(),
            format!("<style>\n{}</style>", read("style.css")?),
        ),
        (
            "<script type=\"module\" src=\"app.js\"></script>".to_owned(),
            format!("{program}<script type=\"module\">\n{script}</script>"),
        ),
    ] {
        if whole.matches(&from).count() != 1 {
            return Err(failed(format!("index.html has not once: {from}")));
        }
        whole = whole.replace(&from, &to);
    }
    Ok(whole)
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let all = group
            .iter()
            .chain([&0, &0])
            .take(3)
            .fold(0_u32, |all, byte| all << 8 | u32::from(*byte));
        for place in 0..4 {
            let digit = DIGITS[(all >> (18 - 6 * place) & 63) as usize];
            text.push(if place > group.len() {
                '='
            } else {
                char::from(digit)
            });
        }
    }
    text
}
