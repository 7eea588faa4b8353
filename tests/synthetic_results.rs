//! Results of a campaign as identification would leave them, made from known coefficients.

use std::f64::consts::PI;

use crate::synthetic_roll::{STEP_S, Truth};
use devices::{Quantity, channel::Brought, channel::Counts};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use replay::Columns;
use rolltank::campaign::{Campaign, Live, Plan, Recording, Tank, Trueness};
use rolltank::hull::{Hull, Water};
use rolltank::inverse::estimate::Estimate;
use rolltank::inverse::identification::{
    Beliefs, Chain, CurvePoint, DampingFit, EquivalentDamping, ForcedResponse, FormBelief,
    FroudeLaw, HalfCycle, Identification, Method, MomentHistory, Resimulation, Trace,
};
use rolltank::results::{IdentifiedRun, Overview, RejectedStretch, Results, Sampling};
use rolltank::roll::exciting_moment::{Arm, Exciter};
use rolltank::run::{Run, RunEnd, RunKind, Series, Still, Timing};

/// Noise of the roll channel [rad].
const NOISE_RAD: f64 = 0.000_9;
/// Froude numbers of the campaign [-].
const FROUDE: [f64; 5] = [0.0, 0.1, 0.2, 0.3, 0.4];
/// What one condition is made of: name, `w` [rad/s], `b0` [1/s], `kappa` [-], `b3` [s].
const CONDITIONS: [(&str, f64, f64, f64, f64); 2] =
    [("bare hull", 6.905, 0.38, 11.8, 0.14), ("bilge keels", 6.136, 1.24, 11.9, 0.67)];

/// The paper's model and tank, with one recording per decay and per forced run.
pub(crate) fn campaign(name: &str) -> Campaign {
    let recordings = CONDITIONS.iter().flat_map(|(condition, ..)| {
        FROUDE.iter().enumerate().map(move |(index, froude)| Recording {
            name: format!("{}/pass_{:02}.csv", condition.replace(' ', "_"), index + 1),
            files: Vec::new(),
            condition: (*condition).to_owned(),
            speed_m_s: Some(froude * 4.952),
            line: None,
        })
    });
    Campaign {
        folder: std::path::PathBuf::from("campaign"),
        name: name.to_owned(),
        hull: Hull {
            length_pp_m: 2.5,
            beam_m: 0.387,
            draft_m: 0.132,
            displacement_m3: 0.110,
            gm_m: 0.074,
        },
        water: Water::default(),
        tank: Tank {
            length_m: Some(50.0),
            width_m: Some(10.0),
            depth_m: Some(5.0),
            carriage_max_speed_m_s: Some(2.0),
        },
        exciter: Some(Exciter { moment_arm_m: 0.43, arm: Arm::Constant, force_sign: 1.0 }),
        columns: Columns::default(),
        recordings: recordings.collect(),
        model: None,
        judgements: rolltank::judgement::Judgements::default(),
        live: Live::default(),
        plan: Plan::default(),
        trueness: Trueness::default(),
    }
}

/// Decays and forced runs of both conditions at every Froude number, from one seed.
pub(crate) fn results() -> Results {
    static RESULTS: std::sync::LazyLock<Results> = std::sync::LazyLock::new(simulated);
    RESULTS.clone()
}

fn simulated() -> Results {
    let campaign = campaign("");
    let mut random = ChaCha8Rng::seed_from_u64(20_260_301);
    let mut results = Results::default();
    for (condition, w, b0, kappa, b3) in CONDITIONS {
        for (index, froude) in FROUDE.into_iter().enumerate() {
            let number = results.runs.len() + 1;
            let b1 = b0 * (1.0 + kappa * froude * froude) * (1.0 + 0.05 * normal(&mut random));
            let recording = &campaign.recordings[results.overviews.len()].name;
            let truth = Truth { w, b1, b3, moment_amplitude_per_s2: 0.0, excitation_rad_s: 0.0 };
            let mut run = identified(recording, condition, froude, number, &truth, &mut random);
            if index == 3 {
                run.identification.chain = Some(chain(&mut random));
                run.identification.method = Method::PaperMcmc;
                run.identification.remarks.push("the law leaves a quadratic part over".to_owned());
            }
            results.overviews.push(overview(&run));
            results.rejected.push(RejectedStretch {
                recording: recording.clone(),
                start_s: run.run.end_s + 1.0,
                end_s: run.run.end_s + 4.0,
                reason: "the carriage brakes: speed falls by 0.8 m/s, the limit is 0.02".to_owned(),
                run: None,
            });
            results.runs.push(run);
            for (kind, ratio) in [0.74, 0.9, 1.0, 1.1].into_iter().enumerate() {
                let truth = Truth {
                    moment_amplitude_per_s2: 1.2 + 0.3 * kind as f64,
                    excitation_rad_s: ratio * w,
                    ..truth
                };
                let number = results.runs.len() + 1;
                let run = identified(recording, condition, froude, number, &truth, &mut random);
                results.runs.push(run);
            }
        }
        results.froude_laws.push(law(condition, b0, kappa, b3));
    }
    results.overviews[0].notes.push("3 samples without a time stamp were dropped".to_owned());
    results
}

