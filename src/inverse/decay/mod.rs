//! One decay, from its samples to everything that they say.

mod beliefs;
pub mod curve;
pub mod disturbance;
pub mod draw;
pub mod equivalent;
pub mod fit;
pub mod form;
pub mod half_cycles;
pub mod moment;
pub mod posterior;
mod remarks;
mod search;
pub mod solution;
mod start;

use self::disturbance::Columns;
use self::equivalent::equivalent_damping;
use self::fit::{CUBIC_RESTORING, FREQUENCY, Linearised, Point, RATE, ROLL, ZERO, settle};
use self::form::{CUBIC, FORMS};
use self::half_cycles::Restoring;
use self::moment::MotionPosterior;
use self::posterior::DecayPosterior;
use self::start::first_guess;
use crate::inverse::Setting;
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::{
    DampingFit, HalfCycle, Identification, Method, MomentHistory, Resimulation,
};
use crate::inverse::mixture;
use crate::inverse::observed::Observed;
use crate::inverse::plausible;
use crate::inverse::record::Record;
use crate::run::{Run, RunKind};

/// Samples per roll period that the posterior is computed from; a mean over more of them is as
/// good as they are, for what it does to the roll is part of the model.
const SAMPLES_PER_PERIOD: f64 = 20.0;

/// A decay with its posterior.
pub struct Solved {
    /// The roll as it is shown.
    pub record: Record,
    /// The roll as the posterior sees it.
    pub thinned: Record,
    /// The least-squares decay with linear restoring, on the thinned record.
    pub linear: Point,
    /// The posterior.
    pub posterior: DecayPosterior,
}

impl Solved {
    /// Marginal posterior of one unknown.
    pub fn unknown(&self, position: usize) -> Estimate {
        mixture::estimate(&self.posterior.unknown(position))
    }

    /// The half cycles of a motion of this decay, in order of time.
    pub fn half_cycles(&self, motion: &MotionPosterior) -> Vec<HalfCycle> {
        let restoring = Restoring {
            natural_frequency_rad_s: self.unknown(FREQUENCY).mean,
            cubic_per_rad2: self.unknown(CUBIC_RESTORING).mean,
        };
        let Record { origin_s, time_s, .. } = &self.thinned;
        half_cycles::half_cycles(*origin_s, time_s, motion, &restoring)
    }
}

/// Solves the inverse problem of a decay.
///
/// # Errors
/// The reason, as a sentence with its values, why the decay cannot be identified.
pub fn solve(run: &Run) -> Result<Solved, String> {
    let record = Record::new(&run.roll)?;
    plausible::resolution(run, record.quantum_rad)?;
    let thinned = record.per_period(SAMPLES_PER_PERIOD);
    let cubic = FORMS[CUBIC].powers();
    let linear = settle(&thinned, first_guess(&thinned, run), cubic, false)?;
    let best = settle(&thinned, linear, cubic, true)?;
    let mut posterior = posterior(&thinned, best);
    // A law of another form is linearised where it fits best itself.
    let favoured = posterior.solutions[0].form;
    if favoured != CUBIC {
        let best = settle(&thinned, best, FORMS[favoured].powers(), true)?;
        posterior = self::posterior(&thinned, best);
    }
    Ok(Solved { record, thinned, linear, posterior })
}

/// The posterior about a least-squares point.
fn posterior(record: &Record, point: Point) -> DecayPosterior {
    let linearised = Linearised::new(record, point);
    let columns = Columns::new(record, &linearised);
    let quantum_rad = record.quantum_rad.unwrap_or(0.0);
    let floor_rad2 = quantum_rad * quantum_rad / (12.0 * record.n_averaged as f64);
    DecayPosterior::new(linearised, columns, floor_rad2)
}

