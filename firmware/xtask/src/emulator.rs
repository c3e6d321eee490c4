//! Runs an image in QEMU.

use crate::target::Target;
use anyhow::{bail, Context, Result};
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Far more than any image takes: the closed loop without a float unit takes ten seconds.
const LIMIT: Duration = Duration::from_secs(180);

/// What the image prints; `icount` is how the emulator's time passes.
pub fn run(target: &Target, image: &Path, icount: &str) -> Result<Vec<u8>> {
    let mut qemu = Command::new(target.emulator);
    qemu.args(target.machine)
        .args(["-icount", icount, "-no-reboot"])
        .args(["-display", "none", "-monitor", "none", "-serial", "none"])
        .args(["-chardev", "stdio,id=out"])
        .args(["-semihosting-config", "enable=on,target=native,chardev=out"])
        .arg("-kernel")
        .arg(image)
        .stdin(Stdio::null())
        .stdout(Stdio::piped());
    printed(&mut qemu, LIMIT).with_context(|| format!("{} in {}", image.display(), target.emulator))
}

/// What a program prints, if it ends in time and well.
fn printed(command: &mut Command, limit: Duration) -> Result<Vec<u8>> {
    let mut child = command.spawn()?;
    let Some(mut output) = child.stdout.take() else {
        bail!("no output");
    };
    let reader = std::thread::spawn(move || {
        let mut bytes = Vec::new();
        output.read_to_end(&mut bytes).map(|_| bytes)
    });
    let begun = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if begun.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            bail!("not finished after {} s", limit.as_secs());
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    match status.code() {
        Some(0) => {}
        Some(2) => bail!("the constructor refuses its settings"),
        Some(3) => bail!("the step panics"),
        Some(4) => bail!("the step needs more stack than `Case::STACK`, which is watched"),
        _ => bail!("ended with {status}"),
    }
    match reader.join() {
        Ok(bytes) => Ok(bytes?),
        Err(_) => bail!("the output could not be read"),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn shell(script: &str, limit: Duration) -> Result<Vec<u8>> {
        let mut shell = Command::new("sh");
        shell.args(["-c", script]).stdout(Stdio::piped());
        printed(&mut shell, limit)
    }

    #[test]
    fn what_is_printed_comes_back() {
        assert_eq!(shell("echo end", LIMIT).unwrap(), b"end\n");
    }

    #[test]
    fn a_bad_end_is_told_with_its_reason() {
        let message = |script| shell(script, LIMIT).unwrap_err().to_string();
        assert_eq!(message("exit 2"), "the constructor refuses its settings");
        assert_eq!(message("exit 3"), "the step panics");
        assert!(message("exit 4").contains("more stack"));
        assert!(message("exit 9").contains('9'));
    }

    #[test]
    fn an_image_that_hangs_is_ended() {
        let begun = Instant::now();
        let error = shell("exec sleep 20", Duration::from_millis(50)).unwrap_err();
        // Half of the sleep, for a machine that is busy.
        assert!(begun.elapsed() < Duration::from_secs(10));
        assert!(error.to_string().starts_with("not finished"), "{error}");
    }
}