fn identified(
    recording: &str,
    condition: &str,
    froude: f64,
    number: usize,
    truth: &Truth,
    random: &mut ChaCha8Rng,
) -> IdentifiedRun {
    let start_s = 21.4;
    let n = if truth.forced() { 1500 } else { (5.0 / truth.b1 / STEP_S) as usize + 200 };
    let motion = truth.motion(n);
    let time_s: Vec<_> = (0..n).map(|k| start_s + STEP_S * k as f64).collect();
    let measured: Vec<_> =
        motion.iter().map(|(roll, _)| roll + 0.001 + NOISE_RAD * normal(random)).collect();
    let forced = truth.forced();
    let moment_n_m: Vec<_> = time_s
        .iter()
        .map(|t| (truth.excitation_rad_s * (t - start_s)).cos() * truth.moment_amplitude_per_s2)
        .map(|moment| 1.68 * moment + 0.01 * normal(random))
        .collect();
    let roll = Series { time_s: time_s.clone(), value: measured.clone() };
    let run = found(truth, froude, roll, &moment_n_m);
    let amplitude = motion.iter().skip(n / 2).map(|(roll, _)| roll.abs()).fold(0.0, f64::max);
    let identification = Identification {
        kind: run.kind,
        method: Method::Exact,
        natural_frequency_rad_s: Estimate::normal(truth.w + 0.002 * normal(random), 0.003),
        initial_roll_rad: Estimate::normal(motion[0].0, 0.000_3),
        initial_roll_rate_rad_per_s: Estimate::normal(motion[0].1, 0.002),
        roll_offset_rad: Estimate::normal(0.001, 0.000_05),
        roll_noise_rad: Estimate::normal(NOISE_RAD, 0.000_03),
        damping: DampingFit {
            b1_per_s: Estimate::normal(truth.b1 * (1.0 + 0.01 * normal(random)), 0.012 * truth.b1),
            b3_s: Estimate::normal(truth.b3 * (1.0 + 0.08 * normal(random)), 0.08 * truth.b3),
            correlation: -0.87,
        },
        equivalent_damping: equivalent_damping(truth, amplitude),
        half_cycles: half_cycles(truth, &time_s, &motion, random),
        damping_curve: if forced { Vec::new() } else { damping_curve(truth) },
        beliefs: (!forced).then(|| beliefs(truth)),
        moment: moment(truth, &time_s, &motion, &measured, random),
        resimulation: Resimulation {
            time_s: time_s.clone(),
            measured_rad: measured,
            simulated_rad: motion.iter().map(|(roll, _)| roll + 0.001).collect(),
            rmse_rad: NOISE_RAD,
        },
        inertia_kg_m2: forced.then(|| Estimate::normal(79.85 / (truth.w * truth.w), 0.004)),
        forced: forced.then(|| response(truth, amplitude, time_s.clone(), moment_n_m)),
        least_squares_per_s2: motion
            .iter()
            .map(|(_, rate)| -truth.damping(*rate) + 6.0 * normal(random))
            .collect(),
        skew: None,
        chain: None,
        remarks: Vec::new(),
    };
    let whole = Brought { quantity: Quantity::Roll, counts: Counts::default(), bound_s: None };
    IdentifiedRun {
        id: format!("pass_{number:02}-1"),
        recording: recording.to_owned(),
        condition: condition.to_owned(),
        speed_m_s: froude * 4.952,
        froude,
        sampling: Sampling::of(&run),
        brought: vec![whole],
        run,
        identification,
    }
}

