//! The square-root filter: whitens every column of a linear inverse problem in one pass.
//!
//! The record is `y = X b + z + noise` with `z` the response of the oscillator to the random part
//! of the moment. Whatever has a flat prior (initial state, parameters) is a column of `X`, so the
//! filter starts from a state known to be zero and its gains serve every column alike. Covariances
//! are kept as triangular roots in units of the roll noise: a step is one small orthogonal
//! reduction and no digits are lost, however short the step.

use super::matrix::{Matrix, apply, joined_root, product};
use super::transition::{Step, Transition};
use super::triangle::Triangle;

/// One column that the filter whitens.
#[derive(Debug, Clone, Copy)]
pub enum Column<'a> {
    /// A record, one value per sample [rad].
    Record(&'a [f64]),
    /// The free motion from a unit of one component of the initial state.
    InitialState(usize),
}

/// What the filter knew before each sample, kept for the smoother.
#[derive(Debug, Clone)]
pub struct Trail<const N: usize> {
    /// The step that led to each sample (the first one is not used).
    pub steps: Kept<Step<N>>,
    /// Triangular root of the predicted covariance at each sample.
    pub roots: Kept<Matrix<N>>,
    /// Predicted state, sample by sample, `n_columns` each.
    pub states: Vec<[f64; N]>,
    /// Innovation, sample by sample, `n_columns` each.
    pub innovations: Vec<f64>,
}

impl<const N: usize> Default for Trail<N> {
    fn default() -> Self {
        Self {
            steps: Kept::default(),
            roots: Kept::default(),
            states: Vec::new(),
            innovations: Vec::new(),
        }
    }
}

/// One value a sample, those that repeat kept once: gains that have settled cost no memory.
#[derive(Debug, Clone)]
pub struct Kept<T> {
    values: Vec<T>,
    place: Vec<u32>,
}

impl<T> Default for Kept<T> {
    fn default() -> Self {
        Self { values: Vec::new(), place: Vec::new() }
    }
}

impl<T: Copy> Kept<T> {
    /// Appends a value; `again` tells that it is the last one.
    fn push(&mut self, value: T, again: bool) {
        if !again || self.values.is_empty() {
            self.values.push(value);
        }
        self.place.push((self.values.len() - 1) as u32);
    }

    /// The value of a sample.
    pub fn at(&self, sample: usize) -> &T {
        &self.values[self.place[sample] as usize]
    }

    /// Whether two samples have one value.
    pub fn is_same(&self, a: usize, b: usize) -> bool {
        self.place[a] == self.place[b]
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.place.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.place.is_empty()
    }
}

/// The whitened columns, reduced to a triangle.
#[derive(Debug, Clone)]
pub struct Filtered {
    /// Sum of the logarithms of the innovation variances.
    pub log_determinant: f64,
    /// Number of samples.
    pub n_samples: usize,
    /// Upper triangle `R` of the whitened columns, in the order in which they were given.
    pub triangle: Triangle,
}

/// Whitens `columns`, whose records are sampled at the scaled times `tau`.
pub fn filter<const N: usize>(
    prior: &impl Transition<N>,
    tau: &[f64],
    columns: &[Column<'_>],
    mut trail: Option<&mut Trail<N>>,
) -> Filtered {
    let mut states: Vec<[f64; N]> = columns.iter().map(Column::start).collect();
    let mut triangle = Triangle::new(columns.len());
    let mut whitened = vec![0.0; columns.len()];
    let mut predicted = prior.start();
    let mut root = predicted;
    let (mut log_determinant, mut determinant) = (0.0, 1.0);
    let mut step = Step { f: [[0.0; N]; N], g: [[0.0; N]; N] };
    let mut width = f64::NAN;
    let mut settled = false;
    for (i, &now) in tau.iter().enumerate() {
        let mut same_step = true;
        if i > 0 {
            let passed = now - tau[i - 1];
            // Stamps of an even record differ by one width but for their rounding.
            same_step = prior.is_even() && (passed - width).abs() <= 2.0 * f64::EPSILON * now;
            if !same_step {
                settled = false;
                width = passed;
                step = prior.step(i, width);
            }
            for state in &mut states {
                *state = apply(&step.f, state);
            }
            if !settled {
                let before = predicted;
                predicted = spread(&step, &root);
                settled = same(&before, &predicted);
            }
        }
        // The root is triangular, so the roll is its first row's only entry.
        let reach = predicted[0][0];
        let variance = 1.0 + reach * reach;
        let deviation = variance.sqrt();
        // A logarithm of a few dozen factors at a time; each lies between 1 and what the misfit
        // reaches in units of the noise, so their product is far from overflowing.
        determinant *= variance;
        if determinant > 1e100 {
            log_determinant += determinant.ln();
            determinant = 1.0;
        }
        for ((out, state), column) in whitened.iter_mut().zip(&states).zip(columns) {
            *out = column.at(i) - state[0];
        }
        if let Some(trail) = trail.as_deref_mut() {
            trail.roots.push(predicted, settled);
            trail.steps.push(step, same_step);
            trail.states.extend_from_slice(&states);
            trail.innovations.extend_from_slice(&whitened);
        }
        for (state, innovation) in states.iter_mut().zip(&whitened) {
            let pull = reach / variance * innovation;
            for (x, row) in state.iter_mut().zip(&predicted) {
                *x += row[0] * pull;
            }
        }
        triangle.push(whitened.iter().map(|innovation| innovation / deviation));
        if !settled {
            root = predicted;
            for row in &mut root {
                row[0] /= deviation;
            }
        }
    }
    triangle.settle();
    log_determinant += determinant.ln();
    Filtered { log_determinant, n_samples: tau.len(), triangle }
}

impl Column<'_> {
    fn start<const N: usize>(&self) -> [f64; N] {
        let mut state = [0.0; N];
        if let Column::InitialState(component) = self {
            state[*component] = 1.0;
        }
        state
    }

    fn at(&self, sample: usize) -> f64 {
        match self {
            Column::Record(record) => record[sample],
            Column::InitialState(_) => 0.0,
        }
    }
}

/// The root of the covariance after a step.
fn spread<const N: usize>(step: &Step<N>, root: &Matrix<N>) -> Matrix<N> {
    joined_root(product(&step.f, root), step.g)
}

/// Whether a covariance, or its inverse, has stopped changing, so that what follows can be kept.
pub(super) fn same<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> bool {
    // A relative change of 1e-13 a step is rounding: the filter forgets within a few periods.
    if (a[0][0] - b[0][0]).abs() > 1e-13 * b[0][0].abs() {
        return false;
    }
    let size = b.iter().flatten().fold(0.0_f64, |size, b| size.max(b.abs()));
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-13 * b.abs().max(1e-3 * size);
    a.iter().flatten().zip(b.iter().flatten()).all(near)
}
