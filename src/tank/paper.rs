//! The paper's model test: Tables 1 and 2 as constants, the campaign they describe as a scenario.
//!
//! Source: Mathematical Problems in Engineering 2012, article 769385. Table 2 is printed with its
//! column heads exchanged; here the small coefficients belong to the bare hull, as Fig. 12 shows.

use super::action::Action;
use super::instruments::{Instrument, Instruments, RecordingFormat};
use super::scenario::{
    ArmShape, Basin, CarriagePlan, Condition, Damping, DampingRow, Pass, Scenario, Shaker, Zeros,
};
use crate::hull::{Hull, Water};

/// Name of the scenario.
pub const NAME: &str = "paper";

/// Name of the part of it that a demonstration has time for.
pub const SHORT_DAY: &str = "short-day";

/// Table 1: the model.
pub const HULL: Hull =
    Hull { length_pp_m: 2.5, beam_m: 0.387, draft_m: 0.132, displacement_m3: 0.110, gm_m: 0.074 };

/// Table 1: natural frequency of the bare hull [rad/s].
pub const NATURAL_FREQUENCY_BARE_RAD_S: f64 = 6.905;
/// Table 1: natural frequency with bilge keels [rad/s].
pub const NATURAL_FREQUENCY_KEELS_RAD_S: f64 = 6.136;

/// Table 2 by Froude number, the columns printed as "with BK": the bare hull.
pub const BARE_HULL: [DampingRow; 5] = [
    DampingRow { froude: 0.0, b1_per_s: 0.3796, b3_s: 0.1436 },
    DampingRow { froude: 0.1, b1_per_s: 0.5070, b3_s: 0.1016 },
    DampingRow { froude: 0.2, b1_per_s: 0.4203, b3_s: 0.1219 },
    DampingRow { froude: 0.3, b1_per_s: 0.7208, b3_s: 0.2027 },
    DampingRow { froude: 0.4, b1_per_s: 1.1007, b3_s: 0.1829 },
];

/// Table 2 by Froude number, the columns printed as "without BK": with bilge keels.
pub const BILGE_KEELS: [DampingRow; 5] = [
    DampingRow { froude: 0.0, b1_per_s: 1.2408, b3_s: 0.6682 },
    DampingRow { froude: 0.1, b1_per_s: 1.2475, b3_s: 0.4852 },
    DampingRow { froude: 0.2, b1_per_s: 1.3262, b3_s: 0.6725 },
    DampingRow { froude: 0.3, b1_per_s: 2.5105, b3_s: 0.4689 },
    DampingRow { froude: 0.4, b1_per_s: 3.1812, b3_s: 0.6552 },
];

/// Sec. 3 and Fig. 4: the basin; margins and accelerations leave 35 m of steady tow at Fr 0.4.
pub const BASIN: Basin = Basin {
    length_m: 50.0,
    width_m: 10.0,
    depth_m: 5.0,
    carriage_max_speed_m_s: 2.0,
    end_margin_m: 7.0,
    carriage_acceleration_m_s2: 0.5,
    carriage_braking_m_s2: 0.5,
};

/// Fig. 6: distance from the roll axis to the pin joint [m].
pub const MOMENT_ARM_M: f64 = 0.430;
/// Sec. 4.2: the excitation frequency of the printed example [rad/s].
pub const EXAMPLE_FREQUENCY_RAD_S: f64 = 5.12;
/// Sec. 4.2: the Froude number printed for that example [-].
pub const EXAMPLE_FROUDE: f64 = 1.0;
/// The printed speed coefficients of (4.3), bare hull and bilge keels [-].
pub const PRINTED_KAPPA: [f64; 2] = [4.7536, 13.097];

