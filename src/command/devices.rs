//! `rolltank devices`: ports, profiles, and what the instruments of a campaign or one alone read.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;

use ::devices::InstrumentError;
use ::devices::clock::{Clock, WallClock};
use ::devices::port::{BY_ID_FOLDER, found_ports};
use ::devices::probe::{ChannelReport, FieldReport, ProbeReport, probe};
use ::devices::profile::{profile, profiles};
use ::devices::setup::{DeviceConfig, DeviceSetup};
use clap::Args;
use serde_json::{Value, json};

use super::{Exit, Failure};
use crate::campaign;

/// Schema of the JSON output; its number rises when a field changes its meaning.
const SCHEMA: &str = "rolltank.devices/1";

/// List ports and profiles; with a campaign or a port, ask the instruments what they read
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: Option<PathBuf>,
    /// Ask one instrument alone at this port
    #[arg(long, requires = "profile", conflicts_with = "campaign")]
    port: Option<PathBuf>,
    /// Profile of that instrument
    #[arg(long, requires = "port", value_name = "NAME")]
    profile: Option<String>,
    /// Settings that differ from the profile's, such as 'stations = [2], command = 40'
    #[arg(long, requires = "port", value_name = "SETTINGS", default_value = "")]
    settings: String,
    /// Bits per second, where they differ from the profile's
    #[arg(long, requires = "port")]
    baud: Option<u32>,
    /// Listen to each instrument for so long
    #[arg(long, value_name = "SECONDS", default_value_t = 2.0, value_parser = super::positive)]
    seconds: f64,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    if let (Some(port), Some(profile)) = (&arguments.port, &arguments.profile) {
        return ask_one(arguments, port, profile, out);
    }
    let Some(folder) = &arguments.campaign else { return list(arguments.json, out) };
    let campaign = campaign::read(folder)?;
    let asked = ask_all(&campaign.live.devices, arguments.seconds);
    let mut exit = Exit::Done;
    let mut all = Vec::new();
    for (device, report) in campaign.live.devices.iter().zip(asked) {
        let report = report.map_err(|source| Failure::Instrument { source })?;
        if !report.troubles.is_empty() || !report.linked {
            exit = Exit::Failed;
        }
        if arguments.json {
            all.push(report_json(device, &report));
        } else {
            tell(out, device, &report)?;
            tell_troubles(out, &report)?;
        }
    }
    if arguments.json {
        writeln!(out, "{:#}", json!({"schema": SCHEMA, "devices": all}))?;
    }
    Ok(exit)
}

/// One instrument that no campaign names: every field that it delivers, as it says it.
fn ask_one(
    arguments: &Arguments,
    port: &Path,
    profile: &str,
    out: &mut dyn Write,
) -> Result<Exit, Failure> {
    let failed = |source| Failure::Instrument { source };
    let setup = DeviceSetup::alone(port.to_owned(), profile, &arguments.settings);
    let setup = DeviceSetup { baud: arguments.baud, ..setup.map_err(failed)? };
    let device = setup.resolve_raw().map_err(failed)?;
    let clock: Arc<dyn Clock> = Arc::new(WallClock::start());
    let report = probe(&device, (arguments.seconds * 1e9) as u64, &clock).map_err(failed)?;
    if arguments.json {
        let devices = [report_json(&device, &report)];
        writeln!(out, "{:#}", json!({"schema": SCHEMA, "devices": devices}))?;
    } else {
        tell(out, &device, &report)?;
        for (number, FieldReport { name, last_raw, rate_hz, .. }) in
            report.fields.iter().enumerate()
        {
            match last_raw {
                Some(raw) => write!(out, "  field {number} ({name}): {raw}")?,
                None => write!(out, "  field {number} ({name}): no value")?,
            }
            rate_hz.map_or(Ok(()), |rate_hz| write!(out, ", {rate_hz:.1} Hz"))?;
            writeln!(out)?;
        }
        tell_troubles(out, &report)?;
    }
    let is_good = report.linked && report.troubles.is_empty();
    Ok(if is_good { Exit::Done } else { Exit::Failed })
}

/// Listens to every device at once, each on a thread of its own.
pub(super) fn ask_all(
    devices: &[DeviceConfig],
    seconds: f64,
) -> Vec<Result<ProbeReport, InstrumentError>> {
    let clock: Arc<dyn Clock> = Arc::new(WallClock::start());
    thread::scope(|scope| {
        let clock = &clock;
        let ask = |device| scope.spawn(move || probe(device, (seconds * 1e9) as u64, clock));
        let threads: Vec<_> = devices.iter().map(ask).collect();
        let join = |thread: thread::ScopedJoinHandle<'_, _>| {
            thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        threads.into_iter().map(join).collect()
    })
}

