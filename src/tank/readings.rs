//! What an instrument shows of exact values, reading by reading.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::instruments::Instrument;
use super::sensing::measured;

/// The readings of one instrument; each has a noise of its own, whenever it is taken.
#[derive(Debug, Clone)]
pub struct Readings {
    instrument: Instrument,
    noise: ChaCha8Rng,
}

impl Readings {
    /// Those of an instrument, all draws from `seed`; streams of different numbers are independent.
    pub fn new(instrument: Instrument, seed: u64, stream: u64) -> Self {
        let mut noise = ChaCha8Rng::seed_from_u64(seed);
        noise.set_stream(stream);
        Self { instrument, noise }
    }

    /// The next reading of an exact value, both in SI units.
    pub fn of(&mut self, exact: f64) -> f64 {
        measured(&self.instrument, exact, &mut self.noise)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_readings_have_noise_of_their_own() {
        let instrument = Instrument {
            sample_rate_hz: 50.0,
            noise: 2.0,
            quantum: 0.0,
            time_jitter_s: 0.0,
            clock_offset_s: 0.0,
        };
        let mut readings = Readings::new(instrument, 7, 1);
        let noise: Vec<f64> = (0..10_000).map(|_| readings.of(5.0) - 5.0).collect();
        let mean = |of: &dyn Fn(&[f64]) -> f64| noise.windows(2).map(of).sum::<f64>() / 1e4;
        assert!((mean(&|pair| pair[0] * pair[0]) - 4.0).abs() < 0.3);
        assert!(mean(&|pair| pair[0] * pair[1]).abs() < 0.2);
    }
}
