//! How long the parts of an identification take: `cargo bench`.

use divan::{Bencher, black_box};
use rolltank::bench::speed::{SETTING, decay, paper_problem};
use rolltank::inverse::decay::{moment, solve};
use rolltank::inverse::identify;
use rolltank::inverse::paper::exact::exact;
use rolltank::inverse::paper::{ChainSettings, Hyperpriors, PriorPower, sample};
use rolltank::inverse::state_space::posterior::Quadrature;

fn main() {
    divan::main();
}

/// Bands of the moment, evidence, order, natural frequency, hyperparameters of a decay.
#[divan::bench(args = [500, 1_000, 10_000, 100_000])]
fn posterior_of_a_decay(bencher: Bencher, n_samples: usize) {
    let run = decay(n_samples, 80.0);
    bencher.bench(|| solve(black_box(&run)).map(|solved| moment::motion(&solved.posterior)));
}

/// All that a report shows of a decay.
#[divan::bench(args = [1_000])]
fn identification_of_a_decay(bencher: Bencher, n_samples: usize) {
    let run = decay(n_samples, 80.0);
    bencher.bench(|| identify(black_box(&run), &SETTING));
}

/// The paper's posterior, exactly.
#[divan::bench(args = [500])]
fn exact_posterior_of_the_paper(bencher: Bencher, n_samples: usize) {
    let (g, convolution) = paper_problem(n_samples).expect("the problem is well posed");
    bencher.bench(|| {
        let (hyper, power) = (Hyperpriors::PAPER, PriorPower::Printed);
        exact(black_box(&g), &convolution, &hyper, power, Quadrature::BAND)
    });
}

/// A fiftieth of the paper's chain.
#[divan::bench(args = [500], sample_count = 10)]
fn thousand_sweeps_of_the_paper(bencher: Bencher, n_samples: usize) {
    let (g, convolution) = paper_problem(n_samples).expect("the problem is well posed");
    let paper = ChainSettings::paper(1);
    let settings = ChainSettings { n_chains: 1, n_sweeps: 1_000, n_burn_in: 500, ..paper };
    bencher.bench(|| sample(black_box(&g), &convolution, &Hyperpriors::PAPER, &settings));
}
