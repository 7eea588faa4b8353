//! One run as the diagnosis sees it: thinned records, circumstances, and where a fit starts.

use super::clipping::middle;
use super::facts;
use super::noise;
use super::repeating;
use super::wavering::Wavering;
use crate::campaign::Campaign;
use crate::inverse::forced::response::SteadyResponse;
use crate::inverse::record::Record;
use crate::model::course::{N_COURSE, N_HARMONICS};
use crate::model::lead::Lead;
use crate::model::{Base, Circumstances, Facts};
use crate::results::IdentifiedRun;
use crate::roll::cross_modes::Section;
use crate::run::{Run, RunKind, Series};

/// A run ready to be fitted.
#[derive(Debug, Clone)]
pub struct Observation {
    /// Id of the run in its campaign.
    pub id: String,
    /// Loading or appendage condition.
    pub condition: String,
    /// Where and when.
    pub at: Circumstances,
    /// What the record shows without a model.
    pub facts: Facts,
    /// Instant of time zero on the recording's time base [s]; that of a decay's release.
    pub origin_s: f64,
    /// Times of the roll [s].
    pub roll_time_s: Vec<f64>,
    /// Roll as read [rad].
    pub roll_rad: Vec<f64>,
    /// Times of the moment [s]; empty when none was recorded.
    pub moment_time_s: Vec<f64>,
    /// Moment as read [N m].
    pub moment_n_m: Vec<f64>,
    /// Roll before its time zero.
    pub lead: Lead,
    /// How the carriage left its speed; none where it kept it.
    pub wavering: Option<Wavering>,
    /// Noise of one value of each channel, from neighbouring values [rad, N m].
    pub rough_noise: [f64; 2],
    /// How far off the times of the roll may be, and the time between it and the moment, where that
    /// is stated [s].
    pub clock_bounds_s: [Option<f64>; 2],
    /// What the fit of this run starts from: initial roll and rate, or the imposed course; then
    /// the run's own zero offset.
    pub start: Vec<f64>,
    /// Base equation to start from.
    pub base: Base,
}

/// Values of the moment channel a period.
const MOMENTS_PER_PERIOD: f64 = 80.0;

impl Observation {
    /// Prepares a run of a campaign.
    ///
    /// # Errors
    /// The reason, as a sentence, why the run takes no part.
    pub fn new(run: &IdentifiedRun, campaign: &Campaign, order: usize) -> Result<Self, String> {
        if let Some(repeating) = repeating::with_frequency(&run.run) {
            return Self::forced(&IdentifiedRun { run: repeating, ..run.clone() }, campaign, order);
        }
        match run.run.kind {
            RunKind::Decay => Self::decay(run, campaign, order),
            RunKind::Forced => Self::forced(run, campaign, order),
        }
    }

    /// What it holds sample by sample: all that makes it large.
    pub fn series_mut(&mut self) -> [&mut Vec<f64>; 4] {
        [&mut self.roll_time_s, &mut self.roll_rad, &mut self.moment_time_s, &mut self.moment_n_m]
    }

    fn decay(run: &IdentifiedRun, campaign: &Campaign, order: usize) -> Result<Self, String> {
        let mut record = Record::new(&run.run.roll)?;
        let known = &run.identification;
        let rolling_rad_s = known.natural_frequency_rad_s.mean;
        let (roll, rate) =
            (known.initial_roll_rad.mean, known.initial_roll_rate_rad_per_s.mean / rolling_rad_s);
        // The record begins when the model is surely free; what remembers began at the release.
        let since_s = (-rate * roll.signum()).max(0.0).atan2(roll.abs()) / rolling_rad_s;
        record.origin_s -= since_s;
        record.time_s.iter_mut().for_each(|t| *t += since_s);
        let heel_rad = if since_s > 0.0 { roll.signum() * roll.hypot(rate) } else { roll };
        let rate_rad_per_s = if since_s > 0.0 { 0.0 } else { rate * rolling_rad_s };
        let start = vec![heel_rad, rate_rad_per_s, 0.0];
        let moment = moment(&run.run, campaign, record.origin_s, record.rough_frequency_rad_s);
        Ok(Self::assemble(run, campaign, order, &record, moment, start, rolling_rad_s))
    }

