//! Calm water between runs: the level is measured, the time to go is told only where it holds.

use std::f64::consts::SQRT_2;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rolltank::settling::{Calm, Settling, ToGo};

use crate::run_finding_kvlcc2;

/// Below this roll the water is calm [deg].
const LIMIT_DEG: f64 = 0.1;
const RATE_HZ: f64 = 50.0;

/// A model that rolls down, and the waves that it left in the tank.
struct Tank {
    frequency_rad_s: f64,
    heel_deg: f64,
    own_decay_s: f64,
    waves_deg: f64,
    waves_decay_s: f64,
    /// Share of a second wave, of another frequency, that beats with the first.
    beat: f64,
    beat_rad_s: f64,
    /// Waves that never die.
    floor_deg: f64,
    noise_deg: f64,
    quantum_deg: f64,
}

impl Tank {
    fn drawn(random: &mut ChaCha8Rng) -> Self {
        let mut between = |low: f64, high: f64| low * (high / low).powf(random.random::<f64>());
        let frequency_rad_s = between(2.5, 8.0);
        Self {
            frequency_rad_s,
            heel_deg: between(5.0, 15.0),
            own_decay_s: between(2.0, 15.0),
            waves_deg: between(0.15, 1.0),
            waves_decay_s: between(25.0, 120.0),
            beat: between(0.01, 0.5),
            beat_rad_s: frequency_rad_s * between(1.005, 1.05),
            floor_deg: 0.0,
            noise_deg: between(0.005, 0.05),
            quantum_deg: between(0.001, 0.02),
        }
    }

    /// Roll without noise [deg], released at nought.
    fn roll_deg(&self, t: f64) -> f64 {
        let own = self.heel_deg * (-t / self.own_decay_s).exp() * (self.frequency_rad_s * t).cos();
        let grown = 1.0 - (-t / self.own_decay_s).exp();
        let waves = grown * self.waves_deg * (-t / self.waves_decay_s).exp() + self.floor_deg;
        let first = (0.99 * self.frequency_rad_s * t + 1.0).cos();
        own + waves * (first + self.beat * (self.beat_rad_s * t).cos())
    }

    /// Amplitude of the roll over the six seconds about an instant [deg].
    fn level_deg(&self, at_s: f64) -> f64 {
        let rolls: Vec<f64> =
            (-100..=100).map(|k| self.roll_deg(at_s + 0.03 * f64::from(k))).collect();
        let mean = rolls.iter().sum::<f64>() / rolls.len() as f64;
        let square: f64 = rolls.iter().map(|roll| (roll - mean).powi(2)).sum();
        SQRT_2 * (square / rolls.len() as f64).sqrt()
    }

    /// From when on the level stays below the limit [s].
    fn calm_from_s(&self, end_s: f64) -> Option<f64> {
        let n = (end_s / 0.5) as usize;
        let last = (0..=n).rev().map(|k| 0.5 * k as f64).find(|t| self.level_deg(*t) > LIMIT_DEG);
        last.filter(|last| *last < end_s - 1.0)
    }

    /// What is told at each sixth second from the release to `end_s`.
    fn told(&self, end_s: f64, random: &mut ChaCha8Rng) -> Vec<(f64, Calm)> {
        let mut settling = Settling::new(LIMIT_DEG);
        let mut told = Vec::new();
        for k in 0..(end_s * RATE_HZ) as usize {
            let time_s = k as f64 / RATE_HZ;
            let noise: f64 = StandardNormal.sample(random);
            let roll_deg = self.roll_deg(time_s) + self.noise_deg * noise;
            let steps = (roll_deg / self.quantum_deg).round();
            settling.push(time_s, (steps * self.quantum_deg).to_radians());
            if k > 0 && k % 300 == 0 {
                told.push((time_s, settling.calm()));
            }
        }
        told
    }
}

