//! Zeros from the instruments that the daemon itself listens to: taken, taken back, taken again.

use std::path::Path;

use devices::Quantity;
use devices::channel::Calibration;
use serde::Deserialize;

use super::stamp::stamp_of_now;
use super::status::{ChannelStatus, Status};
use crate::campaign::{self, TakenCalibration, ZeroTaken};
use crate::judgement::Zeroed;

/// What is to be zeroed, and by whom.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ZeroRequest {
    /// Who takes it, as recordings will say.
    pub(super) by: String,
    /// The channel; roll and force or moment when none is named.
    channel: Option<Quantity>,
    /// Remark to be kept with it.
    #[serde(default)]
    pub(super) note: String,
}

/// Takes zeros from the last seconds and keeps them; a sentence about each with what was in force
/// before, or why there are none.
pub(super) fn zero(
    folder: &Path,
    status: &Status,
    asked: &ZeroRequest,
) -> Result<(String, Vec<Zeroed>), String> {
    let campaign = campaign::read(folder).map_err(|mistakes| {
        mistakes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    })?;
    let wanted = |channel: &&ChannelStatus| match asked.channel {
        Some(quantity) => channel.quantity == quantity,
        // A carriage that stands has no speed whose zero could be wrong by a calibration.
        None => channel.quantity != Quantity::Speed,
    };
    let (mut told, mut zeroed) = (Vec::new(), Vec::new());
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
                at: stamp_of_now(),
                note: asked.note.clone(),
            };
            let mut channels = setup.into_iter().flat_map(|setup| &setup.channels);
            let Some(known) = channels.find(|known| known.quantity == quantity) else { continue };
            let (calibration, sentence) = taken.applied(&device.name, known);
            let (before, after) = (known.calibration.clone(), calibration.calibration.clone());
            campaign::keep_calibration(folder, calibration).map_err(|error| error.to_string())?;
            told.push(sentence + "\n");
            zeroed.push(Zeroed { device: device.name.clone(), quantity, before, after });
        }
    }
    if told.is_empty() {
        Err("no such channel is measured\n".to_owned())
    } else {
        Ok((told.concat(), zeroed))
    }
}

/// Puts the calibrations that were in force before some zeros in force again.
pub(super) fn take_back(folder: &Path, channels: &[Zeroed]) -> Result<(), String> {
    put_in_force(folder, channels, |zeroed| &zeroed.before)
}

/// Puts zeros that were taken back in force again.
pub(super) fn take_again(folder: &Path, channels: &[Zeroed]) -> Result<(), String> {
    put_in_force(folder, channels, |zeroed| &zeroed.after)
}

fn put_in_force(
    folder: &Path,
    channels: &[Zeroed],
    of: impl Fn(&Zeroed) -> &Calibration,
) -> Result<(), String> {
    channels.iter().try_for_each(|zeroed| {
        let (device, quantity) = (zeroed.device.clone(), zeroed.quantity);
        let calibration = of(zeroed).clone();
        campaign::keep_calibration(folder, TakenCalibration { device, quantity, calibration })
            .map_err(|error| error.to_string())
    })
}