    fn forced(run: &IdentifiedRun, campaign: &Campaign, order: usize) -> Result<Self, String> {
        let restoring = campaign.hull.restoring_n_m_per_rad(&campaign.water);
        let response = SteadyResponse::of(&run.run, restoring, campaign.exciter.as_ref())?;
        let steady = response.steady.clone();
        let record = Record::new(&Series {
            time_s: run.run.roll.time_s[steady.clone()].to_vec(),
            value: run.run.roll.value[steady].to_vec(),
        })?;
        let w = response.roll.frequency_rad_s.mean;
        let shift_s = record.origin_s - run.run.start_s;
        let mut start = vec![0.0; N_COURSE + 1];
        start[0] = response.roll.mean;
        for h in 0..N_HARMONICS.min(response.roll.pairs.len()) {
            let (a, b) = response.roll.pairs[h];
            let (sin, cos) = ((h + 1) as f64 * w * shift_s).sin_cos();
            start[1 + 2 * h] = a * cos + b * sin;
            start[2 + 2 * h] = b * cos - a * sin;
        }
        start[N_COURSE - 1] = w;
        let last_s = record.origin_s + record.span_s();
        let all = moment(&run.run, campaign, record.origin_s, w);
        let inside = |t: &f64| *t >= 0.0 && *t <= last_s - record.origin_s;
        let (time_s, value) = all
            .time_s
            .iter()
            .zip(&all.value)
            .filter(|(t, _)| inside(t))
            .map(|(t, v)| (*t, *v))
            .unzip();
        let moment = Series { time_s, value };
        if moment.time_s.len() < 30 {
            return Err("its moment has fewer than 30 values while it is steady".to_owned());
        }
        Ok(Self::assemble(run, campaign, order, &record, moment, start, w))
    }

    fn assemble(
        run: &IdentifiedRun,
        campaign: &Campaign,
        order: usize,
        record: &Record,
        moment: Series,
        start: Vec<f64>,
        rolling_rad_s: f64,
    ) -> Self {
        let known = &run.identification;
        let w = known.natural_frequency_rad_s.mean;
        let b1_per_s = known.damping.b1_per_s.mean.max(2e-4 * w);
        let mean = record.roll_rad.iter().sum::<f64>() / record.roll_rad.len() as f64;
        let amplitude_rad = record.roll_rad.iter().map(|r| (r - mean).abs()).fold(0.0, f64::max);
        let noise_rad = noise::rough_noise(&record.roll_rad);
        let n = run.run.roll.time_s.len();
        let sample_rate_hz = (n - 1) as f64 / (run.run.roll.time_s[n - 1] - run.run.roll.time_s[0]);
        let width_m = campaign.tank.width_m;
        let at = Circumstances {
            kind: run.run.kind,
            froude: run.froude,
            speed_m_s: run.speed_m_s.abs(),
            natural_rad_s: w,
            b1_per_s,
            inertia_kg_m2: campaign.hull.inertia_kg_m2(&campaign.water, w),
            amplitude_rad,
            rolling_rad_s,
            span_s: record.span_s(),
            gravity_m_s2: campaign.water.gravity_m_s2,
            clear_width_m: width_m.map(|width_m| width_m - campaign.hull.beam_m),
            section: width_m.map(|width_m| Section { width_m, depth_m: campaign.tank.depth_m }),
            sample_rate_hz,
            order,
            has_moment: !moment.time_s.is_empty(),
            n_runs: 1,
            initial_roll_rad: start[0],
            rolled_for_s: rolled_for_s(&run.run, record.origin_s, rolling_rad_s),
            since_rest_s: run.run.still.map_or(0.0, |still| record.origin_s - still.end_s),
        };
        let moment_noise =
            if moment.value.is_empty() { 1.0 } else { noise::rough_noise(&moment.value) };
        let quantum_rad = record.quantum_rad;
        let facts = facts::of(&run.run.lead, &run.run.roll, quantum_rad, rolling_rad_s, run.froude);
        let lead = lead(&run.run, record, rolling_rad_s);
        Self {
            id: run.id.clone(),
            condition: run.condition.clone(),
            facts,
            at,
            lead,
            wavering: Wavering::of(&run.run.speed, run.froude),
            origin_s: record.origin_s,
            roll_time_s: record.time_s.clone(),
            roll_rad: record.roll_rad.clone(),
            moment_time_s: moment.time_s,
            moment_n_m: moment.value,
            rough_noise: [noise_rad, moment_noise],
            clock_bounds_s: [run.run.timing.roll_bound_s, run.run.timing.skew_bound_s()],
            start,
            base: Base {
                natural_rad_s: w,
                b1_per_s,
                b3_s: known.damping.b3_s.mean,
                log_scale: 0.0,
            },
        }
    }

    /// Half of the range of its roll, wherever its middle is [rad].
    pub(in crate::diagnosis) fn half_range_rad(&self) -> f64 {
        let high = self.roll_rad.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let low = self.roll_rad.iter().copied().fold(f64::INFINITY, f64::min);
        0.5 * (high - low)
    }

    /// Whether its crests seem cut off below what another run of the channel reads.
    pub(in crate::diagnosis) fn is_below(&self, largest_rad: f64) -> bool {
        self.facts.clip.is_some_and(|clip| largest_rad > 1.02 * clip.level_rad)
    }

