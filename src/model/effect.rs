//! What an effect is: its equation as functions of an instant, its parameters, its scope.

use super::echo::Taps;
use super::number::Sloped;
use crate::roll::cross_modes::Section;
use crate::run::RunKind;

/// Logarithm of the odds that a parameter of a run with this value, known to this deviation, is
/// what its effect says and not something else that takes its form.
pub type Odds = fn(&Circumstances, f64, f64) -> f64;

/// One number of an effect.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// Symbol, as the equation writes it.
    pub symbol: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Standard deviation of its normal prior about nil, or about its node for a shape.
    pub typical: f64,
    /// Physical range; an effect outside is not named.
    pub range: [f64; 2],
    /// What the tank says of its value; none where it may be any in its range.
    pub odds: Option<Odds>,
    /// Whether it is an instant at which the effect sets in at once, so that readings jump.
    pub is_instant: bool,
}

impl Parameter {
    /// A parameter.
    pub const fn new(
        symbol: &'static str,
        unit: &'static str,
        typical: f64,
        range: [f64; 2],
    ) -> Self {
        Self { symbol, unit, typical, range, odds: None, is_instant: false }
    }

    /// The same where it is an instant at which the effect sets in at once.
    #[must_use]
    pub const fn at_once(self) -> Self {
        Self { is_instant: true, ..self }
    }

    /// The same where the tank says which values it may have.
    #[must_use]
    pub const fn held_to(self, odds: Odds) -> Self {
        Self { odds: Some(odds), ..self }
    }
}

/// The part of the simulation that an effect belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layer {
    /// Moment with the roll rate.
    Damping,
    /// Moment with the roll.
    Restoring,
    /// Moment with the roll acceleration.
    Inertia,
    /// The oscillator rod.
    Exciter,
    /// The measuring chain.
    Instrument,
    /// Tank, carriage and handling.
    Tank,
}

/// What one set of an effect's parameters covers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// The whole campaign.
    Campaign,
    /// Each condition has its own.
    Condition,
    /// Each run has its own.
    Run,
    /// The same, and few runs have any.
    OddRun,
}

/// Runs of which one may have what few have; by judgement: where more seem to carry a wrong label,
/// it is the model that is wrong.
const RUNS_OF_ONE_ODD: usize = 10;

impl Scope {
    /// Whether each run has its own set.
    pub fn is_of_each_run(self) -> bool {
        matches!(self, Self::Run | Self::OddRun)
    }

    /// How many runs of `n_runs` may have a set of their own.
    pub fn most_runs(self, n_runs: usize) -> usize {
        match self {
            Self::OddRun => (n_runs / RUNS_OF_ONE_ODD).max(1),
            _ => n_runs,
        }
    }
}

/// Where and when a run was made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circumstances {
    /// Decay or forced.
    pub kind: RunKind,
    /// Froude number [-].
    pub froude: f64,
    /// Carriage speed [m/s].
    pub speed_m_s: f64,
    /// Natural frequency [rad/s] as identified: for scales, never for an equation.
    pub natural_rad_s: f64,
    /// Linear damping [1/s] as identified, for scales too; at least a hundredth of a per cent of
    /// critical.
    pub b1_per_s: f64,
    /// Total inertia `K/w^2` [kg m2].
    pub inertia_kg_m2: f64,
    /// Largest roll [rad].
    pub amplitude_rad: f64,
    /// Frequency of the excitation [rad/s]; the natural one in a decay.
    pub rolling_rad_s: f64,
    /// Length [s].
    pub span_s: f64,
    /// Gravity [m/s2].
    pub gravity_m_s2: f64,
    /// Clear water between both tank walls and both sides of the model [m], where known.
    pub clear_width_m: Option<f64>,
    /// Section of the tank, where its width is known.
    pub section: Option<Section>,
    /// Sample rate of the roll channel [Hz].
    pub sample_rate_hz: f64,
    /// Place in the order of runs.
    pub order: usize,
    /// Whether the exciting moment was recorded.
    pub has_moment: bool,
    /// Runs of the campaign.
    pub n_runs: usize,
    /// Roll at the start [rad].
    pub initial_roll_rad: f64,
    /// For how long a rod had rolled the model when its record begins [s]: what comes back later
    /// than that is not back yet. Infinite where it is not known.
    pub rolled_for_s: f64,
    /// Time from the model's last rest, where its channels read their zeros, to time zero [s];
    /// nought where it is not known.
    pub since_rest_s: f64,
}