/// Held heel before each decay, by condition and Froude number [deg]: more where it dies sooner.
const HEEL_DEG: [[f64; 5]; 2] = [[12.0, 13.0, 11.0, 14.0, 12.5], [12.0, 13.0, 14.0, 15.0, 15.0]];
/// Roll amplitude of all forced runs [deg]: "the same amplitude of the motion is imposed".
const FORCED_AMPLITUDE_DEG: f64 = 8.0;
/// Excitation frequencies as shares of the natural frequency [-], beside the printed example.
const FREQUENCY_SHARES: [f64; 6] = [0.8, 0.9, 0.95, 1.0, 1.05, 1.2];
/// Steady periods of each forced run [-].
const FORCED_PERIODS: f64 = 10.0;
/// Start-up or change of a forced motion [s].
const FORCED_RAMP_S: f64 = 2.0;
/// Most forced runs in one pass.
const FORCED_PER_PASS: usize = 3;
/// Length of a decay at zero speed [s].
const DECAY_AT_REST_S: f64 = 40.0;
/// Froude numbers of the forced runs of a short day [-].
const FORCED_AT: [f64; 2] = [0.0, 0.2];
/// Calm water before a decay, and before a forced run [s].
const CALM_S: [f64; 2] = [8.0, 20.0];
/// Steady towing before a run begins [s].
const STEADY_BEFORE_S: f64 = 2.0;

/// The paper's campaign: a decay per row of Table 2, and forced runs around each resonance.
pub fn scenario() -> Scenario {
    let conditions = vec![
        condition("bare hull", NATURAL_FREQUENCY_BARE_RAD_S, &BARE_HULL),
        condition("bilge keels", NATURAL_FREQUENCY_KEELS_RAD_S, &BILGE_KEELS),
    ];
    let mut passes = Vec::new();
    for (condition, heels_deg) in conditions.iter().zip(HEEL_DEG) {
        for (row, heel_deg) in BARE_HULL.iter().zip(heels_deg) {
            passes.push(decay_pass(condition, row.froude, heel_deg));
        }
    }
    for condition in &conditions {
        for row in &BARE_HULL {
            passes.extend(forced_passes(condition, row.froude));
        }
    }
    Scenario {
        name: "Roll damping at forward speed, the paper's campaign".to_owned(),
        hull: HULL,
        water: Water::default(),
        tank: BASIN,
        exciter: Some(Shaker {
            moment_arm_m: MOMENT_ARM_M,
            arm: ArmShape::Constant,
            rod_length_m: None,
            force_sign: 1.0,
        }),
        instruments: instruments(),
        recordings: RecordingFormat::default(),
        conditions,
        passes,
    }
}

/// Every decay of the paper's campaign, and its forced runs at two speeds.
pub fn short_day() -> Scenario {
    let mut scenario = scenario();
    "Roll damping at forward speed, a short day".clone_into(&mut scenario.name);
    let is_decay = |pass: &Pass| pass.actions.iter().any(|a| matches!(a, Action::Release { .. }));
    let is_kept = |pass: &Pass| pass.froude.is_some_and(|froude| FORCED_AT.contains(&froude));
    scenario.passes.retain(|pass| is_decay(pass) || is_kept(pass));
    scenario
}

/// Instruments of a good tank; the paper does not state its own.
fn instruments() -> Instruments {
    let channel = |noise, quantum| Instrument {
        sample_rate_hz: 100.0,
        noise,
        quantum,
        time_jitter_s: 0.0,
        clock_offset_s: 0.0,
    };
    Instruments {
        roll: channel(0.05_f64.to_radians(), 0.02_f64.to_radians()),
        // 0.05 N m of moment noise at the arm.
        force: Some(channel(0.05 / MOMENT_ARM_M, 0.05)),
        moment: None,
        speed: Some(channel(0.002, 0.001)),
    }
}

fn condition(name: &str, natural_frequency_rad_s: f64, rows: &[DampingRow]) -> Condition {
    let damping = Damping::Table(rows.to_vec());
    Condition { name: name.to_owned(), natural_frequency_rad_s, damping }
}

