//! Inertia, damping and phase of a steady forced run from its measured moment (4.4)-(4.5).

use super::estimate::Estimate;
use super::filter::Triangle;
use super::harmonic::FourierSeries;
use super::smoother::explained_by;
use crate::roll::exciting_moment::Exciter;
use crate::run::Run;

/// The steady response of a forced run with everything that its harmonics say.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyResponse {
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
        let roll = FourierSeries::fit(&roll_time_s, &run.roll.value, near)?;
        if run.drive.time_s.len() < 30 {
            return Err("a forced run needs its measured force or moment".into());
        }
        let moment_time_s = from_start(&run.drive.time_s);
        let zero = run.still.and_then(|s| s.force).unwrap_or(0.0);
        let moment_n_m: Vec<f64> = moment_time_s
            .iter()
            .zip(&run.drive.value)
            .map(|(&t, &value)| match exciter {
                Some(exciter) => exciter.moment_n_m(value - zero, roll.at(t).value),
                None => value - zero,
            })
            .collect();
        let frequency = roll.frequency_rad_s.mean;
        let moment = FourierSeries::fit(&moment_time_s, &moment_n_m, frequency)?;
        let balance = Balance::new(&roll, &moment_time_s, &moment_n_m, restoring_n_m_per_rad);
        let response = balance.response(roll, moment, restoring_n_m_per_rad);
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
        Ok(Self { moment_time_s, moment_n_m, ..response })
    }

    /// Phase `eps` by which the moment leads the roll [rad].
    pub fn phase_rad(&self) -> Estimate {
        let angle = |s: &FourierSeries| s.pairs[0].1.atan2(s.pairs[0].0);
        let lead = angle(&self.roll) - angle(&self.moment);
        let lead = lead.sin().atan2(lead.cos());
        let share = |s: &FourierSeries| s.coefficient_sd / s.amplitude();
        Estimate::normal(lead, share(&self.roll).hypot(share(&self.moment)))
    }
}

/// Least squares of `M - K phi = I phi'' + B1 phi' + B3 phi'^3 + M0` on the moment samples.
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
            triangle.add(&mut [
                motion.acceleration,
                motion.rate,
                motion.rate.powi(3),
                1.0,
                moment - restoring * (motion.value - roll.mean),
            ]);
        }
        let values: Vec<f64> = explained_by(&triangle, N, N).iter().map(|w| -w).collect();
        let freedom = (time_s.len() - N) as f64;
        let noise_n_m = triangle.at(N, N).abs() / freedom.sqrt();
        let mut inverse = [[0.0; N]; N];
        for column in 0..N {
            for i in (0..=column).rev() {
                let unit = f64::from(u8::from(i == column));
                let known: f64 =
                    (i + 1..=column).map(|j| triangle.at(i, j) * inverse[j][column]).sum();
                inverse[i][column] = (unit - known) / triangle.at(i, i);
            }
        }
        let covariance = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                noise_n_m.powi(2)
                    * inverse[i].iter().zip(&inverse[j]).map(|(a, b)| a * b).sum::<f64>()
            })
        });
        Self { values, covariance, noise_n_m }
    }

    fn response(
        &self,
        roll: FourierSeries,
        moment: FourierSeries,
        restoring: f64,
    ) -> SteadyResponse {
        let w = roll.frequency_rad_s.mean;
        let [inertia, linear, cubic] = [self.values[0], self.values[1], self.values[2]];
        // Noise of the roll turns its fundamental in phase and size; the dynamic stiffness makes an
        // apparent damping and inertia of that.
        let turn = roll.coefficient_sd / roll.amplitude();
        let stiffness = restoring - inertia * w * w;
        let equivalent = linear + 0.75 * (w * roll.amplitude()).powi(2) * cubic;
        let inertia_sd =
            self.covariance[0][0].sqrt().hypot(stiffness.hypot(equivalent * w) * turn / (w * w));
        let from_roll = (stiffness.hypot(equivalent * w) * turn / w).powi(2);
        let (b1, b3) = (linear / inertia, cubic / inertia);
        let relative = (inertia_sd / inertia).powi(2);
        let c = &self.covariance;
        let square = inertia * inertia;
        let damping_covariance = [
            [
                (c[1][1] + from_roll) / square + b1 * b1 * relative,
                c[1][2] / square + b1 * b3 * relative,
            ],
            [c[1][2] / square + b1 * b3 * relative, c[2][2] / square + b3 * b3 * relative],
        ];
        // Only the fundamental of the moment does work on a sinusoidal roll.
        let (cos, sin) = (roll.pairs[0].0 * w, roll.pairs[0].1 * w);
        let power = 0.5 * (moment.pairs[0].0 * sin - moment.pairs[0].1 * cos);
        let rate_square = 0.5 * (cos * cos + sin * sin);
        let work_sd = (moment.coefficient_sd / (w * roll.amplitude())).hypot(from_roll.sqrt());
        SteadyResponse {
            roll,
            moment_time_s: Vec::new(),
            moment_n_m: Vec::new(),
            moment,
            inertia_kg_m2: Estimate::normal(inertia, inertia_sd),
            damping: [b1, b3],
            damping_covariance,
            work_damping_n_m_s: Estimate::normal(power / rate_square, work_sd),
            moment_noise_n_m: self.noise_n_m,
        }
    }
}
