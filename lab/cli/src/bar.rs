//! The progress bar on a terminal.
//!
//! Without a terminal, in a web page, a bar does nothing, because `indicatif` would add the
//! bindings of a clock to the page.

#[cfg(not(target_family = "wasm"))]
pub use indicatif::{ProgressBar, ProgressStyle};

#[cfg(target_family = "wasm")]
pub use absent::{ProgressBar, ProgressStyle};

#[cfg(target_family = "wasm")]
mod absent {
    use std::borrow::Cow;
    use std::fmt::Error;
    use std::time::Duration;

    /// A bar that is not shown.
    pub struct ProgressBar;

    /// Its style.
    pub struct ProgressStyle;

    impl ProgressBar {
        pub fn new(_: u64) -> Self {
            Self
        }

        pub fn hidden() -> Self {
            Self
        }

        pub fn set_style(&self, _: ProgressStyle) {}

        pub fn set_message(&self, _: impl Into<Cow<'static, str>>) {}

        pub fn set_position(&self, _: u64) {}

        pub fn inc(&self, _: u64) {}

        pub fn position(&self) -> u64 {
            0
        }

        pub fn enable_steady_tick(&self, _: Duration) {}

        pub fn finish_and_clear(&self) {}
    }

    impl ProgressStyle {
        pub fn with_template(_: &str) -> Result<Self, Error> {
            Ok(Self)
        }

        pub fn progress_chars(self, _: &str) -> Self {
            self
        }
    }
}
