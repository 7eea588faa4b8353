//! One emulated instrument on a pseudo-terminal, and the live driver at its other end.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use devices::clock::{Clock, WallClock};
use devices::emulator::{EmulatedPort, Signal, emulator};
use devices::port::LinkEvent;
use devices::setup::{DeviceConfig, DeviceSetup};
use devices::{Instrument, InstrumentError, InstrumentEvent, Measured};
use tempfile::TempDir;

/// A slow roll in raw units, different on every field, so that times show in values.
pub(crate) fn swing(field: usize, time_s: f64) -> f64 {
    1000.0 * (std::f64::consts::TAU * 0.25 * time_s + field as f64).sin()
}

/// The instrument, plugged in, and what listens to it.
pub(crate) struct Bench {
    pub(crate) port: EmulatedPort,
    pub(crate) instrument: Instrument,
    pub(crate) config: DeviceConfig,
    pub(crate) links: Vec<LinkEvent>,
    pub(crate) events: Vec<InstrumentEvent>,
    pub(crate) clock: Arc<dyn Clock>,
    _folder: TempDir,
}

/// A device of that profile with these lines of a campaign file, not yet plugged in.
pub(crate) fn device(profile: &str, lines: &str) -> (TempDir, DeviceConfig) {
    let folder = tempfile::tempdir().expect("a folder");
    let port = folder.path().join("usb-Emulated-if00-port0");
    let text = format!(
        "name = \"bench\"\nprofile = \"{profile}\"\nport = \"{}\"\nparity = \"none\"\n{lines}",
        port.display()
    );
    let setup: DeviceSetup = toml::from_str(&text).unwrap_or_else(|error| panic!("{error}"));
    let config = setup.resolve().unwrap_or_else(|error| panic!("{error}"));
    (folder, config)
}

/// Channels `roll`, `force` and so on from fields 0 and up.
pub(crate) fn channels(n_fields: usize) -> String {
    let names = ["roll", "force", "moment", "speed"];
    let channel = |(field, name): (usize, &&str)| {
        format!("[[channel]]\nquantity = \"{name}\"\nfield = {field}\n")
    };
    names.iter().take(n_fields).enumerate().map(channel).collect()
}

/// Plugs the device's emulator in and starts listening.
pub(crate) fn bench(profile: &str, lines: &str, rate_hz: f64) -> Bench {
    bench_of(profile, lines, rate_hz, Box::new(swing))
}

pub(crate) fn bench_of(profile: &str, lines: &str, rate_hz: f64, signal: Signal) -> Bench {
    let (folder, config) = device(profile, lines);
    let clock: Arc<dyn Clock> = Arc::new(WallClock::start());
    let other_end =
        emulator(&config.driver, &config.settings, rate_hz, signal).expect("the settings are good");
    let byte_ns = config.line.byte_ns();
    let port = EmulatedPort::plug_in(&config.port, other_end, byte_ns, Arc::clone(&clock))
        .expect("a pseudo-terminal");
    let instrument = Instrument::start(&config, Arc::clone(&clock)).expect("the settings are good");
    Bench {
        port,
        instrument,
        config,
        links: Vec::new(),
        events: Vec::new(),
        clock,
        _folder: folder,
    }
}

impl Bench {
    /// Listens until `enough`, or fails after ten seconds with what came.
    #[expect(clippy::disallowed_methods, reason = "a test must not wait for ever")]
    pub(crate) fn listen_until(&mut self, enough: impl Fn(&Self) -> bool) {
        let start = Instant::now();
        while !enough(self) {
            if let Some(link) = self.instrument.next(Duration::from_millis(5), &mut self.events) {
                self.links.push(link);
            }
            let last: Vec<_> = self.events.iter().rev().take(5).collect();
            assert!(start.elapsed() < Duration::from_secs(10), "not enough came: {last:?}");
        }
    }

    /// Listens for so long.
    pub(crate) fn listen_for(&mut self, duration_s: f64) {
        let until_ns = self.clock.now_ns() + (duration_s * 1e9) as u64;
        let clock = Arc::clone(&self.clock);
        self.listen_until(|_| clock.now_ns() >= until_ns);
    }

    pub(crate) fn samples(&self) -> Vec<Measured> {
        let sample = |event: &InstrumentEvent| match event {
            InstrumentEvent::Sample(measured) => Some(*measured),
            _ => None,
        };
        self.events.iter().filter_map(sample).collect()
    }

    /// The first that was told that a person must mend.
    pub(crate) fn trouble(&self) -> Option<&InstrumentError> {
        self.events.iter().find_map(|event| match event {
            InstrumentEvent::Trouble(error) => Some(error),
            _ => None,
        })
    }

    /// Everything told that a person must mend.
    pub(crate) fn troubles(&self) -> Vec<String> {
        let trouble = |event: &InstrumentEvent| match event {
            InstrumentEvent::Trouble(error) => Some(error.to_string()),
            _ => None,
        };
        self.events.iter().filter_map(trouble).collect()
    }

    pub(crate) fn n_samples(&self) -> usize {
        let is_sample = |event: &&InstrumentEvent| matches!(event, InstrumentEvent::Sample(_));
        self.events.iter().filter(is_sample).count()
    }

    pub(crate) fn port_path(&self) -> PathBuf {
        self.port.path().to_owned()
    }
}
