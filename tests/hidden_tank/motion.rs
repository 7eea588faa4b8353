//! What the model does in a pass, and what moment the rod needs.

use super::base::{Base, froude};
use super::effect::{Hiding, Situation, own_states};
use super::integrate::{State, step};
use super::plan::Pass;
use super::timeline::{Timeline, imposed};

/// Time that a model with hidden effects gets to find its rest before the recording [s].
const SETTLING_S: f64 = 6.0;

/// Motion and moment of one pass on an even time grid.
#[derive(Clone)]
pub(crate) struct Motion {
    /// Distance of the grid [s].
    pub(crate) step_s: f64,
    /// Time since the start of the recording [s].
    pub(crate) time_s: Vec<f64>,
    /// Roll [rad].
    pub(crate) roll: Vec<f64>,
    /// Moment of the rod, positive to positive roll [N m]; nought where it is not coupled.
    pub(crate) moment: Vec<f64>,
    /// Carriage speed [m/s].
    pub(crate) speed: Vec<f64>,
}

/// A free start: time [s], roll [rad], roll rate [rad/s].
#[derive(Clone, Copy)]
pub(crate) struct Start {
    pub(crate) time_s: f64,
    pub(crate) roll: f64,
    pub(crate) rate: f64,
}

/// The tank during one pass.
struct World<'a> {
    pass: &'a Pass,
    base: &'a Base,
    hiding: &'a Hiding,
    own: Vec<std::ops::Range<usize>>,
    line: Timeline,
}

impl World<'_> {
    fn speed_m_s(&self, time_s: f64) -> f64 {
        let asked = self.line.speed_m_s(self.pass, time_s);
        let since_start_s = time_s - self.line.start_s;
        self.hiding.iter().fold(asked, |v, effect| effect.speed(self.pass, since_start_s, v))
    }

    fn situation(&self, time_s: f64, roll: f64, rate: f64) -> Situation<'_> {
        Situation {
            time_s,
            since_start_s: time_s - self.line.start_s,
            roll,
            rate,
            froude: froude(self.speed_m_s(time_s)),
            free: imposed(self.pass, &self.line, time_s).is_none(),
            base: self.base,
            pass: self.pass,
        }
    }

    /// All moments but that of the rod [N m], and the inertia [kg m2].
    fn moment_and_inertia(&self, at: &Situation, y: &State, echo: f64) -> (f64, f64) {
        let base = self.base;
        let [linear, cubic] = self.pass.scatter;
        let mut moment = echo
            - linear * base.linear(at.froude) * at.rate
            - cubic * base.b3 * at.rate.powi(3)
            - base.restoring * at.roll;
        if at.time_s < 0.0 {
            // A hand calms the model before the recording starts.
            moment -= base.inertia * base.natural_rad_s() * at.rate;
        }
        let mut inertia = base.inertia;
        for (effect, own) in self.hiding.iter().zip(&self.own) {
            moment += effect.moment(at, &y[own.clone()]);
            inertia += effect.inertia(at);
        }
        (moment, inertia)
    }

    /// Time derivative of the state.
    fn rates(&self, time_s: f64, y: &State, echo: f64) -> State {
        let path = imposed(self.pass, &self.line, time_s);
        let [roll, rate] = path.map_or([y[0], y[1]], |[angle, rate, _]| [angle, rate]);
        let at = self.situation(time_s, roll, rate);
        let acceleration = path.map_or_else(
            || {
                let (moment, inertia) = self.moment_and_inertia(&at, y, echo);
                moment / inertia
            },
            |[_, _, acceleration]| acceleration,
        );
        let mut out = State::default();
        out[0] = rate;
        out[1] = acceleration;
        for (effect, own) in self.hiding.iter().zip(&self.own) {
            effect.rates(&at, acceleration, &y[own.clone()], &mut out[own.clone()]);
        }
        out
    }

    /// Moment of the rod [N m] at an instant.
    fn rod_moment(&self, time_s: f64, y: &State, echo: f64) -> f64 {
        let path = imposed(self.pass, &self.line, time_s);
        let Some([roll, rate, acceleration]) = path.filter(|_| self.pass.is_forced()) else {
            return 0.0;
        };
        let at = self.situation(time_s, roll, rate);
        let (moment, inertia) = self.moment_and_inertia(&at, y, echo);
        inertia * acceleration - moment
    }
}

/// Plays a pass: whole, or from a free start on.
pub(crate) fn simulate(
    pass: &Pass,
    base: &Base,
    hiding: &Hiding,
    step_s: f64,
    start: Option<Start>,
) -> Motion {
    let line = Timeline::of(pass);
    let world = World { pass, base, hiding, own: own_states(hiding), line };
    let n_states = world.own.last().map_or(2, |own| own.end);
    let settles = start.is_none() && !hiding.is_empty();
    let begins_s = start.map_or(if settles { -SETTLING_S } else { 0.0 }, |start| start.time_s);
    let mut y = State::default();
    if let Some(start) = start {
        (y[0], y[1]) = (start.roll, start.rate);
    }
    let ends_s = if start.is_some() { line.end_s } else { line.stop_s };
    let n_steps = ((ends_s - begins_s) / step_s).round() as usize;
    let (mut time_s, mut roll) = (Vec::new(), Vec::new());
    let (mut moment, mut speed) = (Vec::new(), Vec::new());
    let mut past = Vec::new();
    for index in 0..=n_steps {
        // Whole steps counted, so that the instants of the plan are met to rounding.
        let now_s = ((begins_s / step_s).round() + index as f64) * step_s;
        if let Some([angle, rate, _]) = imposed(pass, &line, now_s) {
            (y[0], y[1]) = (angle, rate);
        }
        past.push(y[1]);
        let echo = hiding.iter().map(|effect| effect.echo(base, pass, &past, step_s)).sum();
        if now_s > -0.5 * step_s {
            time_s.push(now_s);
            roll.push(y[0]);
            moment.push(world.rod_moment(now_s, &y, echo));
            speed.push(world.speed_m_s(now_s));
        }
        y = step(now_s, step_s, &y, n_states, |at_s, y| world.rates(at_s, y, echo));
    }
    Motion { step_s, time_s, roll, moment, speed }
}
