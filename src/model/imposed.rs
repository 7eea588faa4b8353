//! A forced run simulated: the rod imposes a periodic course, and the moment follows from it.

use super::channel;
use super::course::Course;
use super::echo::{CourseEcho, Echo};
use super::effect::{Acts, Circumstances, Instant, MOST_LAGS};
use super::lagging::follow;
use super::lead::Lead;
use super::linear::between;
use super::term::{Base, Term};

/// Periods before the record over which effects that remember settle where nobody knows how the
/// model rolled then.
const PERIODS_BEFORE: f64 = 30.0;
const STEPS_PER_PERIOD: f64 = 96.0;
/// Points of some three thousand periods, more than any run has.
const MOST_POINTS: f64 = 3e5;
/// Points that a parabola needs.
const LEAST_POINTS: f64 = 3.0;

/// One forced run: its equation, its course, and when its channels are read.
#[derive(Debug, Clone, Copy)]
pub struct Imposed<'a> {
    /// The run.
    pub run: &'a Circumstances,
    /// Base equation.
    pub base: &'a Base,
    /// Effects that extend it.
    pub terms: &'a [Term],
    /// The course of the roll.
    pub course: &'a Course,
    /// The roll before the record.
    pub lead: &'a Lead,
    /// Times of the roll and of the moment [s].
    pub time_s: [&'a [f64]; 2],
}

/// Points a step apart, from the start, or well before it, to the last reading.
pub(super) struct Points {
    pub(super) from_s: f64,
    pub(super) step_s: f64,
    pub(super) n: usize,
}

impl Points {
    /// Times of the points [s].
    pub(super) fn times_s(&self) -> impl Iterator<Item = f64> {
        (0..self.n).map(|point| self.from_s + self.step_s * point as f64)
    }

    /// Where a time lies between the points.
    pub(super) fn place(&self, time_s: f64) -> f64 {
        (time_s - self.from_s) / self.step_s
    }
}

/// What the terms keep of the course.
pub(super) struct Remembered {
    pub(super) points: Points,
    /// States of every term that remembers, at every point.
    pub(super) states: Vec<Vec<[f64; MOST_LAGS]>>,
    /// The echo of every term that is one.
    pub(super) echoes: Vec<CourseEcho>,
}

impl<'a> Imposed<'a> {
    /// What both channels read: roll [rad], then moment [N m].
    pub fn readings(&self) -> Vec<f64> {
        let remembered = self.remembered();
        let is_through = channel::is_read_through(self.terms, 0);
        let seen = if is_through { self.instants(0, &remembered) } else { Vec::new() };
        let roll = self.time_s[0].iter().map(|t| self.course.at(*t)[0]).collect();
        self.read(roll, [&seen, &self.instants(1, &remembered)])
    }

