//! How a command ended, as the shell sees it.

use std::process::ExitCode;

/// The four exit codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// Everything asked for was done.
    Done,
    /// It could not be done.
    Failed,
    /// The command line or the campaign file is wrong.
    Usage,
    /// It was done, but data was lost or runs were rejected that were asked for.
    Incomplete,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(match exit {
            Exit::Done => 0,
            Exit::Failed => 1,
            Exit::Usage => 2,
            Exit::Incomplete => 3,
        })
    }
}
