//! What a campaign has taught so far: runs, rejections, damping against Froude number.

use devices::channel::Brought;

use crate::inverse::identification::{EquivalentDamping, FroudeLaw, Identification};
use crate::run::{Run, Series};

/// One identified run in its place in the campaign.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifiedRun {
    /// Unique in the campaign and safe in a file name, such as `pass_03-2`.
    pub id: String,
    /// Name of the recording, as in the campaign file.
    pub recording: String,
    /// Loading or appendage condition.
    pub condition: String,
    /// Carriage speed over the run [m/s]: measured, else as declared for the recording.
    pub speed_m_s: f64,
    /// Froude number over the run [-].
    pub froude: f64,
    /// How densely it was sampled.
    pub sampling: Sampling,
    /// What the instruments brought on each channel of it; none where no instrument was read.
    pub brought: Vec<Brought>,
    /// The run as found.
    pub run: Run,
    /// What it says.
    pub identification: Identification,
}

/// Roll amplitude [deg] at which runs are compared with each other.
pub const COMPARISON_DEG: f64 = 5.0;

impl IdentifiedRun {
    /// Equivalent damping at the amplitude at which runs are compared, if the run gives one.
    pub fn at_comparison(&self) -> Option<&EquivalentDamping> {
        self.at(COMPARISON_DEG)
    }

    /// Equivalent damping at one of the contract's amplitudes [deg], if the run gives one.
    pub fn at(&self, amplitude_deg: f64) -> Option<&EquivalentDamping> {
        let all = &self.identification.equivalent_damping;
        all.iter().find(|at| (at.amplitude_deg - amplitude_deg).abs() < 1e-9)
    }
}

/// Mean sampling rates over a run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sampling {
    /// Of the roll [Hz].
    pub roll_hz: Option<f64>,
    /// Of the rod force or moment [Hz], where one was recorded.
    pub drive_hz: Option<f64>,
}

impl Sampling {
    /// The rates of a run whose samples are still there.
    pub fn of(run: &Run) -> Self {
        let rate_hz = |series: &Series| {
            let (first_s, last_s) = (*series.time_s.first()?, *series.time_s.last()?);
            let n_intervals = series.time_s.len() - 1;
            (last_s > first_s).then(|| n_intervals as f64 / (last_s - first_s))
        };
        Self { roll_hz: rate_hz(&run.roll), drive_hz: rate_hz(&run.drive) }
    }
}

/// A stretch of a recording that was not used.
#[derive(Debug, Clone, PartialEq)]
pub struct RejectedStretch {
    /// Name of the recording, as in the campaign file.
    pub recording: String,
    /// Start [s].
    pub start_s: f64,
    /// End [s].
    pub end_s: f64,
    /// The reason, as a sentence with its values and limits.
    pub reason: String,
    /// Id of the run that it is, when it was rejected by hand.
    pub run: Option<String>,
}

/// A whole recording, thinned for drawing: lowest and highest value of each stretch.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Overview {
    /// Name of the recording, as in the campaign file.
    pub recording: String,
    /// Roll [rad]: a low and a high value per stretch.
    pub roll: Series,
    /// Carriage speed [m/s], where recorded.
    pub speed: Series,
    /// Rod force [N] or moment [N m], where recorded.
    pub drive: Series,
    /// What was lost or mended while reading, as sentences.
    pub notes: Vec<String>,
}

/// Everything the campaign has taught so far.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Results {
    /// Identified runs in the order in which they ended.
    pub runs: Vec<IdentifiedRun>,
    /// Stretches not used, in order.
    pub rejected: Vec<RejectedStretch>,
    /// One law per condition that has runs at two Froude numbers or more.
    pub froude_laws: Vec<FroudeLaw>,
    /// One per recording read.
    pub overviews: Vec<Overview>,
}

/// Froude numbers further apart than this [-] were meant to differ.
pub const FROUDE_APART: f64 = 0.012;

/// Runs in groups of one nominal Froude number, slowest first.
pub fn by_speed(mut runs: Vec<&IdentifiedRun>) -> Vec<Vec<&IdentifiedRun>> {
    runs.sort_by(|a, b| a.froude.total_cmp(&b.froude));
    runs.chunk_by(|a, b| b.froude - a.froude <= FROUDE_APART).map(<[_]>::to_vec).collect()
}

/// Periods that a rod may take from one steady excitation to the next, or to rest.
const CHANGEOVER_PERIODS: f64 = 5.0;

impl Results {
    /// Conditions that have runs, in the order in which they were first met.
    pub fn conditions(&self) -> Vec<&str> {
        let mut conditions: Vec<&str> = Vec::new();
        for run in &self.runs {
            if !conditions.contains(&run.condition.as_str()) {
                conditions.push(&run.condition);
            }
        }
        conditions
    }

    /// Refusals to be judged, then the short changeovers beside forced runs: the rod starts, stops
    /// or goes over to its next frequency. Each in order.
    pub fn refusals_and_changeovers(&self) -> (Vec<&RejectedStretch>, Vec<&RejectedStretch>) {
        self.rejected.iter().partition(|stretch| {
            self.runs
                .iter()
                .filter(|run| run.recording == stretch.recording)
                .all(|run| !stretch.is_changeover_of(run))
        })
    }
}

impl RejectedStretch {
    /// Whether the stretch is short and touches this forced run.
    fn is_changeover_of(&self, run: &IdentifiedRun) -> bool {
        let Some(forced) = &run.identification.forced else { return false };
        let limit_s = CHANGEOVER_PERIODS * std::f64::consts::TAU / forced.frequency_rad_s.mean;
        let before_s = (run.run.start_s - self.end_s).abs();
        let after_s = (self.start_s - run.run.end_s).abs();
        self.end_s - self.start_s <= limit_s && before_s.min(after_s) <= limit_s
    }
}
