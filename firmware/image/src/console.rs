//! Lines to the host, without `core::fmt`: that would be in every image.

use core::ffi::CStr;
use semihosting::sys::arm_compat::sys_write0;

const LONGEST: usize = 48;

/// A line that is being put together; what does not fit is left out.
pub(crate) struct Line {
    bytes: [u8; LONGEST],
    length: usize,
}

impl Line {
    pub(crate) fn new() -> Self {
        Self {
            bytes: [0; LONGEST],
            length: 0,
        }
    }

    fn push(&mut self, byte: u8) {
        // Two places are for the end of the line and of the string.
        if self.length < LONGEST - 2 {
            if let Some(place) = self.bytes.get_mut(self.length) {
                *place = byte;
                self.length += 1;
            }
        }
    }

    pub(crate) fn text(mut self, text: &str) -> Self {
        for byte in text.bytes() {
            self.push(byte);
        }
        self
    }

    /// A number in hexadecimal digits, and a space.
    pub(crate) fn hex(mut self, number: u32) -> Self {
        for place in (0..8).rev() {
            let digit = (number >> (4 * place) & 0xf) as u8;
            self.push(if digit < 10 {
                b'0' + digit
            } else {
                b'a' - 10 + digit
            });
        }
        self.push(b' ');
        self
    }

    pub(crate) fn print(mut self) {
        if let Some(end) = self.bytes.get_mut(self.length) {
            *end = b'\n';
        }
        if let Ok(line) = CStr::from_bytes_until_nul(&self.bytes) {
            sys_write0(line);
        }
    }
}
