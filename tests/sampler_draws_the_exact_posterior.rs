//! The paper's sampler against the exact posterior of the same model.

use rolltank::inverse::paper::{
    ChainResult, ChainSettings, Convolution, Hyperpriors, PriorPower, sample,
};

use crate::dense_posterior::{DensePosterior, dense_posterior};
use crate::sampler_cases::{BARE_HULL_AS_PRINTED, BILGE_KEELS, Case, FORCED_SCALE_FREE};

fn exact(case: &Case, g: &[f64]) -> DensePosterior {
    dense_posterior(g, case.step_s, case.natural_frequency_rad_s, &case.hyper, case.power)
}

fn sampled(case: &Case, g: &[f64], convolution: &Convolution, seed: u64) -> ChainResult {
    let settings = ChainSettings {
        n_sweeps: 40_000,
        n_burn_in: 10_000,
        n_chains: 4,
        seed,
        prior_power: case.power,
    };
    sample(g, convolution, &case.hyper, &settings).expect("the case can be sampled")
}

/// Distance of the sampled from the exact mean of each `U`, in Monte Carlo standard errors.
fn scores(sampled: &ChainResult, exact: &DensePosterior) -> Vec<f64> {
    (0..exact.mean.len())
        .map(|i| {
            let error = exact.sd[i] / sampled.effective_sample_size[i].sqrt();
            (sampled.mean[i] - exact.mean[i]) / error
        })
        .collect()
}

/// The strict rule: every mean within 3 Monte Carlo standard errors, every sd within 10 %.
///
/// Neighbouring moments are so correlated that a hundred of them are some twenty independent ones,
/// so a right sampler breaks the rule of 3 in about one run of twenty; the seed is fixed. With the
/// effective sample size above 500, asked for here, the sd of an sd is below 3.2 %.
fn assert_agreement(case: &Case, seed: u64) {
    let (convolution, g) = case.observable(seed);
    let exact = exact(case, &g);
    let sampled = sampled(case, &g, &convolution, seed);
    assert!(sampled.chain.converged, "R-hat {}", sampled.chain.r_hat_max);
    let size = sampled.chain.effective_sample_size_min;
    assert!(size > 500.0, "effective sample size {size}");
    for (i, z) in scores(&sampled, &exact).into_iter().enumerate() {
        assert!(z.abs() < 3.0, "U[{i}]: mean {z} standard errors from exact");
        let ratio = sampled.sd[i] / exact.sd[i];
        assert!((ratio - 1.0).abs() < 0.1, "U[{i}]: sd {ratio} of exact");
        // A 2.5 % tail from 500 independent draws has a standard error of 0.7 %; four of them.
        let tails = [exact.cdf(i, sampled.lo95[i]), 1.0 - exact.cdf(i, sampled.hi95[i])];
        for tail in tails {
            assert!((tail - 0.025).abs() < 0.028, "U[{i}]: tail {tail} beyond the band");
        }
    }
    let scales = [(sampled.lambda, exact.lambda), (sampled.sigma, exact.sigma)];
    for ((drawn, (mean, sd)), size) in scales.into_iter().zip(sampled.scale_effective_sample_size) {
        let z = (drawn.mean - mean) / (sd / size.sqrt());
        assert!(z.abs() < 3.0, "scale {mean}: mean {z} standard errors from exact");
        assert!((drawn.sd / sd - 1.0).abs() < 0.1, "scale {mean}: sd {}", drawn.sd / sd);
    }
}

#[test]
fn a_bare_hull_decay_read_as_printed() {
    assert_agreement(&BARE_HULL_AS_PRINTED, 1);
}

#[test]
fn a_decay_with_bilge_keels_and_smaller_hyperpriors() {
    assert_agreement(&BILGE_KEELS, 1);
}

#[test]
fn forced_rolling_with_hyperpriors_that_set_no_scale() {
    assert_agreement(&FORCED_SCALE_FREE, 1);
}

#[test]
fn over_many_runs_the_errors_are_those_that_the_effective_sample_size_promises() {
    let mut scores_of_all = Vec::new();
    for seed in 1..=18 {
        let case = [BARE_HULL_AS_PRINTED, BILGE_KEELS, FORCED_SCALE_FREE][seed as usize % 3];
        let case = Case { n: 40, ..case };
        let (convolution, g) = case.observable(seed);
        let sampled = sampled(&case, &g, &convolution, seed);
        scores_of_all.extend(scores(&sampled, &exact(&case, &g)));
    }
    let n = scores_of_all.len() as f64;
    let rms = (scores_of_all.iter().map(|z| z * z).sum::<f64>() / n).sqrt();
    let above = scores_of_all.iter().filter(|z| z.abs() > 3.0).count() as f64 / n;
    let worst = scores_of_all.iter().fold(0.0_f64, |worst, z| worst.max(z.abs()));
    // Normal scores: rms 1, 0.27 % above 3, none of 720 above 5. Some 100 of them are independent,
    // and they come in clusters: rms within 3 x 7 %, room for two clusters of five above 3. The
    // lower bound finds an effective sample size that is too small by half.
    assert!((0.75..1.25).contains(&rms), "rms score {rms}");
    assert!(above <= 10.0 / n, "{above} of the scores above 3");
    assert!(worst < 5.0, "worst score {worst}");
}

#[test]
fn the_power_of_lambda_is_the_one_asked_for() {
    // Half a unit of exponent is 14 % of lambda when there are 8 moments.
    let printed = Case { n: 8, hyper: Hyperpriors::PAPER, ..BILGE_KEELS };
    let mended = Case { power: PriorPower::Rank, ..printed };
    let printed = Case { power: PriorPower::Printed, ..printed };
    let (convolution, g) = printed.observable(1);
    let exact = [exact(&printed, &g), exact(&mended, &g)];
    for (asked, case) in [printed, mended].iter().enumerate() {
        let sampled = sampled(case, &g, &convolution, 2);
        let z = exact.each_ref().map(|exact| {
            let (mean, sd) = exact.lambda;
            (sampled.lambda.mean - mean) / (sd / sampled.scale_effective_sample_size[0].sqrt())
        });
        assert!(z[asked].abs() < 3.0, "{z:?} standard errors from the power asked for");
        assert!(z[1 - asked].abs() > 6.0, "{z:?} standard errors from the other power");
    }
}
