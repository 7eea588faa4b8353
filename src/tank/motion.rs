//! Plays the actions of a pass: the true roll, rod moment and speed, millisecond by millisecond.

use rand_chacha::ChaCha8Rng;

use super::action::Action;
use super::carriage::{Carriage, half_sine};
use super::equation::{RollState, RollingModel, advance};
use super::excitation::{Excitation, Following};
use super::imposed::{Heeling, Kinematics, Oscillating, Oscillation};
use super::scenario::Waves;

/// Integration step [s]: under 0.007 rad of roll phase, and a divisor of common sample intervals.
pub(super) const STEP_S: f64 = 1e-3;

/// Roll at which the rig's end stops hold the model [rad].
const END_STOPS_RAD: f64 = std::f64::consts::FRAC_PI_3;

/// Everything that moves the model in one pass.
pub(super) struct Scene<'a> {
    /// The model, in its condition.
    pub(super) model: RollingModel,
    /// The carriage.
    pub(super) carriage: Carriage,
    /// Waves left in the tank.
    pub(super) waves: Option<Waves>,
    /// `b1` [1/s] at a carriage speed [m/s].
    pub(super) b1_per_s: &'a dyn Fn(f64) -> f64,
    /// Randomness of the excitation of an action, by its place in the pass.
    pub(super) draws: &'a dyn Fn(usize) -> ChaCha8Rng,
}

/// The true motion at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    /// Time [s].
    pub(super) time_s: f64,
    /// Roll and roll rate.
    pub(super) state: RollState,
    /// Moment of the oscillator rod [N m].
    pub(super) rod_moment_n_m: f64,
}

/// One action as played: its nodes, both ends included.
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    /// The action.
    pub(super) action: Action,
    /// Start [s].
    pub(super) start_s: f64,
    /// End [s].
    pub(super) end_s: f64,
    /// The motion, [`STEP_S`] apart but for the last step.
    pub(super) nodes: Vec<Node>,
}

/// What moves the model besides water and waves.
enum Drive {
    /// Nothing.
    Free,
    /// A hand's moment [N m] that fades over a time [s].
    Fading { moment_n_m: f64, fade_s: f64 },
    /// A blow.
    Blow { impulse_n_m_s: f64, blow_s: f64 },
    /// A hand that resists the roll.
    Hand { damping_n_m_s: f64 },
    /// A sinusoidal moment of the rod.
    Rod { moment_n_m: f64, frequency_rad_s: f64, ramp_s: f64 },
    /// A moment of the rod [N m] that does not repeat.
    Excited(Excitation),
}

impl Drive {
    /// Moment of anything but the rod [N m].
    fn hand_n_m(&self, elapsed_s: f64, state: RollState) -> f64 {
        match *self {
            Self::Free | Self::Rod { .. } | Self::Excited(_) => 0.0,
            Self::Fading { moment_n_m, fade_s } => {
                let x = (elapsed_s / fade_s).min(1.0);
                0.5 * moment_n_m * (1.0 + (std::f64::consts::PI * x).cos())
            }
            Self::Blow { impulse_n_m_s, blow_s } => half_sine(elapsed_s, blow_s, impulse_n_m_s),
            Self::Hand { damping_n_m_s } => -damping_n_m_s * state.rate_rad_per_s,
        }
    }

    /// Moment of the rod [N m].
    fn rod_n_m(&self, elapsed_s: f64) -> f64 {
        match *self {
            Self::Excited(ref excitation) => excitation.at(elapsed_s)[0],
            Self::Rod { moment_n_m, frequency_rad_s, ramp_s } => {
                let grown = (elapsed_s / ramp_s).min(1.0);
                moment_n_m * grown * (frequency_rad_s * elapsed_s).sin()
            }
            _ => 0.0,
        }
    }
}

