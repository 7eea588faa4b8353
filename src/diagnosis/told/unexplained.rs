//! The moment that a model leaves unexplained in each run, with its credible band.
//!
//! METHOD section 5: with the model's own moments on the known side, the posterior that otherwise
//! gives the damping moment gives what the simulation gets wrong. In a decay what is left of the
//! roll is the response to that moment; in a forced run it stands in the moment channel itself.

use crate::diagnosis::fit::run_fit::predict;
use crate::diagnosis::fit::survey::{Fit, Survey};
use crate::diagnosis::record::observation::Observation;
use crate::inverse::record::evened;
use crate::inverse::state_space::damped::Damped;
use crate::inverse::state_space::drifting::Drifting;
use crate::inverse::state_space::posterior::{
    Hyperprior, MomentProblem, Quadrature, StatePosterior,
};
use crate::run::RunKind;

/// What a model leaves of one run's moment, instant by instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Unexplained {
    /// Id of the run.
    pub run: String,
    /// Decay or forced.
    pub kind: RunKind,
    /// Froude number [-].
    pub froude: f64,
    /// Place in the order of runs.
    pub order: usize,
    /// Frequency of rolling [rad/s].
    pub frequency_rad_s: f64,
    /// Instants on the recording's time base [s].
    pub time_s: Vec<f64>,
    /// Roll of the model [rad].
    pub roll_rad: Vec<f64>,
    /// Roll rate of the model [rad/s].
    pub rate_rad_per_s: Vec<f64>,
    /// Roll acceleration of the model [rad/s2].
    pub acceleration_rad_per_s2: Vec<f64>,
    /// Mean of the unexplained moment [N m].
    pub mean_n_m: Vec<f64>,
    /// Its standard deviation [N m].
    pub sd_n_m: Vec<f64>,
    /// Root mean square of the mean over that of the inertia moment in a decay, of the exciting
    /// moment in a forced run [-].
    pub share: f64,
    /// The same over that of the damping moment [-].
    pub share_of_damping: f64,
    /// Share of the instants at which the 95 % band excludes nil [-].
    pub outside: f64,
}

/// Instants kept a period of roll: beyond them the band only repeats itself.
const PER_PERIOD: f64 = 24.0;

impl Unexplained {
    /// Phase of the roll at each instant [rad], nil at a crest to starboard.
    pub fn phase_rad(&self) -> Vec<f64> {
        let w = self.frequency_rad_s;
        let phase = |(roll, rate): (&f64, &f64)| (-rate / w).atan2(*roll);
        self.roll_rad.iter().zip(&self.rate_rad_per_s).map(phase).collect()
    }
}

/// What the fit leaves of every run whose record is long enough.
pub(super) fn unexplained(survey: &Survey, fit: &Fit) -> Vec<Unexplained> {
    survey.each_run(&|run| of(survey, fit, run)).into_iter().flatten().collect()
}

fn of(survey: &Survey, fit: &Fit, run: usize) -> Option<Unexplained> {
    let observation = &survey.runs[run];
    let state = &fit.states[run];
    let predicted = predict(observation, state, &fit.terms(run));
    let n_roll = observation.roll_rad.len();
    let w = observation.at.rolling_rad_s;
    let inertia = observation.at.inertia_kg_m2;
    let motion = Motion::through(&observation.roll_time_s, &predicted[..n_roll]);
    let is_forced = observation.at.kind == RunKind::Forced;
    let (times, left, scale): (&[f64], Vec<f64>, f64) = if is_forced {
        let moment = observation.moment_n_m.iter().zip(&predicted[n_roll..]);
        (&observation.moment_time_s, moment.map(|(m, p)| m - p).collect(), 1.0)
    } else {
        let roll = observation.roll_rad.iter().zip(&predicted[..n_roll]);
        let natural = state.base.natural_rad_s;
        let left = roll.map(|(m, p)| m - p).collect();
        (&observation.roll_time_s, left, inertia * natural * natural)
    };
    if times.len() < 30 {
        return None;
    }
    let posterior = posterior(observation, state.base, times, &left, is_forced);
    // A model that was driven out of the numbers leaves nothing that could be told.
    if posterior.mean.len() != times.len() {
        return None;
    }
    let mut told = Unexplained {
        run: observation.id.clone(),
        kind: observation.at.kind,
        froude: observation.at.froude,
        order: observation.at.order,
        frequency_rad_s: w,
        time_s: Vec::new(),
        roll_rad: Vec::new(),
        rate_rad_per_s: Vec::new(),
        acceleration_rad_per_s2: Vec::new(),
        mean_n_m: Vec::new(),
        sd_n_m: Vec::new(),
        share: 0.0,
        share_of_damping: 0.0,
        outside: 0.0,
    };
    let step_s = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let stride = ((std::f64::consts::TAU / w / PER_PERIOD / step_s) as usize).max(1);
    for i in (0..times.len()).step_by(stride) {
        let [roll, rate, acceleration] = motion.at(times[i]);
        told.time_s.push(observation.origin_s + times[i]);
        told.roll_rad.push(roll);
        told.rate_rad_per_s.push(rate);
        told.acceleration_rad_per_s2.push(acceleration);
        told.mean_n_m.push(scale * posterior.mean[i][2]);
        told.sd_n_m.push(scale * posterior.sd[i][2]);
    }
    let unexplained = rms(told.mean_n_m.iter().copied());
    let whole = if is_forced {
        let n = observation.moment_n_m.len() as f64;
        let mean = observation.moment_n_m.iter().sum::<f64>() / n;
        rms(observation.moment_n_m.iter().map(|m| m - mean))
    } else {
        rms(told.acceleration_rad_per_s2.iter().map(|a| inertia * a))
    };
    let base = state.base;
    let damping = |rate: &f64| inertia * (base.b1_per_s * rate + base.b3_s * rate.powi(3));
    told.share = unexplained / whole;
    told.share_of_damping = unexplained / rms(told.rate_rad_per_s.iter().map(damping));
    let is_outside = |(mean, sd): &(&f64, &f64)| mean.abs() > 1.96 * **sd;
    let n_outside = told.mean_n_m.iter().zip(&told.sd_n_m).filter(is_outside).count();
    told.outside = n_outside as f64 / told.mean_n_m.len() as f64;
    Some(told)
}

