//! A simulated tank whose instruments hang on real ports, faster than the world when asked.

use std::sync::{Arc, Mutex, PoisonError, RwLock};

use devices::channel::{Channel, Curve};
use devices::clock::{Clock, WallClock};
use devices::emulator::{EmulatedPort, EmulatorError, emulator};
use devices::setup::DeviceConfig;
use devices::{InstrumentError, Quantity, Sample};

use super::error::LiveError;
use crate::run::Series;
use crate::tank::{Instrument, Readings, Scenario, simulate_pass};

/// Rest between two passes [s]; the carriage stops in it.
const PAUSE_S: f64 = 8.0;
/// Braking where a pass left the carriage moving [m/s2].
const BRAKING_M_S2: f64 = 0.5;
/// Calm water at the beginning of a pass, which stands for every rest [s].
const CALM_S: f64 = 4.0;
/// Samples further apart belong to two passes [s].
const APART_S: f64 = 1.0;

/// Emulated instruments, and the model that they look at.
pub struct VirtualTank {
    /// What happens, as ideal instruments would show it.
    exact: Scenario,
    instruments: Vec<(Quantity, Instrument)>,
    seed: u64,
    clock: Arc<WallClock>,
    stage: Arc<RwLock<Stage>>,
    ports: Vec<EmulatedPort>,
}

/// What happens in the tank, from when on.
#[derive(Default)]
struct Stage {
    begins_s: f64,
    /// What each instrument sees, in the order of [`Quantity::ALL`].
    courses: [Course; Quantity::ALL.len()],
}

/// What one instrument sees.
#[derive(Default)]
struct Course {
    series: Series,
    /// What it sees of calm water.
    calm: Vec<f64>,
}

impl VirtualTank {
    /// Plugs an emulator in at the port of every device, before calm water.
    ///
    /// # Errors
    /// [`LiveError`] when a device has no emulator or the system no pseudo-terminal.
    pub fn plug_in(
        scenario: Scenario,
        seed: u64,
        devices: &[DeviceConfig],
        clock: &Arc<WallClock>,
    ) -> Result<Self, LiveError> {
        let clock = Arc::clone(clock);
        let (stage, ports) = (Arc::default(), Vec::new());
        let instruments = scenario.instruments.recorded();
        // Readings come when the instruments take them: between two samples of a recording with
        // noise there would be less of it.
        let exact = Scenario { instruments: scenario.instruments.ideal(), ..scenario };
        let mut tank = Self { exact, instruments, seed, clock, stage, ports };
        tank.play(&[]);
        for device in devices {
            let port = tank.plugged(device)?;
            tank.ports.push(port);
        }
        Ok(tank)
    }

    /// The ports, in the order of the devices: cables can be pulled, and faults commanded.
    pub fn ports(&self) -> &[EmulatedPort] {
        &self.ports
    }

    fn plugged(&self, device: &DeviceConfig) -> Result<EmulatedPort, LiveError> {
        let stage = Arc::clone(&self.stage);
        let channels = device.channels.clone();
        let readings = |channel: &Channel| {
            let (quantity, instrument) =
                *self.instruments.iter().find(|(quantity, _)| *quantity == channel.quantity)?;
            Some((quantity, Readings::new(instrument, self.seed, quantity as u64)))
        };
        let readings: Mutex<Vec<(Quantity, Readings)>> =
            Mutex::new(channels.iter().filter_map(readings).collect());
        let signal = move |field: usize, time_s: f64| {
            let Some(channel) = channels.iter().find(|channel| channel.field == field) else {
                return 0.0;
            };
            let stage = stage.read().unwrap_or_else(PoisonError::into_inner);
            let exact = stage.value(channel.quantity, time_s);
            let mut readings = readings.lock().unwrap_or_else(PoisonError::into_inner);
            let own = readings.iter_mut().find(|(quantity, _)| *quantity == channel.quantity);
            raw(channel, own.map_or(exact, |(_, readings)| readings.of(exact)))
        };
        let rates_hz = device.channels.iter().map(|channel| self.rate_hz(channel.quantity));
        let rate_hz = rates_hz.fold(1.0, f64::max);
        let other_end = emulator(&device.driver, &device.settings, rate_hz, Box::new(signal));
        let other_end = other_end.map_err(|source| InstrumentError::Settings {
            device: device.name.clone(),
            driver: device.driver.clone(),
            source,
        })?;
        let clock = Arc::clone(&self.clock) as Arc<dyn Clock>;
        let plugged = EmulatedPort::plug_in(&device.port, other_end, device.line.byte_ns(), clock);
        plugged.map_err(|EmulatorError { path, source }| LiveError::File { path, source })
    }

    fn rate_hz(&self, quantity: Quantity) -> f64 {
        let of_it = self.instruments.iter().find(|(recorded, _)| *recorded == quantity);
        of_it.map_or(1.0, |(_, instrument)| instrument.sample_rate_hz)
    }

    /// Plays passes one after the other from now on; when the last and the rest behind it will be
    /// over [s].
    pub fn play(&self, passes: &[usize]) -> f64 {
        let mut stage = Stage::default();
        for sample in simulate_pass(&self.exact, 0, self.seed).samples {
            if sample.time_s < CALM_S {
                stage.courses[sample.quantity as usize].calm.push(sample.value);
            }
        }
        let mut offset_s = PAUSE_S;
        for &index in passes {
            let mut last_s = 0.0;
            for Sample { quantity, time_s, value } in
                simulate_pass(&self.exact, index, self.seed).samples
            {
                let series = &mut stage.courses[quantity as usize].series;
                series.time_s.push(offset_s + time_s);
                series.value.push(value);
                last_s = time_s;
            }
            offset_s += last_s + PAUSE_S;
        }
        stage.begins_s = self.clock.now_ns() as f64 / 1e9;
        let ends_s = stage.begins_s + offset_s;
        *self.stage.write().unwrap_or_else(PoisonError::into_inner) = stage;
        ends_s
    }
}

impl Stage {
    /// The value of a quantity [SI] at a time of the clock [s].
    fn value(&self, quantity: Quantity, time_s: f64) -> f64 {
        let course = &self.courses[quantity as usize];
        let time_s = time_s - self.begins_s;
        let Series { time_s: times_s, value } = &course.series;
        let after = times_s.partition_point(|at_s| *at_s <= time_s);
        let before = after.checked_sub(1).map(|last| (times_s[last], value[last]));
        let next = times_s.get(after).map(|at_s| (*at_s, value[after]));
        match (before, next) {
            (Some((from_s, from)), Some((to_s, to))) if to_s - from_s < APART_S => {
                from + (to - from) * (time_s - from_s) / (to_s - from_s)
            }
            (Some((from_s, from)), _) if quantity == Quantity::Speed => {
                let left_m_s = (from.abs() - BRAKING_M_S2 * (time_s - from_s)).max(0.0);
                left_m_s + course.calm(time_s)
            }
            _ => course.calm(time_s),
        }
    }
}

impl Course {
    fn calm(&self, time_s: f64) -> f64 {
        let share = (time_s / CALM_S).rem_euclid(1.0);
        let at = (share * self.calm.len() as f64) as usize;
        self.calm.get(at).copied().unwrap_or(0.0)
    }
}

/// What the instrument shows for a value; a virtual tank has straight calibrations.
fn raw(channel: &Channel, value: f64) -> f64 {
    match channel.calibration.curve {
        Curve::Gain(gain) => channel.calibration.zero_raw + value / gain,
        _ => value,
    }
}
