//! What really happened in a pass: the runs in it, their true coefficients, the unusable stretches.

use serde::{Deserialize, Serialize};

/// The truth of a whole simulated campaign, sealed in a file beside its folder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CampaignTruth {
    /// Version of this file's shape.
    pub schema: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of all draws.
    pub seed: u64,
    /// One per recording.
    pub passes: Vec<PassTruth>,
}

/// The truth of one pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PassTruth {
    /// Name of the recording.
    pub name: String,
    /// Condition of the model.
    pub condition: String,
    /// Carriage speed of the steady stretch [m/s].
    pub speed_m_s: f64,
    /// Froude number of the steady stretch [-].
    pub froude: f64,
    /// The runs, in order of time.
    pub runs: Vec<TrueRun>,
    /// Stretches that no run may use, in order of time.
    pub unusable: Vec<TrueRejection>,
}

/// How the model was set rolling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TrueKind {
    /// Free rolling.
    Decay,
    /// Rolling under the rod.
    Forced,
}

/// Why a run ends where it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TrueEnd {
    /// The roll amplitude falls below three times the noise.
    LostInNoise,
    /// A hand or the rod stopped the roll.
    Caught,
    /// The carriage braked.
    PassEnded,
    /// A blow.
    ReStruck,
    /// The excitation changed or stopped.
    ExcitationChanged,
    /// Samples are missing.
    Gap,
    /// The recording ended.
    RecordingEnded,
}

/// One run with what an identification of it should find.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrueRun {
    /// Decay or forced.
    pub kind: TrueKind,
    /// First instant at which the model rolls freely, steadily under the rod, or under an
    /// excitation that does not repeat [s].
    pub start_s: f64,
    /// Last usable instant [s].
    pub end_s: f64,
    /// Why it ends there.
    pub end: TrueEnd,
    /// Froude number [-].
    pub froude: f64,
    /// Natural frequency at small angles [rad/s].
    pub natural_frequency_rad_s: f64,
    /// Linear damping per unit inertia [1/s].
    pub b1_per_s: f64,
    /// Cubic damping per unit inertia [s].
    pub b3_s: f64,
    /// Roll from the position of rest at the start [rad].
    pub initial_roll_rad: f64,
    /// Roll rate at the start [rad/s].
    pub initial_roll_rate_rad_per_s: f64,
    /// Total inertia `I + dI` [kg m2].
    pub inertia_kg_m2: f64,
    /// Frequency of the excitation [rad/s], forced runs that repeat only.
    pub excitation_rad_s: Option<f64>,
    /// Imposed roll amplitude [rad], where one is imposed.
    pub imposed_amplitude_rad: Option<f64>,
}

/// Why a stretch cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RejectedKind {
    /// The carriage was speeding up.
    SpeedUp,
    /// The carriage was braking or had stopped.
    Braking,
    /// A hand or line held the model.
    Held,
    /// A hand rocked the model.
    Rocked,
    /// The blow itself.
    Struck,
    /// A hand stopped the model.
    Caught,
    /// The forced motion was building up or changing.
    StartUp,
    /// The rod was stopping the model.
    Stopping,
    /// Samples are missing, and the decay behind the hole has no start.
    Gap,
    /// Free or steady rolling of too few periods.
    TooShort,
}

/// A stretch that no run may use.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TrueRejection {
    /// Why.
    pub kind: RejectedKind,
    /// Start [s].
    pub start_s: f64,
    /// End [s].
    pub end_s: f64,
}