    /// Lets go of readings at the end of the channel's range, which are none of the roll, unless
    /// another run read beyond: then it was no end. Whether enough is left: a channel that reads
    /// its end most of the time leaves no run to speak of.
    pub(in crate::diagnosis) fn read_within(&mut self, largest_rad: f64) -> bool {
        let Some(clip) = self.facts.clip else { return true };
        tracing::debug!(run = self.id, level = clip.level_rad, largest_rad, "clipped");
        if self.is_below(largest_rad) {
            self.facts.clip = None;
            return true;
        }
        let mean_rad = middle(&self.roll_rad);
        let end_rad = clip.level_rad - 3.0 * self.rough_noise[0];
        let is_read = |r: &f64| (r - mean_rad).abs() < end_rad;
        // A value beside one at the end is the mean of some readings there too.
        let n = self.roll_rad.len();
        let beside = |i: usize| &self.roll_rad[i.saturating_sub(1)..(i + 2).min(n)];
        let kept: Vec<usize> = (0..n).filter(|i| beside(*i).iter().all(is_read)).collect();
        let of = |values: &[f64]| kept.iter().map(|i| values[*i]).collect::<Vec<f64>>();
        let within = (of(&self.roll_time_s), of(&self.roll_rad));
        let is_enough = 2 * within.0.len() > self.roll_rad.len();
        (self.roll_time_s, self.roll_rad) = within;
        is_enough
    }

    /// The first periods of a decay; the whole of another run.
    #[must_use]
    pub(in crate::diagnosis) fn first_periods(mut self, n_periods: f64) -> Self {
        let most_s = n_periods * std::f64::consts::TAU / self.at.rolling_rad_s;
        if self.at.kind == RunKind::Decay && self.at.span_s > most_s {
            let until = |times: &[f64]| times.partition_point(|t| *t <= most_s);
            let (n_roll, n_moment) = (until(&self.roll_time_s), until(&self.moment_time_s));
            self.roll_time_s.truncate(n_roll);
            self.roll_rad.truncate(n_roll);
            self.moment_time_s.truncate(n_moment);
            self.moment_n_m.truncate(n_moment);
            self.at.span_s = most_s;
        }
        self
    }
}

/// The roll before time zero of a record: the last readings of it may lie in the run itself, which
/// begins when the model is surely free. A rod does not let go, and what follows belongs to it.
fn lead(run: &Run, record: &Record, rolling_rad_s: f64) -> Lead {
    let all = [&run.lead, &run.roll];
    let times = all.iter().flat_map(|series| &series.time_s).map(|t| t - record.origin_s);
    let readings = all.iter().flat_map(|series| &series.value);
    let until_s = if run.kind == RunKind::Forced { f64::INFINITY } else { 0.0 };
    let before = times.zip(readings).take_while(|(t, _)| *t <= until_s);
    let (time_s, roll_rad): (Vec<f64>, Vec<f64>) = before.unzip();
    Lead::new(&time_s, &roll_rad, rolling_rad_s)
}

/// Longest time from rest to a settled roll [periods] in which nothing but the rod's start went on;
/// by judgement.
const START_PERIODS: f64 = 5.0;

/// For how long a rod had rolled the model at `origin_s` [s]: it reached half of its amplitude
/// midway between the model's rest and the settled roll.
fn rolled_for_s(run: &Run, origin_s: f64, rolling_rad_s: f64) -> f64 {
    let most_s = START_PERIODS * std::f64::consts::TAU / rolling_rad_s;
    let rest = run.still.filter(|still| run.start_s - still.end_s < most_s);
    rest.map_or(f64::INFINITY, |still| origin_s - 0.5 * (still.end_s + run.start_s))
}

/// The moment channel as it reads, without any zero taken out, thinned by averaging.
fn moment(run: &Run, campaign: &Campaign, origin_s: f64, rolling_rad_s: f64) -> Series {
    let drive = &run.drive;
    let n = drive.time_s.len();
    if n < 30 {
        return Series::default();
    }
    let rate_hz = (n - 1) as f64 / (drive.time_s[n - 1] - drive.time_s[0]);
    let wanted_hz = MOMENTS_PER_PERIOD * rolling_rad_s / std::f64::consts::TAU;
    let width = ((rate_hz / wanted_hz) as usize).max(1);
    let mut thinned = Series::default();
    for (times, values) in drive.time_s.chunks_exact(width).zip(drive.value.chunks_exact(width)) {
        let count = width as f64;
        let time_s = times.iter().sum::<f64>() / count;
        let force = values.iter().sum::<f64>() / count;
        let value = campaign
            .exciter
            .as_ref()
            .map_or(force, |exciter| exciter.moment_n_m(force, roll_at(&run.roll, time_s)));
        thinned.time_s.push(time_s - origin_s);
        thinned.value.push(value);
    }
    thinned
}

fn roll_at(roll: &Series, time_s: f64) -> f64 {
    let after = roll.time_s.partition_point(|t| *t < time_s).clamp(1, roll.time_s.len() - 1);
    let (t0, t1) = (roll.time_s[after - 1], roll.time_s[after]);
    let share = if t1 > t0 { ((time_s - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { 1.0 };
    roll.value[after - 1] + share * (roll.value[after] - roll.value[after - 1])
}
