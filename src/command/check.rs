//! `rolltank check`: every mistake of a campaign at once, without identifying anything.

use std::io::Write;
use std::path::{Path, PathBuf};

use ::devices::InstrumentError;
use ::devices::port::{BY_ID_FOLDER, USB_SERIAL_FOLDER, adapter_latency_s, stable_name};
use ::devices::probe::ProbeReport;
use ::replay::{Note, Severity};
use clap::Args;
use serde_json::{Value, json};

use super::devices;
use super::failure::told;
use super::terminal::Terminal;
use super::{Exit, Failure};
use crate::campaign::{self, Campaign, FILE_NAME, Mistake};
use crate::pipeline::{self, PipelineError, Surveyed};

/// Schema of the JSON output; its number rises when a field changes its meaning.
const SCHEMA: &str = "rolltank.check/1";

/// What an adapter may hold bytes back [s] without a word about it.
const LONGEST_HELD_S: f64 = 2e-3;

/// Check the campaign file and read every recording; tells every mistake with its place
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: PathBuf,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
    /// Listen to each instrument for so long
    #[arg(long, value_name = "SECONDS", default_value_t = 2.0, value_parser = super::positive)]
    seconds: f64,
    /// Folder of the names that ports keep when they are replugged
    #[arg(long, value_name = "FOLDER", default_value = BY_ID_FOLDER)]
    by_id: PathBuf,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let (mut live, mut asked) = (Vec::new(), Vec::new());
    let (mistakes, unreadable, recordings) = match campaign::read(&arguments.campaign) {
        Err(mistakes) => (mistakes, Vec::new(), Vec::new()),
        Ok(campaign) => {
            let (mut unreadable, recordings) = survey(&campaign);
            asked = devices::ask_all(&campaign.live.devices, arguments.seconds);
            unreadable.extend(troubles(&campaign, &asked));
            live.clone_from(&campaign.live.devices);
            (campaign.unreachable_speeds(), unreadable, recordings)
        }
    };
    // The same codes with which a replay of this campaign would end.
    let exit = match (&mistakes[..], &unreadable[..], recordings.iter().any(has_lost_data)) {
        ([], [], false) => Exit::Done,
        ([], [], true) => Exit::Incomplete,
        ([], _, _) => Exit::Failed,
        _ => Exit::Usage,
    };
    let mut mistakes = [mistakes, unreadable].concat();
    mistakes.sort_by_key(|mistake| mistake.line);
    if arguments.json {
        let recordings: Vec<Value> = recordings.iter().map(surveyed_json).collect();
        let ok = mistakes.is_empty();
        let reports = live.iter().zip(&asked);
        let devices: Vec<Value> = reports
            .filter_map(|(device, report)| {
                let mut told = devices::report_json(device, report.as_ref().ok()?);
                told["stable_port"] = json!(stable_name(&device.port, &arguments.by_id));
                Some(told)
            })
            .collect();
        let report = json!({
            "schema": SCHEMA, "ok": ok, "mistakes": mistakes, "recordings": recordings,
            "devices": devices,
        });
        writeln!(out, "{report:#}")?;
        return Ok(exit);
    }
    for surveyed in &recordings {
        tell(out, surveyed)?;
    }
    for (device, report) in live.iter().zip(&asked) {
        if let Ok(report) = report {
            devices::tell(out, device, report)?;
        }
        let held_s = adapter_latency_s(&device.port, Path::new(USB_SERIAL_FOLDER));
        if let Some(held_s) = held_s.filter(|held_s| *held_s > LONGEST_HELD_S) {
            writeln!(
                out,
                "  note: the adapter of {} holds bytes back for {:.0} ms, and times are known no \
                 better; docs/60-rolltank.rules sets it to 1 ms at every plugging in",
                device.port.display(),
                held_s * 1e3
            )?;
        }
        if let Some(name) = stable_name(&device.port, &arguments.by_id) {
            writeln!(
                out,
                "  note: {} may be another instrument's after replugging; write port = \"{}\"",
                device.port.display(),
                name.display()
            )?;
        }
    }
    match exit {
        Exit::Usage => return Err(Failure::Campaign { mistakes }),
        Exit::Failed => return Err(Failure::Recordings { mistakes }),
        Exit::Done | Exit::Incomplete => {}
    }
    writeln!(out, "no mistake found")?;
    Ok(exit)
}

/// What is wrong with the instruments, each at the line of its device.
fn troubles(campaign: &Campaign, asked: &[Result<ProbeReport, InstrumentError>]) -> Vec<Mistake> {
    let found = asked.iter().flat_map(|asked| match asked {
        Ok(report) => report.troubles.clone(),
        Err(error) => vec![error.clone()],
    });
    let file = campaign.folder.join(FILE_NAME).display().to_string();
    let mistake = |error: InstrumentError| Mistake {
        file: file.clone(),
        line: campaign.live.line_of(&error),
        message: error.to_string(),
        hint: error.hint(),
    };
    found.map(mistake).collect()
}

fn has_lost_data(surveyed: &Surveyed) -> bool {
    surveyed.notes.iter().any(|note| note.severity == Severity::Lost)
}

fn survey(campaign: &Campaign) -> (Vec<Mistake>, Vec<Surveyed>) {
    let mut unreadable = Vec::new();
    let mut recordings = Vec::new();
    let terminal = Terminal::new();
    let surveyed = pipeline::survey(campaign, &mut |recording, done, total| {
        terminal.show(done, total, recording.to_owned());
    });
    for (recording, surveyed) in campaign.recordings.iter().zip(surveyed) {
        match surveyed {
            Ok(surveyed) => recordings.push(surveyed),
            Err(error) => unreadable.push(mistake(campaign, recording.line, &error)),
        }
    }
    (unreadable, recordings)
}

fn mistake(campaign: &Campaign, line: Option<usize>, error: &PipelineError) -> Mistake {
    let (message, hints) = told(error);
    let file = campaign.folder.join(FILE_NAME).display().to_string();
    Mistake { file, line, message, hint: hints.into_iter().next().or_else(|| error.hint()) }
}

fn tell(out: &mut dyn Write, surveyed: &Surveyed) -> std::io::Result<()> {
    let Surveyed { recording, start_s, end_s, channels, notes } = surveyed;
    let duration_s = end_s - start_s;
    write!(out, "{recording}: {duration_s:.1} s")?;
    for (quantity, n_samples) in channels {
        write!(out, ", {} {n_samples} samples", quantity.name())?;
    }
    writeln!(out)?;
    for note in notes {
        writeln!(out, "  {}: {}", severity(note), note.message)?;
    }
    Ok(())
}

fn surveyed_json(surveyed: &Surveyed) -> Value {
    let Surveyed { recording, start_s, end_s, channels, notes } = surveyed;
    let channels: Vec<Value> = channels
        .iter()
        .map(|(quantity, n)| json!({"channel": quantity.name(), "n_samples": n}))
        .collect();
    let notes: Vec<Value> = notes
        .iter()
        .map(|note| json!({"severity": severity(note), "message": note.message}))
        .collect();
    json!({
        "recording": recording, "start_s": start_s, "end_s": end_s,
        "channels": channels, "notes": notes,
    })
}

fn severity(note: &Note) -> &'static str {
    match note.severity {
        Severity::Mended => "mended",
        Severity::Lost => "lost",
    }
}
