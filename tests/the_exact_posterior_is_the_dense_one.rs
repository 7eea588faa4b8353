//! The posterior in linear time against dense algebra, on the paper's own model.

use rolltank::bench::speed::paper_problem;
use rolltank::inverse::paper::exact::exact;
use rolltank::inverse::paper::{Hyperpriors, PriorPower};
use rolltank::inverse::state_space::posterior::Quadrature;

use crate::dense_posterior::dense_posterior;
use crate::sampler_cases::{BARE_HULL_AS_PRINTED, BILGE_KEELS, Case, FORCED_SCALE_FREE};

/// Largest differences of mean and standard deviation, in standard deviations.
fn differences(case: &Case, seed: u64) -> (f64, f64) {
    let (convolution, g) = case.observable(seed);
    let dense =
        dense_posterior(&g, case.step_s, case.natural_frequency_rad_s, &case.hyper, case.power);
    let fast = exact(&g, &convolution, &case.hyper, case.power, Quadrature::EXACT);
    let largest = |pairs: Vec<(f64, f64)>| {
        pairs.iter().zip(&dense.sd).map(|((a, b), sd)| ((a - b) / sd).abs()).fold(0.0_f64, f64::max)
    };
    let mean = largest(fast.mean.iter().copied().zip(dense.mean.iter().copied()).collect());
    let sd = largest(fast.sd.iter().copied().zip(dense.sd.iter().copied()).collect());
    (mean, sd)
}

/// Eight digits: the dense factorisation itself loses as many.
const ROUNDING: f64 = 1e-8;

#[test]
fn a_decay_with_the_printed_hyperpriors_has_the_dense_posterior() {
    let (mean, sd) = differences(&BARE_HULL_AS_PRINTED, 1);
    assert!(mean < ROUNDING && sd < ROUNDING, "mean {mean}, sd {sd}");
}

#[test]
fn a_bilge_keel_decay_with_the_mended_power_has_the_dense_posterior() {
    let (mean, sd) = differences(&BILGE_KEELS, 2);
    assert!(mean < ROUNDING && sd < ROUNDING, "mean {mean}, sd {sd}");
}

#[test]
fn a_forced_run_with_scale_free_hyperpriors_has_the_dense_posterior() {
    let (mean, sd) = differences(&FORCED_SCALE_FREE, 3);
    assert!(mean < ROUNDING && sd < ROUNDING, "mean {mean}, sd {sd}");
}

#[test]
fn three_hundred_samples_have_the_dense_posterior_to_eight_digits() {
    let long = Case { n: 300, step_s: 0.03, ..BARE_HULL_AS_PRINTED };
    let (mean, sd) = differences(&long, 4);
    println!("n = 300: largest difference of mean {mean:.1e} sd, of sd {sd:.1e}");
    assert!(mean < ROUNDING && sd < ROUNDING, "mean {mean}, sd {sd}");
    let free = Case { hyper: FORCED_SCALE_FREE.hyper, power: FORCED_SCALE_FREE.power, ..long };
    let (mean, sd) = differences(&free, 5);
    println!("n = 300, scale free: largest difference of mean {mean:.1e} sd, of sd {sd:.1e}");
    assert!(mean < ROUNDING && sd < ROUNDING, "mean {mean}, sd {sd}");
}

#[test]
fn the_nodes_that_a_band_takes_move_it_by_a_thousandth_of_a_deviation() {
    let (g, convolution) = paper_problem(500).expect("the problem is well posed");
    let at =
        |quadrature| exact(&g, &convolution, &Hyperpriors::PAPER, PriorPower::Printed, quadrature);
    let (band, all) = (at(Quadrature::BAND), at(Quadrature::EXACT));
    for (few, many) in [(&band.mean, &all.mean), (&band.sd, &all.sd)] {
        let off = |((few, many), sd): ((&f64, &f64), &f64)| ((few - many) / sd).abs();
        let worst = few.iter().zip(many).zip(&all.sd).map(off).fold(0.0, f64::max);
        println!("largest difference {worst:.1e} sd");
        assert!(worst < 1.1e-3, "{worst}");
    }
}