fn list(as_json: bool, out: &mut dyn Write) -> Result<Exit, Failure> {
    let ports = found_ports(Path::new(BY_ID_FOLDER));
    let known: Vec<(&str, String)> = profiles()
        .map(|name| (name, profile(name).map_or_else(|error| error.to_string(), |p| p.title)))
        .collect();
    if as_json {
        let ports: Vec<Value> =
            ports.iter().map(|port| json!({"port": port.path, "device": port.device})).collect();
        let known: Vec<Value> =
            known.iter().map(|(name, title)| json!({"profile": name, "title": title})).collect();
        writeln!(out, "{:#}", json!({"schema": SCHEMA, "ports": ports, "profiles": known}))?;
        return Ok(Exit::Done);
    }
    if ports.is_empty() {
        writeln!(out, "no serial port is there")?;
    }
    for port in ports {
        writeln!(out, "{}", port.path.display())?;
    }
    writeln!(out)?;
    for (name, title) in known {
        writeln!(out, "{name:20} {title}")?;
    }
    Ok(Exit::Done)
}

/// One device for people; what is wrong with it stands apart.
pub(super) fn tell(
    out: &mut dyn Write,
    device: &DeviceConfig,
    report: &ProbeReport,
) -> std::io::Result<()> {
    let DeviceConfig { name, port, line, .. } = device;
    // An instrument by itself has no name but its port's.
    let on = if port.as_os_str() == name.as_str() { "" } else { " on " };
    let path = if on.is_empty() { String::new() } else { port.display().to_string() };
    write!(out, "{name}{on}{path} ({})", line.name())?;
    match &report.identity {
        Some(identity) => writeln!(out, ": {identity}")?,
        None if !report.linked => writeln!(out)?,
        None if report.asks_who => writeln!(out, ": does not say who it is")?,
        None => writeln!(out, ": cannot say who it is")?,
    }
    for ChannelReport { quantity, last, rate_hz, quality, counts } in &report.channels {
        let (name, unit) = (quantity.name(), quantity.unit());
        match last {
            Some(last) => {
                write!(out, "  {name}: {:.6} {unit}, raw {}", last.sample.value, last.raw)?;
            }
            None => write!(out, "  {name}: no sample")?,
        }
        if let Some(rate_hz) = rate_hz {
            write!(out, ", {rate_hz:.1} Hz")?;
        }
        for flag in quality.names() {
            write!(out, ", {flag}")?;
        }
        if counts.lost + counts.damaged + counts.repeated > 0 {
            write!(
                out,
                ", {} lost, {} repeated, {} damaged",
                counts.lost, counts.repeated, counts.damaged
            )?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn tell_troubles(out: &mut dyn Write, report: &ProbeReport) -> std::io::Result<()> {
    for trouble in &report.troubles {
        writeln!(out, "  error: {trouble}")?;
        if let Some(hint) = trouble.hint() {
            writeln!(out, "  hint: {hint}")?;
        }
    }
    Ok(())
}

/// One device for programs.
pub(super) fn report_json(device: &DeviceConfig, report: &ProbeReport) -> Value {
    let channels: Vec<Value> = report
        .channels
        .iter()
        .map(|channel| {
            json!({
                "channel": channel.quantity.name(),
                "unit": channel.quantity.unit(),
                "value": channel.last.map(|last| last.sample.value),
                "raw": channel.last.map(|last| last.raw),
                "rate_hz": channel.rate_hz,
                "quality": channel.quality.names().collect::<Vec<_>>(),
                "counts": channel.counts,
            })
        })
        .collect();
    let fields: Vec<Value> = report
        .fields
        .iter()
        .map(|field| json!({"name": field.name, "raw": field.last_raw, "rate_hz": field.rate_hz}))
        .collect();
    let troubles: Vec<Value> = report
        .troubles
        .iter()
        .map(|trouble| json!({"message": trouble.to_string(), "hint": trouble.hint()}))
        .collect();
    json!({
        "device": device.name, "port": device.port, "line": device.line.name(),
        "linked": report.linked, "asks_who": report.asks_who, "identity": report.identity,
        "channels": channels, "fields": fields, "troubles": troubles,
    })
}