impl Scene<'_> {
    /// Moment of waves and jolts [N m].
    fn surroundings_n_m(&self, time_s: f64) -> f64 {
        let waves = self.waves.map_or(0.0, |w| {
            w.moment_n_m * (-time_s / w.decay_s).exp() * (w.frequency_rad_s * time_s).cos()
        });
        waves + self.carriage.shock_n_m(time_s)
    }

    fn b1_per_s(&self, time_s: f64) -> f64 {
        (self.b1_per_s)(self.carriage.speed_m_s(time_s))
    }

    /// Plays the actions from rest.
    pub(super) fn play(&self, actions: &[Action]) -> Vec<Stretch> {
        let mut state = RollState { roll_rad: self.model.rest_roll_rad, rate_rad_per_s: 0.0 };
        let mut oscillation = Oscillation::default();
        let mut start_s = 0.0;
        let mut stretches = Vec::with_capacity(actions.len());
        for (at, action) in actions.iter().enumerate() {
            let end_s = start_s + action.duration_s();
            let excitation = self.excitation(action, at);
            let imposed = self.imposed(action, excitation.as_ref(), state, oscillation);
            let nodes = match &imposed {
                Some(motion) => self.impose(motion, start_s, end_s),
                None => self.roll(&self.drive(action, excitation, state), state, start_s, end_s),
            };
            oscillation = match imposed {
                Some(Imposed { path: Path::Oscillating(path), .. }) => {
                    path.oscillation(end_s - start_s)
                }
                _ => Oscillation::default(),
            };
            state = nodes.last().map_or(state, |node| node.state);
            stretches.push(Stretch { action: *action, start_s, end_s, nodes });
            start_s = end_s;
        }
        stretches
    }

    /// The excitation of an action at its place in the pass, if it has one that does not repeat.
    fn excitation(&self, action: &Action, at: usize) -> Option<Excitation> {
        let band = action.band()?;
        match *action {
            Action::ForcedSweep { amplitude_rad: amplitude, duration_s, ramp_s, .. }
            | Action::DrivenSweep { moment_n_m: amplitude, duration_s, ramp_s, .. } => {
                Some(Excitation::sweep(amplitude, band, duration_s, ramp_s))
            }
            Action::ForcedIrregular { rms_rad: rms, ramp_s, .. }
            | Action::DrivenIrregular { rms_n_m: rms, ramp_s, .. } => {
                Some(Excitation::irregular(rms, band, ramp_s, &mut (self.draws)(at)))
            }
            _ => None,
        }
    }

    fn imposed(
        &self,
        action: &Action,
        excitation: Option<&Excitation>,
        from: RollState,
        before: Oscillation,
    ) -> Option<Imposed> {
        let rest = self.model.rest_roll_rad;
        let oscillating = |amplitude_rad, frequency_rad_s, ramp_s| {
            let path = Oscillating::new(from, before, amplitude_rad, frequency_rad_s, ramp_s, rest);
            Path::Oscillating(path)
        };
        let (by_rod, path) = match *action {
            Action::Hold { heel_rad, duration_s, ramp_s, tremor_rad } => {
                let heel_rad = rest + heel_rad;
                (false, Path::Heeling(Heeling { from, heel_rad, ramp_s, duration_s, tremor_rad }))
            }
            Action::Rock { amplitude_rad, frequency_rad_s, duration_s } => {
                (false, oscillating(amplitude_rad, frequency_rad_s, duration_s))
            }
            Action::Forced { amplitude_rad, frequency_rad_s, ramp_s, .. } => {
                (true, oscillating(amplitude_rad, frequency_rad_s, ramp_s))
            }
            // The frequency does not matter: an oscillation that stops keeps the one it had.
            Action::Stop { ramp_s, .. } => (true, oscillating(0.0, 1.0, ramp_s)),
            Action::ForcedSweep { .. } | Action::ForcedIrregular { .. } => {
                (true, Path::Following(Following::new(from, rest, excitation?.clone())))
            }
            _ => return None,
        };
        Some(Imposed { by_rod, path })
    }

    fn drive(&self, action: &Action, excitation: Option<Excitation>, from: RollState) -> Drive {
        if let Some(excitation) = excitation {
            return Drive::Excited(excitation);
        }
        match *action {
            Action::Release { fade_s, .. } if fade_s > 0.0 => {
                let still = RollState { rate_rad_per_s: 0.0, ..from };
                Drive::Fading { moment_n_m: self.model.moment_needed(0.0, still, 0.0), fade_s }
            }
            Action::Strike { impulse_n_m_s, blow_s, .. } => Drive::Blow { impulse_n_m_s, blow_s },
            Action::Catch { damping_ratio, .. } => {
                let critical =
                    2.0 * (self.model.inertia_kg_m2 * self.model.restoring_n_m_per_rad).sqrt();
                Drive::Hand { damping_n_m_s: damping_ratio * critical }
            }
            Action::Driven { moment_n_m, frequency_rad_s, ramp_s, .. } => {
                Drive::Rod { moment_n_m, frequency_rad_s, ramp_s }
            }
            _ => Drive::Free,
        }
    }

    fn roll(&self, drive: &Drive, from: RollState, start_s: f64, end_s: f64) -> Vec<Node> {
        let acceleration = |time_s: f64, state: RollState| {
            let elapsed_s = time_s - start_s;
            let moment = drive.hand_n_m(elapsed_s, state)
                + drive.rod_n_m(elapsed_s)
                + self.surroundings_n_m(time_s);
            self.model.acceleration(self.b1_per_s(time_s), state, moment)
        };
        let mut nodes: Vec<Node> = Vec::new();
        let mut state = from;
        for time_s in instants(start_s, end_s) {
            if let Some(last) = nodes.last() {
                state = advance(state, last.time_s, time_s - last.time_s, acceleration);
                if state.roll_rad.abs() > END_STOPS_RAD {
                    let roll_rad = END_STOPS_RAD.copysign(state.roll_rad);
                    state = RollState { roll_rad, rate_rad_per_s: 0.0 };
                }
            }
            let rod_moment_n_m = drive.rod_n_m(time_s - start_s);
            nodes.push(Node { time_s, state, rod_moment_n_m });
        }
        nodes
    }

    fn impose(&self, motion: &Imposed, start_s: f64, end_s: f64) -> Vec<Node> {
        instants(start_s, end_s)
            .map(|time_s| {
                let kinematics = motion.path.at(time_s - start_s);
                let needed = self.model.moment_needed(
                    self.b1_per_s(time_s),
                    kinematics.state(),
                    kinematics.acceleration_rad_per_s2,
                );
                let rod_moment_n_m =
                    if motion.by_rod { needed - self.surroundings_n_m(time_s) } else { 0.0 };
                Node { time_s, state: kinematics.state(), rod_moment_n_m }
            })
            .collect()
    }
}

