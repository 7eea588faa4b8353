//! Progress on standard error: a bar on a terminal, nothing in a pipe or a log file.

use std::io::{self, IsTerminal};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// The progress of one command.
pub(super) struct Terminal {
    bar: ProgressBar,
}

impl Terminal {
    pub(super) fn new() -> Self {
        let bar = ProgressBar::no_length();
        if !io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}")
            .expect("the template is a constant");
        bar.set_style(style);
        Self { bar }
    }

    /// How much has been done, in any unit, and on what.
    pub(super) fn show(&self, done: u64, total: u64, message: String) {
        self.bar.set_length(total.max(1));
        self.bar.set_position(done.min(total));
        self.bar.set_message(message);
    }

    /// A line above the bar, on a terminal only.
    pub(super) fn line(&self, text: &str) {
        self.bar.println(text);
    }

    /// Lets `tell` write to standard error without tearing the bar.
    pub(super) fn pause<T>(&self, tell: impl FnOnce() -> T) -> T {
        self.bar.suspend(tell)
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
