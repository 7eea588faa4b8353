//! What a record holds beside the law: the channel's noise and the moment that the law lacks.

use super::fit::{Linearised, N_UNKNOWNS};
use crate::inverse::record::Record;
use crate::inverse::state_space::coloured::{Memory, Remembering};
use crate::inverse::state_space::filter::{Column, Filtered, filter};
use crate::inverse::state_space::matern::{Matern, Steps};
use crate::inverse::state_space::smoother::{Smoothed, smooth};
use crate::inverse::state_space::transition::Transition;
use crate::inverse::state_space::triangle::Triangle;
use crate::roll::equation::Motion;

/// The noise of the roll channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Noise {
    /// Every sample errs on its own.
    White,
    /// First-order autoregressive: the error fades to `1/e` in this scaled time [-].
    Coloured(f64),
}

/// A moment that the law lacks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misfit {
    /// Order of its Matern prior, 1 to 3.
    pub order: usize,
    /// Its standard deviation at the start of the run, in units of the roll noise [-].
    pub sd: f64,
}

/// One belief about what disturbs a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disturbance {
    /// The noise.
    pub noise: Noise,
    /// The moment that the law lacks, if any.
    pub misfit: Option<Misfit>,
}

/// The columns of a linearised decay, ready to be whitened under any disturbance.
///
/// The columns are those of the unknowns, then the record: what the linearised equation leaves of
/// it when damping and cubic restoring are nil, so that these two are sought as a whole.
#[derive(Clone)]
pub struct Columns {
    values: Vec<Vec<f64>>,
    /// What the fit leaves of the record [rad].
    residual: Vec<f64>,
    tau: Vec<f64>,
    /// Size of the roll against its largest, sample by sample [-].
    envelope: Vec<f64>,
    steps: (Steps<3>, Steps<4>, Steps<5>),
}

/// Below this share of its start the size of a misfit falls no further.
const ENVELOPE_FLOOR: f64 = 0.02;

impl Columns {
    /// The columns of a decay linearised on `record`.
    pub fn new(record: &Record, linearised: &Linearised) -> Self {
        let w = linearised.point.decay.natural_frequency_rad_s;
        let tau = record.scaled_time(w);
        let size = |m: &Motion| m.roll_rad.hypot(m.roll_rate_rad_per_s / w);
        let largest = linearised.motion.iter().map(size).fold(0.0, f64::max);
        let share = |m: &Motion| (size(m) / largest).max(ENVELOPE_FLOOR);
        let mut whole = linearised.residual_rad.clone();
        for (fitted, column) in linearised.fitted.iter().zip(&linearised.columns) {
            for (record, value) in whole.iter_mut().zip(column) {
                *record += fitted * value;
            }
        }
        let mut columns = linearised.columns.clone();
        columns.push(whole);
        Self {
            values: columns,
            residual: linearised.residual_rad.clone(),
            envelope: linearised.motion.iter().map(share).collect(),
            steps: (Steps::new(&tau), Steps::new(&tau), Steps::new(&tau)),
            tau,
        }
    }

    /// Correlation of neighbouring residuals of the fit [-].
    pub fn neighbours_correlate(&self) -> f64 {
        let product = |(a, b): (&f64, &f64)| a * b;
        let pairs = self.residual.iter().zip(&self.residual[1..]).map(product).sum::<f64>();
        pairs / self.residual.iter().map(|r| r * r).sum::<f64>()
    }

    /// Number of samples.
    pub fn n_samples(&self) -> usize {
        self.tau.len()
    }

    /// Scaled time from one sample to the next [-].
    pub fn spacing(&self) -> f64 {
        self.tau[self.tau.len() - 1] / (self.tau.len() - 1) as f64
    }

    /// The same columns with another record.
    #[must_use]
    pub fn with_record(&self, record: Vec<f64>) -> Self {
        let mut columns = self.clone();
        columns.values[N_UNKNOWNS] = record;
        columns
    }

    /// Entry of a column, the record last, at a sample [rad].
    pub fn at(&self, column: usize, sample: usize) -> f64 {
        self.values[column][sample]
    }

