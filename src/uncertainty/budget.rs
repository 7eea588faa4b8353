//! The uncertainty of the damping of one condition at one speed, source by source.
//!
//! After the Guide to the Expression of Uncertainty in Measurement (GUM, JCGM 100:2008), to which
//! ITTC 7.5-02-01-01 refers: standard uncertainties, type A from statistics, type B from elsewhere,
//! combined as the root of the sum of squares, expanded by a coverage factor for 95 %.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::AMPLITUDES_DEG;
use super::repeats::{Repeats, repeats_at};
use super::slopes::Slopes;
use crate::campaign::Campaign;
use crate::results::{IdentifiedRun, Results};
use crate::run::RunKind;

/// Sources with type and equation, in the order of the columns.
pub const EQUATIONS: [(&str, &str, &str); 8] = [
    ("Noise", "A", "posterior sd of b_{eq} of a run over √n, less its digitiser and skew"),
    (
        "Digitiser",
        "B",
        "decays: noise times q/(√12 σ), q the step of the roll channel, σ its noise",
    ),
    ("Run to run", "A", "√(s² − noise²)/√n, s the standard deviation of the n runs"),
    (
        "Clock",
        "B",
        "b_{eq} u(clock): b is the inverse of a time; u(clock) as given, else √(2/3) d/T of the \
         stated bound d of the roll's times over a run of length T",
    ),
    (
        "Skew",
        "B",
        "forced runs: |∂b_{eq}/∂t| u(t), about (K/(I+ΔI) − ω²) u(t), of the time t between roll \
         and moment; u(t) = √((d₁² + d₂²)/3) of their stated bounds, not less by √n",
    ),
    (
        "Roll gain",
        "B",
        "2 (b_{eq} − b₁) u(gain): b₁ has no amplitude in it, b₃ its square; forced runs: \
         (ω_{n}/ω)² b_{eq} u(gain) more",
    ),
    ("Force gain", "B", "forced runs: (ω_{n}/ω)² b_{eq} u(gain), in B̂₄₄ B̂₄₄ u(gain)"),
    (
        "GM",
        "B",
        "decays: B̂₄₄ u(GM), none in b: I+ΔI = K/ω_{n}², and ∇ cancels in B̂₄₄; forced runs: \
         (ω_{n}/ω)² b_{eq} u(GM), none in B̂₄₄",
    ),
];

/// Standard uncertainties [1/s] of the mean `b_eq` of one condition at one speed; none where the
/// source is not known.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Budget {
    /// Loading or appendage condition.
    pub condition: String,
    /// Decay or forced.
    pub kind: &'static str,
    /// Mean Froude number [-].
    pub froude: f64,
    /// Mean frequency at which the model rolls [rad/s].
    pub frequency_rad_s: f64,
    /// Roll amplitude of the damping [deg].
    pub amplitude_deg: f64,
    /// Runs of that kind.
    pub n_runs: usize,
    /// Mean `b_eq` [1/s].
    pub damping_per_s: f64,
    /// Noise and all that the posterior of a run knows but the digitiser and the skew.
    pub noise_per_s: f64,
    /// Steps of the digitiser.
    pub digitiser_per_s: Option<f64>,
    /// Scatter from run to run beyond the noise.
    pub run_to_run_per_s: Option<f64>,
    /// Rate of the clock.
    pub clock_per_s: Option<f64>,
    /// Time between roll and moment; nil for decays.
    pub skew_per_s: Option<f64>,
    /// Gain of the roll channel.
    pub roll_gain_per_s: Option<f64>,
    /// Gain of the force channel; nil for decays.
    pub force_gain_per_s: Option<f64>,
    /// Metacentric height; nil for decays.
    pub gm_per_s: Option<f64>,
    /// All that is known of these together.
    pub combined_per_s: f64,
    /// Coverage factor for 95 %, Student's with the effective degrees of freedom of (G.2b).
    pub coverage_factor: f64,
    /// Expanded relative uncertainty of `b_eq` [-].
    pub expanded_share: f64,
    /// The same of `B44hat`, the metacentric height and the clock in the inertia included [-].
    pub b44_expanded_share: f64,
    /// Sources that are left out because nothing is known of them.
    pub left_out: Vec<&'static str>,
}

/// One budget per amplitude, kind of run, condition and speed, in order; forced runs at one
/// frequency each.
pub fn budgets(campaign: &Campaign, results: &Results) -> Vec<Budget> {
    let all = AMPLITUDES_DEG.into_iter().flat_map(|amplitude| {
        let kinds = [RunKind::Decay, RunKind::Forced].into_iter();
        kinds.flat_map(move |kind| {
            repeats_at(results, kind, amplitude).into_iter().map(move |r| (kind, r))
        })
    });
    all.map(|(kind, repeats)| budget(campaign, results, kind, &repeats)).collect()
}