/// The run as the finder would hand it over.
fn found(truth: &Truth, froude: f64, roll: Series, moment_n_m: &[f64]) -> Run {
    let (forced, force) = (truth.forced(), Some(0.02));
    let still = Still { start_s: 4.0, end_s: 20.9, roll_rad: 0.001, roll_sd_rad: 0.0, force };
    let force_n: Vec<f64> = moment_n_m.iter().filter(|_| forced).map(|m| m / 0.43).collect();
    Run {
        kind: if forced { RunKind::Forced } else { RunKind::Decay },
        start_s: roll.time_s[0],
        end_s: roll.time_s[roll.time_s.len() - 1],
        end: if forced { RunEnd::ExcitationChanged } else { RunEnd::LostInNoise },
        speed_m_s: Some(froude * 4.952),
        drive: Series { time_s: roll.time_s[..force_n.len()].to_vec(), value: force_n },
        roll,
        lead: Series::default(),
        speed: Series::default(),
        still: Some(still),
        excitation_rad_s: forced.then_some(truth.excitation_rad_s),
        timing: Timing::default(),
    }
}

fn equivalent_damping(truth: &Truth, amplitude_max_rad: f64) -> Vec<EquivalentDamping> {
    let amplitudes = [1.0, 2.0, 3.0, 5.0, 7.5, 10.0, 15.0, 20.0_f64];
    amplitudes
        .into_iter()
        .map(|amplitude_deg| {
            let b = truth.equivalent(amplitude_deg.to_radians());
            let extrapolated = truth.forced() && amplitude_deg.to_radians() > amplitude_max_rad
                || amplitude_deg > 15.0;
            EquivalentDamping {
                amplitude_deg,
                fitted_per_s: Estimate::normal(b, 0.006 * b),
                local_per_s: (!extrapolated).then(|| Estimate::normal(1.004 * b, 0.013 * b)),
                extrapolated,
            }
        })
        .collect()
}

/// The true law at some rates, with a band of a hundredth.
fn damping_curve(truth: &Truth) -> Vec<CurvePoint> {
    (0..=10)
        .map(|i| {
            let rate_rad_per_s = 0.1 * f64::from(i);
            let mean = truth.b1 * rate_rad_per_s + truth.b3 * rate_rad_per_s.powi(3);
            CurvePoint { rate_rad_per_s, damping_per_s2: Estimate::normal(mean, 0.01 * mean) }
        })
        .collect()
}

fn beliefs(truth: &Truth) -> Beliefs {
    let form =
        |equation, probability, coefficients| FormBelief { equation, probability, coefficients };
    let b1 = vec![("b1", "1/s", Estimate::normal(truth.b1, 0.01 * truth.b1))];
    Beliefs {
        forms: vec![
            form("b1 phi' + b3 phi'^3", 0.93, b1),
            form("a smooth odd curve", 0.0, Vec::new()),
        ],
        cubic_restoring: 0.04,
        k3_per_rad2: Estimate::normal(0.01, 0.05),
        misfit_orders: [0.0, 0.02, 0.0],
        coloured_noise: 0.0,
        quantum_rad: Some(1e-4),
        n_effective: 1200.0,
    }
}

fn half_cycles(
    truth: &Truth,
    time_s: &[f64],
    motion: &[(f64, f64)],
    random: &mut ChaCha8Rng,
) -> Vec<HalfCycle> {
    let mut peaks: Vec<(f64, f64)> = Vec::new();
    for k in 1..motion.len() {
        if motion[k - 1].1 * motion[k].1 <= 0.0 && motion[k].0.abs() > 3.0 * NOISE_RAD {
            peaks.push((time_s[k], motion[k].0.abs()));
        }
    }
    peaks
        .windows(2)
        .map(|pair| {
            let amplitude_rad = 0.5 * (pair[0].1 + pair[1].1);
            let b = truth.equivalent(amplitude_rad);
            let sd = (0.4 * NOISE_RAD / amplitude_rad * truth.w / PI).hypot(0.004 * b);
            HalfCycle {
                time_s: 0.5 * (pair[0].0 + pair[1].0),
                amplitude_rad,
                frequency_rad_s: truth.w + 0.01 * normal(random) * 0.1 / amplitude_rad,
                equivalent_damping_per_s: Estimate::normal(b + sd * normal(random), sd),
            }
        })
        .collect()
}

