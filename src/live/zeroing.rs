//! `POST /zero`: zeros from the instruments that the daemon itself listens to.

use std::path::Path;

use devices::Quantity;
use devices::clock::WallClock;
use serde::Deserialize;

use super::keeping::stamp;
use super::status::{ChannelStatus, Status};
use crate::campaign::{self, ZeroTaken};

/// What is to be zeroed, and by whom.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ZeroRequest {
    /// Who takes it, as recordings will say.
    by: String,
    /// The channel; roll and force or moment when none is named.
    channel: Option<Quantity>,
    /// Remark to be kept with it.
    #[serde(default)]
    note: String,
}

/// Takes zeros from the last seconds and keeps them; a sentence about each, or why there are none.
pub(super) fn zero(folder: &Path, status: &Status, asked: &ZeroRequest) -> Result<String, String> {
    let campaign = campaign::read(folder).map_err(|mistakes| {
        mistakes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    })?;
    let wanted = |channel: &&ChannelStatus| match asked.channel {
        Some(quantity) => channel.quantity == quantity,
        // A carriage that stands has no speed whose zero could be wrong by a calibration.
        None => channel.quantity != Quantity::Speed,
    };
    let mut told = Vec::new();
    for device in &status.devices {
        let setup = campaign.live.setups.iter().find(|setup| setup.name == device.name);
        for channel in device.channels.iter().filter(wanted) {
            let quantity = channel.quantity;
            let recent = channel.recent.ok_or_else(|| {
                format!("{} of {} brings too few readings\n", quantity.name(), device.name)
            })?;
            let taken = ZeroTaken {
                n_readings: recent.n_readings,
                mean: recent.mean,
                sd: recent.sd,
                by: asked.by.clone(),
                at: stamp(&WallClock::start(), 0, "%Y-%m-%d %H:%M:%S UTC"),
                note: asked.note.clone(),
            };
            let mut channels = setup.into_iter().flat_map(|setup| &setup.channels);
            let Some(known) = channels.find(|known| known.quantity == quantity) else { continue };
            let (calibration, sentence) = taken.applied(&device.name, known);
            campaign::keep_calibration(folder, calibration).map_err(|error| error.to_string())?;
            told.push(sentence + "\n");
        }
    }
    if told.is_empty() {
        Err("no such channel is measured\n".to_owned())
    } else {
        Ok(told.concat())
    }
}
