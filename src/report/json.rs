//! The JSON contract `rolltank.identification/1`.

use replay::ChannelCounts;
use serde::Serialize;

use super::field_units::FieldUnits;
use super::json_beliefs::{BeliefsJson, CurvePointJson};
use crate::campaign::Campaign;
use crate::inverse::estimate::Estimate;
use crate::inverse::extinction::{Extinction, extinction};
use crate::inverse::identification::{Chain, ForcedResponse, FroudeLaw, HalfCycle, Method, Skew};
use crate::procedure::{self, Answer, CampaignAnswer};
use crate::progress::{Progress, progress};
use crate::results::{IdentifiedRun, RejectedStretch, Results};
use crate::run::RunEnd;
use crate::uncertainty::{self, Budget, Comparison, Repeats};

/// Name and version of the contract.
pub const IDENTIFICATION_NAME: &str = "rolltank.identification/1";

/// The JSON Schema that every [`identification_json`] keeps.
pub const IDENTIFICATION_SCHEMA: &str = include_str!("identification.schema.json");

/// The results of a campaign as JSON; the same results give the same bytes.
///
/// Numbers are written with as many digits as they need to be read back exactly; a number that is
/// not finite is `null`.
///
/// # Panics
///
/// Never: every key of the document is a string, which is all that can fail.
pub fn identification_json(campaign: &Campaign, results: &Results) -> String {
    let document = Document {
        schema: IDENTIFICATION_NAME,
        campaign: &campaign.name,
        runs: results.runs.iter().map(|run| RunJson::new(campaign, run)).collect(),
        rejected: results.rejected.iter().map(RejectedJson::new).collect(),
        froude_law: results.froude_laws.iter().map(FroudeLawJson::new).collect(),
        comparisons: uncertainty::comparisons(results),
        repeats: uncertainty::repeats(results),
        budgets: uncertainty::budgets(campaign, results),
        gates: procedure::of_campaign(results),
        plan: progress(campaign, &results.runs),
        notes: results
            .overviews
            .iter()
            .filter(|overview| !overview.notes.is_empty())
            .map(|overview| NotesJson { recording: &overview.recording, notes: &overview.notes })
            .collect(),
    };
    let mut text = serde_json::to_string_pretty(&document)
        .expect("every key is a string, and a number that is not finite becomes null");
    text.push('\n');
    text
}

#[derive(Serialize)]
struct Document<'a> {
    schema: &'static str,
    campaign: &'a str,
    runs: Vec<RunJson<'a>>,
    rejected: Vec<RejectedJson<'a>>,
    froude_law: Vec<FroudeLawJson<'a>>,
    comparisons: Vec<Comparison>,
    repeats: Vec<Repeats>,
    budgets: Vec<Budget>,
    gates: Vec<CampaignAnswer>,
    plan: Progress,
    notes: Vec<NotesJson<'a>>,
}

#[derive(Serialize)]
struct RunJson<'a> {
    id: &'a str,
    recording: &'a str,
    kind: &'static str,
    condition: &'a str,
    start_s: f64,
    end_s: f64,
    end_reason: &'static str,
    froude: f64,
    speed_m_s: f64,
    method: &'static str,
    natural_frequency_rad_s: Estimate,
    initial_roll_rad: Estimate,
    initial_roll_rate_rad_per_s: Estimate,
    roll_offset_rad: Estimate,
    roll_noise_rad: Estimate,
    b1_per_s: Estimate,
    b3_s: Estimate,
    b1_b3_correlation: f64,
    equivalent_damping_per_s: Vec<EquivalentDampingJson>,
    extinction: Option<Extinction>,
    half_cycles: Vec<HalfCycleJson>,
    damping_curve: Vec<CurvePointJson>,
    beliefs: Option<BeliefsJson>,
    resimulation_rmse_deg: f64,
    inertia_kg_m2: Option<Estimate>,
    inertia_used_kg_m2: Estimate,
    skew: Option<SkewJson>,
    forced: Option<ForcedJson>,
    chain: Option<ChainJson>,
    counts: Vec<ChannelCounts>,
    gates: Vec<Answer>,
    remarks: &'a [String],
}

impl<'a> RunJson<'a> {
    fn new(campaign: &'a Campaign, run: &'a IdentifiedRun) -> Self {
        let identification = &run.identification;
        let units = FieldUnits::new(campaign, run);
        Self {
            id: &run.id,
            recording: &run.recording,
            kind: run.run.kind.name(),
            condition: &run.condition,
            start_s: run.run.start_s,
            end_s: run.run.end_s,
            end_reason: end_name(run.run.end),
            froude: run.froude,
            speed_m_s: run.speed_m_s,
            method: method_name(identification.method),
            natural_frequency_rad_s: identification.natural_frequency_rad_s,
            initial_roll_rad: identification.initial_roll_rad,
            initial_roll_rate_rad_per_s: identification.initial_roll_rate_rad_per_s,
            roll_offset_rad: identification.roll_offset_rad,
            roll_noise_rad: identification.roll_noise_rad,
            b1_per_s: identification.damping.b1_per_s,
            b3_s: identification.damping.b3_s,
            b1_b3_correlation: identification.damping.correlation,
            equivalent_damping_per_s: EquivalentDampingJson::all(run, &units),
            extinction: extinction(identification),
            half_cycles: identification.half_cycles.iter().map(HalfCycleJson::new).collect(),
            damping_curve: identification.damping_curve.iter().map(CurvePointJson::new).collect(),
            beliefs: identification.beliefs.as_ref().map(BeliefsJson::new),
            resimulation_rmse_deg: identification.resimulation.rmse_rad.to_degrees(),
            inertia_kg_m2: identification.inertia_kg_m2,
            inertia_used_kg_m2: units.inertia_kg_m2(),
            skew: identification.skew.as_ref().map(SkewJson::new),
            forced: identification.forced.as_ref().map(ForcedJson::new),
            chain: identification.chain.as_ref().map(ChainJson::new),
            counts: run.brought.iter().map(ChannelCounts::of).collect(),
            gates: procedure::of_run(campaign, run),
            remarks: &identification.remarks,
        }
    }
}