fn budget(campaign: &Campaign, results: &Results, kind: RunKind, repeats: &Repeats) -> Budget {
    let runs: Vec<&IdentifiedRun> =
        results.runs.iter().filter(|run| repeats.runs.contains(&run.id)).collect();
    let n = repeats.runs.len() as f64;
    let slopes = Slopes::of(kind, &runs, repeats);
    let skew_per_s = slopes.skew_per_s(&runs);
    let skew_square = skew_per_s.unwrap_or(0.0).powi(2);
    let (b, own) = (repeats.mean_per_s, (repeats.own_per_s.powi(2) - skew_square).max(0.0).sqrt());
    let mean_of = |of: &dyn Fn(&IdentifiedRun) -> f64| runs.iter().map(|r| of(r)).sum::<f64>() / n;
    // The share of the digitiser's steps in the variance of the noise.
    let step_share = mean_of(&|run| {
        let quantum_rad = run.identification.beliefs.as_ref().and_then(|known| known.quantum_rad);
        let noise_rad = run.identification.roll_noise_rad.mean;
        quantum_rad.map_or(0.0, |step| (step.powi(2) / (12.0 * noise_rad.powi(2))).min(1.0))
    });
    let noise_per_s = own * (1.0 - step_share).max(0.0).sqrt() / n.sqrt();
    let digitiser_per_s = Some(own * step_share.sqrt() / n.sqrt());
    let run_to_run_per_s =
        repeats.run_to_run_per_s.map(|s| (s.powi(2) - own.powi(2)).max(0.0).sqrt() / n.sqrt());
    let trueness = campaign.trueness;
    let clock_per_s = trueness.clock.or_else(|| stated_rate(&runs)).map(|share| b * share);
    let by = |share: Option<f64>, slope: f64| share.map(|share| slope.abs() * share);
    let roll_gain_per_s = by(trueness.roll_gain, slopes.damping.roll_gain);
    let [force_gain_per_s, gm_per_s] = match kind {
        RunKind::Decay => [Some(0.0); 2],
        RunKind::Forced => {
            [by(trueness.force_gain, slopes.damping.force_gain), by(trueness.gm, slopes.damping.gm)]
        }
    };
    let square = |value: f64| value * value;
    let squares = |of: &[Option<f64>]| of.iter().flatten().copied().map(square).sum::<f64>();
    let common =
        squares(&[Some(noise_per_s), digitiser_per_s, run_to_run_per_s, clock_per_s, skew_per_s]);
    let combined_per_s = (common + squares(&[roll_gain_per_s, force_gain_per_s, gm_per_s])).sqrt();
    // B = b K/w2: a clock that is fast makes b larger and 1/w2 smaller by twice as much.
    let b44_per_s = (common
        + squares(&[
            by(trueness.roll_gain, slopes.moment.roll_gain),
            by(trueness.force_gain, slopes.moment.force_gain),
            by(trueness.gm, slopes.moment.gm),
        ]))
    .sqrt();
    // Only the scatter of a few runs is itself badly known; Welch and Satterthwaite, GUM (G.2b).
    let freedom = run_to_run_per_s
        .filter(|u| *u > 0.0)
        .map_or(f64::INFINITY, |u| (combined_per_s / u).powi(4) * (n - 1.0));
    let coverage_factor = student(freedom);
    let named = [
        ("run to run", run_to_run_per_s.is_none()),
        ("clock", clock_per_s.is_none()),
        ("skew", skew_per_s.is_none()),
        ("roll gain", trueness.roll_gain.is_none()),
        ("force gain", force_gain_per_s.is_none()),
        ("GM", trueness.gm.is_none()),
    ];
    Budget {
        condition: repeats.condition.clone(),
        kind: kind.name(),
        froude: repeats.froude,
        frequency_rad_s: slopes.frequency_rad_s,
        amplitude_deg: repeats.amplitude_deg,
        n_runs: repeats.runs.len(),
        damping_per_s: b,
        noise_per_s,
        digitiser_per_s,
        run_to_run_per_s,
        clock_per_s,
        skew_per_s,
        roll_gain_per_s,
        force_gain_per_s,
        gm_per_s,
        combined_per_s,
        coverage_factor,
        expanded_share: coverage_factor * combined_per_s / b.abs(),
        b44_expanded_share: coverage_factor * b44_per_s / b.abs(),
        left_out: named.iter().filter(|(_, missing)| *missing).map(|(name, _)| *name).collect(),
    }
}

/// The rate of the clocks as the bounds of the runs state it, where all of them do [-].
fn stated_rate(runs: &[&IdentifiedRun]) -> Option<f64> {
    let rates = runs.iter().map(|run| run.run.timing.rate_sd(run.run.end_s - run.run.start_s));
    let rates: Vec<f64> = rates.collect::<Option<_>>()?;
    Some(rates.iter().sum::<f64>() / rates.len() as f64)
}

/// The factor of Student's distribution that holds 95 %.
fn student(freedom: f64) -> f64 {
    const NORMAL: f64 = 1.959_963_984_540_054;
    if freedom > 1e6 {
        return NORMAL;
    }
    StudentsT::new(0.0, 1.0, freedom.max(1.0)).map_or(NORMAL, |t| t.inverse_cdf(0.975))
}
