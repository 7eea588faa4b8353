//! The scenario: model, tank, instruments, conditions and passes, as a naval architect writes them.
//!
//! A scenario is a TOML file; `docs/scenario.md` holds a complete example. The keys are the field
//! names below, with angles in degrees in the file (`heel_deg`) and radians here (`heel_rad`).

use serde::Deserialize;

use super::action::Action;
use super::action::degrees;
use super::instruments::Instruments;
use super::instruments::RecordingFormat;
use crate::hull::{Hull, Water};

/// Everything one simulated campaign needs.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Name of the campaign, for titles.
    pub name: String,
    /// `[hull]`: `length_pp_m`, `beam_m`, `draft_m`, `displacement_m3`, `gm_m`.
    #[serde(with = "HullKeys")]
    pub hull: Hull,
    /// `[water]`: `density_kg_m3`, `gravity_m_s2`; fresh water when left out.
    #[serde(with = "WaterKeys", default)]
    pub water: Water,
    /// `[tank]`: how far and how fast the carriage can go.
    pub tank: Basin,
    /// `[exciter]`: the rod that forces the roll; needed when a force is recorded.
    #[serde(default)]
    pub exciter: Option<Shaker>,
    /// `[instruments.roll]`, `.force`, `.moment`, `.speed`: a channel left out is not recorded.
    pub instruments: Instruments,
    /// `[recordings]`: how the files are written.
    #[serde(default)]
    pub recordings: RecordingFormat,
    /// `[[condition]]`: loading or appendage conditions, each with its damping.
    #[serde(rename = "condition")]
    pub conditions: Vec<Condition>,
    /// `[[pass]]`: one recording each, times its `repeat`.
    #[serde(rename = "pass")]
    pub passes: Vec<Pass>,
}

#[derive(Deserialize)]
#[serde(remote = "Hull", deny_unknown_fields)]
struct HullKeys {
    length_pp_m: f64,
    beam_m: f64,
    draft_m: f64,
    displacement_m3: f64,
    gm_m: f64,
}

#[derive(Deserialize)]
#[serde(remote = "Water", deny_unknown_fields)]
struct WaterKeys {
    density_kg_m3: f64,
    gravity_m_s2: f64,
}

/// The tank and its carriage.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Basin {
    /// Length [m].
    pub length_m: f64,
    /// Width [m].
    pub width_m: f64,
    /// Depth [m].
    pub depth_m: f64,
    /// Greatest carriage speed [m/s].
    pub carriage_max_speed_m_s: f64,
    /// Length at the two ends together that the carriage cannot use [m].
    #[serde(default)]
    pub end_margin_m: f64,
    /// Acceleration when speeding up [m/s2].
    #[serde(default = "half")]
    pub carriage_acceleration_m_s2: f64,
    /// Deceleration when braking [m/s2].
    #[serde(default = "half")]
    pub carriage_braking_m_s2: f64,
}

fn half() -> f64 {
    0.5
}

/// The oscillator rod.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shaker {
    /// Distance from the roll axis to the pin joint of the rod [m].
    pub moment_arm_m: f64,
    /// How the arm changes with the roll angle.
    #[serde(default)]
    pub arm: ArmShape,
    /// Length of the rod between its joints [m], for `arm = "rod"` only.
    #[serde(default)]
    pub rod_length_m: Option<f64>,
    /// Sign of the recorded force: `1.0` when a positive one rolls to starboard, else `-1.0`.
    #[serde(default = "unit")]
    pub force_sign: f64,
}

fn unit() -> f64 {
    1.0
}

/// How the moment arm of the rod depends on the roll angle.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ArmShape {
    /// The arm is the same at every angle, as in the paper.
    #[default]
    Constant,
    /// The rod stays vertical, so the arm shrinks with the cosine of the roll angle.
    Cosine,
    /// The rod, hung above the port side, leans as its pin joint moves sideways with the roll.
    Rod,
}

/// One loading or appendage condition of the model.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// Name, as passes and reports call it.
    pub name: String,
    /// Natural roll frequency at small angles [rad/s].
    pub natural_frequency_rad_s: f64,
    /// Damping: `damping.table = [..]` or `damping.law = {..}`.
    pub damping: Damping,
}

/// Damping per unit inertia `b1 phi' + b3 phi'^3` against Froude number.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Damping {
    /// Rows in order of Froude number, joined by straight lines in `Fr^2`, that reach every pass.
    Table(Vec<DampingRow>),
    /// `b1 = b0 (1 + kappa Fr^2)` (4.3), with a scatter from pass to pass.
    Law(DampingLaw),
}

