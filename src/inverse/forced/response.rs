//! Inertia, damping and phase of a steady forced run from its measured moment (4.4)-(4.5).

use std::ops::Range;

use super::harmonic::{FourierSeries, Motion};
use super::{skew, steady};
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::Skew;
use crate::inverse::state_space::triangle::Triangle;
use crate::roll::exciting_moment::Exciter;
use crate::run::{Run, Timing};

/// The steady response of a forced run with everything that its harmonics say.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyResponse {
    /// The roll samples of the run that are steady.
    pub steady: Range<usize>,
    /// The roll [rad], time from the start of the run.
    pub roll: FourierSeries,
    /// Times of the moment samples [s] from the start of the run.
    pub moment_time_s: Vec<f64>,
    /// Exciting moment [N m], zero taken out.
    pub moment_n_m: Vec<f64>,
    /// The moment as a series [N m].
    pub moment: FourierSeries,
    /// Total inertia `I + dI` [kg m2].
    pub inertia_kg_m2: Estimate,
    /// Linear and cubic damping per unit inertia, `[1/s, s]`.
    pub damping: [f64; 2],
    /// Their covariance.
    pub damping_covariance: [[f64; 2]; 2],
    /// Damping from the work per cycle `W / (pi w A1^2)` [N m s].
    pub work_damping_n_m_s: Estimate,
    /// Standard deviation of the moment's noise [N m].
    pub moment_noise_n_m: f64,
    /// What the time between roll and moment leaves unsure, where that is stated.
    pub skew: Option<Skew>,
}

/// Unknowns of the moment balance: inertia, linear damping, cubic damping, offset.
const N: usize = 4;

impl SteadyResponse {
    /// Analyses a forced run of a model with restoring coefficient `K` [N m/rad].
    ///
    /// # Errors
    /// The reason, as a sentence, why the run cannot be used.
    pub fn of(
        run: &Run,
        restoring_n_m_per_rad: f64,
        exciter: Option<&Exciter>,
    ) -> Result<Self, String> {
        let from_start = |times: &[f64]| times.iter().map(|t| t - run.start_s).collect::<Vec<_>>();
        let roll_time_s = from_start(&run.roll.time_s);
        let near = run.excitation_rad_s.ok_or("the excitation frequency is not known")?;
        if roll_time_s.len() < 30 {
            return Err(format!("{} roll samples are too few, 30 are needed", roll_time_s.len()));
        }
        let drive_time_s = from_start(&run.drive.time_s);
        if drive_time_s.len() < 30 {
            return Err("a forced run needs its measured force or moment".into());
        }
        let (from_s, to_s) =
            steady::both((&roll_time_s, &run.roll.value), (&drive_time_s, &run.drive.value), near)?;
        let within = |times: &[f64]| {
            times.partition_point(|t| *t < from_s)..times.partition_point(|t| *t <= to_s)
        };
        let (steady, during) = (within(&roll_time_s), within(&drive_time_s));
        let roll = FourierSeries::fit(
            &roll_time_s[steady.clone()],
            &run.roll.value[steady.clone()],
            near,
        )?;
        let moment_time_s = drive_time_s[during.clone()].to_vec();
        let zero = run.still.and_then(|s| s.force).unwrap_or(0.0);
        let moment_n_m: Vec<f64> = moment_time_s
            .iter()
            .zip(&run.drive.value[during])
            .map(|(&t, &value)| match exciter {
                Some(exciter) => exciter.moment_n_m(value - zero, roll.at(t).value),
                None => value - zero,
            })
            .collect();
        let moment = FourierSeries::fit_at(&moment_time_s, &moment_n_m, roll.frequency_rad_s);
        let mut balance = Balance::new(&roll, &moment_time_s, &moment_n_m, restoring_n_m_per_rad);
        let by_s = balance.delay(&roll, &moment, &moment_time_s, &run.timing);
        let mut response = balance.response(roll, moment);
        response.skew = skew::of(&run.timing, first_three(&balance.values), first_three(&by_s));
        if response.work_damping_n_m_s.hi95 < 0.0 {
            return Err(format!(
                "the rod takes {:.3} N m s of damping out of the model, so the force or the roll \
                 has the wrong sign (hint: force_sign = -1 in [exciter])",
                -response.work_damping_n_m_s.mean
            ));
        }
        if response.inertia_kg_m2.mean <= 0.0 {
            return Err(format!(
                "the inertia comes out at {:.3} kg m2: restoring, arm and force do not belong \
                 together (hint: gm_m, moment_arm_m, and the unit of the force)",
                response.inertia_kg_m2.mean
            ));
        }
        Ok(Self { steady, moment_time_s, moment_n_m, ..response })
    }

    /// First and last steady instant [s] on the recording's time base.
    pub fn steady_s(&self, run: &Run) -> (f64, f64) {
        (run.roll.time_s[self.steady.start], run.roll.time_s[self.steady.end - 1])
    }

    /// Phase `eps` by which the moment leads the roll [rad].
    pub fn phase_rad(&self) -> Estimate {
        let angle = |s: &FourierSeries| s.pairs[0].1.atan2(s.pairs[0].0);
        let lead = angle(&self.roll) - angle(&self.moment);
        let lead = lead.sin().atan2(lead.cos());
        let share = |s: &FourierSeries| s.coefficient_sd / s.amplitude();
        let delay = self.skew.map_or(0.0, |skew| self.roll.frequency_rad_s.mean * skew.sd_s);
        Estimate::normal(lead, share(&self.roll).hypot(share(&self.moment)).hypot(delay))
    }
}

