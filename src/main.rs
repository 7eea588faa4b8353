//! The command line.

use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

use clap::Parser;
use rolltank::command::{self, CommandLine, Exit, LogFormat};
use tracing_subscriber::EnvFilter;

fn main() -> ExitCode {
    let line = CommandLine::parse();
    let filter = EnvFilter::try_from_default_env();
    let filter = filter.unwrap_or_else(|_| EnvFilter::new(line.log_filter()));
    let logging = tracing_subscriber::fmt().with_env_filter(filter).with_writer(io::stderr);
    let logging = logging.with_ansi(io::stderr().is_terminal()).with_target(false);
    match line.log_format() {
        LogFormat::Json => logging.json().flatten_event(true).init(),
        LogFormat::Text => logging.without_time().init(),
    }
    let mut out = io::BufWriter::new(io::stdout().lock());
    let done = command::run(&line, &mut out).and_then(|exit| Ok(out.flush().map(|()| exit)?));
    match done {
        Ok(exit) => exit.into(),
        // The reader has seen enough, as in `rolltank identify day | head`.
        Err(failure) if failure.is_broken_pipe() => Exit::Done.into(),
        Err(failure) => {
            // Nothing is left to report to when standard error is gone as well.
            let _ = failure.tell(&mut io::stderr().lock());
            failure.exit().into()
        }
    }
}
