//! How long an identification takes, and how much memory, on the machine at hand.

use std::fs;
use std::path::Path;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use super::stopwatch::{fastest_s, timed};
use crate::campaign;
use crate::inverse::decay::{moment, solve};
use crate::inverse::identification::Method;
use crate::inverse::paper::exact::exact;
use crate::inverse::paper::{
    ChainSettings, Convolution, Hyperpriors, PaperError, PriorPower, sample,
};
use crate::inverse::state_space::posterior::Quadrature;
use crate::inverse::{Setting, identify};
use crate::pipeline::{self, Options};
use crate::run::{Run, RunEnd, RunKind, Series, Timing};
use crate::tank::{Action, FileFormat, FreeRoll, Scenario, write_campaign};

/// One figure with what it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// What was measured.
    pub name: String,
    /// The figure with its unit.
    pub value: String,
}

pub(super) fn figure(name: impl Into<String>, value: String) -> Figure {
    Figure { name: name.into(), value }
}

/// Nothing but a decay's own record.
pub const SETTING: Setting =
    Setting { restoring_n_m_per_rad: 1.0, exciter: None, method: Method::Exact, seed: 1 };

/// Natural frequency of every decay here [rad/s].
const FREQUENCY_RAD_S: f64 = 6.905;
/// Samples of a roll period.
const PER_PERIOD: f64 = 80.0;

/// A decay of `n_samples` that falls to a fifteenth, `per_period` of them in each roll period.
pub fn decay(n_samples: usize, per_period: f64) -> Run {
    let mut rng = ChaCha8Rng::seed_from_u64(n_samples as u64);
    let step_s = std::f64::consts::TAU / FREQUENCY_RAD_S / per_period;
    let damping_per_s = 2.0 * 15_f64.ln() / (step_s * n_samples as f64);
    let truth = FreeRoll {
        natural_frequency_rad_s: FREQUENCY_RAD_S,
        b1_per_s: 0.7 * damping_per_s,
        b3_s: 0.3 * damping_per_s,
        initial_roll_rad: 0.17,
        initial_roll_rate_rad_per_s: 0.0,
    };
    let noise = |rng: &mut ChaCha8Rng| 9e-4 * rng.sample::<f64, _>(StandardNormal);
    let value = truth.motion(step_s, n_samples).iter().map(|m| m.0 + noise(&mut rng)).collect();
    let time_s: Vec<f64> = (0..n_samples).map(|i| step_s * i as f64).collect();
    Run {
        kind: RunKind::Decay,
        start_s: 0.0,
        end_s: time_s[n_samples - 1],
        end: RunEnd::RecordingEnded,
        speed_m_s: None,
        roll: Series { time_s, value },
        drive: Series::default(),
        speed: Series::default(),
        lead: Series::default(),
        still: None,
        excitation_rad_s: None,
        timing: Timing::default(),
    }
}

/// The posterior of a decay with its bands.
fn posterior_s(run: &Run, n: usize) -> f64 {
    fastest_s(n, || solve(run).map(|solved| moment::motion(&solved.posterior)))
}

/// Time of one decay of a thousand samples.
pub fn one_decay() -> Vec<Figure> {
    let run = decay(1000, PER_PERIOD);
    let whole_s = fastest_s(201, || identify(&run, &SETTING));
    vec![
        figure(
            "decay of 1 000 samples: bands, evidence, order, frequency, hyperparameters",
            format!("{:.2} ms", 1e3 * posterior_s(&run, 201)),
        ),
        figure(
            "the same with coefficients, half cycles, resimulation and all that a report shows",
            format!("{:.2} ms", 1e3 * whole_s),
        ),
    ]
}

/// Time and memory a sample for records of a thousand to a million samples.
pub fn long_decays() -> Vec<Figure> {
    let mut figures = Vec::new();
    let mut first_ns = 0.0;
    for n_samples in [1_000, 10_000, 100_000, 1_000_000] {
        let run = decay(n_samples, PER_PERIOD);
        let before = resident_bytes("VmRSS:");
        let n = (400_000 / n_samples).clamp(5, 201);
        let sample_ns = 1e9 * posterior_s(&run, n) / n_samples as f64;
        if n_samples == 1_000 {
            first_ns = sample_ns;
        }
        figures.push(figure(
            format!("{n_samples} samples, {PER_PERIOD} a period: time a sample"),
            format!("{sample_ns:.0} ns, {:.2} of that at 1 000", sample_ns / first_ns),
        ));
        if n_samples == 1_000_000 {
            let peak = resident_bytes("VmHWM:") - before;
            figures.push(figure(
                format!("{n_samples} samples: peak memory a sample beside the record itself"),
                format!("{:.0} bytes", peak / n_samples as f64),
            ));
        }
    }
    let fast = decay(1_000_000, 80_000.0);
    figures.push(figure(
        "1000000 samples in 12.5 periods (88 kHz): time a sample",
        format!("{:.1} ns", 1e9 * posterior_s(&fast, 5) / 1e6),
    ));
    figures
}

