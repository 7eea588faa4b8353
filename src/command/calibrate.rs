//! `rolltank calibrate`: gain and zero of one channel from known loads, one after the other.

use std::io::{self, BufRead, IsTerminal, Write};
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

use ::devices::Quantity;
use ::devices::channel::{Calibration, Curve, gain_from_loads, zero_from_readings};
use clap::Args;

use super::calibrating::{ChannelName, device_of, keep, now, readings};
use super::daemon_page::DaemonPage;
use super::{Exit, Failure};
use crate::campaign::{self, TakenCalibration};
use crate::page::status::RecentRaw;

/// What the page of a daemon tells is a mean over so long, all of it under the load.
const PAGE_MEAN: Duration = Duration::from_secs(5);

/// Calibrate a channel by known loads: apply one, enter it, and so on
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: PathBuf,
    /// Channel to calibrate
    #[arg(long, value_enum)]
    channel: ChannelName,
    /// Who takes it, as recordings will say
    #[arg(long, value_name = "NAME")]
    by: String,
    /// Certificate, weights, conditions
    #[arg(long, value_name = "TEXT", default_value = "")]
    note: String,
    /// Mean of each load over so long; a daemon's page tells the last 5 seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 3.0, value_parser = super::positive,
          conflicts_with = "page")]
    seconds: f64,
    #[command(flatten)]
    daemon: DaemonPage,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let campaign = campaign::read(&arguments.campaign)?;
    let quantity = arguments.channel.quantity();
    let Some(device) = device_of(&campaign, quantity) else {
        return Err(Failure::NotMeasured { quantity });
    };
    let failed = |source| Failure::Calibration { device: device.name.clone(), quantity, source };
    let unit = asked_unit(quantity);
    let mut pairs = Vec::new();
    let mut lines = io::stdin().lock().lines();
    loop {
        if io::stdin().is_terminal() {
            write!(out, "load {} [{unit}], empty to end: ", pairs.len() + 1)?;
            out.flush()?;
        }
        let line = lines.next().transpose()?.unwrap_or_default();
        let Some(load) = line.split_whitespace().next() else { break };
        let Ok(load) = load.parse::<f64>() else {
            writeln!(out, "\"{load}\" is no number, such as 9.81; the load is not taken")?;
            continue;
        };
        let RecentRaw { n_readings, mean, sd } = if arguments.daemon.is_named() {
            thread::sleep(PAGE_MEAN);
            arguments.daemon.recent(quantity)?
        } else {
            let raw = readings(device, &[quantity], arguments.seconds)?.concat();
            let (mean, sd) = zero_from_readings(&raw).map_err(failed)?;
            RecentRaw { n_readings: raw.len(), mean, sd }
        };
        writeln!(out, "load {load} {unit}: raw {mean:.4}, sd {sd:.4}, {n_readings} readings")?;
        out.flush()?;
        pairs.push([mean, si(quantity, load)]);
    }
    let (zero_raw, gain, deviation) = gain_from_loads(&pairs).map_err(failed)?;
    let calibration = Calibration {
        zero_raw,
        curve: Curve::Gain(gain),
        by: arguments.by.clone(),
        at: now(),
        note: arguments.note.clone(),
    };
    writeln!(
        out,
        "{} of {}: zero {zero_raw}, gain {gain} {} per raw unit, off the line by {deviation:.6} {} \
         at most",
        quantity.name(),
        device.name,
        quantity.unit(),
        quantity.unit(),
    )?;
    let taken = TakenCalibration { device: device.name.clone(), quantity, calibration };
    keep(&arguments.campaign, taken)?;
    if arguments.daemon.is_named() {
        writeln!(out, "in force from the next rest on, once the daemon is told: systemctl reload")?;
    }
    Ok(Exit::Done)
}

/// The unit in which a person applies loads.
fn asked_unit(quantity: Quantity) -> &'static str {
    if quantity == Quantity::Roll { "deg" } else { quantity.unit() }
}

fn si(quantity: Quantity, load: f64) -> f64 {
    if quantity == Quantity::Roll { load.to_radians() } else { load }
}