/// What a roll record shows without any model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facts {
    /// Step between its values [rad], where coarse enough to be seen.
    pub quantum_rad: Option<f64>,
    /// A line in its noise.
    pub line: Option<Line>,
    /// Where lines are sought [Hz]: above the roll and its harmonics.
    pub line_band_hz: [f64; 2],
    /// Samples.
    pub n_samples: usize,
    /// Sample rate [Hz].
    pub sample_rate_hz: f64,
    /// Froude number of the run [-].
    pub froude: f64,
    /// Crests that are cut off.
    pub clip: Option<Clip>,
}

/// Crests that are flat at one level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clip {
    /// The level [rad].
    pub level_rad: f64,
    /// Its standard deviation [rad].
    pub sd_rad: f64,
    /// Logarithm of the Bayes factor against round crests [-].
    pub log_bayes_factor: f64,
}

/// One frequency that stands out of the noise of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Frequency as it shows [Hz].
    pub frequency_hz: f64,
    /// Amplitude [rad].
    pub amplitude_rad: f64,
    /// Standard deviation of the amplitude [rad].
    pub amplitude_sd_rad: f64,
    /// Logarithm of the Bayes factor against none [-].
    pub log_bayes_factor: f64,
}

/// What an effect makes of a record alone.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// Logarithm of the Bayes factor for the effect in this run [-].
    pub log_bayes_factor: f64,
    /// Mean and standard deviation of each strength.
    pub values: Vec<(f64, f64)>,
    /// Where the same cause would show a line in another run; none for what is no line.
    pub recurs: Option<Recurs>,
}

/// How the frequency of a line depends on the run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Recurs {
    /// The same frequency everywhere [Hz].
    Fixed(f64),
    /// In proportion to the Froude number [Hz].
    PerFroude(f64),
}

impl Recurs {
    /// Whether two recur by the same law.
    pub fn is_alike(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }

    /// Frequency of the line [Hz] at a Froude number.
    pub fn frequency_hz(&self, froude: f64) -> f64 {
        match self {
            Self::Fixed(hz) => *hz,
            Self::PerFroude(hz) => hz * froude,
        }
    }
}

/// The motion at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Instant<'a, N = f64> {
    /// Time since the start of the run [s].
    pub time_s: f64,
    /// Roll [rad].
    pub roll_rad: N,
    /// Roll rate [rad/s].
    pub rate_rad_per_s: N,
    /// Roll acceleration [rad/s2]; in a decay, that of the base equation.
    pub acceleration_rad_per_s2: N,
    /// Exciting moment [N m].
    pub moment_n_m: N,
    /// Natural frequency of the base equation [rad/s].
    pub natural_rad_s: N,
    /// Linear damping of the base equation [1/s].
    pub b1_per_s: N,
    /// The run.
    pub run: &'a Circumstances,
}

