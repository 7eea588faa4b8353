//! A drawn campaign: hull, passes, and what hides in them.

use super::base::Base;
use super::draw::Draw;
use super::effect::{Hiding, Row};
use super::instruments::{Rows, record};
use super::motion::simulate;
use super::plan::{Action, Pass, RunSet};

/// Integration step of what is recorded [s].
const STEP_S: f64 = 0.005;
/// Standard deviation of the run-to-run factors on the damping, unless asked otherwise.
pub(crate) const SCATTER: f64 = 0.03;

/// What is asked of the draw.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Asked {
    /// Run set.
    pub(crate) set: RunSet,
    /// Names of the hidden effects; none for a clean campaign.
    pub(crate) hidden: Vec<String>,
    /// Size by the middle of the range.
    pub(crate) size: f64,
    /// Seed.
    pub(crate) seed: u64,
    /// Standard deviation of the run-to-run factors on the damping.
    pub(crate) scatter: f64,
}

impl Asked {
    /// Its name, from which everything is drawn: the same name is the same campaign.
    pub(crate) fn name(&self) -> String {
        let hidden =
            if self.hidden.is_empty() { "clean".to_owned() } else { self.hidden.join("+") };
        let mut name = format!("{hidden} x{} {} #{}", self.size, self.set.name(), self.seed);
        if self.scatter != SCATTER {
            name += " scatter ";
            name += &self.scatter.to_string();
        }
        name
    }
}

/// A campaign before it is played.
#[derive(Clone)]
pub(crate) struct Campaign {
    /// What was asked.
    pub(crate) asked: Asked,
    /// The hull has bilge keels.
    pub(crate) keels: bool,
    /// Its roll model.
    pub(crate) base: Base,
    /// The other hull, which a mislabelled run may have.
    pub(crate) other: Base,
    /// The passes as the crew made them.
    pub(crate) passes: Vec<Pass>,
    /// What hides.
    pub(crate) effects: Vec<Effect>,
}

/// One hidden effect with its values.
#[derive(Clone)]
pub(crate) struct Effect {
    /// Its line in the table.
    pub(crate) row: &'static Row,
    /// Its values, in the order of the symbols.
    pub(crate) values: Vec<f64>,
}

impl Campaign {
    /// Draws it.
    ///
    /// # Panics
    /// When an effect is asked for that is not in the table.
    pub(crate) fn draw(asked: &Asked) -> Self {
        let mut draw = Draw::named(&asked.name());
        // Every fourth campaign has bilge keels.
        let keels = asked.seed % 4 == 3;
        let base = Base::of_hull(keels).drawn(&mut draw);
        let other = Base::of_hull(!keels).drawn(&mut draw);
        let mut passes = asked.set.passes(asked.scatter, &mut draw);
        let effects = asked.hidden.iter().map(|id| {
            let row = super::effects::row(id).unwrap_or_else(|| panic!("no effect {id}"));
            Effect { row, values: (row.draw)(asked.size, &mut draw, &base) }
        });
        let effects: Vec<Effect> = effects.collect();
        for mut hidden in hiding(&effects) {
            hidden.plan(&mut passes);
        }
        Self { asked: asked.clone(), keels, base, other, passes, effects }
    }

    /// The hull of a pass.
    pub(crate) fn base_of(&self, pass: &Pass) -> &Base {
        if pass.other_hull { &self.other } else { &self.base }
    }

    /// The campaign with one more run at the end of the day.
    pub(crate) fn with_run(&self, froude: f64, action: Action) -> Self {
        let mut longer = self.clone();
        let (index, scatter) = (self.passes.len(), self.asked.scatter);
        let mut draw = Draw::named(&format!("{} and pass {index}", self.asked.name()));
        longer.passes.push(Pass::drawn(index, froude, action, scatter, &mut draw));
        longer
    }

    /// The load cell is logged: in every pass of a campaign that has a rod.
    pub(crate) fn has_force(&self) -> bool {
        self.passes.iter().any(Pass::is_forced)
    }

    /// The recording of a pass; without noise on request, as only this tank can have it.
    pub(crate) fn rows(&self, pass: &Pass, noisy: bool) -> Rows {
        self.rows_with(&self.effects, pass, noisy)
    }

    /// The same with other effects than those that hide.
    pub(crate) fn rows_with(&self, effects: &[Effect], pass: &Pass, noisy: bool) -> Rows {
        let mut hiding = hiding(effects);
        for hidden in &mut hiding {
            hidden.plan(&mut self.passes.clone());
        }
        let motion = simulate(pass, self.base_of(pass), &hiding, STEP_S, None);
        let mut noise = Draw::named(&format!("{} noise of {}", self.asked.name(), pass.index));
        record(motion, pass, &hiding, noisy.then_some(&mut noise))
    }
}

/// The effects, ready to act.
pub(crate) fn hiding(effects: &[Effect]) -> Hiding {
    effects.iter().map(|effect| (effect.row.hide)(&effect.values)).collect()
}
