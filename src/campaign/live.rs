//! `[live]` and `[[device]]`: the instruments of the tank, and what they are recorded under.

use std::path::Path;

use devices::setup::{self, DeviceConfig, DeviceSetup};
use devices::{InstrumentError, Quantity};
use replay::Recorded;

use super::calibrations;
use super::tree::{NOT_NEGATIVE, Section};
use super::{Live, Recording};

/// Folder below the campaign's that holds what its own instruments recorded.
pub const LIVE_FOLDER: &str = "live";

/// Condition of a recording that names none.
pub(super) const DEFAULT_CONDITION: &str = "default";

/// Reads `[live]` and every `[[device]]`, with the calibrations that were taken since.
pub(super) fn read(root: &Section<'_>, folder: &Path) -> Live {
    let mut live = Live { condition: DEFAULT_CONDITION.to_owned(), ..Live::default() };
    if let Some(section) = root.section("live") {
        if let Some(condition) = section.text("condition") {
            condition.clone_into(&mut live.condition);
        }
        live.speed_m_s = section.number("speed_m_s", &NOT_NEGATIVE);
        section.close();
    }
    for section in root.sections("device") {
        if let Some(setup) = section.whole::<DeviceSetup>() {
            live.setups.push(setup);
            live.lines.push(section.own_line());
        }
    }
    match calibrations::read(folder) {
        Ok(taken) => calibrations::apply(&taken, &mut live.setups),
        Err(mistake) => root.add(mistake),
    }
    let (devices, mistakes) = setup::check(&live.setups);
    for mistake in mistakes {
        root.mistake_on(live.line_of(&mistake), mistake.to_string(), mistake.hint());
    }
    check_channels(root, &devices);
    live.devices = devices;
    live
}

impl Live {
    /// The line of the device that a mistake is about, the last one of its name.
    pub fn line_of(&self, mistake: &InstrumentError) -> Option<usize> {
        let is_it = |setup: &DeviceSetup| match mistake.device() {
            Some(device) => setup.name == device,
            None => mistake.to_string().contains(&format!("\"{}\"", setup.profile)),
        };
        let at = self.setups.iter().rposition(is_it)?;
        self.lines.get(at).copied().flatten()
    }
}

/// What takes all channels together to see.
fn check_channels(root: &Section<'_>, devices: &[DeviceConfig]) {
    let measured = |quantity| {
        let mut channels = devices.iter().flat_map(|device| &device.channels);
        channels.any(|channel| channel.quantity == quantity)
    };
    if !devices.is_empty() && !measured(Quantity::Roll) {
        root.mistake(
            "device",
            "no [[device]] measures the roll".to_owned(),
            "add a [[device.channel]] with quantity = \"roll\"",
        );
    }
    if measured(Quantity::Force) && measured(Quantity::Moment) {
        root.mistake(
            "device",
            "both a force and a moment are measured".to_owned(),
            "keep the one that the rod's transducer gives; a force becomes a moment by [exciter]",
        );
    }
    if measured(Quantity::Force) && !root.holds("exciter") {
        root.mistake(
            "device",
            "a force is measured, but no [exciter] says how it becomes a moment".to_owned(),
            "add [exciter] with `moment_arm_m = ...`, or drop the channel",
        );
    }
}

/// Fills in what a recording of live instruments says about itself: its condition and speed.
pub(super) fn described(mut recording: Recording) -> Recording {
    let Some((_, path)) = recording.files.first() else { return recording };
    // What cannot be read is told when the recording is played.
    let Ok(recorded) = Recorded::open(path) else { return recording };
    let text = recorded.metadata().get("campaign").map_or("", String::as_str);
    let Ok(table) = text.parse::<toml::Table>() else { return recording };
    let live = table.get("live").and_then(toml::Value::as_table);
    let of = |key: &str| live.and_then(|live| live.get(key));
    if let Some(condition) = of("condition").and_then(toml::Value::as_str) {
        condition.clone_into(&mut recording.condition);
    }
    recording.speed_m_s = of("speed_m_s").and_then(|value| {
        value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
    });
    recording
}
