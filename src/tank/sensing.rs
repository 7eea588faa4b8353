//! The instrument chain: true motion to recorded samples.

use devices::{Quantity, Sample};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::carriage::Carriage;
use super::instruments::Instrument;
use super::motion::{Stretch, motion_at};
use super::scenario::{ArmShape, Gap, Pass, Scenario, Shaker};

/// The true values that the instruments look at.
pub(super) struct View<'a> {
    /// The scenario.
    pub(super) scenario: &'a Scenario,
    /// The pass.
    pub(super) pass: &'a Pass,
    /// Its carriage.
    pub(super) carriage: &'a Carriage,
    /// Its motion.
    pub(super) stretches: &'a [Stretch],
}

impl View<'_> {
    /// What a noiseless instrument shows, in SI units, zero and vibration included.
    fn value(&self, quantity: Quantity, time_s: f64) -> f64 {
        let zero = &self.pass.zero;
        match quantity {
            Quantity::Speed => self.carriage.speed_m_s(time_s),
            Quantity::Moment => motion_at(self.stretches, time_s).1 + zero.moment_n_m,
            Quantity::Force => {
                let (roll_rad, moment_n_m) = motion_at(self.stretches, time_s);
                let force_n = self.scenario.exciter.map_or(0.0, |shaker| {
                    shaker.force_sign * moment_n_m / arm_m(&shaker, roll_rad)
                });
                force_n + zero.force_n
            }
            Quantity::Roll => {
                motion_at(self.stretches, time_s).0
                    + zero.roll_rad
                    + zero.roll_drift_rad_per_s * time_s
                    + self.vibration_rad(time_s)
            }
        }
    }

    fn vibration_rad(&self, time_s: f64) -> f64 {
        let Some(vibration) = self.pass.vibration.filter(|_| self.carriage.speed_m_s > 0.0) else {
            return 0.0;
        };
        let share = self.carriage.speed_m_s(time_s) / self.carriage.speed_m_s;
        let phase = std::f64::consts::TAU * vibration.frequency_hz * time_s;
        vibration.amplitude_rad * share * phase.sin()
    }

    /// Every sample of the pass in order of time, channels in the order of [`Quantity::ALL`].
    ///
    /// `draws` gives the randomness of a purpose: first one clock, then one channel each.
    pub(super) fn samples(
        &self,
        duration_s: f64,
        draws: impl Fn(u64) -> ChaCha8Rng,
    ) -> Vec<Sample> {
        let channels = self.scenario.instruments.recorded();
        let mut samples = Vec::new();
        for (at, (quantity, instrument)) in channels.iter().enumerate() {
            // Channels that share a clock draw their sampling instants from the same stream.
            let clock =
                channels.iter().position(|(_, other)| other.shares_clock(instrument)).unwrap_or(at);
            let mut jitter = draws(2 * clock as u64);
            let mut noise = draws(2 * at as u64 + 1);
            for time_s in sampling_times(instrument, duration_s, &mut jitter) {
                let exact = self.value(*quantity, time_s);
                let value = measured(instrument, exact, &mut noise);
                if self.pass.gaps.iter().any(|gap| swallows(gap, *quantity, time_s)) {
                    continue;
                }
                let time_s = time_s + instrument.clock_offset_s;
                samples.push(Sample { quantity: *quantity, time_s, value });
            }
        }
        samples.sort_by(|a, b| {
            a.time_s.total_cmp(&b.time_s).then_with(|| a.quantity.cmp(&b.quantity))
        });
        samples
    }
}

/// Moment arm of the rod [m] at a roll angle, in the simulated tank's own words.
///
/// Sideways to port and upwards from the roll axis the pin joint stands at `(l cos, l sin)` of the
/// roll angle; the rod pulls it towards a joint straight above its place at rest. The arm is the
/// cross product of place and direction.
fn arm_m(shaker: &Shaker, roll_rad: f64) -> f64 {
    let l = shaker.moment_arm_m;
    match (shaker.arm, shaker.rod_length_m) {
        (ArmShape::Cosine, _) => l * roll_rad.cos(),
        (ArmShape::Rod, Some(rod_length_m)) => {
            let pin = (l * roll_rad.cos(), l * roll_rad.sin());
            let aside_m = l - pin.0;
            let up_m = (rod_length_m * rod_length_m - aside_m * aside_m).sqrt();
            (pin.0 * up_m - pin.1 * aside_m) / rod_length_m
        }
        _ => l,
    }
}

/// What an instrument shows of an exact value: noise, then the steps of the digitiser.
pub(super) fn measured(instrument: &Instrument, exact: f64, noise: &mut ChaCha8Rng) -> f64 {
    let draw: f64 = StandardNormal.sample(noise);
    let noisy = exact + instrument.noise * draw;
    if instrument.quantum > 0.0 {
        (noisy / instrument.quantum).round() * instrument.quantum
    } else {
        noisy
    }
}

/// Instants on an even grid, each shifted by the jitter but never past its neighbours.
fn sampling_times(instrument: &Instrument, duration_s: f64, jitter: &mut ChaCha8Rng) -> Vec<f64> {
    let period_s = 1.0 / instrument.sample_rate_hz;
    let n_samples = (duration_s / period_s + 1e-9).floor() as usize + 1;
    (0..n_samples)
        .map(|k| {
            let draw: f64 = StandardNormal.sample(jitter);
            let shift_s =
                (instrument.time_jitter_s * draw).clamp(-0.45 * period_s, 0.45 * period_s);
            (k as f64 * period_s + shift_s).clamp(0.0, duration_s)
        })
        .collect()
}

fn swallows(gap: &Gap, quantity: Quantity, time_s: f64) -> bool {
    let inside = time_s >= gap.start_s && time_s < gap.start_s + gap.duration_s;
    inside && gap.channel.as_deref().is_none_or(|name| name == quantity.name())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_leaning_rod_does_the_work_that_its_upper_joint_is_given() {
        let (l, length) = (0.43_f64, 0.6_f64);
        let shaker = Shaker {
            moment_arm_m: l,
            arm: ArmShape::Rod,
            rod_length_m: Some(length),
            force_sign: 1.0,
        };
        // Virtual work: a unit force along the rod lifts its upper joint by dh cos(lean).
        let aside = |roll: f64| l * (1.0 - roll.cos());
        let height = |roll: f64| l * roll.sin() + (length.powi(2) - aside(roll).powi(2)).sqrt();
        for roll in [-0.3, -0.1, 0.0, 0.2, 0.35_f64] {
            let lean_cosine = (1.0 - (aside(roll) / length).powi(2)).sqrt();
            let lift = (height(roll + 1e-5) - height(roll - 1e-5)) / 2e-5;
            // Central differences of size 1e-5 are good to 1e-10.
            assert!((arm_m(&shaker, roll) - lift * lean_cosine).abs() < 1e-9, "at {roll} rad");
        }
    }
}
