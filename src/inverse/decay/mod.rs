//! One decay, from its samples to everything that they say.

pub mod fit;
pub mod half_cycles;
mod law;
mod misfit;
mod start;

use self::fit::{DecayPosterior, K3, N_UNKNOWNS, OFFSET};
use self::half_cycles::Restoring;
use self::law::{Law, equivalent_damping};
use self::start::first_guess;
use crate::inverse::Setting;
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::{DampingFit, Identification, MomentHistory, Resimulation};
use crate::inverse::mixture;
use crate::inverse::observed::Observed;
use crate::inverse::record::Record;
use crate::inverse::state_space::history::{Reference, state_posterior};
use crate::run::{Run, RunKind};

/// Identifies a decay.
pub(super) fn identify(run: &Run, setting: &Setting) -> Result<Identification, String> {
    let record = Record::new(&run.roll)?;
    let (start, offset_rad) = first_guess(&record, run);
    let fit = fit::fit(&record, start, offset_rad)?;
    let unknown = |position| mixture::estimate(&fit.unknown(position));
    let frequency = unknown(2);
    let zero = unknown(OFFSET);
    let tau = record.scaled_time(frequency.mean);
    let ordered = state_posterior(&tau, &record.roll_rad, 0.0);
    let restoring = Restoring {
        natural_frequency_rad_s: frequency.mean,
        cubic_per_rad2: unknown(K3).mean,
        zero_rad: zero.mean,
    };
    let cycles =
        half_cycles::half_cycles(record.origin_s, &record.time_s, &ordered.states, &restoring);
    if cycles.len() < 3 {
        return Err(format!("{} half cycles stand clear of the noise, 3 are needed", cycles.len()));
    }
    let law = Law::new(&fit, &cycles);
    let reference = Reference {
        natural_frequency_rad_s: frequency.mean,
        natural_frequency_sd_rad_s: frequency.sd,
        zero_rad: zero.mean,
        zero_sd_rad: zero.sd,
    };
    let initial = (unknown(0), unknown(1));
    let observed = Observed {
        record: &record,
        natural_frequency_rad_s: frequency.mean,
        zero_rad: zero.mean,
        start: (initial.0.mean, initial.1.mean),
        drive: None,
    };
    let moment = MomentHistory::of_decay(&record, &ordered.states, &reference);
    let mut told = observed.tell(moment, setting)?;
    let mut remarks = remarks(&fit, ordered.order, &law);
    remarks.append(&mut told.remarks);
    // The paper fits its law to its own scatter of moments.
    let damping = told.scatter_fit.unwrap_or_else(|| law.damping());
    let equivalent = |cubic_weight: f64| match told.scatter_fit {
        Some(fit) => fit.combination(1.0, cubic_weight),
        None => law.combination(1.0, cubic_weight),
    };
    let largest_rad = told.moment.roll_rad.iter().map(|roll| roll.abs()).fold(0.0, f64::max);
    let b3_s = damping.b3_s.mean;
    let equivalent_damping =
        equivalent_damping(equivalent, b3_s, &cycles, largest_rad, frequency.mean);
    Ok(Identification {
        kind: RunKind::Decay,
        method: setting.method,
        natural_frequency_rad_s: frequency,
        initial_roll_rad: initial.0,
        initial_roll_rate_rad_per_s: initial.1,
        roll_offset_rad: zero,
        roll_noise_rad: Estimate::normal(
            ordered.states.noise_sd_rad,
            ordered.states.noise_sd_rad / (2.0 * record.roll_rad.len() as f64).sqrt(),
        ),
        damping,
        equivalent_damping,
        half_cycles: cycles,
        moment: told.moment,
        resimulation: resimulation(&record, &fit, told.scatter_fit.as_ref()),
        inertia_kg_m2: None,
        forced: None,
        least_squares_per_s2: told.least_squares_per_s2,
        chain: told.chain,
        remarks,
    })
}

/// The run simulated with linear restoring and its law, as in the paper's Fig. 13.
///
/// The law is that of least squares, or that of the chain's scatter where there is one.
fn resimulation(
    record: &Record,
    fit: &DecayPosterior,
    scatter_fit: Option<&DampingFit>,
) -> Resimulation {
    let (mut decay, offset_rad) = fit.linear;
    if let Some(law) = scatter_fit {
        (decay.b1_per_s, decay.b3_s) = (law.b1_per_s.mean, law.b3_s.mean);
    }
    let motion = decay.solve(&record.time_s);
    record.resimulation(motion.iter().map(|m| m.roll_rad + offset_rad).collect())
}

fn remarks(fit: &DecayPosterior, order: usize, law: &Law<'_>) -> Vec<String> {
    let mut remarks = vec![format!("the evidence favours a moment prior of order {order}")];
    let cubic = fit.probability_of_cubic_restoring();
    let k3 = mixture::estimate(&fit.unknown(K3));
    let rms_deg = |residual: &[f64]| {
        let square: f64 = residual.iter().map(|r| r * r).sum();
        (square / residual.len() as f64).sqrt().to_degrees()
    };
    if cubic > 0.95 {
        let mut weights = [0.0; N_UNKNOWNS];
        weights[2] = 1.0;
        let small = mixture::estimate(&fit.combination(&weights)).mean;
        let at_ten = small * (1.0 + 0.375 * k3.mean * 10_f64.to_radians().powi(2));
        let best = fit.solutions.iter().find(|s| s.cubic_restoring);
        let left = best.map_or(0.0, |s| rms_deg(&s.residual_rad));
        remarks.push(format!(
            "linear restoring does not capture that the frequency changes with amplitude, from \
             {small:.3} rad/s at small angles to {at_ten:.3} rad/s at 10 deg: a restoring moment \
             K (phi + k3 phi^3) with k3 = {:.2} [{:.2}, {:.2}] 1/rad2 leaves {left:.3} deg rms",
            k3.mean, k3.lo95, k3.hi95
        ));
    }
    let misfit: f64 = fit.solutions.iter().map(|s| s.weight * s.probability_of_misfit).sum();
    if misfit > 0.5 {
        let (b1_per_s, b3_s) = law.misfit_sd();
        remarks.push(format!(
            "b1 phi' + b3 phi'^3 leaves more than noise; the half cycles' scatter about it widens \
             the standard deviations of b1 and b3 by {b1_per_s:.4} 1/s and {b3_s:.4} s"
        ));
    }
    remarks
}
