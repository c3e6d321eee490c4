//! The interface to JavaScript: three functions imported from the host, and three exported to it.
//!
//! The page calls `room` to reserve a number of bytes, writes a request there, and calls `ask`. The
//! answer is at `answer_at` until the next `ask`. A worker is one thread and never calls back from
//! within `ask`, so the state is never borrowed twice; if it were, `ask` would do nothing.

use crate::Engine;
use std::cell::RefCell;

#[link(wasm_import_module = "host")]
extern "C" {
    /// One progress message, as UTF-8: the completed fraction (empty if the message is not a step),
    /// a tab, and the message.
    fn tell(at: *const u8, length: usize);
    /// The message of a panic in this program, as UTF-8.
    fn fault(at: *const u8, length: usize);
    /// Seconds on the host's clock.
    fn now() -> f64;
}

#[derive(Default)]
struct State {
    engine: Engine,
    request: Vec<u8>,
    answer: Vec<u8>,
}

thread_local! {
    static STATE: RefCell<State> = RefCell::default();
}

/// Reserves this many bytes for the next request.
#[no_mangle]
pub extern "C" fn room(length: usize) -> *mut u8 {
    STATE.with(|state| match state.try_borrow_mut() {
        Ok(mut state) => {
            state.request = vec![0; length];
            state.request.as_mut_ptr()
        }
        Err(_) => std::ptr::null_mut(),
    })
}

/// Answers the request; returns the length of the answer.
#[no_mangle]
pub extern "C" fn ask() -> usize {
    std::panic::set_hook(Box::new(|info| send(fault, &info.to_string())));
    // SAFETY: the host's function has no arguments and accesses no memory of this program.
    bowden_lab::facts::set_clock(|| unsafe { now() });
    STATE.with(|state| match state.try_borrow_mut() {
        Ok(mut state) => {
            let request = std::mem::take(&mut state.request);
            let answer = state.engine.answer(&request, &progress);
            state.answer = answer.bytes();
            state.answer.len()
        }
        Err(_) => 0,
    })
}

/// The address of the answer.
#[no_mangle]
pub extern "C" fn answer_at() -> *const u8 {
    STATE.with(|state| match state.try_borrow() {
        Ok(state) => state.answer.as_ptr(),
        Err(_) => std::ptr::null(),
    })
}

fn progress(what: &str) {
    let share = bowden_cli::share(what).map_or_else(String::new, |share| share.to_string());
    send(tell, &format!("{share}\t{what}"));
}

fn send(to: unsafe extern "C" fn(*const u8, usize), text: &str) {
    // SAFETY: the host reads `length` bytes of a text that lives until the call returns.
    unsafe { to(text.as_ptr(), text.len()) }
}
