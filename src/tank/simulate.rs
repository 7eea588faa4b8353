//! Simulates one pass of a scenario, from its script to its samples.

use devices::{Quantity, Sample};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

use super::carriage::Carriage;
use super::equation::RollingModel;
use super::motion::Scene;
use super::scenario::{Condition, Damping, DampingRow, Pass, Scenario};
use super::sensing::View;
use super::truth::PassTruth;
use super::witness::Witness;

/// One pass as the instruments saw it, with the truth they did not see.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedPass {
    /// Name of the recording.
    pub name: String,
    /// Condition of the model.
    pub condition: String,
    /// Every sample, in order of time.
    pub samples: Vec<Sample>,
    /// What really happened.
    pub truth: PassTruth,
}

/// Randomness of one pass for one purpose; equal arguments give equal draws, whatever the order.
fn draws(seed: u64, pass_index: usize, purpose: u64) -> ChaCha8Rng {
    const PURPOSES_PER_PASS: u64 = 16;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(pass_index as u64 * PURPOSES_PER_PASS + purpose);
    rng
}

/// Purpose of the draw of the pass-to-pass scatter; the instruments use the numbers below it.
const SCATTER: u64 = 15;
/// Purpose of the draw of irregular excitations.
const EXCITATION: u64 = 14;

/// Simulates the pass at `pass_index`, counting repeats, with all draws from `seed`.
///
/// # Panics
/// When `pass_index` is not below [`Scenario::pass_count`], or the scenario was put together by a
/// program into one that [`Scenario::checked`] refuses.
pub fn simulate_pass(scenario: &Scenario, pass_index: usize, seed: u64) -> SimulatedPass {
    let (pass, name) = scenario.pass_at(pass_index);
    let condition = scenario
        .conditions
        .iter()
        .find(|c| c.name == pass.condition)
        .expect("a checked scenario names only conditions that it has");
    let speed_m_s = scenario.pass_speed_m_s(pass);
    let carriage = Carriage::plan(&scenario.tank, &pass.carriage, speed_m_s)
        .expect("a checked scenario plans only passes that fit the tank");
    let shift_per_s = scatter_per_s(condition, &mut draws(seed, pass_index, SCATTER));
    let froude_of = |speed_m_s: f64| froude(scenario, speed_m_s);
    let b1_per_s = |speed: f64| damping_at(condition, froude_of(speed)).b1_per_s + shift_per_s;
    let froude = froude_of(speed_m_s);
    let b3_s = damping_at(condition, froude).b3_s;
    let model = rolling_model(scenario, pass, condition, b3_s);
    // Far apart in the stream, so that actions do not share draws.
    let excitation = |action_index: usize| {
        let mut rng = draws(seed, pass_index, EXCITATION);
        rng.set_word_pos((action_index as u128) << 20);
        rng
    };
    let scene =
        Scene { model, carriage, waves: pass.waves, b1_per_s: &b1_per_s, draws: &excitation };
    let stretches = scene.play(&pass.actions);
    let duration_s = stretches.last().map_or(0.0, |s| s.end_s);
    let view = View { scenario, pass, carriage: &carriage, stretches: &stretches };
    let samples = view.samples(duration_s, |purpose| draws(seed, pass_index, purpose));
    let holes_s = roll_holes_s(pass);
    let witness = Witness {
        scene: &scene,
        stretches: &stretches,
        holes_s: &holes_s,
        roll_noise_rad: roll_noise_rad(scenario, pass, &carriage),
        froude,
    };
    let (runs, unusable) = witness.account();
    let condition = pass.condition.clone();
    let truth = PassTruth {
        name: name.clone(),
        condition: condition.clone(),
        speed_m_s,
        froude,
        runs,
        unusable,
    };
    SimulatedPass { name, condition, samples, truth }
}

/// Froude number, stated here again because the tank shares no formula with the identifier.
fn froude(scenario: &Scenario, speed_m_s: f64) -> f64 {
    speed_m_s / (scenario.water.gravity_m_s2 * scenario.hull.length_pp_m).sqrt()
}

fn rolling_model(
    scenario: &Scenario,
    pass: &Pass,
    condition: &Condition,
    b3_s: f64,
) -> RollingModel {
    let weight_n =
        scenario.water.density_kg_m3 * scenario.water.gravity_m_s2 * scenario.hull.displacement_m3;
    let restoring_n_m_per_rad = weight_n * scenario.hull.gm_m;
    RollingModel {
        inertia_kg_m2: restoring_n_m_per_rad / condition.natural_frequency_rad_s.powi(2),
        restoring_n_m_per_rad,
        b3_s,
        rest_roll_rad: pass.static_heel_rad,
    }
}

/// Damping at a Froude number, before the scatter.
fn damping_at(condition: &Condition, froude: f64) -> DampingRow {
    match &condition.damping {
        Damping::Law(law) => DampingRow {
            froude,
            b1_per_s: law.b0_per_s * (1.0 + law.kappa * froude * froude),
            b3_s: law.b3_s,
        },
        Damping::Table(rows) => {
            let right = rows.partition_point(|row| row.froude < froude).min(rows.len() - 1);
            let (a, b) = (rows[right.saturating_sub(1)], rows[right]);
            let way = b.froude.powi(2) - a.froude.powi(2);
            let x = if way > 0.0 { (froude.powi(2) - a.froude.powi(2)) / way } else { 1.0 };
            let x = x.clamp(0.0, 1.0);
            DampingRow {
                froude,
                b1_per_s: a.b1_per_s + x * (b.b1_per_s - a.b1_per_s),
                b3_s: a.b3_s + x * (b.b3_s - a.b3_s),
            }
        }
    }
}

/// Draws the scatter of `b1` [1/s], never taking away more than nine tenths of the damping at rest.
fn scatter_per_s(condition: &Condition, draws: &mut ChaCha8Rng) -> f64 {
    let Damping::Law(law) = &condition.damping else { return 0.0 };
    let draw: f64 = StandardNormal.sample(draws);
    (law.scatter_per_s * draw).max(-0.9 * law.b0_per_s)
}

fn roll_holes_s(pass: &Pass) -> Vec<(f64, f64)> {
    pass.gaps
        .iter()
        .filter(|gap| gap.channel.as_deref().is_none_or(|name| name == Quantity::Roll.name()))
        .map(|gap| (gap.start_s, gap.start_s + gap.duration_s))
        .collect()
}

fn roll_noise_rad(scenario: &Scenario, pass: &Pass, carriage: &Carriage) -> f64 {
    let vibration_rad = pass
        .vibration
        .filter(|_| carriage.speed_m_s > 0.0)
        .map_or(0.0, |v| v.amplitude_rad / 2.0_f64.sqrt());
    scenario.instruments.roll.total_noise().hypot(vibration_rad)
}
