//! `rolltank bench`: what the program can do on this machine, measured.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::{Args, ValueEnum};

use super::{Exit, Failure};
use crate::bench::ranks::Ranks;
use crate::bench::speed::{self, Figure};
use crate::bench::{Calibration, acquisition, calibrate, diagnosis, live, machine, page};
use crate::live::LiveError;

/// Measure speed and memory on this machine, and how often the bands hold the truth
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// What to measure
    #[arg(value_enum, default_value_t = Subject::All)]
    subject: Subject,
    /// Runs that the bands are judged over
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u64).range(5..))]
    runs: u64,
    /// Seed of the drawn runs
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Seconds for which the page of eight channels is left open for a browser
    #[arg(long, value_name = "SECONDS", default_value_t = 0)]
    hold: u64,
    /// Folder in which the campaign of a thousand runs, or that to be diagnosed, is written and
    /// left; new or empty
    #[arg(long, value_name = "FOLDER", required_if_eq("subject", "diagnosis"))]
    campaign: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Subject {
    /// Time and memory
    Speed,
    /// From the end of a run to its report, at a virtual tank
    Live,
    /// Bytes to the live page, and processor time by the number of pages
    Page,
    /// Coverage and rank histograms over drawn runs
    Calibration,
    /// Time of a diagnosis of twelve passes, and of one run
    Diagnosis,
    /// Everything
    All,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    writeln!(out, "machine: {}\n", machine())?;
    if arguments.subject == Subject::Diagnosis {
        if let Some(folder) = &arguments.campaign {
            super::fresh_folder::require_fresh(folder)?;
            told(out, diagnosis::of_twelve_passes(folder).map_err(Failure::Bench)?)?;
        }
        return Ok(Exit::Done);
    }
    if matches!(arguments.subject, Subject::Live | Subject::All) {
        told(out, in_a_folder(live::report_latency)?)?;
        writeln!(out)?;
    }
    if matches!(arguments.subject, Subject::Page | Subject::All) {
        let hold = Duration::from_secs(arguments.hold);
        let figures = page::page(hold, &mut |address| {
            writeln!(out, "page of eight channels: http://{address}/")?;
            out.flush()
        })?;
        told(out, figures)?;
        told(out, in_a_folder(acquisition::acquisition)?)?;
        writeln!(out)?;
    }
    if matches!(arguments.subject, Subject::Speed | Subject::All) {
        told(out, speed::one_decay())?;
        told(out, speed::long_decays())?;
        told(out, speed::against_the_chain())?;
        if let Some(folder) = &arguments.campaign {
            super::fresh_folder::require_fresh(folder)?;
            let figures = speed::campaign_of_a_thousand(folder).map_err(Failure::Bench)?;
            told(out, figures)?;
        }
        writeln!(out)?;
    }
    if matches!(arguments.subject, Subject::Calibration | Subject::All) {
        let n_campaigns = (arguments.runs / 5) as usize;
        write!(out, "{}", table(&calibrate(n_campaigns, arguments.seed)))?;
    }
    Ok(Exit::Done)
}

/// Measured in a folder of its own, which is removed.
fn in_a_folder(
    measure: impl Fn(&Path) -> Result<Vec<Figure>, LiveError>,
) -> Result<Vec<Figure>, Failure> {
    let folder = std::env::temp_dir().join(format!("rolltank-bench-{}", std::process::id()));
    super::fresh_folder::require_fresh(&folder)?;
    let failed = |source| Failure::File { path: folder.clone(), source };
    std::fs::create_dir_all(&folder).map_err(failed)?;
    let measured = measure(&folder);
    std::fs::remove_dir_all(&folder).map_err(failed)?;
    Ok(measured?)
}

fn told(out: &mut dyn Write, figures: Vec<Figure>) -> io::Result<()> {
    for Figure { name, value } in figures {
        writeln!(out, "{name}: {value}")?;
    }
    out.flush()
}

/// Coverage and rank histograms, line by line.
fn table(calibration: &Calibration) -> String {
    let mut text = String::new();
    let parts = [
        ("rolltank's posterior", &calibration.ranks),
        ("the paper's hyperpriors as printed, plain fit of the scatter", &calibration.paper),
    ];
    for (title, all) in parts {
        let _ = writeln!(text, "{title}");
        let _ =
            writeln!(text, "{:18} {:>5} {:>7} {:>7} {:>8}  ranks", "", "runs", "95 %", "50 %", "p");
        for ranks in all {
            let _ = writeln!(text, "{}", line(ranks));
        }
        let _ = writeln!(text);
    }
    let _ = writeln!(text, "refused: {} runs", calibration.refused.len());
    for reason in calibration.refused.iter().take(3) {
        let _ = writeln!(text, "  {reason}");
    }
    text
}

fn line(ranks: &Ranks) -> String {
    format!(
        "{:18} {:>5} {:>6.1}% {:>6.1}% {:>8.4}  {}",
        ranks.name,
        ranks.below.len(),
        100.0 * ranks.coverage(0.95),
        100.0 * ranks.coverage(0.5),
        ranks.uniformity(),
        ranks.bars()
    )
}