#[derive(Serialize)]
struct EquivalentDampingJson {
    amplitude_deg: f64,
    value: Estimate,
    local: Option<Estimate>,
    extrapolated: bool,
    moment_n_m_s: Estimate,
    b44_hat: Estimate,
    damping_ratio: Estimate,
    half_cycle_decrement: Estimate,
    bertin_n_per_deg: Estimate,
}

impl EquivalentDampingJson {
    fn all(run: &IdentifiedRun, units: &FieldUnits) -> Vec<Self> {
        let all = &run.identification.equivalent_damping;
        all.iter()
            .map(|at| Self {
                amplitude_deg: at.amplitude_deg,
                value: at.fitted_per_s,
                local: at.local_per_s,
                extrapolated: at.extrapolated,
                moment_n_m_s: units.moment(at.fitted_per_s),
                b44_hat: units.b44_hat(at.fitted_per_s),
                damping_ratio: units.damping_ratio(at.fitted_per_s),
                half_cycle_decrement: units.half_cycle_decrement(at.fitted_per_s),
                bertin_n_per_deg: units.bertin_n_per_deg(at.fitted_per_s, at.amplitude_deg),
            })
            .collect()
    }
}

#[derive(Serialize)]
struct HalfCycleJson {
    time_s: f64,
    amplitude_deg: f64,
    frequency_rad_s: f64,
    value: Estimate,
}

impl HalfCycleJson {
    fn new(half_cycle: &HalfCycle) -> Self {
        Self {
            time_s: half_cycle.time_s,
            amplitude_deg: half_cycle.amplitude_rad.to_degrees(),
            frequency_rad_s: half_cycle.frequency_rad_s,
            value: half_cycle.equivalent_damping_per_s,
        }
    }
}

#[derive(Serialize)]
struct SkewJson {
    sd_s: f64,
    b1_by_per_s2: f64,
    b3_by: f64,
}

impl SkewJson {
    fn new(skew: &Skew) -> Self {
        let Skew { sd_s, b1_by_per_s2, b3_by } = *skew;
        Self { sd_s, b1_by_per_s2, b3_by }
    }
}

#[derive(Serialize)]
struct ForcedJson {
    frequency_rad_s: Estimate,
    roll_amplitude_rad: Estimate,
    moment_amplitude_n_m: Estimate,
    phase_rad: Estimate,
    peak_moment_per_s2: Estimate,
    work_damping_n_m_s: Estimate,
}

impl ForcedJson {
    fn new(forced: &ForcedResponse) -> Self {
        Self {
            frequency_rad_s: forced.frequency_rad_s,
            roll_amplitude_rad: forced.roll_amplitude_rad,
            moment_amplitude_n_m: forced.moment_amplitude_n_m,
            phase_rad: forced.phase_rad,
            peak_moment_per_s2: forced.peak_moment_per_s2,
            work_damping_n_m_s: forced.work_damping_n_m_s,
        }
    }
}

#[derive(Serialize)]
struct ChainJson {
    seed: u64,
    n_sweeps: usize,
    n_burn_in: usize,
    n_chains: usize,
    r_hat_max: f64,
    effective_sample_size_min: f64,
    converged: bool,
}

impl ChainJson {
    fn new(chain: &Chain) -> Self {
        Self {
            seed: chain.seed,
            n_sweeps: chain.n_sweeps,
            n_burn_in: chain.n_burn_in,
            n_chains: chain.n_chains,
            r_hat_max: chain.r_hat_max,
            effective_sample_size_min: chain.effective_sample_size_min,
            converged: chain.converged,
        }
    }
}

#[derive(Serialize)]
struct RejectedJson<'a> {
    recording: &'a str,
    start_s: f64,
    end_s: f64,
    reason: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    run: Option<&'a str>,
}

impl<'a> RejectedJson<'a> {
    fn new(stretch: &'a RejectedStretch) -> Self {
        let RejectedStretch { recording, start_s, end_s, reason, run } = stretch;
        Self { recording, start_s: *start_s, end_s: *end_s, reason, run: run.as_deref() }
    }
}

#[derive(Serialize)]
struct FroudeLawJson<'a> {
    condition: &'a str,
    b0_per_s: Estimate,
    kappa: Estimate,
    b3_s: Estimate,
    scatter_per_s: Estimate,
}

impl<'a> FroudeLawJson<'a> {
    fn new(law: &'a FroudeLaw) -> Self {
        Self {
            condition: &law.condition,
            b0_per_s: law.b0_per_s,
            kappa: law.kappa,
            b3_s: law.b3_s,
            scatter_per_s: law.scatter_per_s,
        }
    }
}

#[derive(Serialize)]
struct NotesJson<'a> {
    recording: &'a str,
    notes: &'a [String],
}

fn method_name(method: Method) -> &'static str {
    match method {
        Method::Exact => "exact",
        Method::PaperMcmc => "paper-mcmc",
    }
}

fn end_name(end: RunEnd) -> &'static str {
    match end {
        RunEnd::LostInNoise => "lost in noise",
        RunEnd::Caught => "caught",
        RunEnd::PassEnded => "pass ended",
        RunEnd::ReStruck => "re-struck",
        RunEnd::ExcitationChanged => "excitation changed",
        RunEnd::Gap => "gap",
        RunEnd::RecordingEnded => "recording ended",
        RunEnd::TooLong => "too long",
    }
}