/// Least squares of `M - K phi = I phi'' + B1 phi' + B3 phi'^3 + M0` on the moment samples.
///
/// The motion is itself a fit, so the noise of each of its harmonics turns into a moment that was
/// never there; what that does to the unknowns is added to their covariance. Above resonance the
/// third harmonic carries most of it, which is why one amplitude parts `B1` from `B3` so badly.
struct Balance {
    values: Vec<f64>,
    covariance: [[f64; N]; N],
    noise_n_m: f64,
}

impl Balance {
    fn new(roll: &FourierSeries, time_s: &[f64], moment_n_m: &[f64], restoring: f64) -> Self {
        let mut triangle = Triangle::new(N + 1);
        for (&t, &moment) in time_s.iter().zip(moment_n_m) {
            let motion = roll.at(t);
            let left = moment - restoring * (motion.value - roll.mean);
            let [acceleration, rate, cubed, one] = row(&motion);
            triangle.push([acceleration, rate, cubed, one, left]);
        }
        triangle.settle();
        let values: Vec<f64> = triangle.explained_by(N, N).iter().map(|w| -w).collect();
        let freedom = (time_s.len() - N) as f64;
        let noise_n_m = triangle.at(N, N).abs() / freedom.sqrt();
        let mut covariance = [[0.0; N]; N];
        for column in triangle.inverse_columns(N) {
            add_square(&mut covariance, &column, noise_n_m);
        }
        for shift in Self::harmonic_shifts(roll, time_s, &values, restoring) {
            add_square(&mut covariance, &shift, roll.coefficient_sd);
        }
        Self { values, covariance, noise_n_m }
    }

    /// Shift of the unknowns by a unit error in each coefficient of the roll's harmonics.
    fn harmonic_shifts(
        roll: &FourierSeries,
        time_s: &[f64],
        values: &[f64],
        restoring: f64,
    ) -> Vec<Vec<f64>> {
        let units = roll.units();
        let mut triangle = Triangle::new(N + units.len());
        for &t in time_s {
            let motion = roll.at(t);
            let slope = values[1] + 3.0 * values[2] * motion.rate.powi(2);
            let moment = |unit: &FourierSeries| {
                let error = unit.at(t);
                restoring * error.value + values[0] * error.acceleration + slope * error.rate
            };
            let line: Vec<f64> = row(&motion).into_iter().chain(units.iter().map(moment)).collect();
            triangle.push(line);
        }
        triangle.settle();
        (0..units.len()).map(|u| triangle.explained_by(N, N + u)).collect()
    }

    /// Shift of the unknowns by a unit delay of the moment, which the covariance takes with what
    /// the timing of the run leaves unsure: the moment's own rate, explained by the unknowns.
    fn delay(
        &mut self,
        roll: &FourierSeries,
        moment: &FourierSeries,
        time_s: &[f64],
        timing: &Timing,
    ) -> Vec<f64> {
        let mut triangle = Triangle::new(N + 1);
        for &t in time_s {
            let line = row(&roll.at(t)).into_iter().chain([moment.at(t).rate]);
            triangle.push(line);
        }
        triangle.settle();
        let by_s = triangle.explained_by(N, N);
        add_square(&mut self.covariance, &by_s, skew::sd_s(timing));
        by_s
    }

    fn response(&self, roll: FourierSeries, moment: FourierSeries) -> SteadyResponse {
        let w = roll.frequency_rad_s.mean;
        let c = &self.covariance;
        let [inertia, linear, cubic] = [self.values[0], self.values[1], self.values[2]];
        let (b1, b3) = (linear / inertia, cubic / inertia);
        // Per unit inertia: b = B / I, with the inertia's own error and its share in common.
        let by = |b: f64, row: usize, other: f64, column: usize| {
            (c[row][column] - b * c[0][column] - other * c[0][row] + b * other * c[0][0])
                / (inertia * inertia)
        };
        let damping_covariance =
            [[by(b1, 1, b1, 1), by(b1, 1, b3, 2)], [by(b3, 2, b1, 1), by(b3, 2, b3, 2)]];
        // Only the fundamental of the moment does work on a sinusoidal roll.
        let (cos, sin) = (roll.pairs[0].0 * w, roll.pairs[0].1 * w);
        let power = 0.5 * (moment.pairs[0].0 * sin - moment.pairs[0].1 * cos);
        let rate_square = 0.5 * (cos * cos + sin * sin);
        let cubic_share = 0.75 * (w * roll.amplitude()).powi(2);
        let work_variance =
            c[1][1] + 2.0 * cubic_share * c[1][2] + cubic_share * cubic_share * c[2][2];
        SteadyResponse {
            steady: 0..0,
            roll,
            moment_time_s: Vec::new(),
            moment_n_m: Vec::new(),
            moment,
            inertia_kg_m2: Estimate::normal(inertia, c[0][0].sqrt()),
            damping: [b1, b3],
            damping_covariance,
            work_damping_n_m_s: Estimate::normal(power / rate_square, work_variance.sqrt()),
            moment_noise_n_m: self.noise_n_m,
            skew: None,
        }
    }
}

fn first_three(values: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| values[i])
}

/// What the unknowns multiply.
fn row(motion: &Motion) -> [f64; N] {
    [motion.acceleration, motion.rate, motion.rate.powi(3), 1.0]
}

/// Adds an error of the unknowns along a vector, of standard deviation `sd` of its length.
pub(super) fn add_square<const M: usize>(covariance: &mut [[f64; M]; M], vector: &[f64], sd: f64) {
    for (row, a) in covariance.iter_mut().zip(vector) {
        for (entry, b) in row.iter_mut().zip(vector) {
            *entry += sd * sd * a * b;
        }
    }
}
