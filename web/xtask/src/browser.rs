//! Headless Chromium, driven through the DevTools protocol over two pipes.
//!
//! Each message is JSON, terminated by a zero byte. A shell connects the pipes to the descriptors
//! that Chromium uses, 3 and 4.

use crate::{failed, Ended};
use serde_json::{json, Value};
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

/// Maximum time that a page may take to answer.
const PATIENCE: Duration = Duration::from_secs(240);

/// A browser with one page.
pub struct Browser {
    process: Child,
    to: ChildStdin,
    from: Receiver<Value>,
    session: String,
    next: u64,
    profile: PathBuf,
    /// URLs that the page has requested.
    pub requests: Vec<String>,
    /// Console errors and exceptions.
    pub errors: Vec<String>,
}

/// Names of the browser program, the most common first.
const NAMES: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

impl Browser {
    /// Starts Chromium with an empty page.
    pub fn start() -> Result<Self, Ended> {
        let has = |name: &&str| {
            let version = Command::new(name).arg("--version").output();
            version.is_ok_and(|output| output.status.success())
        };
        let Some(name) = NAMES.into_iter().find(has) else {
            let why = "Chromium is not installed (Debian: chromium)";
            return Err(Ended::Skipped(why.to_owned()));
        };
        let profile = std::env::temp_dir().join(format!("bowden-web-{}", std::process::id()));
        let mut process = Command::new("sh")
            .arg("-c")
            .arg("exec \"$0\" \"$@\" 3<&0 4>&1 0</dev/null 1>/dev/null 2>/dev/null")
            .arg(name)
            .args(["--headless", "--no-sandbox", "--disable-gpu"])
            .args(["--disable-background-networking", "--no-first-run"])
            .args(["--disable-component-update", "--disable-sync"])
            .arg("--remote-debugging-pipe")
            .arg(format!("--user-data-dir={}", profile.display()))
            .arg("about:blank")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let (Some(to), Some(out)) = (process.stdin.take(), process.stdout.take()) else {
            return Err(failed("Chromium has no pipes"));
        };
        let (send, from) = std::sync::mpsc::channel();
        std::thread::spawn(move || {
            let mut reader = BufReader::new(out);
            let mut message = Vec::new();
            while reader
                .read_until(0, &mut message)
                .is_ok_and(|read| read > 0)
            {
                message.pop();
                if let Ok(value) = serde_json::from_slice(&message) {
                    if send.send(value).is_err() {
                        break;
                    }
                }
                message.clear();
            }
        });
        let mut browser = Self {
            process,
            to,
            from,
            session: String::new(),
            next: 0,
            profile,
            requests: Vec::new(),
            errors: Vec::new(),
        };
        browser.attach()?;
        Ok(browser)
    }

    fn attach(&mut self) -> Result<(), Ended> {
        let targets = self.call("Target.getTargets", json!({}))?;
        let all = targets["targetInfos"]
            .as_array()
            .cloned()
            .unwrap_or_default();
        let page = all.iter().find(|one| one["type"] == "page");
        let Some(page) = page else {
            return Err(failed("Chromium has no page"));
        };
        let options = json!({"targetId": page["targetId"], "flatten": true});
        let attached = self.call("Target.attachToTarget", options)?;
        attached["sessionId"]
            .as_str()
            .unwrap_or_default()
            .clone_into(&mut self.session);
        for domain in ["Page", "Runtime", "Network", "Log", "DOM"] {
            self.call(&format!("{domain}.enable"), json!({}))?;
        }
        // Also report the requests and errors of the worker.
        let options = json!({"autoAttach": true, "waitForDebuggerOnStart": false, "flatten": true});
        self.call("Target.setAutoAttach", options)?;
        Ok(())
    }

    /// Calls a method and waits for its answer.
    pub fn call(&mut self, method: &str, parameters: Value) -> Result<Value, Ended> {
        let session = self.session.clone();
        self.call_in(&session, method, parameters)
    }

