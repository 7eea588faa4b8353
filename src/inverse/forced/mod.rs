//! One forced run, from its samples to everything that they say.

pub(super) mod drive;
mod driven;
pub mod harmonic;
mod moment;
pub mod response;
mod skew;
pub mod steady;
mod transient;

use self::drive::Drive;
use self::response::SteadyResponse;
use crate::inverse::Setting;
use crate::inverse::amplitudes::{AMPLITUDES_DEG, is_compared};
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::{
    DampingFit, EquivalentDamping, ForcedResponse, Identification, MomentHistory,
};
use crate::inverse::observed::Observed;
use crate::inverse::plausible;
use crate::inverse::record::Record;
use crate::inverse::state_space::history::{Reference, state_posterior};
use crate::roll::damping::cubic_weight;
use crate::run::{Run, RunKind, Series};

/// Identifies a forced run: from its harmonics where the excitation repeats, else from its course.
pub(super) fn identify(run: &Run, setting: &Setting) -> Result<Identification, String> {
    plausible::drive(run)?;
    if run.excitation_rad_s.is_none() {
        return transient::identify(run, setting);
    }
    let restoring = setting.restoring_n_m_per_rad;
    let response = SteadyResponse::of(run, restoring, setting.exciter.as_ref())?;
    plausible::response(&response, restoring)?;
    let record = Record::new(&Series {
        time_s: run.roll.time_s[response.steady.clone()].to_vec(),
        value: run.roll.value[response.steady.clone()].to_vec(),
    })?;
    let inertia = response.inertia_kg_m2;
    let natural = (restoring / inertia.mean).sqrt();
    let natural_sd = 0.5 * natural * inertia.sd / inertia.mean;
    let drive = Drive::new(&response, &record, run, inertia.mean);
    let driven = drive.response(&record.time_s, natural);
    let tau = record.scaled_time(natural);
    let free: Vec<f64> = record.roll_rad.iter().zip(&driven).map(|(r, d)| r - d[0]).collect();
    let ordered = state_posterior(&tau, &free, drive.noise_intensity(&response, natural));
    let zero = response.roll.mean;
    let reference = Reference {
        natural_frequency_rad_s: natural,
        natural_frequency_sd_rad_s: natural_sd,
        zero_rad: zero,
        zero_sd_rad: response.roll.coefficient_sd,
    };
    let moment = drive.history(&record, &ordered.states, &driven, &reference);
    let start = response.roll.at(record.origin_s - run.start_s);
    let start = (start.value - zero, start.rate);
    let observed = Observed {
        record: &record,
        natural_frequency_rad_s: natural,
        zero_rad: zero,
        start,
        drive: Some(&drive),
    };
    let mut told = observed.tell(moment, setting)?;
    let damping = damping(&response);
    let (from_s, to_s) = response.steady_s(run);
    let mut remarks = vec![
        format!("the evidence favours a moment prior of order {}", ordered.order),
        format!(
            "steady from {from_s:.2} to {to_s:.2} s of the recording, where nothing but the \
             excitation repeats"
        ),
        format!("restoring K = {restoring:.3} N m/rad from displacement and GM, taken as exact"),
    ];
    remarks.append(&mut told.remarks);
    if response.skew.is_none() {
        remarks.push(skew::NOT_STATED.to_owned());
    }
    let forced = forced_response(&response, &told.moment, run);
    skew::widen(&mut told.moment, skew::sd_s(&run.timing), |time_s| {
        response.moment.at(time_s - run.start_s).rate / inertia.mean
    });
    let noise_sd = response.roll.noise_sd;
    Ok(Identification {
        kind: RunKind::Forced,
        method: setting.method,
        natural_frequency_rad_s: Estimate::normal(natural, natural_sd),
        initial_roll_rad: Estimate::normal(start.0, response.roll.coefficient_sd),
        initial_roll_rate_rad_per_s: Estimate::normal(
            start.1,
            response.roll.coefficient_sd * response.roll.frequency_rad_s.mean,
        ),
        roll_offset_rad: Estimate::normal(zero, noise_sd / (run.roll.value.len() as f64).sqrt()),
        roll_noise_rad: Estimate::normal(
            noise_sd,
            noise_sd / (2.0 * run.roll.value.len() as f64).sqrt(),
        ),
        equivalent_damping: equivalent_damping(&response),
        half_cycles: Vec::new(),
        damping_curve: Vec::new(),
        beliefs: None,
        moment: told.moment,
        resimulation: drive.resimulation(&record, &damping, &reference, start),
        inertia_kg_m2: Some(inertia),
        skew: response.skew,
        forced: Some(forced),
        least_squares_per_s2: told.least_squares_per_s2,
        damping,
        chain: told.chain,
        remarks,
    })
}

