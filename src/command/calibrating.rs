//! What `zero` and `calibrate` share: readings of one channel, and who took them when.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use ::devices::clock::{Clock, WallClock};
use ::devices::port::PortFault;
use ::devices::setup::DeviceConfig;
use ::devices::{Instrument, InstrumentError, InstrumentEvent, Quantity};
use clap::ValueEnum;

use super::Failure;
use crate::campaign::{self, Campaign, TakenCalibration};

/// The first readings after an opening may be of what was on the instrument before.
const SETTLING_NS: u64 = 200_000_000;

/// A channel as it is named on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum ChannelName {
    /// Roll angle
    Roll,
    /// Force of the rod
    Force,
    /// Exciting moment
    Moment,
    /// Carriage speed
    Speed,
}

impl ChannelName {
    pub(super) fn quantity(self) -> Quantity {
        match self {
            Self::Roll => Quantity::Roll,
            Self::Force => Quantity::Force,
            Self::Moment => Quantity::Moment,
            Self::Speed => Quantity::Speed,
        }
    }
}

/// The device that measures a quantity.
pub(super) fn device_of(campaign: &Campaign, quantity: Quantity) -> Option<&DeviceConfig> {
    let measures =
        |device: &&DeviceConfig| device.channels.iter().any(|channel| channel.quantity == quantity);
    campaign.live.devices.iter().find(measures)
}

/// Raw readings of some channels of a device over so long a time [s], in the order asked for.
pub(super) fn readings(
    device: &DeviceConfig,
    quantities: &[Quantity],
    seconds: f64,
) -> Result<Vec<Vec<f64>>, Failure> {
    let clock: Arc<dyn Clock> = Arc::new(WallClock::start());
    let failed = |source| Failure::Instrument { source };
    let mut instrument = Instrument::start(device, Arc::clone(&clock)).map_err(failed)?;
    let until_ns = clock.now_ns() + SETTLING_NS + (seconds * 1e9) as u64;
    let mut raw = vec![Vec::new(); quantities.len()];
    let (mut events, mut trouble) = (Vec::new(), None);
    let mut settled_ns = None;
    while clock.now_ns() < until_ns {
        instrument.next(Duration::from_millis(20), &mut events);
        let now_ns = clock.now_ns();
        if events.iter().any(|event| matches!(event, InstrumentEvent::Sample(_))) {
            settled_ns.get_or_insert(now_ns + SETTLING_NS);
        }
        if settled_ns.is_none_or(|settled_ns| now_ns < settled_ns) {
            events.retain(|event| !matches!(event, InstrumentEvent::Sample(_)));
        }
        for event in events.drain(..) {
            match event {
                InstrumentEvent::Sample(measured) if measured.quality.is_usable() => {
                    let of = measured.sample.quantity;
                    let at = quantities.iter().position(|quantity| *quantity == of);
                    raw.iter_mut().skip(at.unwrap_or(usize::MAX)).take(1).for_each(|raw| {
                        raw.push(measured.raw);
                    });
                }
                InstrumentEvent::Trouble(found) => trouble = Some(found),
                _ => {}
            }
        }
    }
    match trouble {
        Some(source @ InstrumentError::Port { fault: PortFault::Busy, .. }) => {
            Err(Failure::PortInUse { source })
        }
        Some(source) if raw.iter().any(Vec::is_empty) => Err(failed(source)),
        _ => Ok(raw),
    }
}

/// Keeps a calibration beside the campaign file, in force from the next recording on.
pub(super) fn keep(folder: &Path, taken: TakenCalibration) -> Result<(), Failure> {
    let path = folder.join(campaign::CALIBRATIONS_FILE);
    campaign::keep_calibration(folder, taken).map_err(|source| Failure::File { path, source })
}

/// Date and time, as it stands in a calibration.
pub(super) fn now() -> String {
    crate::page::stamp_of_now()
}
