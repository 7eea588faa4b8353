//! Joint draws from the posterior of a decay: law, motion and moment that belong together.
//!
//! A draw of a misfit is one from its prior, corrected by what the record says of the difference
//! (Durbin and Koopman, Biometrika 89, 2002).

use rand::Rng;
use rand::RngExt;
use rand_distr::{Distribution, Gamma, StandardNormal};

use super::disturbance::{Columns, Disturbance, Noise};
use super::fit::N_UNKNOWNS;
use super::posterior::{DecayPosterior, Weighed};
use super::solution::Plan;
use crate::inverse::state_space::matern::Matern;
use crate::inverse::state_space::matrix::apply;
use crate::inverse::state_space::transition::Transition;

/// One draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Draw {
    /// Unknowns: damping curve and cubic restoring as a whole, the rest as changes of the fit.
    pub unknowns: [f64; N_UNKNOWNS],
    /// Standard deviation of the roll noise [rad], that of the thinned record.
    pub noise_sd_rad: f64,
    /// Roll [rad] about its zero, roll rate [rad/s] and `U` [rad/s2], sample by sample.
    pub motion: Vec<[f64; 3]>,
}

/// Draws from the posterior with the randomness of `rng`.
pub fn draw(posterior: &DecayPosterior, rng: &mut impl Rng) -> Draw {
    let weighed = pick(posterior, rng);
    let solution = &weighed.solution;
    let disturbance = posterior.disturbances[weighed.disturbance];
    // One over a gamma variate has the inverse gamma law.
    let precision = Gamma::new(solution.shape, 1.0).map_or(1.0, |gamma| gamma.sample(rng));
    let noise_sd_rad = (solution.scale_rad2 / precision).sqrt();
    let (unknowns, misfit) = if disturbance.misfit.is_some() {
        corrected(posterior, weighed, &disturbance, noise_sd_rad, rng)
    } else {
        let mut unknowns = solution.mean;
        for column in &solution.factor {
            let step = noise_sd_rad * normal(rng);
            for (value, share) in unknowns.iter_mut().zip(column) {
                *value += step * share;
            }
        }
        (unknowns, None)
    };
    let motion = motion(posterior, &unknowns, misfit.as_deref());
    Draw { unknowns, noise_sd_rad, motion }
}

/// A solution as often as its weight says.
fn pick<'a>(posterior: &'a DecayPosterior, rng: &mut impl Rng) -> &'a Weighed {
    let total: f64 = posterior.solutions.iter().map(Weighed::weight).sum();
    let mut left = total * rng.random::<f64>();
    for weighed in &posterior.solutions {
        left -= weighed.weight();
        if left <= 0.0 {
            return weighed;
        }
    }
    &posterior.solutions[0]
}

/// Unknowns and misfit drawn from their prior, corrected by the record.
fn corrected(
    posterior: &DecayPosterior,
    weighed: &Weighed,
    disturbance: &Disturbance,
    noise_sd_rad: f64,
    rng: &mut impl Rng,
) -> ([f64; N_UNKNOWNS], Option<Vec<[f64; 3]>>) {
    let columns = &posterior.columns;
    let plan =
        Plan::new(weighed.form, weighed.cubic_restoring, posterior.noise_rad, posterior.floor_rad2);
    let path = prior_path(columns, disturbance, rng);
    let prior = plan.prior_draw(noise_sd_rad, || normal(rng));
    let noise = noise_path(columns, disturbance.noise, rng);
    let difference: Vec<f64> = (0..columns.n_samples())
        .map(|i| {
            let law: f64 = (0..N_UNKNOWNS).map(|u| prior[u] * columns.at(u, i)).sum();
            columns.at(N_UNKNOWNS, i) - law - noise_sd_rad * (path[i][0] + noise[i])
        })
        .collect();
    let columns = columns.with_record(difference);
    let (filtered, smoothed) = columns.smooth(disturbance);
    let found = plan.solution(&filtered).mean;
    let unknowns = std::array::from_fn(|u| prior[u] + found[u]);
    let misfit = smoothed.zip(disturbance.misfit).map(|(smoothed, misfit)| {
        let weights = found.map(|f| -f);
        (0..columns.n_samples())
            .map(|i| {
                let size = columns.size(&misfit, i);
                std::array::from_fn(|k| {
                    let unit = if k == 2 { size } else { 1.0 };
                    unit * (noise_sd_rad * path[i][k] + smoothed.mean(i, k, &weights))
                })
            })
            .collect()
    });
    (unknowns, misfit)
}