fn damping(response: &SteadyResponse) -> DampingFit {
    let [b1, b3] = response.damping;
    let c = &response.damping_covariance;
    let (b1_sd, b3_sd) = (c[0][0].sqrt(), c[1][1].sqrt());
    DampingFit {
        b1_per_s: Estimate::normal(b1, b1_sd),
        b3_s: Estimate::normal(b3, b3_sd),
        correlation: c[0][1] / (b1_sd * b3_sd),
    }
}

fn equivalent_damping(response: &SteadyResponse) -> Vec<EquivalentDamping> {
    let w = response.roll.frequency_rad_s.mean;
    let [b1, b3] = response.damping;
    let c = &response.damping_covariance;
    let fitted = |amplitude_rad: f64| {
        let x = cubic_weight(w, amplitude_rad);
        let variance = c[0][0] + 2.0 * x * c[0][1] + x * x * c[1][1];
        Estimate::normal(b1 + x * b3, variance.max(0.0).sqrt())
    };
    let amplitude_rad = response.roll.amplitude();
    let work = response.work_damping_n_m_s.scaled(1.0 / response.inertia_kg_m2.mean);
    let mut all: Vec<EquivalentDamping> = AMPLITUDES_DEG
        .iter()
        .filter(|a| (0.8..=1.25).contains(&(a.to_radians() / amplitude_rad)) || is_compared(**a))
        .map(|&amplitude_deg| EquivalentDamping {
            amplitude_deg,
            fitted_per_s: fitted(amplitude_deg.to_radians()),
            // The work is known at the run's own amplitude alone.
            local_per_s: ((amplitude_deg.to_radians() / amplitude_rad - 1.0).abs() < 0.02)
                .then_some(work),
            extrapolated: amplitude_deg.to_radians() > 1.02 * amplitude_rad,
        })
        .collect();
    all.sort_by(|a, b| a.amplitude_deg.total_cmp(&b.amplitude_deg));
    all
}

fn forced_response(response: &SteadyResponse, moment: &MomentHistory, run: &Run) -> ForcedResponse {
    let share = response.roll.coefficient_sd;
    ForcedResponse {
        frequency_rad_s: response.roll.frequency_rad_s,
        roll_amplitude_rad: Estimate::normal(response.roll.amplitude(), share),
        moment_amplitude_n_m: Estimate::normal(
            response.moment.amplitude(),
            response.moment.coefficient_sd,
        ),
        phase_rad: response.phase_rad(),
        peak_moment_per_s2: peak(moment, response),
        work_damping_n_m_s: response.work_damping_n_m_s,
        moment_time_s: response.moment_time_s.iter().map(|t| run.start_s + t).collect(),
        moment_n_m: response.moment_n_m.clone(),
    }
}

/// Mean of the largest `|U|` of each cycle, with the standard error over cycles, and what the time
/// between roll and moment does to all of them.
fn peak(moment: &MomentHistory, response: &SteadyResponse) -> Estimate {
    let frequency_rad_s = response.roll.frequency_rad_s.mean;
    let start_s = moment.time_s[0];
    let period_s = std::f64::consts::TAU / frequency_rad_s;
    let mut peaks: Vec<(f64, f64)> = Vec::new();
    for ((time_s, mean), sd) in moment.time_s.iter().zip(&moment.mean_per_s2).zip(&moment.sd_per_s2)
    {
        let cycle = ((time_s - start_s) / period_s) as usize;
        peaks.resize(peaks.len().max(cycle + 1), (0.0, 0.0));
        if mean.abs() > peaks[cycle].0 {
            peaks[cycle] = (mean.abs(), *sd);
        }
    }
    // The last cycle is cut short.
    if peaks.len() > 1 {
        peaks.pop();
    }
    let n = peaks.len() as f64;
    let mean = peaks.iter().map(|p| p.0).sum::<f64>() / n;
    let scatter = peaks.iter().map(|p| (p.0 - mean).powi(2)).sum::<f64>() / n;
    let band = peaks.iter().map(|p| p.1.powi(2)).sum::<f64>() / n;
    let amplitude_rad = response.roll.amplitude();
    let weight = cubic_weight(frequency_rad_s, amplitude_rad);
    let skewed = response.skew.map_or(0.0, |skew| skew.damping_sd_per_s(weight));
    let skewed_per_s2 = skewed * frequency_rad_s * amplitude_rad;
    Estimate::normal(mean, (scatter.max(band) / n).sqrt().hypot(skewed_per_s2))
}