#[test]
fn the_time_to_go_holds_as_often_as_it_claims() {
    let (mut n_told, mut n_held, mut n_tanks) = (0, 0, 0);
    // Tanks in which the waves alone last for more than a minute.
    let (mut n_long, mut n_useful) = (0, 0);
    let (mut n_calm, mut n_calm_held) = (0, 0);
    let mut ahead_s = Vec::new();
    for seed in 0..200 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let tank = Tank::drawn(&mut random);
        let Some(calm_s) = tank.calm_from_s(600.0) else { continue };
        n_tanks += 1;
        let mut first_s = None;
        for (at_s, calm) in tank.told(calm_s + 60.0, &mut random) {
            match calm.to_go {
                ToGo::Seconds { lo95_s, hi95_s, .. } => {
                    n_told += 1;
                    // A level counts over six seconds, so neither side knows its instant better.
                    let to_go_s = (calm_s - at_s).max(0.0);
                    let held = (lo95_s - 3.0..=hi95_s + 3.0).contains(&to_go_s);
                    n_held += usize::from(held);
                    first_s.get_or_insert(to_go_s);
                }
                ToGo::Calm => {
                    n_calm += 1;
                    n_calm_held += usize::from(tank.level_deg(at_s) < 1.2 * LIMIT_DEG);
                }
                ToGo::CantTell { .. } => {}
            }
        }
        if tank.waves_decay_s * (tank.waves_deg / LIMIT_DEG).ln() > 60.0 {
            n_long += 1;
            n_useful += usize::from(first_s.is_some_and(|ahead_s| ahead_s > 10.0));
            ahead_s.extend(first_s);
        }
    }
    ahead_s.sort_by(f64::total_cmp);
    let median_s = ahead_s[ahead_s.len() / 2];
    println!(
        "{n_tanks} tanks: told {n_told} times, held {n_held}; of {n_long} with long waves \
         told 10 s ahead in {n_useful}, first {median_s:.0} s ahead; calm {n_calm} times, held \
         {n_calm_held}"
    );
    assert!(n_tanks > 100 && n_told > 300);
    assert!(n_held as f64 >= 0.93 * f64::from(n_told as u32), "{n_held} of {n_told}");
    assert!(n_calm_held as f64 >= 0.97 * f64::from(n_calm as u32), "{n_calm_held} of {n_calm}");
    assert!(2 * n_useful > n_long, "{n_useful} of {n_long}");
}

#[test]
fn waves_that_never_die_are_neither_called_calm_nor_given_a_time() {
    let mut n_told = 0;
    for seed in 0..30 {
        let mut random = ChaCha8Rng::seed_from_u64(1000 + seed);
        let tank = Tank { floor_deg: 0.2, beat: 0.01, ..Tank::drawn(&mut random) };
        for (_, calm) in tank.told(400.0, &mut random) {
            assert!(calm.to_go != ToGo::Calm, "seed {seed}: {calm:?}");
            n_told += usize::from(matches!(calm.to_go, ToGo::Seconds { .. }));
        }
    }
    // On their way down to the floor the waves look like waves that die.
    println!("a time told {n_told} times of {}", 30 * 66);
    assert!(n_told < 30 * 66 / 20, "{n_told}");
}

#[test]
fn noise_above_the_limit_is_told_and_not_called_calm() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let tank = Tank { noise_deg: 1.0, waves_deg: 0.0, ..Tank::drawn(&mut random) };
    let told = tank.told(200.0, &mut random);
    let why = "the noise of the roll hides the limit";
    assert_eq!(told.last().unwrap().1.to_go, ToGo::CantTell { why });
}

#[test]
fn the_same_samples_tell_the_same_and_a_hole_or_a_new_run_begins_anew() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let tank = Tank::drawn(&mut random);
    let of = |seed| tank.told(120.0, &mut ChaCha8Rng::seed_from_u64(seed));
    assert_eq!(of(7), of(7));
    let mut settling = Settling::new(LIMIT_DEG);
    let mut feed = |from_s: f64, to_s: f64, since_s: f64| {
        let n = ((to_s - from_s) * RATE_HZ) as usize;
        for k in 0..n {
            let time_s = from_s + k as f64 / RATE_HZ;
            settling.push(time_s, tank.roll_deg(time_s - since_s).to_radians());
        }
        settling.calm()
    };
    assert_eq!(feed(0.0, 200.0, 0.0).to_go, ToGo::Calm);
    let released = feed(200.0, 215.0, 200.0);
    assert!(matches!(released.to_go, ToGo::CantTell { .. }), "{released:?}");
    assert!(released.level_deg.unwrap() > 1.0, "{released:?}");
}

#[test]
fn a_measured_decay_is_measured_right_and_foretells_nothing_while_the_model_itself_rolls() {
    let Some(samples) = run_finding_kvlcc2::measured("model_test_21338.csv") else { return };
    let rows: Vec<(f64, f64)> = samples
        .iter()
        .map(|sample| (sample.time_s, sample.value))
        .take_while(|(time_s, _)| *time_s < 190.0)
        .collect();
    let mut settling = Settling::new(LIMIT_DEG);
    let mut n_levels = 0;
    for (k, (time_s, roll_rad)) in rows.iter().enumerate() {
        settling.push(*time_s, *roll_rad);
        if k % 600 != 0 || *time_s < 24.0 {
            continue;
        }
        let calm = settling.calm();
        assert!(matches!(calm.to_go, ToGo::CantTell { .. }), "{time_s} s: {calm:?}");
        // Half of the range over two periods, the middle of which lies 3 to 9 s back.
        let rolls = rows[k - 900..k - 300].iter().map(|(_, roll_rad)| roll_rad.to_degrees());
        let (low, high) = rolls.fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
        let (level_deg, peak_deg) = (calm.level_deg.unwrap(), 0.5 * (high - low));
        assert!((level_deg / peak_deg - 1.0).abs() < 0.2, "{time_s} s: {level_deg} {peak_deg}");
        n_levels += 1;
    }
    assert!(n_levels > 20);
}