/// When the carriage is steady, for a start at `start_s`: from and until [s].
fn steady_s(froude: f64, start_s: f64) -> (f64, f64) {
    if froude == 0.0 {
        return (start_s, f64::INFINITY);
    }
    let speed_m_s = froude * (Water::default().gravity_m_s2 * HULL.length_pp_m).sqrt();
    let speed_up_s = speed_m_s / BASIN.carriage_acceleration_m_s2;
    // Speeding up and braking at the same rate cover together the way of one at full speed.
    let steady_m = BASIN.length_m - BASIN.end_margin_m - speed_m_s * speed_up_s;
    (start_s + speed_up_s, start_s + speed_up_s + steady_m / speed_m_s)
}

fn pass(condition: &Condition, froude: f64, start_s: f64, actions: Vec<Action>) -> Pass {
    Pass {
        name: None,
        condition: condition.name.clone(),
        froude: Some(froude),
        speed_m_s: None,
        repeat: 1,
        declared_speed_m_s: None,
        static_heel_rad: 0.0,
        carriage: CarriagePlan { start_s, ..CarriagePlan::default() },
        zero: Zeros::default(),
        waves: None,
        vibration: None,
        gaps: Vec::new(),
        actions,
    }
}

/// Heeled in calm water, held while the carriage speeds up, released, caught when it brakes.
fn decay_pass(condition: &Condition, froude: f64, heel_deg: f64) -> Pass {
    let [calm_s, _] = CALM_S;
    let (from_s, until_s) = steady_s(froude, calm_s);
    let release_s = from_s + STEADY_BEFORE_S;
    let free_s = (until_s - release_s).min(DECAY_AT_REST_S);
    let heeled_s = 3.0;
    let actions = vec![
        Action::Rest { duration_s: calm_s - heeled_s },
        Action::Hold {
            heel_rad: heel_deg.to_radians(),
            duration_s: release_s - (calm_s - heeled_s),
            ramp_s: 1.5,
            tremor_rad: 0.0,
        },
        Action::Release { duration_s: free_s + 1.0, fade_s: 0.0 },
        Action::Catch { duration_s: 4.0, damping_ratio: 1.5 },
    ];
    pass(condition, froude, calm_s, actions)
}

/// As many frequencies in each pass as the tank allows, every one of the ladder once.
fn forced_passes(condition: &Condition, froude: f64) -> Vec<Pass> {
    let [_, calm_s] = CALM_S;
    let (from_s, until_s) = steady_s(froude, calm_s);
    let mut ladder: Vec<f64> =
        FREQUENCY_SHARES.iter().map(|share| share * condition.natural_frequency_rad_s).collect();
    ladder.push(EXAMPLE_FREQUENCY_RAD_S);
    ladder.sort_by(f64::total_cmp);
    let mut passes = Vec::new();
    let mut left = ladder.as_slice();
    while !left.is_empty() {
        let mut actions = vec![Action::Rest { duration_s: from_s }];
        let mut end_s = from_s;
        while let Some((&frequency_rad_s, rest)) = left.split_first() {
            let steady_s = FORCED_PERIODS * std::f64::consts::TAU / frequency_rad_s;
            let duration_s = FORCED_RAMP_S + steady_s;
            let full = actions.len() > FORCED_PER_PASS || end_s + duration_s > until_s;
            // A first run that does not fit is towed all the same: a short one is better than none.
            if full && actions.len() > 1 {
                break;
            }
            actions.push(Action::Forced {
                amplitude_rad: FORCED_AMPLITUDE_DEG.to_radians(),
                frequency_rad_s,
                duration_s,
                ramp_s: FORCED_RAMP_S,
            });
            end_s += duration_s;
            left = rest;
        }
        actions.push(Action::Stop { duration_s: 5.0, ramp_s: FORCED_RAMP_S });
        passes.push(pass(condition, froude, calm_s, actions));
    }
    passes
}
