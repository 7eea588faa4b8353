//! The campaign: one day's model, tank and recordings, as written in `campaign.toml`.

mod calibrations;
mod columns;
mod judged;
mod known_loads;
mod live;
mod mistake;
mod particulars;
mod plan;
mod plan_table;
mod read;
mod recordings;
mod speeds;
mod tree;
mod units;

use std::path::{Path, PathBuf};

use devices::Quantity;
use devices::setup::{DeviceConfig, DeviceSetup};
use replay::Columns;

use crate::hull::{Hull, Water};
use crate::judgement::Judgements;
use crate::model::model_file::ModelFile;
use crate::roll::exciting_moment::Exciter;

pub use calibrations::{CALIBRATIONS_FILE, TakenCalibration, ZeroTaken, keep_calibration};
pub use known_loads::{CurveForm, FromLoads, Loaded, LoadsError, curve_from_loads};
pub use live::LIVE_FOLDER;
pub use mistake::Mistake;
pub use plan::PlannedRuns;
pub use read::{FILE_NAME, read};

/// A validated campaign file; every value is in SI units and in its physical range.
#[derive(Debug, Clone, PartialEq)]
pub struct Campaign {
    /// Folder that holds `campaign.toml`; results go to `results/` inside it and nowhere else.
    pub folder: PathBuf,
    /// Name for titles.
    pub name: String,
    /// The model.
    pub hull: Hull,
    /// The water.
    pub water: Water,
    /// The tank, where given.
    pub tank: Tank,
    /// How rod force becomes exciting moment, where a force is recorded.
    pub exciter: Option<Exciter>,
    /// How recordings name their channels.
    pub columns: Columns,
    /// The recordings in the order in which they are read.
    pub recordings: Vec<Recording>,
    /// The simulation model that a diagnosis extended, where one was written.
    pub model: Option<ModelFile>,
    /// What people have judged of its runs.
    pub judgements: Judgements,
    /// The instruments of the tank, where there are such.
    pub live: Live,
    /// The runs that are asked for, in the order in which they are to be made.
    pub plan: Plan,
    /// How true instruments and particulars are.
    pub trueness: Trueness,
}

impl Campaign {
    /// Where a diagnosis writes the model that it extended.
    pub fn model_path(folder: &Path) -> PathBuf {
        folder.join("results").join("model.toml")
    }
}

/// The instruments of the tank, and what they are recorded under from here on.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Live {
    /// Loading or appendage condition.
    pub condition: String,
    /// Carriage speed [m/s] where none is measured.
    pub speed_m_s: Option<f64>,
    /// The devices as written, with the newest calibrations.
    pub setups: Vec<DeviceSetup>,
    /// The lines on which they begin.
    pub lines: Vec<Option<usize>>,
    /// The devices with everything decided.
    pub devices: Vec<DeviceConfig>,
}

/// The test plan.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plan {
    /// The file that holds it, relative to the campaign's folder.
    pub file: String,
    /// Its rows in order; empty where there is no plan.
    pub rows: Vec<PlannedRuns>,
}

/// Relative standard uncertainties that no record can tell, each where it is known [-].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Trueness {
    /// Of the gain of the roll channel.
    pub roll_gain: Option<f64>,
    /// Of the gain of the force or moment channel, arm included.
    pub force_gain: Option<f64>,
    /// Of the rate of the recorder's clock.
    pub clock: Option<f64>,
    /// Of the metacentric height.
    pub gm: Option<f64>,
}

/// Limits of the tank that runs are checked against.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tank {
    /// Length [m].
    pub length_m: Option<f64>,
    /// Width [m].
    pub width_m: Option<f64>,
    /// Depth [m].
    pub depth_m: Option<f64>,
    /// Greatest carriage speed [m/s].
    pub carriage_max_speed_m_s: Option<f64>,
}

/// One recording of the campaign: one file, or one file per channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Name in results: the file as written in the campaign file, relative to the folder.
    pub name: String,
    /// The files, with the channel each carries; `None` when the file carries every channel.
    pub files: Vec<(Option<Quantity>, PathBuf)>,
    /// Loading or appendage condition.
    pub condition: String,
    /// Carriage speed [m/s] where no speed channel was recorded.
    pub speed_m_s: Option<f64>,
    /// Line of `campaign.toml` that names the recording; none when the folder was searched.
    pub line: Option<usize>,
}