/// A function of the instant and the parameters, strengths first, then shapes: one equation,
/// compiled for plain numbers and for numbers that know their slopes.
#[derive(Debug, Clone, Copy)]
pub struct Law {
    /// For its value.
    pub plain: fn(&Instant<'_>, &[f64]) -> f64,
    /// For its slopes as well.
    pub sloped: fn(&Instant<'_, Sloped>, &[Sloped]) -> Sloped,
}

/// What a channel adds to all of a record's instants, in order of time.
#[derive(Debug, Clone, Copy)]
pub struct Reading {
    /// For its value.
    pub plain: fn(&[Instant<'_>], &[f64]) -> Vec<f64>,
    /// For its slopes as well.
    pub sloped: fn(&[Instant<'_, Sloped>], &[Sloped]) -> Vec<Sloped>,
}

/// A function of the instant, the parameters and the states of an effect that remembers.
#[derive(Debug, Clone, Copy)]
pub struct LagLaw<P, S> {
    /// For its value.
    pub plain: fn(&Instant<'_>, &[f64], &[f64]) -> P,
    /// For its slopes as well.
    pub sloped: fn(&Instant<'_, Sloped>, &[Sloped], &[Sloped]) -> S,
}

/// States of an effect that remembers; their equation is linear in them and the same all along.
#[derive(Debug, Clone, Copy)]
pub struct Lag {
    /// Number of states, at most [`MOST_LAGS`].
    pub n_states: usize,
    /// Whether heeling the model stirs them, so that each release finds them as they happen to be.
    pub is_stirred: bool,
    /// Slopes of the states.
    pub slope: LagLaw<[f64; MOST_LAGS], [Sloped; MOST_LAGS]>,
    /// Moment per unit inertia [rad/s2] of the states.
    pub moment: LagLaw<f64, Sloped>,
}

/// Most states that an effect may have.
pub const MOST_LAGS: usize = 2;

/// Where an effect enters.
#[derive(Debug, Clone, Copy)]
pub enum Acts {
    /// Moment per unit inertia [rad/s2] on the right-hand side.
    Moment(Law),
    /// The same of the roll and its rate at earlier times.
    Echo(Taps),
    /// Share added to the inertia [-].
    Inertia(Law),
    /// Moment of states that follow the motion.
    Lagging(Lag),
    /// What the roll channel adds [rad], sample by sample in order of time.
    Roll(Reading),
    /// What the moment channel adds [N m].
    Drive(Law),
    /// What the roll channel adds [rad], and the moment channel [N m], sample by sample in order of
    /// time.
    Chain(Reading, Reading),
    /// Seen in the record alone; it disturbs no estimate but the noise.
    Record(fn(&Facts) -> Option<Seen>),
}

/// One extension of the simulation model.
#[derive(Debug, Clone, Copy)]
pub struct Effect {
    /// Name of the contract.
    pub id: &'static str,
    /// Layer.
    pub layer: Layer,
    /// Equation, as the field writes it.
    pub equation: &'static str,
    /// Parameters that are nil without the effect and enter linearly when small.
    pub strengths: &'static [Parameter],
    /// Parameters that shape it.
    pub shapes: &'static [Parameter],
    /// Shapes to start from.
    pub nodes: fn(&Circumstances) -> Vec<Vec<f64>>,
    /// What one set of parameters covers.
    pub scope: Scope,
    /// Whether a run can show it.
    pub shows: fn(&Circumstances) -> bool,
    /// Where it enters.
    pub acts: Acts,
    /// Effects that no run of a roll test could part from it.
    pub always_equivalent: &'static [&'static str],
    /// Source.
    pub reference: &'static str,
}

impl Effect {
    /// Number of parameters of one set.
    pub fn n_parameters(&self) -> usize {
        self.strengths.len() + self.shapes.len()
    }

    /// Whether a rod's pin rings whenever its force changes sign.
    pub fn is_ringing(&self) -> bool {
        self.layer == Layer::Exciter && matches!(self.acts, Acts::Chain(..))
    }

    /// Parameter number `k`, strengths first.
    pub fn parameter(&self, k: usize) -> &'static Parameter {
        if k < self.strengths.len() {
            &self.strengths[k]
        } else {
            &self.shapes[k - self.strengths.len()]
        }
    }
}

/// No shape: one node without numbers.
pub fn one_node(_: &Circumstances) -> Vec<Vec<f64>> {
    vec![Vec::new()]
}

/// Nodes of a single shape.
pub fn each(values: &[f64]) -> Vec<Vec<f64>> {
    values.iter().map(|v| vec![*v]).collect()
}

/// Every run shows it.
pub fn any_run(_: &Circumstances) -> bool {
    true
}

/// Only a decay shows it.
pub fn decays(run: &Circumstances) -> bool {
    run.kind == RunKind::Decay
}

/// Only a forced run shows it.
pub fn forced(run: &Circumstances) -> bool {
    run.kind == RunKind::Forced
}

/// Froude number up to which a carriage rests [-]: a channel's zero is no speed.
pub const UNDER_WAY_FROUDE: f64 = 0.01;

/// Only a run under way shows it.
pub fn under_way(run: &Circumstances) -> bool {
    run.froude > UNDER_WAY_FROUDE
}

/// Only a run with a recorded moment shows it.
pub fn with_moment(run: &Circumstances) -> bool {
    run.has_moment
}
