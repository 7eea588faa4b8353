//! What the paper's sampler reports beside the posterior, and what it refuses.

use std::ops::ControlFlow;
use std::sync::Mutex;

use rolltank::inverse::paper::{
    ChainResult, ChainSettings, Hyperpriors, PaperError, Progress, sample, sample_watched,
};

use crate::sampler_cases::{BILGE_KEELS, Case, FORCED_SCALE_FREE};

fn drawn(case: &Case, settings: &ChainSettings) -> ChainResult {
    let (convolution, g) = case.observable(5);
    sample(&g, &convolution, &case.hyper, settings).expect("the case can be sampled")
}

fn short(seed: u64) -> ChainSettings {
    ChainSettings { n_sweeps: 1_000, n_burn_in: 500, ..ChainSettings::paper(seed) }
}

#[test]
fn a_chain_that_is_too_short_is_said_not_to_have_converged() {
    // At 50 Hz with little noise, neighbours hold each other: hundreds of sweeps to one new draw.
    let case = Case { n: 500, step_s: 0.02, noise_rad: 0.000_9, ..FORCED_SCALE_FREE };
    let result = drawn(&case, &short(1));
    assert!(!result.chain.converged, "R-hat {}", result.chain.r_hat_max);
    assert!(result.chain.r_hat_max >= 1.05);
    assert!(result.chain.effective_sample_size_min < 100.0);
    let worst = result.r_hat.iter().chain(&result.scale_r_hat).copied().fold(1.0, f64::max);
    assert!((result.chain.r_hat_max - worst).abs() < 1e-15, "the worst component decides");
}

#[test]
fn the_same_seed_draws_the_same_posterior_to_the_bit() {
    let again = drawn(&BILGE_KEELS, &short(7));
    assert_eq!(drawn(&BILGE_KEELS, &short(7)), again);
    assert_ne!(drawn(&BILGE_KEELS, &short(8)).mean, again.mean);
}

#[test]
fn chains_differ_from_each_other() {
    // A stream shared by two chains would double the effective sample size without cause.
    let one = drawn(&BILGE_KEELS, &ChainSettings { n_chains: 1, ..short(7) });
    let two = drawn(&BILGE_KEELS, &ChainSettings { n_chains: 2, ..short(7) });
    assert_eq!(one.chain.traces, two.chain.traces, "the first chain does not know of the second");
    let twice = one.mean.iter().zip(&two.mean).filter(|(one, two)| (*one - *two).abs() < 1e-9);
    assert_eq!(twice.count(), 0);
}

#[test]
fn traces_begin_at_the_paper_s_start_and_show_the_burn_in() {
    let settings = ChainSettings { n_sweeps: 5_000, n_burn_in: 2_500, ..ChainSettings::paper(3) };
    let traces = drawn(&BILGE_KEELS, &settings).chain.traces;
    let names: Vec<&str> = traces.iter().map(|trace| trace.name.as_str()).collect();
    let moments = ["U at 2.00 s [rad/s2]", "U at 4.00 s [rad/s2]"];
    assert_eq!(names, ["lambda [s4]", "sigma [rad]", moments[0], moments[1]]);
    for (trace, start) in traces.iter().zip([1.0, 0.1, 0.0, 0.0]) {
        assert!((trace.value[0] - start).abs() < 1e-15, "{} starts at {start}", trace.name);
        assert_eq!((trace.sweep[0], trace.sweep[1]), (0, 5));
        assert_eq!((trace.sweep.len(), trace.value.len()), (1_000, 1_000));
    }
}

#[test]
fn a_watcher_sees_every_chain_and_may_stop_them() {
    let (convolution, g) = BILGE_KEELS.observable(5);
    let seen = Mutex::new(Vec::new());
    let watch = |progress: Progress| {
        seen.lock().unwrap().push(progress);
        if progress.sweep >= 512 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let settings = ChainSettings { n_sweeps: 5_000_000, ..ChainSettings::paper(3) };
    let stopped = sample_watched(&g, &convolution, &BILGE_KEELS.hyper, &settings, &watch);
    let Err(PaperError::Interrupted { sweep, n_sweeps: 5_000_000 }) = stopped else {
        panic!("five million sweeps were not stopped: {stopped:?}");
    };
    assert!(sweep <= 512);
    let seen = seen.into_inner().unwrap();
    assert!((0..4).all(|chain| seen.iter().any(|progress| progress.chain == chain)));
}

#[test]
fn what_cannot_be_sampled_is_refused_with_the_reason() {
    let (convolution, mut g) = BILGE_KEELS.observable(5);
    let refusal = |g: &[f64], hyper: Hyperpriors, settings: ChainSettings| {
        sample(g, &convolution, &hyper, &settings).unwrap_err().to_string()
    };
    let hyper = Hyperpriors { beta2: 0.0, ..Hyperpriors::PAPER };
    let message = refusal(&g, hyper, short(1));
    assert!(message.starts_with("hyperparameter beta2 is 0, it must be positive\nhint: "));

    let settings = ChainSettings { n_burn_in: 950, ..short(1) };
    let message = refusal(&g, Hyperpriors::PAPER, settings);
    assert!(message.contains("1000 sweeps with 950 of burn-in"), "{message}");
    assert!(message.contains("100 sweeps after burn-in"), "{message}");

    g[17] = f64::NAN;
    let message = refusal(&g, Hyperpriors::PAPER, short(1));
    assert!(message.starts_with("observable g[17] is NaN"), "{message}");
}
