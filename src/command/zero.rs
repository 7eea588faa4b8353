//! `rolltank zero`: what the instruments read when there is nothing to measure.

use std::io::Write;
use std::path::PathBuf;

use ::devices::Quantity;
use ::devices::channel::zero_from_readings;
use clap::Args;

use super::calibrating::{ChannelName, keep, now, readings};
use super::{Exit, Failure};
use crate::campaign::{self, ZeroTaken};
use crate::live::LiveError;

/// Take zeros with the model upright and still and the rod unloaded; the daemon must not run
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: PathBuf,
    /// Channel to zero; roll and force or moment when none is named
    #[arg(long = "channel", value_enum)]
    channels: Vec<ChannelName>,
    /// Who takes them, as recordings will say
    #[arg(long, value_name = "NAME")]
    by: String,
    /// Remark to be kept with them
    #[arg(long, value_name = "TEXT", default_value = "")]
    note: String,
    /// Mean over so long
    #[arg(long, value_name = "SECONDS", default_value_t = 5.0, value_parser = super::positive)]
    seconds: f64,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let campaign = campaign::read(&arguments.campaign)?;
    if campaign.live.devices.is_empty() {
        return Err(LiveError::NoDevices { folder: campaign.folder }.into());
    }
    let named: Vec<Quantity> = arguments.channels.iter().map(|name| name.quantity()).collect();
    let wanted = |quantity: Quantity| match &named[..] {
        // A carriage that stands has no speed whose zero could be wrong by a calibration.
        [] => quantity != Quantity::Speed,
        named => named.contains(&quantity),
    };
    for device in &campaign.live.devices {
        let channels = || device.channels.iter().filter(|channel| wanted(channel.quantity));
        let quantities: Vec<Quantity> = channels().map(|channel| channel.quantity).collect();
        if quantities.is_empty() {
            continue;
        }
        let raw = readings(device, &quantities, arguments.seconds)?;
        for (channel, raw) in channels().zip(raw) {
            let quantity = channel.quantity;
            let (mean, sd) = zero_from_readings(&raw).map_err(|source| Failure::Calibration {
                device: device.name.clone(),
                quantity,
                source,
            })?;
            let taken = ZeroTaken {
                n_readings: raw.len(),
                mean,
                sd,
                by: arguments.by.clone(),
                at: now(),
                note: arguments.note.clone(),
            };
            let (calibration, sentence) = taken.applied(&device.name, channel);
            keep(&arguments.campaign, calibration)?;
            writeln!(out, "{sentence}")?;
        }
    }
    Ok(Exit::Done)
}