/// Identifies a decay.
pub(super) fn identify(run: &Run, setting: &Setting) -> Result<Identification, String> {
    let solved = solve(run)?;
    let Solved { record, thinned, linear, posterior } = &solved;
    let (frequency, zero) = (solved.unknown(FREQUENCY), solved.unknown(ZERO));
    let initial = (solved.unknown(ROLL), solved.unknown(RATE));
    let motion = moment::motion(posterior);
    let cycles = solved.half_cycles(&motion);
    if cycles.len() < 3 {
        return Err(format!("{} half cycles stand clear of the noise, 3 are needed", cycles.len()));
    }
    let observed = |record| Observed {
        record,
        natural_frequency_rad_s: frequency.mean,
        zero_rad: zero.mean,
        start: (initial.0.mean, initial.1.mean),
        drive: None,
    };
    let exact = history(thinned, &motion);
    let mut told = match setting.method {
        Method::Exact => observed(thinned).tell(exact, setting)?,
        Method::PaperMcmc => observed(record).tell(exact, setting)?,
    };
    let mut remarks = remarks::remarks(posterior);
    remarks.append(&mut told.remarks);
    // The paper fits its law to its own scatter of moments.
    let damping = told.scatter_fit.unwrap_or_else(|| damping(posterior));
    let scatter_fit = told.scatter_fit.as_ref();
    let b3_s = damping.b3_s.mean;
    Ok(Identification {
        kind: RunKind::Decay,
        method: setting.method,
        natural_frequency_rad_s: frequency,
        initial_roll_rad: initial.0,
        initial_roll_rate_rad_per_s: initial.1,
        roll_offset_rad: zero,
        roll_noise_rad: noise(posterior, thinned),
        damping,
        equivalent_damping: equivalent_damping(
            posterior,
            scatter_fit,
            frequency.mean,
            b3_s,
            &cycles,
        ),
        half_cycles: cycles,
        damping_curve: beliefs::damping_curve(posterior),
        beliefs: Some(beliefs::beliefs(posterior, thinned)),
        moment: told.moment,
        resimulation: resimulation(record, thinned, linear, scatter_fit),
        inertia_kg_m2: None,
        skew: None,
        forced: None,
        least_squares_per_s2: told.least_squares_per_s2,
        chain: told.chain,
        remarks,
    })
}

/// The two coefficients of the law of Sec. 4.1.
fn damping(posterior: &DecayPosterior) -> DampingFit {
    let combination = |a: f64, c: f64| mixture::estimate(&posterior.cubic_law(a, c));
    let (b1_per_s, b3_s) = (combination(1.0, 0.0), combination(0.0, 1.0));
    // Scaled to unit deviations, the variance of the sum is 2 + 2 correlation.
    let sum = combination(b1_per_s.sd.recip(), b3_s.sd.recip());
    let correlation = (0.5 * sum.sd.powi(2) - 1.0).clamp(-1.0, 1.0);
    DampingFit { b1_per_s, b3_s, correlation }
}

/// Standard deviation of the noise of one recorded sample [rad].
fn noise(posterior: &DecayPosterior, record: &Record) -> Estimate {
    let averaged = (record.n_averaged as f64).sqrt();
    let components: Vec<_> = posterior
        .solutions
        .iter()
        .map(|w| {
            let mean = w.solution.noise_variance_rad2().sqrt() * averaged;
            let sd = mean / (4.0 * w.solution.shape).sqrt();
            mixture::Component { weight: w.weight(), mean, sd }
        })
        .collect();
    mixture::estimate(&components)
}

/// The moment history of a decay with the motion beside it.
fn history(record: &Record, motion: &MotionPosterior) -> MomentHistory {
    let mut history = MomentHistory {
        time_s: record.time_s.iter().map(|t| record.origin_s + t).collect(),
        ..MomentHistory::default()
    };
    for (mean, sd) in motion.mean.iter().zip(&motion.sd) {
        let band = Estimate::normal(mean[2], sd[2]);
        history.roll_rad.push(mean[0]);
        history.roll_rate_rad_per_s.push(mean[1]);
        history.mean_per_s2.push(band.mean);
        history.sd_per_s2.push(band.sd);
        history.lo95_per_s2.push(band.lo95);
        history.hi95_per_s2.push(band.hi95);
    }
    history
}

/// The run simulated with linear restoring and its law, as in the paper's Fig. 13.
///
/// The law is that of least squares, or that of the chain's scatter where there is one.
fn resimulation(
    record: &Record,
    thinned: &Record,
    linear: &Point,
    scatter_fit: Option<&DampingFit>,
) -> Resimulation {
    let mut decay = linear.decay;
    if let Some(law) = scatter_fit {
        (decay.b1_per_s, decay.b3_s) = (law.b1_per_s.mean, law.b3_s.mean);
    }
    // The thinned record starts in the middle of its first block.
    let later_s = thinned.origin_s - record.origin_s;
    let time_s: Vec<f64> = record.time_s.iter().map(|t| t - later_s).collect();
    let motion = decay.motion(&time_s);
    record.resimulation(motion.iter().map(|m| m.roll_rad + linear.zero_rad).collect())
}
