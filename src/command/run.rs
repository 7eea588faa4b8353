//! `rolltank run`: the daemon, until a signal ends it.

use std::io::Write;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Args, ValueEnum};
use devices::clock::WallClock;

use super::{Exit, Failure, heap, tables};
use crate::live::{self, DaemonOptions};
use crate::page::{Board, Listen, orders};

/// Seconds in a minute.
const MINUTE_S: f64 = 60.0;

/// Attach to the instruments, record, find runs, identify each as it ends, until SIGTERM
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: PathBuf,
    /// Minutes after which a recording gives way to the next, at the first rest of the model
    #[arg(long, value_name = "MINUTES", default_value_t = 30.0, value_parser = super::positive)]
    rotate: f64,
    /// Address and port of the page, of /healthz, /readyz, /metrics and /status
    #[arg(long, value_name = "ADDRESS", default_value = Listen::DEFAULT)]
    listen: SocketAddr,
    /// File whose first line requests must carry as `Authorization: Bearer ...`
    #[arg(long, value_name = "FILE")]
    token_file: Option<PathBuf>,
    /// How log lines on standard error are written
    #[arg(long, value_enum, default_value_t = LogFormat::Text)]
    pub(super) log_format: LogFormat,
    /// Seconds of the instruments' own time in one second, for simulated instruments
    #[arg(long, hide = true, default_value_t = 1.0, value_parser = super::positive)]
    clock_speed: f64,
}

/// How log lines are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum LogFormat {
    /// For people
    Text,
    /// One JSON object a line
    Json,
}

/// The token in a file, where there is one.
pub(super) fn token(file: Option<&Path>) -> Result<Option<String>, Failure> {
    let Some(path) = file else { return Ok(None) };
    let failed = |source| Failure::File { path: path.to_owned(), source };
    let text = std::fs::read_to_string(path).map_err(failed)?;
    let token = text.lines().next().unwrap_or_default().trim().to_owned();
    if token.is_empty() {
        return Err(failed(std::io::Error::other("its first line is no token")));
    }
    Ok(Some(token))
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    heap::go_on_with(heap::OF_A_DAY);
    let options = DaemonOptions {
        folder: arguments.campaign.clone(),
        rotate_s: MINUTE_S * arguments.rotate,
        listen: Some(Listen {
            address: arguments.listen,
            token: token(arguments.token_file.as_deref())?,
        }),
    };
    let clock = Arc::new(WallClock::start_at_speed(arguments.clock_speed));
    let results = live::run(&options, &clock, orders(), &Board::default())?;
    if let Some(results) = results {
        tables::human(out, &results)?;
    }
    Ok(Exit::Done)
}
