//! Writes a simulated campaign folder, its truth sealed in a file beside it.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use devices::Quantity;
use replay::{Exit, Provenance, Recorder, ReplayError};

use super::instruments::FileFormat;
use super::scenario::{ArmShape, Scenario};
use super::simulate::{SimulatedPass, simulate_pass};
use super::table::{TIME_COLUMN, column_unit, table};
use super::truth::CampaignTruth;

/// Log time at which the first recording starts [s]: a fixed hour, as a simulation reads no clock.
const DAY_STARTS_S: f64 = 8.0 * 3600.0;
/// Wait between two passes for calm water [s].
const CALMING_S: f64 = 300.0;

/// Why `write!` to a `String` is unwrapped.
const INTO_STRING: &str = "writing to a string cannot fail";

/// Why a campaign folder could not be written.
#[derive(Debug, thiserror::Error)]
pub enum TankError {
    /// The folder holds something already.
    #[error(
        "folder \"{}\" is not empty\nhint: a simulation never writes over recordings; name a new \
         folder", folder.display()
    )]
    NotEmpty {
        /// The folder.
        folder: PathBuf,
    },
    /// The truth of another campaign stands where this one's would go.
    #[error(
        "\"{}\" exists already\nhint: move it away, or name another folder", file.display()
    )]
    TruthExists {
        /// The truth file.
        file: PathBuf,
    },
    /// The path ends in no name, so there is no place beside it.
    #[error("\"{}\" is not the name of a folder\nhint: name a new folder", folder.display())]
    Nameless {
        /// The folder.
        folder: PathBuf,
    },
    /// An MCAP recording could not be written.
    #[error(transparent)]
    Record(#[from] ReplayError),
    /// A file or folder could not be written.
    #[error("cannot write \"{}\"\nhint: check its permissions and the space left", file.display())]
    Write {
        /// The file or folder.
        file: PathBuf,
        /// What the system said.
        #[source]
        source: std::io::Error,
    },
}

/// The file beside `folder` that holds the truth of the campaign in it; no analysis reads it.
pub fn truth_path(folder: &Path) -> Result<PathBuf, TankError> {
    let name = folder.file_name().map(|name| name.to_string_lossy().into_owned());
    let nameless = || TankError::Nameless { folder: folder.to_owned() };
    let name = name.ok_or_else(nameless)?;
    Ok(folder.with_file_name(format!("{name}.truth.json")))
}

/// Simulates every pass into `folder`, telling `progress` the passes done and the passes in all.
pub fn write_campaign(
    scenario: &Scenario,
    seed: u64,
    folder: &Path,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(), TankError> {
    let truth_file = truth_path(folder)?;
    if fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some()) {
        return Err(TankError::NotEmpty { folder: folder.to_owned() });
    }
    if truth_file.exists() {
        return Err(TankError::TruthExists { file: truth_file });
    }
    let runs = folder.join("runs");
    fs::create_dir_all(&runs).map_err(|source| TankError::Write { file: runs, source })?;
    let n_passes = scenario.pass_count();
    let head = campaign_head(scenario);
    let mut campaign = head.clone();
    let mut clock_s = DAY_STARTS_S;
    let mut truth = CampaignTruth {
        schema: "rolltank.truth/1".to_owned(),
        scenario: scenario.name.clone(),
        seed,
        passes: Vec::with_capacity(n_passes),
    };
    progress(0, n_passes as u64);
    for index in 0..n_passes {
        let simulated = simulate_pass(scenario, index, seed);
        campaign.push_str(&recording_entry(scenario, index, &simulated));
        let zero_log_time_ns = (clock_s * 1e9) as u64;
        let provenance = Provenance {
            campaign_text: head.clone(),
            source: "simulated instruments".to_owned(),
            zero_log_time_ns,
        };
        write_recording(scenario, folder, &simulated, &provenance)?;
        clock_s += simulated.samples.last().map_or(0.0, |s| s.time_s) + CALMING_S;
        truth.passes.push(simulated.truth);
        progress(index as u64 + 1, n_passes as u64);
    }
    write(&folder.join("campaign.toml"), campaign.as_bytes())?;
    let json = serde_json::to_string_pretty(&truth)
        .map_err(|error| TankError::Write { file: truth_file.clone(), source: error.into() })?;
    write(&truth_file, json.as_bytes())
}

fn write(file: &Path, bytes: &[u8]) -> Result<(), TankError> {
    fs::write(file, bytes).map_err(|source| TankError::Write { file: file.to_owned(), source })
}

