//! What an effect can do to a tank, and the shape of its line in the table.

use super::base::Base;
use super::draw::Draw;
use super::instruments::Rows;
use super::integrate::State;
use super::motion::Motion;
use super::plan::Pass;

/// The model at one instant.
pub(crate) struct Situation<'a> {
    /// Since the start of the recording [s].
    pub(crate) time_s: f64,
    /// Since the release, or since the rod reached its amplitude [s]; negative before.
    pub(crate) since_start_s: f64,
    /// Roll [rad].
    pub(crate) roll: f64,
    /// Roll rate [rad/s].
    pub(crate) rate: f64,
    /// Froude number of the moment.
    pub(crate) froude: f64,
    /// Neither hands nor rod move the model.
    pub(crate) free: bool,
    /// The hull as it is without the effect.
    pub(crate) base: &'a Base,
    /// The pass.
    pub(crate) pass: &'a Pass,
}

/// One hidden effect; what it does not touch it leaves to the defaults.
pub(crate) trait Hidden {
    /// How many numbers it keeps in mind.
    fn n_states(&self) -> usize {
        0
    }

    /// Time derivatives of these, with the roll acceleration [rad/s2].
    fn rates(&self, _at: &Situation, _acceleration: f64, _own: &[f64], _out: &mut [f64]) {}

    /// Moment on the model [N m], at the right-hand side.
    fn moment(&self, _at: &Situation, _own: &[f64]) -> f64 {
        0.0
    }

    /// Inertia that it adds [kg m2].
    fn inertia(&self, _at: &Situation) -> f64 {
        0.0
    }

    /// Moment [N m] that past motion exerts now: `past` holds the roll rate of every step so far.
    fn echo(&self, _base: &Base, _pass: &Pass, _past: &[f64], _step_s: f64) -> f64 {
        0.0
    }

    /// The speed that the model sees, of the one asked for [m/s].
    fn speed(&self, _pass: &Pass, _since_start_s: f64, speed_m_s: f64) -> f64 {
        speed_m_s
    }

    /// What it does to the plan, before anything moves.
    fn plan(&mut self, _passes: &mut [Pass]) {}

    /// What rod and transducers make of motion and moment, on the fine time grid.
    fn transduce(&self, _motion: &mut Motion, _pass: &Pass) {}

    /// When the force is really sampled that is stamped with this time [s].
    fn force_sampled_s(&self, stamp_s: f64, _pass: &Pass) -> f64 {
        stamp_s
    }

    /// What the recording loses after the converter.
    fn spoil(&self, _rows: &mut Rows, _pass: &Pass) {}
}

/// The hidden effects of a campaign.
pub(crate) type Hiding = Vec<Box<dyn Hidden>>;

/// One line of the table of effects.
pub(crate) struct Row {
    /// Its name in `diagnose --json`.
    pub(crate) id: &'static str,
    /// Symbol and unit of each value.
    pub(crate) symbols: &'static [&'static str],
    /// Values at a size, where 1 is the middle of the range.
    pub(crate) draw: fn(f64, &mut Draw, &Base) -> Vec<f64>,
    /// The effect with these values.
    pub(crate) hide: fn(&[f64]) -> Box<dyn Hidden>,
}

/// The moment of an effect of this kind [N m], of its values.
pub(crate) type MomentLaw = fn(&[f64], &Situation) -> f64;

/// An effect that is a moment of the present alone.
pub(crate) struct Acting {
    values: Vec<f64>,
    law: MomentLaw,
}

impl Acting {
    /// Values and law.
    pub(crate) fn hidden(values: &[f64], law: MomentLaw) -> Box<dyn Hidden> {
        Box::new(Self { values: values.to_vec(), law })
    }
}

impl Hidden for Acting {
    fn moment(&self, at: &Situation, _own: &[f64]) -> f64 {
        (self.law)(&self.values, at)
    }
}

/// The numbers of each effect in the common state, after roll and roll rate.
pub(crate) fn own_states(hiding: &Hiding) -> Vec<std::ops::Range<usize>> {
    let mut next = 2;
    let ranges = hiding.iter().map(|effect| {
        let range = next..next + effect.n_states();
        next = range.end;
        range
    });
    let ranges: Vec<_> = ranges.collect();
    assert!(next <= State::default().len(), "too many effects at once");
    ranges
}