fn moment(
    truth: &Truth,
    time_s: &[f64],
    motion: &[(f64, f64)],
    measured: &[f64],
    random: &mut ChaCha8Rng,
) -> MomentHistory {
    let sd = 0.03;
    let phase = 6.0 * random.random::<f64>();
    let mean: Vec<_> = motion
        .iter()
        .zip(time_s)
        .map(|((_, rate), t)| -truth.damping(*rate) + 0.7 * sd * (3.3 * t + phase).sin())
        .collect();
    MomentHistory {
        time_s: time_s.to_vec(),
        sd_per_s2: vec![sd; mean.len()],
        lo95_per_s2: mean.iter().map(|u| u - 1.96 * sd).collect(),
        hi95_per_s2: mean.iter().map(|u| u + 1.96 * sd).collect(),
        mean_per_s2: mean,
        roll_rad: motion.iter().map(|(roll, _)| *roll).collect(),
        roll_rate_rad_per_s: motion.iter().map(|(_, rate)| *rate).collect(),
        observable_rad: measured
            .iter()
            .zip(time_s)
            .map(|(roll, t)| roll - motion[0].0 * (truth.w * (t - time_s[0])).cos())
            .collect(),
    }
}

fn response(
    truth: &Truth,
    amplitude_rad: f64,
    moment_time_s: Vec<f64>,
    moment_n_m: Vec<f64>,
) -> ForcedResponse {
    let w = truth.excitation_rad_s;
    let b = truth.b1 + 0.75 * (w * amplitude_rad).powi(2) * truth.b3;
    ForcedResponse {
        frequency_rad_s: Estimate::normal(w, 0.000_4),
        roll_amplitude_rad: Estimate::normal(amplitude_rad, 0.000_1),
        moment_amplitude_n_m: Estimate::normal(1.68 * truth.moment_amplitude_per_s2, 0.003),
        phase_rad: Estimate::normal((w * b).atan2(truth.w * truth.w - w * w), 0.002),
        peak_moment_per_s2: {
            let peak = truth.damping(w * amplitude_rad);
            Estimate::normal(peak, 0.02 * peak)
        },
        work_damping_n_m_s: Estimate::normal(1.68 * b, 0.01 * 1.68 * b),
        moment_time_s,
        moment_n_m,
    }
}

fn chain(random: &mut ChaCha8Rng) -> Chain {
    let sweep: Vec<_> = (0..1000).map(|k| k * 50).collect();
    let traces = ["U at 22.1 s [rad/s2]", "U at 25.3 s [rad/s2]", "lambda [s4/rad2]"]
        .map(|name| Trace {
            name: name.to_owned(),
            value: sweep
                .iter()
                .map(|&k| normal(random) + 8.0 * (-(k as f64) / 900.0).exp())
                .collect(),
            sweep: sweep.clone(),
        })
        .to_vec();
    Chain {
        seed: 7,
        n_sweeps: 50_000,
        n_burn_in: 25_000,
        n_chains: 4,
        r_hat_max: 1.083,
        effective_sample_size_min: 143.7,
        converged: false,
        traces,
    }
}

fn law(condition: &str, b0: f64, kappa: f64, b3: f64) -> FroudeLaw {
    let froude: Vec<_> = (0..=40).map(|k| 0.01 * f64::from(k)).collect();
    FroudeLaw {
        condition: condition.to_owned(),
        b0_per_s: Estimate::normal(b0, 0.03 * b0),
        kappa: Estimate::normal(kappa, 1.1),
        b3_s: Estimate::normal(b3, 0.03 * b3),
        scatter_per_s: Estimate::normal(0.05 * b0, 0.02 * b0),
        b1_per_s: froude
            .iter()
            .map(|fr| {
                Estimate::normal(b0 * (1.0 + kappa * fr * fr), 0.03 * b0 * (1.0 + 9.0 * fr * fr))
            })
            .collect(),
        froude,
    }
}

/// The recording around a run: rest, heel, the run, rest again; lowest and highest per stretch.
fn overview(run: &IdentifiedRun) -> Overview {
    let mut overview = Overview { recording: run.recording.clone(), ..Overview::default() };
    let end_s = run.run.end_s + 8.0;
    let push = |series: &mut Series, t: f64, value: f64| {
        series.time_s.push(t);
        series.value.push(value);
    };
    for k in 0..(end_s / STEP_S) as usize {
        let t = STEP_S * k as f64;
        let within = run.run.roll.time_s.iter().position(|at| (at - t).abs() < 0.5 * STEP_S);
        let heel = if t > 20.9 && t < run.run.start_s { 0.26 * (t - 20.9) / 0.5 } else { 0.0 };
        let ramp = (t / 4.0).min(1.0).min(((end_s - t) / 6.0).max(0.0));
        push(&mut overview.roll, t, within.map_or(heel, |at| run.run.roll.value[at]));
        push(&mut overview.speed, t, run.speed_m_s * ramp);
    }
    overview
}

/// A standard normal number, by the sum of twelve uniform ones.
fn normal(random: &mut ChaCha8Rng) -> f64 {
    (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0
}
