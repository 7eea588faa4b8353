//! Joint draws from the posterior of a decay against its marginal bands.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rolltank::inverse::decay::draw::{Draw, draw};
use rolltank::inverse::decay::fit::FREQUENCY;
use rolltank::inverse::decay::posterior::DecayPosterior;
use rolltank::inverse::decay::{moment, solve};
use rolltank::inverse::mixture;
use rolltank::run::{Run, RunEnd, RunKind, Series, Timing};

const N_DRAWS: usize = 1000;

/// A decay of natural frequency 4 rad/s; `hidden` is a moment that no law of the rate has [rad/s2].
fn run(hidden: impl Fn(f64, f64) -> f64) -> Run {
    let mut rng = ChaCha8Rng::seed_from_u64(31);
    let (mut roll, mut rate) = (0.2_f64, 0.0_f64);
    let step_s = 1e-3;
    let mut series = Series::default();
    for i in 0..15_000 {
        let time_s = step_s * f64::from(i);
        if i % 20 == 0 {
            series.time_s.push(time_s);
            series.value.push(roll + 5e-4 * rng.sample::<f64, _>(StandardNormal));
        }
        // Velocity Verlet with the damping at half step: good to 1e-6 here.
        let force = |roll: f64, rate: f64, t: f64| {
            -16.0 * roll - 0.2 * rate - 0.3 * rate.powi(3) + hidden(t, rate)
        };
        let half = rate + 0.5 * step_s * force(roll, rate, time_s);
        roll += step_s * half;
        rate = half + 0.5 * step_s * force(roll, half, time_s + step_s);
    }
    Run {
        kind: RunKind::Decay,
        start_s: 0.0,
        end_s: 15.0,
        end: RunEnd::RecordingEnded,
        speed_m_s: None,
        roll: series,
        drive: Series::default(),
        speed: Series::default(),
        lead: Series::default(),
        still: None,
        excitation_rad_s: None,
        timing: Timing::default(),
    }
}

/// Largest distance of the draws' mean from the band's in standard errors, and the mean ratio of
/// their standard deviations, for one component of the motion.
fn compare(posterior: &DecayPosterior, draws: &[Draw], component: usize) -> (f64, f64) {
    let band = moment::motion(posterior);
    let (mut worst, mut ratio) = (0.0_f64, 0.0);
    for (i, (mean, sd)) in band.mean.iter().zip(&band.sd).enumerate() {
        let n = draws.len() as f64;
        let values: Vec<f64> = draws.iter().map(|d| d.motion[i][component]).collect();
        let drawn = values.iter().sum::<f64>() / n;
        let square = values.iter().map(|v| (v - drawn).powi(2)).sum::<f64>() / n;
        worst = worst.max((drawn - mean[component]).abs() / (sd[component] / n.sqrt()));
        ratio += square.sqrt() / sd[component] / band.mean.len() as f64;
    }
    (worst, ratio)
}

fn assert_agreement(posterior: &mut DecayPosterior) {
    // Bands leave out what is lighter than a twentieth of the heaviest; here the draws do too.
    let heaviest = posterior.solutions[0].log_weight;
    posterior.solutions.retain(|weighed| weighed.log_weight > heaviest + 0.05_f64.ln());
    let posterior = &*posterior;
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let draws: Vec<Draw> = (0..N_DRAWS).map(|_| draw(posterior, &mut rng)).collect();
    for component in 0..3 {
        let (worst, ratio) = compare(posterior, &draws, component);
        println!("component {component}: {worst:.2} standard errors, sd ratio {ratio:.3}");
        // Some twenty independent stretches: four standard errors are one case in a thousand.
        assert!(worst < 4.5, "component {component}: {worst} standard errors");
        assert!((ratio - 1.0).abs() < 0.1, "component {component}: sd ratio {ratio}");
    }
    let frequency = mixture::estimate(&posterior.unknown(FREQUENCY));
    let from = posterior.linearised.point.decay.natural_frequency_rad_s;
    let below = draws.iter().filter(|d| from + d.unknowns[FREQUENCY] < frequency.hi95).count();
    // 97.5 % of a thousand, give or take three standard deviations.
    assert!((960..=990).contains(&below), "{below} of {N_DRAWS} below the upper end");
}

#[test]
fn draws_of_a_lawful_decay_fill_its_bands() {
    let mut solved = solve(&run(|_, _| 0.0)).expect("a plain decay");
    assert!(solved.posterior.probability(|_, d| d.misfit.is_some()) < 0.5);
    assert_agreement(&mut solved.posterior);
}

#[test]
fn draws_of_a_decay_with_a_hidden_moment_fill_its_bands() {
    let hidden = |t: f64, rate: f64| 0.4 * rate * (0.9 * t).sin();
    let mut solved = solve(&run(hidden)).expect("a decay");
    let misfit = solved.posterior.probability(|_, d| d.misfit.is_some());
    assert!(misfit > 0.95, "{misfit}");
    assert_agreement(&mut solved.posterior);
}
