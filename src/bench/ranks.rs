//! Where the truth lies in its posterior, over many runs: uniform if the posterior is calibrated.
//!
//! Talts, Betancourt, Simpson, Vehtari and Gelman, Validating Bayesian inference algorithms with
//! simulation-based calibration, 2018, arXiv:1804.06788.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Bins of the histogram.
pub const N_BINS: usize = 20;

/// Posterior probabilities below the truth of one quantity, one a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranks {
    /// Name of the quantity.
    pub name: &'static str,
    /// Probabilities below the truth [-].
    pub below: Vec<f64>,
}

impl Ranks {
    /// Ranks of a quantity, none yet.
    pub fn new(name: &'static str) -> Self {
        Self { name, below: Vec::new() }
    }

    /// Share of the runs whose central band of this probability holds the truth [-].
    pub fn coverage(&self, band: f64) -> f64 {
        let tail = 0.5 * (1.0 - band);
        let held = self.below.iter().filter(|b| (tail..=1.0 - tail).contains(*b)).count();
        held as f64 / self.below.len() as f64
    }

    /// Standard error of [`Ranks::coverage`] if the band is right [-].
    pub fn standard_error(&self, band: f64) -> f64 {
        (band * (1.0 - band) / self.below.len() as f64).sqrt()
    }

    /// How many ranks fall into each of equal bins.
    pub fn histogram(&self) -> [usize; N_BINS] {
        let mut bins = [0; N_BINS];
        for below in &self.below {
            bins[((below * N_BINS as f64) as usize).min(N_BINS - 1)] += 1;
        }
        bins
    }

    /// Probability of a histogram as uneven as this one or more if the ranks are uniform [-].
    pub fn uniformity(&self) -> f64 {
        let expected = self.below.len() as f64 / N_BINS as f64;
        let square: f64 =
            self.histogram().iter().map(|n| (*n as f64 - expected).powi(2) / expected).sum();
        ChiSquared::new((N_BINS - 1) as f64).map_or(f64::NAN, |law| law.sf(square))
    }

    /// The histogram as a line of bars; the middle height is what uniform ranks have.
    pub fn bars(&self) -> String {
        const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
        let expected = self.below.len() as f64 / N_BINS as f64;
        let bar = |n: usize| BARS[((4.0 * n as f64 / expected) as usize).min(BARS.len() - 1)];
        self.histogram().into_iter().map(bar).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_ranks_are_calibrated_and_crowded_ones_are_not() {
        let even =
            Ranks { name: "even", below: (0..2000).map(|i| f64::from(i) / 2000.0).collect() };
        assert!((even.coverage(0.95) - 0.95).abs() < 1e-3);
        assert!((even.coverage(0.5) - 0.5).abs() < 1e-3);
        assert!(even.uniformity() > 0.99);
        let crowded = Ranks { below: even.below.iter().map(|b| 0.4 + 0.2 * b).collect(), ..even };
        assert!((crowded.coverage(0.5) - 1.0).abs() < 1e-12 && crowded.uniformity() < 1e-12);
    }
}