/// Fit, unknowns and misfit put together.
fn motion(
    posterior: &DecayPosterior,
    unknowns: &[f64; N_UNKNOWNS],
    misfit: Option<&[[f64; 3]]>,
) -> Vec<[f64; 3]> {
    let linearised = &posterior.linearised;
    let w = linearised.point.decay.natural_frequency_rad_s;
    let changes: [f64; N_UNKNOWNS] = std::array::from_fn(|u| unknowns[u] - linearised.fitted[u]);
    (0..linearised.motion.len())
        .map(|i| {
            let fit = &linearised.motion[i];
            let mut here = [fit.roll_rad, fit.roll_rate_rad_per_s, linearised.moment_per_s2(i)];
            for (u, change) in changes.iter().enumerate() {
                let response = &linearised.responses[u][i];
                here[0] += change * response.roll;
                here[1] += change * response.rate;
                here[2] += change * linearised.moment_response(u, i);
            }
            if let Some(misfit) = misfit {
                here[0] += misfit[i][0];
                here[1] += w * misfit[i][1];
                here[2] += w * w * misfit[i][2];
            }
            here
        })
        .collect()
}

fn normal(rng: &mut impl Rng) -> f64 {
    rng.sample(StandardNormal)
}

/// Roll, rate and moment over its size of a misfit from its prior, in units of the roll noise.
fn prior_path(columns: &Columns, disturbance: &Disturbance, rng: &mut impl Rng) -> Vec<[f64; 3]> {
    let Some(misfit) = disturbance.misfit else { return vec![[0.0; 3]; columns.n_samples()] };
    let (sd, envelope) = (misfit.sd, columns.envelope());
    let (first, second, third) = columns.steps();
    match misfit.order {
        1 => simulated(&Matern::new(sd, envelope, first), columns.tau(), rng),
        2 => simulated(&Matern::new(sd, envelope, second), columns.tau(), rng),
        _ => simulated(&Matern::new(sd, envelope, third), columns.tau(), rng),
    }
}

fn simulated<const N: usize>(
    prior: &impl Transition<N>,
    tau: &[f64],
    rng: &mut impl Rng,
) -> Vec<[f64; 3]> {
    let mut draw = || std::array::from_fn(|_| normal(rng));
    let mut state: [f64; N] = apply(&prior.start(), &draw());
    let mut path = vec![[state[0], state[1], state[2]]];
    for (i, pair) in tau.windows(2).enumerate() {
        let step = prior.step(i + 1, pair[1] - pair[0]);
        let moved = apply(&step.f, &state);
        let added = apply(&step.g, &draw());
        state = std::array::from_fn(|k| moved[k] + added[k]);
        path.push([state[0], state[1], state[2]]);
    }
    path
}

/// The noise of a channel of unit standard deviation.
fn noise_path(columns: &Columns, noise: Noise, rng: &mut impl Rng) -> Vec<f64> {
    let mut last = normal(rng);
    let mut path = vec![last];
    for pair in columns.tau().windows(2) {
        let kept = match noise {
            Noise::White => 0.0,
            Noise::Coloured(tau_c) => (-(pair[1] - pair[0]) / tau_c).exp(),
        };
        last = kept * last + (1.0 - kept * kept).sqrt() * normal(rng);
        path.push(last);
    }
    path
}
