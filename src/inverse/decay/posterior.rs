//! The posterior of a decay: forms of law, restorings and disturbances weighed by their evidence.

use super::disturbance::{Columns, Disturbance};
use super::fit::{CUBIC_RESTORING, FREQUENCY, Linearised, N_UNKNOWNS, RATE, ROLL, ZERO};
use super::form::{CUBIC, power_unit};
use super::search::{Candidate, Search, log_sum};
use super::solution::Solution;
use crate::inverse::mixture::Component;

/// One solution with its share of the belief.
#[derive(Debug, Clone, PartialEq)]
pub struct Weighed {
    /// Logarithm of its posterior probability.
    pub log_weight: f64,
    /// Position of the form among [`FORMS`].
    pub form: usize,
    /// Whether the restoring has a cubic part.
    pub cubic_restoring: bool,
    /// Position of the disturbance among those of the posterior.
    pub disturbance: usize,
    /// The solution.
    pub solution: Solution,
}

impl Weighed {
    /// Posterior probability.
    pub fn weight(&self) -> f64 {
        self.log_weight.exp()
    }
}

/// The posterior of one decay.
pub struct DecayPosterior {
    /// The equation linearised at its least-squares point.
    pub linearised: Linearised,
    /// The disturbances that carry weight.
    pub disturbances: Vec<Disturbance>,
    /// Every solution that carries weight within its form, heaviest first.
    pub solutions: Vec<Weighed>,
    /// The columns, for whoever draws from the posterior.
    pub columns: Columns,
    /// Noise of the thinned record [rad] that priors were measured with.
    pub noise_rad: f64,
    /// Noise variance that the roll channel's quantum makes in each sample [rad2].
    pub floor_rad2: f64,
}

/// Solutions lighter than this within their form are dropped.
const NEGLIGIBLE: f64 = 1e-4;

impl DecayPosterior {
    /// Weighs everything about a linearised decay; `floor_rad2` is the noise variance that the roll
    /// channel's quantum makes in each sample.
    pub fn new(linearised: Linearised, columns: Columns, floor_rad2: f64) -> Self {
        let square: f64 = linearised.residual_rad.iter().map(|r| r * r).sum();
        let noise_rad = (square / columns.n_samples() as f64).max(floor_rad2).sqrt();
        let search = Search::new(&columns, noise_rad, floor_rad2);
        let (disturbances, solutions) = weighed(&search.candidates());
        Self { linearised, disturbances, solutions, columns, noise_rad, floor_rad2 }
    }

    /// Components of the mixture of one linear combination of the unknowns.
    pub fn combination(&self, weights: &[f64; N_UNKNOWNS]) -> Vec<Component> {
        self.of_solutions(|_| true, |solution| solution.combination(weights))
    }

    /// Components of one unknown: initial roll, rate, frequency and zero as they are, not as
    /// changes.
    pub fn unknown(&self, position: usize) -> Vec<Component> {
        let mut weights = [0.0; N_UNKNOWNS];
        weights[position] = 1.0;
        let point = &self.linearised.point;
        let from = match position {
            ROLL => point.decay.initial_roll_rad,
            RATE => point.decay.initial_roll_rate_rad_per_s,
            FREQUENCY => point.decay.natural_frequency_rad_s,
            ZERO => point.zero_rad,
            _ => 0.0,
        };
        let mut components = self.combination(&weights);
        for component in &mut components {
            component.mean += from;
        }
        components
    }

    /// Components of a mean with its standard deviation over the solutions that `take` takes.
    fn of_solutions(
        &self,
        take: impl Fn(&Weighed) -> bool,
        value: impl Fn(&Solution) -> (f64, f64),
    ) -> Vec<Component> {
        let taken: Vec<&Weighed> = self.solutions.iter().filter(|w| take(w)).collect();
        // The heaviest comes first: what is taken may be all but refuted beside the rest.
        let top = taken.first().map_or(0.0, |w| w.log_weight);
        let component = |weighed: &&Weighed| {
            let (mean, sd) = value(&weighed.solution);
            Component { weight: (weighed.log_weight - top).exp(), mean, sd }
        };
        taken.iter().map(component).collect()
    }

    /// Components of `a b1 + c b3` of the law of Sec. 4.1 [1/s] and [s].
    pub fn cubic_law(&self, a: f64, c: f64) -> Vec<Component> {
        let scale = &self.linearised.scale;
        self.coefficients(CUBIC, &[a * power_unit(1.0, scale), c * power_unit(3.0, scale)])
    }

    /// Components of a linear combination of the coefficients of one form's directions.
    pub fn coefficients(&self, form: usize, weights: &[f64]) -> Vec<Component> {
        let dot = |x: &[f64]| x.iter().zip(weights).map(|(x, w)| x * w).sum::<f64>();
        self.of_solutions(
            |w| w.form == form,
            |s| {
                let square: f64 = s.coefficient_factor.iter().map(|f| dot(f).powi(2)).sum();
                (dot(&s.coefficients), (square * s.noise_variance_rad2()).sqrt())
            },
        )
    }

    /// Components of the cubic part of the restoring [1/rad2], given that there is one.
    pub fn cubic_restoring(&self) -> Vec<Component> {
        let mut weights = [0.0; N_UNKNOWNS];
        weights[CUBIC_RESTORING] = 1.0;
        let given = self.of_solutions(|w| w.cubic_restoring, |s| s.combination(&weights));
        if given.is_empty() { vec![Component { weight: 1.0, mean: 0.0, sd: 0.0 }] } else { given }
    }

    /// Posterior probability of what `is` tells.
    pub fn probability(&self, is: impl Fn(&Weighed, &Disturbance) -> bool) -> f64 {
        let holds = |w: &&Weighed| is(w, &self.disturbances[w.disturbance]);
        self.solutions
            .iter()
            .filter(holds)
            .map(Weighed::weight)
            .fold(0.0, |sum, weight| sum + weight)
    }
}

/// The solutions that carry weight, with the disturbances they need.
fn weighed(candidates: &[Candidate<'_>]) -> (Vec<Disturbance>, Vec<Weighed>) {
    let total = log_sum(candidates.iter().map(|c| c.log_evidence));
    let mut parts: Vec<(f64, usize, usize)> = Vec::new();
    for (c, candidate) in candidates.iter().enumerate() {
        for (p, part) in candidate.log_parts.iter().enumerate() {
            parts.push((part - total, c, p));
        }
    }
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let is_reported = |c: usize, p: usize| candidates[c].plans[p].form == CUBIC;
    let reported = parts.iter().find(|(_, c, p)| is_reported(*c, *p)).map_or(0.0, |part| part.0);
    // A form that is all but refuted is kept only where its coefficients are reported.
    parts.retain(|&(log_weight, c, p)| {
        let least = if is_reported(c, p) { reported.min(0.0) } else { 0.0 };
        log_weight > least + NEGLIGIBLE.ln()
    });
    let mut used: Vec<usize> = parts.iter().map(|part| part.1).collect();
    used.sort_unstable();
    used.dedup();
    let weighed = |&(log_weight, c, p): &(f64, usize, usize)| {
        let plan = &candidates[c].plans[p];
        Weighed {
            log_weight,
            form: plan.form,
            cubic_restoring: plan.cubic_restoring,
            disturbance: used.binary_search(&c).expect("it is among the used ones"),
            solution: plan.solution(&candidates[c].filtered),
        }
    };
    let solutions = parts.iter().map(weighed).collect();
    (used.iter().map(|&c| candidates[c].disturbance).collect(), solutions)
}
