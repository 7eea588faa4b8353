//! Several chains side by side, each on its own thread with its own random stream.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use super::gibbs::{Gibbs, Problem};
use super::kept_draws::KeptDraws;
use super::settings::ChainSettings;
use super::{PaperError, Progress};
use crate::inverse::identification::Trace;

/// Sweeps between two looks at the watcher.
const N_SWEEPS_BETWEEN_LOOKS: usize = 256;

/// Values drawn of a trace at most: as many as a figure has pixels.
const N_TRACE_MAX: usize = 1_000;

/// One finished chain.
#[derive(Debug)]
pub(super) struct FinishedChain {
    /// Its sweeps after burn-in.
    pub(super) kept: KeptDraws,
    /// Its path from the start, burn-in included.
    pub(super) traces: Vec<Trace>,
}

/// Runs all chains; the order of the result is theirs, not that of the threads.
pub(super) fn run(
    problem: &Problem,
    settings: &ChainSettings,
    watch: &(dyn Fn(Progress) -> ControlFlow<()> + Sync),
) -> Result<Vec<FinishedChain>, PaperError> {
    let stop = AtomicBool::new(false);
    let watched = |progress: Progress| {
        if watch(progress).is_break() {
            stop.store(true, Ordering::Relaxed);
        }
        stop.load(Ordering::Relaxed)
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..settings.n_chains)
            .map(|chain| scope.spawn(move || run_one(problem, settings, chain, watched)))
            .collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    })
}

/// Runs one chain until its last sweep, or until `stopped` says so.
fn run_one(
    problem: &Problem,
    settings: &ChainSettings,
    chain: usize,
    stopped: impl Fn(Progress) -> bool,
) -> Result<FinishedChain, PaperError> {
    let ChainSettings { n_sweeps, n_burn_in, n_chains, seed, .. } = *settings;
    let n = problem.g.len();
    let mut gibbs = Gibbs::new(*problem, seed, chain as u64);
    let mut kept = KeptDraws::new(n + 2, n_sweeps - n_burn_in, n_chains);
    let mut traces = empty_traces(problem);
    let trace_spacing = n_sweeps.div_ceil(N_TRACE_MAX);
    for sweep in 0..n_sweeps {
        if sweep.is_multiple_of(N_SWEEPS_BETWEEN_LOOKS)
            && stopped(Progress { chain, sweep, n_sweeps })
        {
            return Err(PaperError::Interrupted { sweep, n_sweeps });
        }
        if sweep.is_multiple_of(trace_spacing) {
            let (one, other) = traced_sites(n);
            let values = [gibbs.lambda, gibbs.sigma, gibbs.u[one], gibbs.u[other]];
            for (trace, value) in traces.iter_mut().zip(values) {
                trace.sweep.push(sweep);
                trace.value.push(value);
            }
        }
        gibbs.sweep(sweep < n_burn_in);
        if sweep >= n_burn_in {
            kept.push(gibbs.u.iter().copied().chain([gibbs.lambda, gibbs.sigma]));
        }
    }
    Ok(FinishedChain { kept, traces })
}

/// The two moments whose paths are kept, as in Fig. 11: a third and two thirds through the run.
fn traced_sites(n: usize) -> (usize, usize) {
    (n / 3, 2 * n / 3)
}

fn empty_traces(problem: &Problem) -> Vec<Trace> {
    let (one, other) = traced_sites(problem.g.len());
    let moment =
        |site: usize| format!("U at {:.2} s [rad/s2]", site as f64 * problem.convolution.step_s());
    ["lambda [s4]".to_owned(), "sigma [rad]".to_owned(), moment(one), moment(other)]
        .into_iter()
        .map(|name| Trace { name, sweep: Vec::new(), value: Vec::new() })
        .collect()
}