/// The posterior whose third component is the unexplained moment: per unit `I w^2` in a decay, as
/// it is in a forced run.
fn posterior(
    observation: &Observation,
    base: crate::model::Base,
    times: &[f64],
    left: &[f64],
    is_forced: bool,
) -> StatePosterior {
    let w = if is_forced { observation.at.rolling_rad_s } else { base.natural_rad_s };
    let tau: Vec<f64> =
        evened(times.iter().map(|t| t - times[0]).collect()).iter().map(|t| w * t).collect();
    if is_forced {
        let prior = |intensity: f64| Drifting { intensity };
        problem(&tau, left, &[0, 1], prior).solve::<2, Drifting>()
    } else {
        // The law's own damping at the size of the roll is no part of what is sought.
        let amplitude_rad = observation.at.amplitude_rad;
        let cubic = 0.75 * base.b3_s * (w * amplitude_rad).powi(2);
        let damping = ((base.b1_per_s + 0.5 * cubic) / w).max(0.0);
        let prior = |walk: f64| Damped { damping, walk, moment_noise: 0.0 };
        problem(&tau, left, &[0, 1, 2], prior).solve::<3, Damped>()
    }
}

fn problem<'a, F>(
    tau: &'a [f64],
    record: &'a [f64],
    free_components: &'a [usize],
    prior: F,
) -> MomentProblem<'a, F> {
    let hyperprior = Hyperprior::ScaleFree { roll_scale_rad: rms(record.iter().copied()) };
    let quadrature = Quadrature::BAND;
    MomentProblem { tau, record, free_components, prior, hyperprior, quadrature }
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (n, square) = values.fold((0.0, 0.0), |(n, s), v| (n + 1.0, s + v * v));
    (square / f64::max(n, 1.0)).sqrt()
}

/// The modelled roll with its derivatives, by parabolas through neighbouring instants.
struct Motion<'a> {
    time_s: &'a [f64],
    roll_rad: &'a [f64],
}

impl<'a> Motion<'a> {
    fn through(time_s: &'a [f64], roll_rad: &'a [f64]) -> Self {
        Self { time_s, roll_rad }
    }

    /// Roll [rad], rate [rad/s] and acceleration [rad/s2] at a time [s].
    fn at(&self, time_s: f64) -> [f64; 3] {
        let after = self.time_s.partition_point(|t| *t < time_s);
        let middle = after.clamp(1, self.time_s.len() - 2);
        let (t, r) =
            (&self.time_s[middle - 1..=middle + 1], &self.roll_rad[middle - 1..=middle + 1]);
        let (first, second) = ((r[1] - r[0]) / (t[1] - t[0]), (r[2] - r[1]) / (t[2] - t[1]));
        let bend = (second - first) / (t[2] - t[0]);
        let from = time_s - t[0];
        let roll = r[0] + first * from + bend * from * (time_s - t[1]);
        [roll, first + bend * (2.0 * time_s - t[0] - t[1]), 2.0 * bend]
    }
}
