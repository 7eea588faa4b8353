//! What is known about one run after its inverse problem is solved.

use super::estimate::Estimate;
use crate::run::RunKind;

/// How the moment history is inferred.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// The exact posterior with scale-free hyperpriors (the default).
    Exact,
    /// The paper's single-site Gibbs and Metropolis-Hastings sampler with its printed hyperpriors.
    PaperMcmc,
}

/// Everything one run says about the damping, per unit inertia `I + dI`.
#[derive(Debug, Clone, PartialEq)]
pub struct Identification {
    /// Decay or forced.
    pub kind: RunKind,
    /// The method that inferred the moment history.
    pub method: Method,
    /// Small-angle natural frequency `w` [rad/s].
    pub natural_frequency_rad_s: Estimate,
    /// Roll at the start of the run [rad].
    pub initial_roll_rad: Estimate,
    /// Roll rate at the start of the run [rad/s].
    pub initial_roll_rate_rad_per_s: Estimate,
    /// Zero offset of the roll channel during the run [rad].
    pub roll_offset_rad: Estimate,
    /// Standard deviation of the roll noise [rad].
    pub roll_noise_rad: Estimate,
    /// The fitted law `b1 phi' + b3 phi'^3`.
    pub damping: DampingFit,
    /// Equivalent damping at the contract's amplitudes, smallest first.
    pub equivalent_damping: Vec<EquivalentDamping>,
    /// Equivalent damping half cycle by half cycle from the moment history, in order of time.
    pub half_cycles: Vec<HalfCycle>,
    /// Damping moment against roll rate whatever its form, rising rates; empty for a forced run.
    pub damping_curve: Vec<CurvePoint>,
    /// What the evidence says of law, restoring and noise; none for a forced run.
    pub beliefs: Option<Beliefs>,
    /// The inferred moment history.
    pub moment: MomentHistory,
    /// The run simulated again with the fitted law.
    pub resimulation: Resimulation,
    /// Total inertia `I + dI` [kg m2]: from (4.5) in a forced run, else none.
    pub inertia_kg_m2: Option<Estimate>,
    /// What the time between roll and moment leaves unsure; none for a decay, and where nothing is
    /// stated of that time.
    pub skew: Option<Skew>,
    /// What only a forced run has.
    pub forced: Option<ForcedResponse>,
    /// Unregularised least-squares solution of (2.5), one value per entry of `moment` (Fig. 9).
    pub least_squares_per_s2: Vec<f64>,
    /// The chain, when the method draws one.
    pub chain: Option<Chain>,
    /// Sentences a reader must know, such as what the law does not capture.
    pub remarks: Vec<String>,
}

impl Identification {
    /// Frequency [rad/s] at which the model rolls: that of the excitation, or its own.
    pub fn rolling_frequency_rad_s(&self) -> f64 {
        let forced = self.forced.as_ref().map(|forced| forced.frequency_rad_s);
        forced.unwrap_or(self.natural_frequency_rad_s).mean
    }
}

/// `B/(I+dI) = b1 phi' + b3 phi'^3` fitted to one run (Sec. 4.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampingFit {
    /// Linear coefficient `b1` [1/s].
    pub b1_per_s: Estimate,
    /// Cubic coefficient `b3` [s].
    pub b3_s: Estimate,
    /// Posterior correlation of `b1` and `b3` [-].
    pub correlation: f64,
}

impl DampingFit {
    /// Estimate of `p b1 + q b3`, as a normal with the posterior correlation of the two.
    pub fn combination(&self, p: f64, q: f64) -> Estimate {
        let (sd1, sd3) = (p * self.b1_per_s.sd, q * self.b3_s.sd);
        let variance = sd1 * sd1 + sd3 * sd3 + 2.0 * self.correlation * sd1 * sd3;
        let mean = p * self.b1_per_s.mean + q * self.b3_s.mean;
        Estimate::normal(mean, variance.max(0.0).sqrt())
    }
}

/// Damping moment per unit inertia at one roll rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Roll rate [rad/s].
    pub rate_rad_per_s: f64,
    /// `B/(I+dI)` there [rad/s2].
    pub damping_per_s2: Estimate,
}

/// Posterior probabilities of what a decay may be made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Beliefs {
    /// Forms of damping law, each with its coefficients.
    pub forms: Vec<FormBelief>,
    /// That the restoring has a cubic part.
    pub cubic_restoring: f64,
    /// Cubic part `k3` of the restoring, given that there is one [1/rad2].
    pub k3_per_rad2: Estimate,
    /// That the law leaves more than noise, by the order 1 to 3 of what it leaves.
    pub misfit_orders: [f64; 3],
    /// That neighbouring samples of the noise are correlated.
    pub coloured_noise: f64,
    /// Step between the values that the roll channel can take, if it is coarse enough to be seen
    /// [rad].
    pub quantum_rad: Option<f64>,
    /// Samples with independent noise that would know as much as the run's [-].
    pub n_effective: f64,
}

/// One form of damping law.
#[derive(Debug, Clone, PartialEq)]
pub struct FormBelief {
    /// Its equation.
    pub equation: &'static str,
    /// Posterior probability among the forms [-].
    pub probability: f64,
    /// Its coefficients: symbol, unit and estimate.
    pub coefficients: Vec<(&'static str, &'static str, Estimate)>,
}

