//! Every effect that can hide: the table, one line each.

mod clocks;
mod damping;
mod exciter;
mod flow_history;
mod force_cell;
mod invented;
pub(crate) mod labels;
mod restoring;
mod rig;
mod roll_sensor;
mod speed;
mod water;

use super::effect::Row;

/// The names of EFFECTS.md, each with what the hidden tank makes of it.
pub(crate) const CATALOGUED: [&Row; 50] = [
    &damping::QUADRATIC,
    &damping::POWER_LAW,
    &damping::QUINTIC,
    &damping::COULOMB,
    &speed::FRICTION,
    &damping::DISPLACEMENT_WEIGHTED,
    &speed::LIFT,
    &speed::NONLINEAR,
    &speed::WAVE,
    &flow_history::MEMORY,
    &flow_history::VORTEX,
    &flow_history::START_UP,
    &restoring::CUBIC,
    &restoring::QUINTIC,
    &restoring::ASYMMETRIC,
    &restoring::HEEL,
    &speed::RESTORING,
    &restoring::FREE_SURFACE,
    &restoring::CABLE,
    &restoring::NATURAL_FREQUENCY,
    &restoring::INERTIA_AMPLITUDE,
    &speed::INERTIA,
    &exciter::ROD_INERTIA,
    &exciter::ARM_GEOMETRY,
    &exciter::PIN_HEIGHT,
    &exciter::PIN_PLAY,
    &roll_sensor::OFFSET,
    &roll_sensor::DRIFT,
    &roll_sensor::NONLINEARITY,
    &roll_sensor::QUANTISATION,
    &roll_sensor::BACKLASH,
    &roll_sensor::LAG,
    &roll_sensor::GAIN,
    &roll_sensor::CLIPPING,
    &roll_sensor::HUM,
    &clocks::SKEW,
    &clocks::DRIFT,
    &clocks::DROPPED,
    &force_cell::ROLL_FROM_MOMENT,
    &force_cell::MOMENT_FROM_ROLL,
    &force_cell::OFFSET,
    &force_cell::DRIFT,
    &force_cell::GAIN,
    &labels::MISLABELLED,
    &water::REFLECTION,
    &water::RESIDUAL_WAVE,
    &rig::VIBRATION,
    &speed::UNSTEADY,
    &rig::SLOW_RELEASE,
    &rig::COUPLED_MODE,
];

/// Effects that no catalogue has.
pub(crate) const INVENTED: [&Row; 7] = [
    &invented::MODULATED_RESTORING,
    &invented::RELAY,
    &invented::ODD_MODE,
    &invented::QUADRANT_DAMPING,
    &invented::STICKING_WIPER,
    &invented::KNOCKS,
    &invented::LOST_KEEL,
];

/// The line of a name.
pub(crate) fn row(id: &str) -> Option<&'static Row> {
    CATALOGUED.iter().chain(&INVENTED).copied().find(|row| row.id == id)
}