/// Files of one recording, relative to the folder, with the channel each carries.
fn files(scenario: &Scenario, name: &str) -> Vec<(Option<Quantity>, String)> {
    let format = &scenario.recordings;
    match format.format {
        FileFormat::Mcap => vec![(None, format!("runs/{name}.mcap"))],
        FileFormat::Csv if format.one_file_per_channel => scenario
            .instruments
            .recorded()
            .into_iter()
            .map(|(q, _)| (Some(q), format!("runs/{name}_{}.csv", q.name())))
            .collect(),
        FileFormat::Csv => vec![(None, format!("runs/{name}.csv"))],
    }
}

fn write_recording(
    scenario: &Scenario,
    folder: &Path,
    simulated: &SimulatedPass,
    provenance: &Provenance,
) -> Result<(), TankError> {
    if scenario.recordings.format == FileFormat::Mcap {
        let file = folder.join(format!("runs/{}.mcap", simulated.name));
        return Ok(record(&file, simulated, provenance)?);
    }
    let every: Vec<Quantity> =
        scenario.instruments.recorded().into_iter().map(|(quantity, _)| quantity).collect();
    for (channel, file) in files(scenario, &simulated.name) {
        let channels = channel.map_or_else(|| every.clone(), |quantity| vec![quantity]);
        let text = table(&simulated.samples, &channels, scenario.recordings);
        write(&folder.join(file), text.as_bytes())?;
    }
    Ok(())
}

fn record(
    file: &Path,
    simulated: &SimulatedPass,
    provenance: &Provenance,
) -> Result<(), ReplayError> {
    let mut recorder = Recorder::create(file, provenance)?;
    for sample in &simulated.samples {
        recorder.push(sample)?;
    }
    recorder.finish(Exit::success("simulated")).map(|_| ())
}

/// Everything of `campaign.toml` before its recordings.
pub fn campaign_head(scenario: &Scenario) -> String {
    let (hull, water, basin) = (&scenario.hull, &scenario.water, &scenario.tank);
    let mut text = format!(
        "name = {}\n\n[hull]\nlength_pp_m = {:?}\nbeam_m = {:?}\ndraft_m = {:?}\n\
         displacement_m3 = {:?}\ngm_m = {:?}\n\n[water]\ndensity_kg_m3 = {:?}\n\
         gravity_m_s2 = {:?}\n\n[tank]\nlength_m = {:?}\nwidth_m = {:?}\ndepth_m = {:?}\n\
         carriage_max_speed_m_s = {:?}\n",
        quoted(&scenario.name),
        hull.length_pp_m,
        hull.beam_m,
        hull.draft_m,
        hull.displacement_m3,
        hull.gm_m,
        water.density_kg_m3,
        water.gravity_m_s2,
        basin.length_m,
        basin.width_m,
        basin.depth_m,
        basin.carriage_max_speed_m_s,
    );
    if let Some(shaker) = scenario.exciter {
        let arm = match shaker.arm {
            ArmShape::Constant => "constant",
            ArmShape::Cosine => "cosine",
            ArmShape::Rod => "rod",
        };
        let rod =
            shaker.rod_length_m.map_or_else(String::new, |m| format!("rod_length_m = {m:?}\n"));
        write!(
            text,
            "\n[exciter]\nmoment_arm_m = {:?}\narm = \"{arm}\"\n{rod}force_sign = {:?}\n",
            shaker.moment_arm_m, shaker.force_sign,
        )
        .expect(INTO_STRING);
    }
    if scenario.recordings.format == FileFormat::Csv {
        text.push_str(&columns(scenario));
    }
    text
}

fn columns(scenario: &Scenario) -> String {
    let mut text = format!("\n[columns]\ntime = {{ column = \"{TIME_COLUMN}\", unit = \"s\" }}\n");
    for (quantity, _) in scenario.instruments.recorded() {
        let (name, unit) = (quantity.name(), column_unit(quantity, scenario.recordings));
        writeln!(text, "{name} = {{ column = \"{name}\", unit = \"{unit}\" }}").expect(INTO_STRING);
    }
    text
}

fn recording_entry(scenario: &Scenario, index: usize, simulated: &SimulatedPass) -> String {
    let files = files(scenario, &simulated.name);
    let named = match files.as_slice() {
        [(None, file)] => format!("file = {}", quoted(file)),
        several => {
            let each: Vec<String> = several
                .iter()
                .filter_map(|(q, file)| q.map(|q| format!("{} = {}", q.name(), quoted(file))))
                .collect();
            format!("files = {{ {} }}", each.join(", "))
        }
    };
    let condition = quoted(&simulated.condition);
    let mut text = format!("\n[[recording]]\n{named}\ncondition = {condition}\n");
    if scenario.instruments.speed.is_none() {
        let claimed = scenario.pass_at(index).0.declared_speed_m_s;
        let speed_m_s = claimed.unwrap_or(simulated.truth.speed_m_s);
        writeln!(text, "speed_m_s = {speed_m_s:?}").expect(INTO_STRING);
    }
    text
}

fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}
