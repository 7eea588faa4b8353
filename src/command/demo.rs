//! `rolltank demo`: a day in the virtual tank, from serial ports to the report, without hardware.

use std::io::Write;
use std::net::SocketAddr;
use std::path::PathBuf;

use clap::Args;

use super::fresh_folder::{next_free, require_fresh};
use super::terminal::Terminal;
use super::{Exit, Failure, tables};
use crate::campaign;
use crate::live::{self, DayProgress};
use crate::page::Listen;
use crate::pipeline;
use crate::tank::Scenario;

/// Run a day of the paper's tests through emulated instruments on real ports, and report it
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder for the campaign: new or empty [default: rolltank-demo, or the next free number]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Seconds of the tank that pass in one second
    #[arg(long, value_name = "X", default_value_t = 20.0, value_parser = super::positive)]
    speed: f64,
    /// Address and port of the page; port 0 is any free one
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:0")]
    listen: SocketAddr,
    /// Seed of everything random
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let folder = arguments.output.clone().unwrap_or_else(|| next_free("rolltank-demo"));
    require_fresh(&folder)?;
    let scenario = Scenario::builtin("short-day").expect("the short day is built in");
    writeln!(out, "campaign: {} (virtual tank)", folder.display())?;
    out.flush()?;
    let terminal = Terminal::new();
    let mut is_told = false;
    let ended = live::virtual_day(
        &scenario,
        arguments.seed,
        &folder,
        (arguments.speed, Some(Listen { address: arguments.listen, token: None })),
        &mut |DayProgress { played_s, total_s, status }| {
            if let Some(page) = status.page.filter(|_| !std::mem::replace(&mut is_told, true)) {
                let told = terminal.pause(|| {
                    writeln!(out, "page while the day lasts: http://{page}/")?;
                    out.flush()
                });
                // Who cannot read it is told so by what follows.
                told.ok();
            }
            let (condition, n_runs) = (&status.condition, status.runs.n_identified);
            let message = format!("{condition}, {n_runs} runs");
            terminal.show(played_s as u64, total_s as u64, message);
        },
    )?;
    drop(terminal);
    let results = ended.results.unwrap_or_default();
    tables::human(out, &results)?;
    let campaign = campaign::read(&folder)?;
    let page = pipeline::results_folder(&campaign).join(pipeline::REPORT_PAGE);
    writeln!(out, "\nreport: {}", page.display())?;
    Ok(if results.runs.is_empty() { Exit::Incomplete } else { Exit::Done })
}