/// A line of the kernel's account of this process [bytes]; nil where there is none.
fn resident_bytes(name: &str) -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(name));
    let kib = line.and_then(|rest| rest.trim().trim_end_matches(" kB").parse::<f64>().ok());
    1024.0 * kib.unwrap_or(0.0)
}

/// The paper's inverse problem of a decay: observable `g` [rad] and `H`.
///
/// # Errors
/// Where the step does not resolve the oscillation.
pub fn paper_problem(n_samples: usize) -> Result<(Vec<f64>, Convolution), PaperError> {
    let run = decay(n_samples, 40.0);
    let step_s = run.roll.time_s[1];
    let convolution = Convolution::new(n_samples, step_s, FREQUENCY_RAD_S)?;
    let g = convolution.observable(&run.roll.value, 0.17, 0.0, None);
    Ok((g, convolution))
}

/// The paper's sampler against the exact posterior of the same problem, 500 samples.
pub fn against_the_chain() -> Vec<Figure> {
    const N_SAMPLES: usize = 500;
    let run = decay(N_SAMPLES, 40.0);
    let Ok((g, convolution)) = paper_problem(N_SAMPLES) else { return Vec::new() };
    let hyper = Hyperpriors::PAPER;
    let one = ChainSettings { n_chains: 1, ..ChainSettings::paper(1) };
    let chain_s = fastest_s(3, || sample(&g, &convolution, &hyper, &one));
    let same_s =
        fastest_s(101, || exact(&g, &convolution, &hyper, PriorPower::Printed, Quadrature::BAND));
    let ours_s = posterior_s(&run, 101);
    vec![
        figure("paper-mcmc: one chain of 50 000 sweeps on 500 samples", format!("{chain_s:.2} s")),
        figure(
            "exact posterior of the very same problem",
            format!("{:.3} ms, {:.0} times faster", 1e3 * same_s, chain_s / same_s),
        ),
        figure(
            "paper-mcmc as run: four chains, on one core",
            format!("{:.2} s, {:.0} times the exact one", 4.0 * chain_s, 4.0 * chain_s / same_s),
        ),
        figure(
            "default identification's posterior of that record",
            format!(
                "{:.2} ms, {:.0} times faster than paper-mcmc as run",
                1e3 * ours_s,
                4.0 * chain_s / ours_s
            ),
        ),
    ]
}

/// A campaign of a thousand decays from MCAP recordings in `folder`, which must be empty.
///
/// # Errors
/// A sentence about what could not be written or read.
pub fn campaign_of_a_thousand(folder: &Path) -> Result<Vec<Figure>, String> {
    let mut scenario = Scenario::builtin("paper").ok_or("the paper's scenario is built in")?;
    let is_decay =
        |action: &Action| matches!(action, Action::Release { .. } | Action::Strike { .. });
    scenario.passes.retain(|pass| pass.actions.iter().any(is_decay));
    scenario.recordings.format = FileFormat::Mcap;
    let n_passes: usize = scenario.pass_count();
    for pass in &mut scenario.passes {
        pass.repeat *= 1000_usize.div_ceil(n_passes);
    }
    let written = write_campaign(&scenario, 1, folder, &mut |_, _| {});
    written.map_err(|error| error.to_string())?;
    let campaign = campaign::read(folder).map_err(|mistakes| {
        mistakes.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    })?;
    let (seconds, results) = timed(|| {
        let options = Options { keep_histories: false, ..Options::default() };
        pipeline::replay(&campaign, &options, &mut |_| {}, &mut |_| Ok(()))
    });
    let n_runs = results.map_err(|error| error.to_string())?.runs.len();
    Ok(vec![figure(
        format!("campaign of {n_runs} runs read from MCAP, found and identified on all cores"),
        format!("{seconds:.2} s"),
    )])
}