/// Damping at one Froude number, a row of Table 2.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DampingRow {
    /// Froude number [-].
    pub froude: f64,
    /// Linear coefficient [1/s].
    pub b1_per_s: f64,
    /// Cubic coefficient [s].
    pub b3_s: f64,
}

/// The law (4.3) with what it leaves unsaid: the scatter from pass to pass.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DampingLaw {
    /// Linear damping at rest [1/s].
    pub b0_per_s: f64,
    /// Speed coefficient [-].
    pub kappa: f64,
    /// Cubic coefficient, the same at every speed [s].
    pub b3_s: f64,
    /// Standard deviation of `b1` from pass to pass [1/s], drawn from the seed.
    #[serde(default)]
    pub scatter_per_s: f64,
}

/// One trip of the carriage, or one stay at zero speed: one recording.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pass {
    /// Name of the recording; `pass_01`, `pass_02`, .. when left out.
    #[serde(default)]
    pub name: Option<String>,
    /// Condition of the model.
    pub condition: String,
    /// Froude number of the steady stretch [-]; either this or `speed_m_s`.
    #[serde(default)]
    pub froude: Option<f64>,
    /// Carriage speed of the steady stretch [m/s]; either this or `froude`.
    #[serde(default)]
    pub speed_m_s: Option<f64>,
    /// How many times the pass is made, each with its own draws.
    #[serde(default = "once")]
    pub repeat: usize,
    /// Speed that the campaign file claims [m/s] where no speed channel is recorded.
    #[serde(default)]
    pub declared_speed_m_s: Option<f64>,
    /// Heel at which the model rests [rad], `static_heel_deg` in the file.
    #[serde(default, rename = "static_heel_deg", deserialize_with = "degrees")]
    pub static_heel_rad: f64,
    /// When the carriage starts and brakes.
    #[serde(default)]
    pub carriage: CarriagePlan,
    /// Zeros of the instruments and their drift.
    #[serde(default)]
    pub zero: Zeros,
    /// Waves left in the tank.
    #[serde(default)]
    pub waves: Option<Waves>,
    /// Vibration of the carriage seen by the roll instrument.
    #[serde(default)]
    pub vibration: Option<Vibration>,
    /// `[[pass.gap]]`: samples that were never written.
    #[serde(default, rename = "gap")]
    pub gaps: Vec<Gap>,
    /// `[[pass.action]]`: what is done to the model, one after the other.
    #[serde(rename = "action")]
    pub actions: Vec<Action>,
}

fn once() -> usize {
    1
}

/// The carriage in one pass.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CarriagePlan {
    /// When the carriage starts [s].
    pub start_s: f64,
    /// When it brakes [s]; as late as the tank allows when left out.
    pub brake_s: Option<f64>,
    /// Roll impulse [N m s] at the start and at the end of speeding up and of braking.
    pub shock_n_m_s: f64,
}

impl Default for CarriagePlan {
    fn default() -> Self {
        Self { start_s: 2.0, brake_s: None, shock_n_m_s: 0.0 }
    }
}

/// Zeros of the instruments during one pass.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Zeros {
    /// What the roll instrument shows upright [rad], `roll_deg` in the file.
    #[serde(rename = "roll_deg", deserialize_with = "degrees")]
    pub roll_rad: f64,
    /// Drift of that zero [rad/s], `roll_drift_deg_per_s` in the file.
    #[serde(rename = "roll_drift_deg_per_s", deserialize_with = "degrees")]
    pub roll_drift_rad_per_s: f64,
    /// What the force instrument shows unloaded [N].
    pub force_n: f64,
    /// What the moment instrument shows unloaded [N m].
    pub moment_n_m: f64,
}

/// Waves left over from the pass before, as a roll moment that dies away from the first sample on.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Waves {
    /// Amplitude of the roll moment at the first sample [N m].
    pub moment_n_m: f64,
    /// Frequency [rad/s].
    pub frequency_rad_s: f64,
    /// Time in which the amplitude falls to 37 % [s].
    pub decay_s: f64,
}

/// Vibration that the roll instrument shows while the carriage moves, proportional to its speed.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vibration {
    /// Amplitude at the steady speed [rad], `amplitude_deg` in the file.
    #[serde(rename = "amplitude_deg", deserialize_with = "degrees")]
    pub amplitude_rad: f64,
    /// Frequency [Hz].
    pub frequency_hz: f64,
}

/// A hole in the record.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gap {
    /// First missing instant [s].
    pub start_s: f64,
    /// Length [s].
    pub duration_s: f64,
    /// `roll`, `force`, `moment` or `speed`; every channel when left out.
    #[serde(default)]
    pub channel: Option<String>,
}
