//! Long work outside the interpreter on separate threads. Ctrl-C stops the work.
//!
//! The calling thread waits, passes the messages of the work to Python, and checks for signals
//! twenty times per second. If a signal handler or the caller's function raises an exception, the
//! call returns at once. The work then ends at its next message.

use crate::failure;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{channel, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Longest time between two checks for signals.
const LOOK: Duration = Duration::from_millis(50);

enum Message<T> {
    Told(String),
    Done(std::thread::Result<T>),
}

/// Panic payload that ends the stopped work.
struct Stopped;

/// The threads of this process. A forked process has none of its parent's threads.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

fn pool(threads: Option<usize>) -> PyResult<Arc<ThreadPool>> {
    let build = |threads: usize| {
        let builder = ThreadPoolBuilder::new().num_threads(threads);
        let built = builder.thread_name(|k| format!("bowden-{k}")).build();
        built
            .map(Arc::new)
            .map_err(|e| PyRuntimeError::new_err(e.to_string()))
    };
    if let Some(threads) = threads {
        return build(threads);
    }
    let mut kept = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let own = std::process::id();
    if let Some((_, pool)) = kept.as_ref().filter(|(process, _)| *process == own) {
        return Ok(Arc::clone(pool));
    }
    let fresh = build(0)?;
    // Not dropped: that would wait for threads that the fork has not taken along.
    std::mem::forget(kept.replace((own, Arc::clone(&fresh))));
    Ok(fresh)
}

/// Runs `work` on `threads` threads; `None` means all threads of the machine. `progress` receives
/// the completed fraction (0 to 1, `None` if unknown) and the current task.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    threads: Option<usize>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&dyn Fn(&str)) -> T + Send + 'static,
) -> PyResult<T> {
    if threads == Some(0) {
        return Err(failure::plain("threads=0: one or more are allowed"));
    }
    let pool = pool(threads)?;
    let stop = Arc::new(AtomicBool::new(false));
    let (send, receive) = channel();
    let stopped = Arc::clone(&stop);
    let worker = move || {
        let tell = |what: &str| {
            if stopped.load(Ordering::Relaxed) {
                resume_unwind(Box::new(Stopped));
            }
            // Nobody listens any more where the caller has gone.
            let _ = send.send(Message::Told(what.to_owned()));
        };
        let done = catch_unwind(AssertUnwindSafe(|| work(&tell)));
        let _ = send.send(Message::Done(done));
    };
    pool.spawn(worker);
    let done = listen(py, &Mutex::new(receive), progress);
    if done.is_err() {
        stop.store(true, Ordering::Relaxed);
    }
    match done? {
        Ok(value) => Ok(value),
        Err(panic) => Err(PyRuntimeError::new_err(words(panic.as_ref()))),
    }
}

fn listen<T: Send>(
    py: Python<'_>,
    receive: &Mutex<Receiver<Message<T>>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<std::thread::Result<T>> {
    loop {
        let heard = py.detach(|| {
            let receive = receive.lock().unwrap_or_else(PoisonError::into_inner);
            receive.recv_timeout(LOOK)
        });
        py.check_signals()?;
        match heard {
            Ok(Message::Done(done)) => return Ok(done),
            Ok(Message::Told(what)) => {
                if let Some(progress) = progress {
                    progress.call1((bowden_cli::share(&what), what))?;
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err(
                    "the work has ended without an answer",
                ));
            }
        }
    }
}

fn words(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "the work has ended without an answer".to_owned())
}