    /// Scaled sample times [-].
    pub fn tau(&self) -> &[f64] {
        &self.tau
    }

    /// Size of the roll against its largest, sample by sample [-].
    pub fn envelope(&self) -> &[f64] {
        &self.envelope
    }

    /// The steps of a unit moment of each order.
    pub(super) fn steps(&self) -> (&Steps<3>, &Steps<4>, &Steps<5>) {
        (&self.steps.0, &self.steps.1, &self.steps.2)
    }

    /// Samples of the noise that are worth an independent one each [-].
    pub fn n_effective(&self, noise: Noise) -> f64 {
        match noise {
            Noise::White => self.n_samples() as f64,
            Noise::Coloured(tau_c) => Memory::new(&self.tau, tau_c).n_effective(),
        }
    }

    /// Size of the moment [-] that `misfit` allows at a sample, in units of the roll noise.
    pub fn size(&self, misfit: &Misfit, sample: usize) -> f64 {
        misfit.sd * self.envelope[sample]
    }

    /// The columns whitened.
    pub fn whiten(&self, disturbance: &Disturbance) -> Filtered {
        self.run(disturbance, false).0
    }

    /// The columns whitened, and the moment behind each of them.
    pub fn smooth(&self, disturbance: &Disturbance) -> (Filtered, Option<Smoothed>) {
        self.run(disturbance, true)
    }

    fn run(&self, disturbance: &Disturbance, back: bool) -> (Filtered, Option<Smoothed>) {
        let memory = match disturbance.noise {
            Noise::White => None,
            Noise::Coloured(tau_c) => Some(Memory::new(&self.tau, tau_c)),
        };
        let differences: Option<Vec<Vec<f64>>> = memory
            .as_ref()
            .map(|memory| self.values.iter().map(|column| memory.differences(column)).collect());
        let columns = differences.as_ref().unwrap_or(&self.values);
        let (mut filtered, smoothed) = match disturbance.misfit {
            None => (lawful(columns), None),
            Some(misfit) => match misfit.order {
                1 => self.walk::<3, 4>(&self.steps.0, &misfit, columns, memory.as_ref(), back),
                2 => self.walk::<4, 5>(&self.steps.1, &misfit, columns, memory.as_ref(), back),
                _ => self.walk::<5, 6>(&self.steps.2, &misfit, columns, memory.as_ref(), back),
            },
        };
        filtered.log_determinant -= 2.0 * memory.map_or(0.0, |memory| memory.log_density());
        (filtered, smoothed)
    }

    fn walk<const N: usize, const M: usize>(
        &self,
        steps: &Steps<N>,
        misfit: &Misfit,
        columns: &[Vec<f64>],
        memory: Option<&Memory>,
        back: bool,
    ) -> (Filtered, Option<Smoothed>) {
        let prior = Matern::new(misfit.sd, &self.envelope, steps);
        let columns: Vec<Column<'_>> = columns.iter().map(|c| Column::Record(c)).collect();
        match memory {
            None => pass(&prior, &self.tau, &columns, back),
            Some(memory) => {
                let prior = Remembering::new(&prior, memory);
                pass::<M>(&prior, &self.tau, &columns, back)
            }
        }
    }
}

fn pass<const N: usize>(
    prior: &impl Transition<N>,
    tau: &[f64],
    columns: &[Column<'_>],
    back: bool,
) -> (Filtered, Option<Smoothed>) {
    if back {
        let (filtered, smoothed) = smooth(prior, tau, columns);
        (filtered, Some(smoothed))
    } else {
        (filter(prior, tau, columns, None), None)
    }
}

/// Columns that carry white noise and nothing else.
fn lawful(columns: &[Vec<f64>]) -> Filtered {
    let n_samples = columns[N_UNKNOWNS].len();
    let mut triangle = Triangle::new(columns.len());
    for sample in 0..n_samples {
        triangle.push(columns.iter().map(|column| column[sample]));
    }
    triangle.settle();
    Filtered { log_determinant: 0.0, n_samples, triangle }
}
