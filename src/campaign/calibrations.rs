//! `calibrations.toml`: zeros and gains that were taken with the instruments, newest last.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use devices::Quantity;
use devices::channel::{Calibration, Channel};
use devices::setup::DeviceSetup;
use serde::{Deserialize, Serialize};

use super::mistake::Mistake;

/// Name of the file beside the campaign file.
pub const CALIBRATIONS_FILE: &str = "calibrations.toml";

/// A calibration of one channel, in force from when it was taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TakenCalibration {
    /// Name of the device.
    pub device: String,
    /// The channel.
    pub quantity: Quantity,
    /// Zero and curve, by whom and when.
    #[serde(flatten)]
    pub calibration: Calibration,
}

/// Raw readings of nothing, and by whom and when they were taken.
#[derive(Debug, Clone, PartialEq)]
pub struct ZeroTaken {
    /// Readings.
    pub n_readings: usize,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation.
    pub sd: f64,
    /// Who took them.
    pub by: String,
    /// When.
    pub at: String,
    /// Remark.
    pub note: String,
}

impl ZeroTaken {
    /// The calibration of a channel with this zero, and a sentence about the change.
    pub fn applied(&self, device: &str, channel: &Channel) -> (TakenCalibration, String) {
        let Self { n_readings, mean, sd, .. } = self;
        let (quantity, before) = (channel.quantity, &channel.calibration);
        let told = format!(
            "{} of {device}: zero {mean} (was {}, off by {:.6} {}), {n_readings} readings, sd \
             {sd:.4}",
            quantity.name(),
            before.zero_raw,
            before.value(*mean),
            quantity.unit(),
        );
        let calibration = Calibration {
            zero_raw: *mean,
            by: self.by.clone(),
            at: self.at.clone(),
            note: self.note.clone(),
            curve: before.curve.clone(),
        };
        (TakenCalibration { device: device.to_owned(), quantity, calibration }, told)
    }
}

#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    calibration: Vec<TakenCalibration>,
}

/// Every calibration that was taken, in the order in which they were.
pub(super) fn read(folder: &Path) -> Result<Vec<TakenCalibration>, Mistake> {
    let path = folder.join(CALIBRATIONS_FILE);
    let told = |line, message| Mistake {
        file: path.display().to_string(),
        line,
        message,
        hint: Some("it is written by `rolltank zero` and `rolltank calibrate`".to_owned()),
    };
    let text = match fs::read_to_string(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(told(None, format!("cannot be read: {error}"))),
        Ok(text) => text,
    };
    let file: File = toml::from_str(&text).map_err(|error| {
        let before = error.span().and_then(|span| text.get(..span.start));
        let line = before.map(|before| 1 + before.matches('\n').count());
        told(line, error.message().to_owned())
    })?;
    Ok(file.calibration)
}

/// Puts the newest calibration of each channel in the place of the campaign file's.
pub(super) fn apply(taken: &[TakenCalibration], setups: &mut [DeviceSetup]) {
    for TakenCalibration { device, quantity, calibration } in taken {
        let channels = setups.iter_mut().filter(|setup| setup.name == *device);
        let channels = channels.flat_map(|setup| &mut setup.channels);
        channels.filter(|channel| channel.quantity == *quantity).for_each(|channel| {
            channel.calibration = calibration.clone();
        });
    }
}

/// Appends a calibration; what was taken before stays, as recordings were made under it.
///
/// # Errors
/// What the system said; then the file is as it was.
pub fn keep_calibration(folder: &Path, taken: TakenCalibration) -> io::Result<()> {
    let path = folder.join(CALIBRATIONS_FILE);
    let before = match fs::read_to_string(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
        read => read?,
    };
    let more = File { calibration: vec![taken] };
    let more = toml::to_string(&more).map_err(io::Error::other)?;
    // Half a table, as a power cut leaves it, would keep the daemon from starting.
    let fresh = path.with_extension("toml.new");
    let mut file = fs::File::create(&fresh)?;
    file.write_all(format!("{before}{more}\n").as_bytes())?;
    file.sync_all()?;
    fs::rename(&fresh, &path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_calibration_of_a_channel_is_in_force() {
        let folder = tempfile::tempdir().unwrap();
        for zero_raw in [12.0, 12.5] {
            let calibration =
                Calibration { zero_raw, by: "A. Nilsson".to_owned(), ..Calibration::default() };
            let (device, quantity) = ("cell".to_owned(), Quantity::Force);
            let taken = TakenCalibration { device, quantity, calibration };
            keep_calibration(folder.path(), taken).unwrap();
        }
        let taken = read(folder.path()).unwrap();
        assert_eq!(taken.len(), 2);
        let text = "name = \"cell\"\nprofile = \"cobs-board\"\nport = \"p\"\n\
            [[channel]]\nquantity = \"force\"\nfield = 0\n\
            [[channel]]\nquantity = \"roll\"\nfield = 1";
        let mut setups: [DeviceSetup; 1] = [toml::from_str(text).unwrap()];
        apply(&taken, &mut setups);
        let zeros: Vec<f64> = setups[0].channels.iter().map(|c| c.calibration.zero_raw).collect();
        assert_eq!(zeros, [12.5, 0.0]);
    }
}
