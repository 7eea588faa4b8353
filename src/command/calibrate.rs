//! `rolltank calibrate`: zero and curve of one channel from known loads, one after the other.

use std::io::{self, BufRead, IsTerminal, Write};
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

use ::devices::Quantity;
use ::devices::channel::{Calibration, Curve, zero_from_readings};
use clap::{Args, ValueEnum};

use super::calibrating::{ChannelName, device_of, keep, now, readings};
use super::daemon_page::DaemonPage;
use super::{Exit, Failure};
use crate::campaign::{self, CurveForm, FromLoads, Loaded, TakenCalibration};
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
    /// Form of the curve
    #[arg(long, value_enum, default_value_t = CurveName::Gain)]
    curve: CurveName,
    /// Highest power of a polynomial
    #[arg(long, value_name = "N", default_value_t = 2,
          value_parser = clap::value_parser!(u8).range(1..=5))]
    degree: u8,
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

/// A form of curve as it is named on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum CurveName {
    /// A straight line through the loads
    Gain,
    /// A polynomial through the loads, its highest power in --degree
    Polynomial,
    /// Straight from each load to the next
    Table,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let campaign = campaign::read(&arguments.campaign)?;
    let quantity = arguments.channel.quantity();
    let Some(device) = device_of(&campaign, quantity) else {
        return Err(Failure::NotMeasured { quantity });
    };
    let failed = |source| Failure::Calibration { device: device.name.clone(), quantity, source };
    let unit = asked_unit(quantity);
    let mut loads = Vec::new();
    let mut lines = io::stdin().lock().lines();
    loop {
        if io::stdin().is_terminal() {
            write!(out, "load {} [{unit}], empty to end: ", loads.len() + 1)?;
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
        loads.push(Loaded { load: si(quantity, load), raw: mean });
    }
    let form = match arguments.curve {
        CurveName::Gain => CurveForm::Gain,
        CurveName::Polynomial => CurveForm::Polynomial { degree: usize::from(arguments.degree) },
        CurveName::Table => CurveForm::Table,
    };
    let from_loads = campaign::curve_from_loads(form, &loads).map_err(|source| Failure::Loads {
        device: device.name.clone(),
        quantity,
        source,
    })?;
    writeln!(out, "{} of {}: {}", quantity.name(), device.name, told(&from_loads, quantity))?;
    let FromLoads { zero_raw, curve, .. } = from_loads;
    let (by, at, note) = (arguments.by.clone(), now(), arguments.note.clone());
    let calibration = Calibration { zero_raw, curve, by, at, note };
    let taken = TakenCalibration { device: device.name.clone(), quantity, calibration };
    keep(&arguments.campaign, taken)?;
    if arguments.daemon.is_named() {
        writeln!(out, "in force from the next rest on, once the daemon is told: systemctl reload")?;
    }
    Ok(Exit::Done)
}

/// Zero, curve, and how far it is off the loads.
fn told(from_loads: &FromLoads, quantity: Quantity) -> String {
    let (zero_raw, unit) = (from_loads.zero_raw, quantity.unit());
    let curve = match &from_loads.curve {
        Curve::Gain(gain) => format!("gain {gain} {unit} per raw unit"),
        Curve::Polynomial(coefficients) => {
            format!("polynomial {coefficients:?} in the raw reading less its zero, in {unit}")
        }
        Curve::Table(pairs) => format!("table of {} loads", pairs.len()),
    };
    let off = from_loads.deviation.map_or_else(
        || "as few loads fit any such curve: more would tell how far it is off".to_owned(),
        |deviation| format!("off the loads by {deviation:.6} {unit} at most"),
    );
    format!("zero {zero_raw}, {curve}, {off}")
}

/// The unit in which a person applies loads.
fn asked_unit(quantity: Quantity) -> &'static str {
    if quantity == Quantity::Roll { "deg" } else { quantity.unit() }
}

fn si(quantity: Quantity, load: f64) -> f64 {
    if quantity == Quantity::Roll { load.to_radians() } else { load }
}