    fn call_in(&mut self, session: &str, method: &str, parameters: Value) -> Result<Value, Ended> {
        let id = self.send(session, method, parameters)?;
        let begun = Instant::now();
        loop {
            let left = PATIENCE.saturating_sub(begun.elapsed());
            match self.from.recv_timeout(left) {
                Ok(message) if message["id"] == id => {
                    return match message.get("error") {
                        Some(error) => Err(failed(format!("{method}: {error}"))),
                        None => Ok(message["result"].clone()),
                    };
                }
                Ok(message) => self.hear(&message)?,
                Err(RecvTimeoutError::Timeout) => {
                    return Err(failed(format!("{method}: no answer within {PATIENCE:?}")))
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(failed(format!("{method}: Chromium has ended")))
                }
            }
        }
    }

    fn send(&mut self, session: &str, method: &str, parameters: Value) -> Result<u64, Ended> {
        self.next += 1;
        let mut message = json!({"id": self.next, "method": method, "params": parameters});
        if !session.is_empty() {
            message["sessionId"] = json!(session);
        }
        let mut bytes = serde_json::to_vec(&message)?;
        bytes.push(0);
        self.to.write_all(&bytes)?;
        Ok(self.next)
    }

    fn hear(&mut self, message: &Value) -> Result<(), Ended> {
        let of = &message["params"];
        match message["method"].as_str().unwrap_or_default() {
            "Target.attachedToTarget" => {
                let session = of["sessionId"].as_str().unwrap_or_default().to_owned();
                for domain in ["Network", "Runtime", "Log"] {
                    self.send(&session, &format!("{domain}.enable"), json!({}))?;
                }
            }
            "Network.requestWillBeSent" => {
                let url = of["request"]["url"].as_str().unwrap_or_default();
                self.requests.push(url.to_owned());
            }
            "Runtime.exceptionThrown" => self.errors.push(of["exceptionDetails"].to_string()),
            "Runtime.consoleAPICalled" if of["type"] == "error" => {
                self.errors.push(of["args"].to_string());
            }
            "Log.entryAdded" if of["entry"]["level"] == "error" => {
                self.errors.push(of["entry"].to_string());
            }
            _ => {}
        }
        Ok(())
    }

    /// The value of an expression, which may be a promise.
    pub fn value(&mut self, expression: &str) -> Result<Value, Ended> {
        let options = json!({
            "expression": expression, "awaitPromise": true, "returnByValue": true, "userGesture": true
        });
        let found = self.call("Runtime.evaluate", options)?;
        match found.get("exceptionDetails") {
            Some(thrown) => Err(failed(format!("{expression}: {thrown}"))),
            None => Ok(found["result"]["value"].clone()),
        }
    }

    /// Waits until an expression is true.
    pub fn until(&mut self, expression: &str) -> Result<(), Ended> {
        let begun = Instant::now();
        while self.value(expression)? != Value::Bool(true) {
            if begun.elapsed() > PATIENCE {
                let page = self.value("document.body.innerText")?;
                return Err(failed(format!(
                    "not within {PATIENCE:?}: {expression}\n{page}"
                )));
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        Ok(())
    }

    /// Opens a page and waits until its script runs.
    pub fn open(&mut self, url: &str) -> Result<(), Ended> {
        self.call("Page.navigate", json!({"url": url}))?;
        self.until("window.bowden !== undefined")
    }

    /// Sets the files of a file input.
    pub fn choose(&mut self, field: &str, files: &[PathBuf]) -> Result<(), Ended> {
        let document = self.call("DOM.getDocument", json!({}))?;
        let options = json!({"nodeId": document["root"]["nodeId"], "selector": field});
        let node = self.call("DOM.querySelector", options)?;
        let files: Vec<String> = files.iter().map(|f| f.display().to_string()).collect();
        let options = json!({"nodeId": node["nodeId"], "files": files});
        self.call("DOM.setFileInputFiles", options)?;
        Ok(())
    }

    /// Sets the width of the page.
    pub fn resize(&mut self, width: u32, height: u32) -> Result<(), Ended> {
        let options = json!({
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false
        });
        self.call("Emulation.setDeviceMetricsOverride", options)?;
        Ok(())
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.send("", "Browser.close", json!({}));
        std::thread::sleep(Duration::from_millis(300));
        let _ = self.process.kill();
        let _ = self.process.wait();
        let _ = std::fs::remove_dir_all(&self.profile);
    }
}
