//! The table of effects: one line each, in the order in which equals are preferred.

mod damping_coulomb;
mod damping_displacement_weighted;
mod damping_friction_speed;
mod damping_lift;
mod damping_memory;
mod damping_nonlinear_speed;
mod damping_power_law;
mod damping_quadratic;
mod damping_quintic;
mod damping_start_up;
mod damping_vortex_history;
mod damping_wave_speed;
mod exciter_arm_geometry;
mod exciter_pin_height;
mod exciter_pin_play;
mod exciter_rod_inertia;
mod inertia_amplitude;
mod inertia_speed;
mod instrument_channel_skew;
mod instrument_clipping;
mod instrument_clock_drift;
mod instrument_dropped_samples;
mod instrument_force_drift;
mod instrument_force_offset;
mod instrument_hum;
mod instrument_moment_from_roll;
mod instrument_roll_backlash;
mod instrument_roll_drift;
mod instrument_roll_from_moment;
mod instrument_roll_lag;
mod instrument_roll_nonlinearity;
mod instrument_roll_offset;
mod instrument_roll_quantisation;
mod restoring_asymmetric;
mod restoring_cubic;
mod restoring_free_surface;
mod restoring_heel;
mod restoring_quintic;
mod restoring_speed;
mod run_mislabelled;
mod tank_carriage_vibration;
mod tank_coupled_mode;
mod tank_residual_wave;
mod tank_slow_release;
mod tank_unsteady_speed;
mod tank_wall_reflection;
mod unnamed_by_quadrant;

pub use instrument_hum::{MAINS_OFF_HZ, mains_hz};

use super::effect::{Circumstances, Effect};
use super::term::Base;

/// Every effect that can be fitted.
pub const EFFECTS: [Effect; 46] = [
    damping_quadratic::EFFECT,
    damping_power_law::EFFECT,
    damping_quintic::EFFECT,
    damping_coulomb::EFFECT,
    damping_friction_speed::EFFECT,
    damping_displacement_weighted::EFFECT,
    damping_lift::EFFECT,
    damping_nonlinear_speed::EFFECT,
    damping_wave_speed::EFFECT,
    damping_memory::EFFECT,
    damping_vortex_history::EFFECT,
    damping_start_up::EFFECT,
    restoring_cubic::EFFECT,
    restoring_quintic::EFFECT,
    restoring_asymmetric::EFFECT,
    restoring_heel::EFFECT,
    restoring_speed::EFFECT,
    restoring_free_surface::EFFECT,
    inertia_amplitude::EFFECT,
    inertia_speed::EFFECT,
    exciter_rod_inertia::EFFECT,
    exciter_arm_geometry::EFFECT,
    exciter_pin_height::EFFECT,
    exciter_pin_play::EFFECT,
    instrument_roll_offset::EFFECT,
    instrument_roll_drift::EFFECT,
    instrument_roll_nonlinearity::EFFECT,
    instrument_roll_quantisation::EFFECT,
    instrument_roll_backlash::EFFECT,
    instrument_roll_lag::EFFECT,
    instrument_channel_skew::EFFECT,
    instrument_clock_drift::EFFECT,
    instrument_dropped_samples::EFFECT,
    instrument_hum::EFFECT,
    instrument_clipping::EFFECT,
    instrument_roll_from_moment::EFFECT,
    instrument_moment_from_roll::EFFECT,
    instrument_force_offset::EFFECT,
    instrument_force_drift::EFFECT,
    run_mislabelled::EFFECT,
    tank_wall_reflection::EFFECT,
    tank_residual_wave::EFFECT,
    tank_carriage_vibration::EFFECT,
    tank_unsteady_speed::EFFECT,
    tank_slow_release::EFFECT,
    tank_coupled_mode::EFFECT,
];

/// Laws that no cause in the table has, weighed beside the effects: where one of them does best,
/// the cause is none of these.
const UNNAMED: [Effect; 1] = [unnamed_by_quadrant::EFFECT];

/// Effects of which no roll test says anything, and why.
pub const UNTESTABLE: [(&str, &str); 4] = [
    ("instrument.roll_gain", STATIC),
    ("instrument.force_gain", STATIC),
    ("restoring.cable", STATIC),
    ("restoring.natural_frequency", "every fit finds the natural frequency itself"),
];

const STATIC: &str = "gains, arm, GM and cables change one scale together, which only a static \
                      run with known heeling moments parts";

/// The effect of this name.
pub fn effect(id: &str) -> Option<&'static Effect> {
    static TABLE: [Effect; EFFECTS.len()] = EFFECTS;
    TABLE.iter().find(|effect| effect.id == id)
}

/// Every effect, at a place that stays.
pub fn all() -> &'static [Effect] {
    static TABLE: [Effect; EFFECTS.len()] = EFFECTS;
    &TABLE
}

/// Every effect, and the laws that no cause in the table has.
pub fn weighed() -> impl Iterator<Item = &'static Effect> {
    static LAWS: [Effect; UNNAMED.len()] = UNNAMED;
    all().iter().chain(&LAWS)
}

/// Whether a law is one that no cause in the table has.
pub fn is_unnamed(id: &str) -> bool {
    UNNAMED.iter().any(|law| law.id == id)
}

/// The base equation that reads with an effect as `base` reads without it, where there is one.
pub fn exchanged(
    effect: &Effect,
    base: &Base,
    run: &Circumstances,
    values: &[f64],
) -> Option<Base> {
    (effect.id == run_mislabelled::EFFECT.id).then(|| run_mislabelled::exchanged(base, run, values))
}