    /// The readings of a roll, and of what the channels see; that of the roll channel may lack
    /// where no effect looks at it.
    pub(super) fn read(&self, roll: Vec<f64>, [seen, moment]: [&[Instant<'_>]; 2]) -> Vec<f64> {
        let mut readings = roll;
        channel::add(self.terms, 0, seen, &mut readings);
        let mut moments: Vec<f64> = moment.iter().map(|i| i.moment_n_m).collect();
        channel::add(self.terms, 1, moment, &mut moments);
        readings.extend(moments);
        readings
    }

    /// The motion at a time, its moment nil.
    pub(super) fn instant(&self, time_s: f64, motion: [f64; 3]) -> Instant<'a> {
        let [roll_rad, rate_rad_per_s, acceleration_rad_per_s2] = motion;
        Instant {
            time_s,
            roll_rad,
            rate_rad_per_s,
            acceleration_rad_per_s2,
            moment_n_m: 0.0,
            natural_rad_s: self.base.natural_rad_s,
            b1_per_s: self.base.b1_per_s,
            run: self.run,
        }
    }

    /// Moment of a unit of angular acceleration [kg m2], scale included.
    pub(super) fn scale(&self) -> f64 {
        let ratio = self.run.natural_rad_s / self.base.natural_rad_s;
        self.base.log_scale.exp() * self.run.inertia_kg_m2 * ratio.powi(2)
    }

    /// Where effects that remember are followed.
    fn points(&self) -> Points {
        let period_s = std::f64::consts::TAU / self.course.frequency_rad_s();
        let step_s = period_s / STEPS_PER_PERIOD;
        let from_s = if self.lead.is_known() { 0.0 } else { -PERIODS_BEFORE * period_s };
        let last_s = self.time_s.iter().filter_map(|t| t.last()).fold(0.0_f64, |a, b| a.max(*b));
        let n = ((last_s - from_s) / step_s).ceil() + 1.0;
        // A fit that runs away to any frequency is turned away by what it leaves, not by its time.
        let n = if (LEAST_POINTS..MOST_POINTS).contains(&n) { n } else { LEAST_POINTS } as usize;
        Points { from_s, step_s, n }
    }

    /// What the terms keep of the course.
    pub(super) fn remembered(&self) -> Remembered {
        let points = self.points();
        let echo = |term: &Term| match term.effect.acts {
            Acts::Echo(taps) => Some(
                Echo::new(&taps, self.run, &term.values)
                    .of_course(self.course, self.run.rolled_for_s),
            ),
            _ => None,
        };
        let echoes = self.terms.iter().filter_map(echo).collect();
        let lags = |term: &Term| matches!(term.effect.acts, Acts::Lagging(_));
        if !self.terms.iter().any(lags) {
            return Remembered { points, states: Vec::new(), echoes };
        }
        let instants: Vec<Instant<'_>> =
            points.times_s().map(|t| self.instant(t, self.course.at(t))).collect();
        let each = self.terms.iter().filter_map(|term| match term.effect.acts {
            Acts::Lagging(lag) => {
                let start = self.lead.states(&lag, &term.values, self.run, self.base);
                Some(follow(&lag, &term.values, start, &instants, points.step_s))
            }
            _ => None,
        });
        let states = each.collect();
        Remembered { points, states, echoes }
    }

    /// The motion with its moment at the times of a channel.
    fn instants(&self, channel: usize, remembered: &Remembered) -> Vec<Instant<'a>> {
        let times = self.time_s[channel].iter();
        times.map(|t| self.with_moment(*t, self.course.at(*t), remembered)).collect()
    }

    /// The motion at a time with the moment that it takes.
    pub(super) fn with_moment(
        &self,
        time_s: f64,
        motion: [f64; 3],
        remembered: &Remembered,
    ) -> Instant<'a> {
        let mut instant = self.instant(time_s, motion);
        instant.moment_n_m = self.scale() * self.sum(&instant, remembered);
        instant
    }

    /// Moment per unit inertia [rad/s2] that the course takes.
    fn sum(&self, instant: &Instant<'_>, remembered: &Remembered) -> f64 {
        let Base { natural_rad_s: w, b1_per_s, b3_s, .. } = *self.base;
        let rate = instant.rate_rad_per_s;
        let mut inertia = 1.0;
        let mut sum = b1_per_s * rate + b3_s * rate.powi(3) + w * w * instant.roll_rad;
        sum -= remembered.echoes.iter().map(|e| e.at(self.course, instant.time_s)).sum::<f64>();
        let mut lagging = remembered.states.iter();
        for Term { effect, values } in self.terms {
            match effect.acts {
                Acts::Moment(law) => sum -= (law.plain)(instant, values),
                Acts::Inertia(law) => inertia += (law.plain)(instant, values),
                Acts::Lagging(lag) => {
                    let states = lagging.next().map_or([0.0; MOST_LAGS], |states| {
                        between(states, remembered.points.place(instant.time_s))
                    });
                    sum -= (lag.moment.plain)(instant, values, &states);
                }
                Acts::Echo(_)
                | Acts::Roll(_)
                | Acts::Drive(_)
                | Acts::Chain(..)
                | Acts::Record(_) => {}
            }
        }
        sum + inertia * instant.acceleration_rad_per_s2
    }
}