/// A motion that hand or rod impose.
struct Imposed {
    by_rod: bool,
    path: Path,
}

enum Path {
    Heeling(Heeling),
    Oscillating(Oscillating),
    Following(Following),
}

impl Path {
    fn at(&self, elapsed_s: f64) -> Kinematics {
        match self {
            Self::Heeling(path) => path.at(elapsed_s),
            Self::Oscillating(path) => path.at(elapsed_s),
            Self::Following(path) => path.at(elapsed_s),
        }
    }
}

/// Instants [`STEP_S`] apart from `start_s`, and `end_s`.
fn instants(start_s: f64, end_s: f64) -> impl Iterator<Item = f64> {
    let n_whole = ((end_s - start_s) / STEP_S - 1e-6).floor().max(0.0) as usize;
    (0..=n_whole).map(move |k| start_s + k as f64 * STEP_S).chain(std::iter::once(end_s))
}

/// Roll [rad] and rod moment [N m] at any time of the pass, between the nodes by interpolation.
pub(super) fn motion_at(stretches: &[Stretch], time_s: f64) -> (f64, f64) {
    let which = stretches.partition_point(|s| s.end_s <= time_s).min(stretches.len() - 1);
    let nodes = &stretches[which].nodes;
    let right = nodes.partition_point(|n| n.time_s <= time_s).clamp(1, nodes.len() - 1);
    let (a, b) = (&nodes[right - 1], &nodes[right]);
    let h = b.time_s - a.time_s;
    if h <= 0.0 {
        return (b.state.roll_rad, b.rod_moment_n_m);
    }
    let x = ((time_s - a.time_s) / h).clamp(0.0, 1.0);
    // Cubic Hermite: the rates are known, so the error is of order 4 like the integrator's.
    let (p, q) = (x * x * (3.0 - 2.0 * x), x * (1.0 - x));
    let roll = a.state.roll_rad * (1.0 - p)
        + b.state.roll_rad * p
        + h * q * (a.state.rate_rad_per_s * (1.0 - x) - b.state.rate_rad_per_s * x);
    (roll, a.rod_moment_n_m + x * (b.rod_moment_n_m - a.rod_moment_n_m))
}
