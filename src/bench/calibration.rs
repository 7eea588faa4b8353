//! How often the bands of a decay hold the truth, over runs drawn from what tanks see.

use std::thread;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use statrs::distribution::{ContinuousCDF, Normal};

use super::drawn_run::{DrawnCampaign, DrawnRun, FROUDE};
use super::paper_hyperpriors;
use super::ranks::Ranks;
use crate::inverse::decay::fit::FREQUENCY;
use crate::inverse::decay::{Solved, equivalent, half_cycles, moment, solve};
use crate::inverse::froude_law::{self, Point};
use crate::inverse::mixture;

/// Amplitudes at which the equivalent damping is judged, as shares of the initial one.
pub(super) const AMPLITUDES: [(f64, &str); 3] =
    [(0.75, "b_eq at 75 %"), (0.5, "b_eq at 50 %"), (0.3, "b_eq at 30 %")];

/// Every rank of a calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// One entry a quantity.
    pub ranks: Vec<Ranks>,
    /// The same for the paper's printed hyperpriors, by its plain fit.
    pub paper: Vec<Ranks>,
    /// Runs that were refused, each with the reason.
    pub refused: Vec<String>,
}

/// What one run adds: quantity and probability below its truth.
type Told = Vec<(&'static str, f64)>;

/// What one campaign adds.
#[derive(Default)]
struct CampaignTold {
    exact: Told,
    paper: Told,
    refused: Vec<String>,
}

/// Calibrates over `n_campaigns` campaigns of five runs each; every number follows from `seed`.
pub fn calibrate(n_campaigns: usize, seed: u64) -> Calibration {
    let of = |index: usize| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(index as u64);
        campaign(&mut rng)
    };
    let half = |parity: usize| (0..n_campaigns).filter(move |i| i % 2 == parity);
    let all: Vec<CampaignTold> = thread::scope(|scope| {
        let odd = scope.spawn(|| half(1).map(of).collect::<Vec<_>>());
        let even: Vec<CampaignTold> = half(0).map(of).collect();
        let odd = odd.join().unwrap_or_default();
        let mut odd = odd.into_iter();
        even.into_iter().flat_map(|even| [Some(even), odd.next()]).flatten().collect()
    });
    let mut calibration = Calibration { ranks: Vec::new(), paper: Vec::new(), refused: Vec::new() };
    for told in all {
        add(&mut calibration.ranks, told.exact);
        add(&mut calibration.paper, told.paper);
        calibration.refused.extend(told.refused);
    }
    calibration
}

fn add(ranks: &mut Vec<Ranks>, told: Told) {
    for (name, below) in told {
        if !ranks.iter().any(|r| r.name == name) {
            ranks.push(Ranks::new(name));
        }
        ranks.iter_mut().filter(|r| r.name == name).for_each(|r| r.below.push(below));
    }
}

fn campaign(rng: &mut ChaCha8Rng) -> CampaignTold {
    let campaign = DrawnCampaign::draw(rng);
    let mut told = CampaignTold::default();
    let (mut points, mut paper_points) = (Vec::new(), Vec::new());
    for froude in FROUDE {
        let drawn = DrawnRun::draw(&campaign, froude, rng);
        let instant = rng.random::<f64>();
        match solve(&drawn.run) {
            Err(reason) => told.refused.push(reason),
            Ok(solved) => {
                told.exact.extend(of_run(&drawn, &solved, instant));
                if let Some(paper) = paper_hyperpriors::of_run(&drawn, &solved, instant) {
                    told.paper.extend(paper.below);
                    paper_points.push(paper.point);
                }
                points.push(Point {
                    froude,
                    b1_per_s: mixture::estimate(&solved.posterior.cubic_law(1.0, 0.0)),
                    b3_s: mixture::estimate(&solved.posterior.cubic_law(0.0, 1.0)),
                });
            }
        }
    }
    for (points, told) in [(points, &mut told.exact), (paper_points, &mut told.paper)] {
        if points.len() == FROUDE.len() {
            told.push(("kappa", froude_law::probability_below(&points, campaign.kappa)));
        }
    }
    told
}

/// The ranks of one run; the moment is looked at where `instant` [-] of the record has passed.
fn of_run(drawn: &DrawnRun, solved: &Solved, instant: f64) -> Told {
    let posterior = &solved.posterior;
    let motion = moment::motion(posterior);
    let cycles = solved.half_cycles(&motion);
    let sample = (instant * motion.mean.len() as f64) as usize;
    let time_s = solved.thinned.origin_s + solved.thinned.time_s[sample];
    let truth = &drawn.truth;
    let (mean, sd) = (motion.mean[sample][2], motion.sd[sample][2]);
    let below = |z: f64| Normal::standard().cdf(z);
    let mut told = vec![("U(t)", below((drawn.moment_per_s2(time_s) - mean) / sd))];
    let w = solved.unknown(FREQUENCY).mean;
    let b3_s = mixture::estimate(&posterior.cubic_law(0.0, 1.0)).mean;
    for (share, name) in AMPLITUDES {
        let amplitude_rad = share * drawn.amplitude_rad;
        let near = half_cycles::local_damping(&cycles, amplitude_rad, b3_s);
        let components = equivalent::components(posterior, w, amplitude_rad, near);
        told.push((name, mixture::cdf(&components, drawn.equivalent_per_s(amplitude_rad))));
    }
    told.push(("b1", mixture::cdf(&posterior.cubic_law(1.0, 0.0), truth.b1_per_s)));
    told.push(("b3", mixture::cdf(&posterior.cubic_law(0.0, 1.0), truth.b3_s)));
    let frequency = posterior.unknown(FREQUENCY);
    told.push(("natural frequency", mixture::cdf(&frequency, truth.natural_frequency_rad_s)));
    told
}
