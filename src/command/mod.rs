//! The commands of `rolltank`, one file each.

mod bench;
mod calibrate;
mod calibrating;
mod check;
mod daemon_page;
mod demo;
mod devices;
mod diagnose;
mod exit;
mod export;
mod failure;
mod fresh_folder;
mod heap;
mod identify;
mod import;
mod method;
mod reference;
mod replay;
mod replaying;
mod report;
mod run;
mod simulate;
mod tables;
mod terminal;
mod zero;

use std::io::Write;

use clap::{Parser, Subcommand};

pub use exit::Exit;
pub use failure::Failure;
pub use run::LogFormat;

/// Roll damping from recorded roll tests, run by run and against Froude number.
#[derive(Debug, Parser)]
#[command(name = "rolltank", version, arg_required_else_help = true)]
#[command(after_help = "Exit codes: 0 done; 1 failed; 2 wrong usage or campaign file; \
    3 finished, but data was lost, or a listed recording or the whole campaign gave no run.\n\
    Stretches that are rejected beside the runs of a recording are no failure.")]
pub struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Demo(demo::Arguments),
    Check(check::Arguments),
    Run(run::Arguments),
    Devices(devices::Arguments),
    Zero(zero::Arguments),
    Calibrate(calibrate::Arguments),
    Replay(replay::Arguments),
    Identify(identify::Arguments),
    Diagnose(diagnose::Arguments),
    Report(report::Arguments),
    Export(export::Arguments),
    Simulate(simulate::Arguments),
    Import(import::Arguments),
    Reference(reference::Arguments),
    Bench(bench::Arguments),
}

impl CommandLine {
    /// What is logged when nothing else is asked for: a daemon tells what it does.
    pub fn log_filter(&self) -> &'static str {
        match self.command {
            Command::Run(_) => "info",
            // At twenty times its pace a hiccup of the computer looks like a silent instrument.
            Command::Demo(_) => "error,rolltank::live::attached=off",
            _ => "warn",
        }
    }

    /// How log lines are to be written.
    pub fn log_format(&self) -> LogFormat {
        match &self.command {
            Command::Run(arguments) => arguments.log_format,
            _ => LogFormat::Text,
        }
    }
}

/// A number above zero from the command line.
fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "expected a number above 0, such as 1 or 60".to_owned())
}

/// Does what the command line asks for; results go to `out`, progress to standard error.
///
/// # Errors
/// [`Failure`], with its exit code and its hints.
pub fn run(line: &CommandLine, out: &mut dyn Write) -> Result<Exit, Failure> {
    match &line.command {
        Command::Demo(arguments) => demo::run(arguments, out),
        Command::Check(arguments) => check::run(arguments, out),
        Command::Run(arguments) => run::run(arguments, out),
        Command::Devices(arguments) => devices::run(arguments, out),
        Command::Zero(arguments) => zero::run(arguments, out),
        Command::Calibrate(arguments) => calibrate::run(arguments, out),
        Command::Replay(arguments) => replay::run(arguments, out),
        Command::Identify(arguments) => identify::run(arguments, out),
        Command::Diagnose(arguments) => diagnose::run(arguments, out),
        Command::Report(arguments) => report::run(arguments, out),
        Command::Export(arguments) => export::run(arguments, out),
        Command::Simulate(arguments) => simulate::run(arguments, out),
        Command::Import(arguments) => import::run(arguments, out),
        Command::Reference(arguments) => reference::run(arguments, out),
        Command::Bench(arguments) => bench::run(arguments, out),
    }
}
