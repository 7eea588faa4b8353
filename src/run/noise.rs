//! Estimates the noise and the quantum of a channel from the stream itself.

use std::collections::VecDeque;

/// Blocks remembered; the estimate is their median, so that a burst or a release inside one of them
/// does not raise it.
const N_BLOCKS: usize = 9;
/// Differences seen before the smallest one is believed to be the quantum.
const N_STEPS_FOR_QUANTUM: usize = 20;
/// Differences below this share of the values are rounding of the unit conversion.
const ROUNDING: f64 = 1e-12;

/// Standard deviation of the white noise of evenly spaced values that also follow a slow motion.
///
/// The fourth difference has variance 70 times that of the noise, while a motion of frequency `w`
/// sampled every `h` enters it only with `(w h)^4`: at ten values a period with 15 %, at twenty
/// with 1 %. Blocks of `BLOCK_LENGTH` values give one estimate each.
#[derive(Debug, Clone)]
pub(crate) struct Noise<const BLOCK_LENGTH: usize> {
    last: [f64; 4],
    n_last: usize,
    square_sum: f64,
    n_squares: usize,
    blocks: VecDeque<f64>,
}

impl<const BLOCK_LENGTH: usize> Default for Noise<BLOCK_LENGTH> {
    fn default() -> Self {
        Self { last: [0.0; 4], n_last: 0, square_sum: 0.0, n_squares: 0, blocks: VecDeque::new() }
    }
}

/// Noise of bins, known after a second.
pub(super) type BinNoise = Noise<20>;
/// Noise of samples, known to some 5 %.
pub(crate) type SampleNoise = Noise<100>;

impl<const BLOCK_LENGTH: usize> Noise<BLOCK_LENGTH> {
    /// Takes the next value.
    pub(crate) fn push(&mut self, value: f64) {
        let [a, b, c, d] = self.last;
        if self.n_last == 4 {
            let fourth = value - 4.0 * d + 6.0 * c - 4.0 * b + a;
            self.square_sum += fourth * fourth / 70.0;
            self.n_squares += 1;
        } else {
            self.n_last += 1;
        }
        self.last = [b, c, d, value];
        if self.n_squares == BLOCK_LENGTH {
            if self.blocks.len() == N_BLOCKS {
                self.blocks.pop_front();
            }
            self.blocks.push_back(self.square_sum / BLOCK_LENGTH as f64);
            (self.square_sum, self.n_squares) = (0.0, 0);
        }
    }

    /// Forgets the last values, because the next one does not follow them evenly.
    pub(crate) fn interrupt(&mut self) {
        self.n_last = 0;
    }

    /// Standard deviation, zero before the first block is full.
    pub(crate) fn sd(&self) -> f64 {
        let mut sorted: Vec<f64> = self.blocks.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).map_or(0.0, |variance| variance.sqrt())
    }
}

/// Step of the digitiser: the smallest difference between successive values that is not zero.
#[derive(Debug, Clone, Default)]
pub(super) struct Quantum {
    last: Option<f64>,
    smallest: Option<f64>,
    n_steps: usize,
}

impl Quantum {
    /// Takes the next raw value.
    pub(super) fn push(&mut self, value: f64) {
        if let Some(last) = self.last.replace(value) {
            let step = (value - last).abs();
            if step > ROUNDING * (1.0 + value.abs()) {
                self.n_steps += 1;
                self.smallest = Some(self.smallest.map_or(step, |s| s.min(step)));
            }
        }
    }

    /// The step, zero until it is known.
    pub(super) fn step(&self) -> f64 {
        if self.n_steps < N_STEPS_FOR_QUANTUM { 0.0 } else { self.smallest.unwrap_or(0.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::Distribution;

    #[test]
    fn the_noise_of_a_rolling_model_is_told_from_its_roll() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let noise = rand_distr::Normal::new(0.0, 0.001).unwrap();
        let mut estimate = BinNoise::default();
        for k in 0..400 {
            // Twenty values a second, period 1 s, 10 degrees.
            let roll = 0.17 * (std::f64::consts::TAU * f64::from(k) / 20.0).sin();
            estimate.push(roll + noise.sample(&mut rng));
        }
        // 180 squares of correlated differences: 12 % of scatter; the roll itself adds 0.00014.
        assert!((estimate.sd() / 0.001 - 1.0).abs() < 0.35, "{}", estimate.sd());
    }

    #[test]
    fn the_quantum_is_the_step_of_the_staircase() {
        let mut quantum = Quantum::default();
        for k in 0..300 {
            let ramp = 0.3 * (f64::from(k) * 0.05).sin();
            quantum.push((ramp / 0.0017).round() * 0.0017);
        }
        assert!((quantum.step() - 0.0017).abs() < 1e-9, "{}", quantum.step());
    }
}