/// Equivalent linear damping `b_eq` at one roll amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EquivalentDamping {
    /// Roll amplitude [deg], a round number of the contract.
    pub amplitude_deg: f64,
    /// `b_eq = b1 + 3/4 (w A)^2 b3` from the fitted law [1/s].
    pub fitted_per_s: Estimate,
    /// The same from the half cycles near this amplitude, without a law [1/s].
    pub local_per_s: Option<Estimate>,
    /// Whether the run did not reach this amplitude.
    pub extrapolated: bool,
}

/// Energy balance over one half cycle of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfCycle {
    /// Middle of the half cycle [s], on the recording's time base.
    pub time_s: f64,
    /// Mean roll amplitude [rad].
    pub amplitude_rad: f64,
    /// Frequency of the half cycle [rad/s].
    pub frequency_rad_s: f64,
    /// Equivalent damping [1/s].
    pub equivalent_damping_per_s: Estimate,
}

/// The posterior of `U = -B/(I+dI)` with the smoothed motion, entry by entry at `time_s`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MomentHistory {
    /// Times [s] on the recording's time base.
    pub time_s: Vec<f64>,
    /// Posterior mean of `U` [rad/s2].
    pub mean_per_s2: Vec<f64>,
    /// Posterior standard deviation of `U` [rad/s2].
    pub sd_per_s2: Vec<f64>,
    /// Lower 95 % band of `U` [rad/s2].
    pub lo95_per_s2: Vec<f64>,
    /// Upper 95 % band of `U` [rad/s2].
    pub hi95_per_s2: Vec<f64>,
    /// Smoothed roll, free of the zero offset [rad].
    pub roll_rad: Vec<f64>,
    /// Smoothed roll rate [rad/s].
    pub roll_rate_rad_per_s: Vec<f64>,
    /// The observable `g` of (2.4) [rad], from the measured roll.
    pub observable_rad: Vec<f64>,
}

/// The run simulated again with the fitted law (Fig. 13, Fig. 17c).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Resimulation {
    /// Times [s] of the measured samples used.
    pub time_s: Vec<f64>,
    /// Measured roll [rad].
    pub measured_rad: Vec<f64>,
    /// Simulated roll with the zero offset added [rad].
    pub simulated_rad: Vec<f64>,
    /// Root mean square of measured less simulated [rad].
    pub rmse_rad: f64,
}

/// What a forced run says beside its damping law (Figs. 15, 16, 18, 19).
#[derive(Debug, Clone, PartialEq)]
pub struct ForcedResponse {
    /// Excitation frequency `w` [rad/s].
    pub frequency_rad_s: Estimate,
    /// Roll amplitude `A1` [rad].
    pub roll_amplitude_rad: Estimate,
    /// Amplitude `Ma` of the exciting moment [N m].
    pub moment_amplitude_n_m: Estimate,
    /// Phase `eps` by which the moment leads the roll [rad].
    pub phase_rad: Estimate,
    /// Peak of `|U|` per cycle [rad/s2].
    pub peak_moment_per_s2: Estimate,
    /// Equivalent damping from the work per cycle, `W/(pi w A1^2)` [N m s].
    pub work_damping_n_m_s: Estimate,
    /// Times [s], exciting moment [N m] after zero and arm, as used.
    pub moment_time_s: Vec<f64>,
    /// Exciting moment [N m] at `moment_time_s`.
    pub moment_n_m: Vec<f64>,
}

/// What an error of the time between roll and moment does to the damping of a forced run; the
/// estimates hold it already.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Skew {
    /// Standard uncertainty of that time [s].
    pub sd_s: f64,
    /// Change of `b1` per second [1/s2].
    pub b1_by_per_s2: f64,
    /// Change of `b3` per second [-].
    pub b3_by: f64,
}

impl Skew {
    /// Standard uncertainty that it leaves in `b1 + weight b3` [1/s].
    pub fn damping_sd_per_s(&self, weight: f64) -> f64 {
        (self.b1_by_per_s2 + weight * self.b3_by).abs() * self.sd_s
    }
}

/// What a Markov chain says about itself (Fig. 11).
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// Seed of the chains.
    pub seed: u64,
    /// Sweeps of each chain, burn-in included.
    pub n_sweeps: usize,
    /// Sweeps dropped from the front of each chain.
    pub n_burn_in: usize,
    /// Number of chains.
    pub n_chains: usize,
    /// Largest split R-hat over all components [-].
    pub r_hat_max: f64,
    /// Smallest effective sample size over all components [-].
    pub effective_sample_size_min: f64,
    /// Whether `r_hat_max < 1.05`.
    pub converged: bool,
    /// A few named traces, thinned for drawing.
    pub traces: Vec<Trace>,
}

/// The path of one component of one chain, thinned.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Component, with its unit.
    pub name: String,
    /// Sweep numbers.
    pub sweep: Vec<usize>,
    /// Values at those sweeps.
    pub value: Vec<f64>,
}

/// `b1(Fr) = b0 (1 + kappa Fr^2)` over the runs of one condition (4.3, Fig. 14).
#[derive(Debug, Clone, PartialEq)]
pub struct FroudeLaw {
    /// Loading or appendage condition.
    pub condition: String,
    /// Linear damping at rest `b0` [1/s].
    pub b0_per_s: Estimate,
    /// Speed coefficient `kappa` [-].
    pub kappa: Estimate,
    /// Cubic coefficient `b3` [s], common to all speeds.
    pub b3_s: Estimate,
    /// Run-to-run standard deviation of `b1` [1/s].
    pub scatter_per_s: Estimate,
    /// Froude numbers at which the band is given [-].
    pub froude: Vec<f64>,
    /// Band of the law at `froude` [1/s].
    pub b1_per_s: Vec<Estimate>,
}
