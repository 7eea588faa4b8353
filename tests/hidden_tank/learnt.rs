//! What the true model learns of the damping of a pass from the recordings of the other runs.

use super::base::{Base, froude};
use super::campaign::{Campaign, hiding};
use super::fit::{START_SD, off_target, recorded, started};
use super::foretold::Stretch;
use super::least_squares::{Part, minimise, solve};
use super::plan::Pass;

/// Unknowns of one run: its start, and the factors on its linear and cubic damping.
const OWN: usize = 4;
/// Steps of the derivatives to either side, wide against those of a coarse converter.
pub(super) const STEPS: [f64; OWN] = [5e-3, 5e-3, 0.02, 0.02];
/// Standard deviation of what a factor and its law may be, before any recording.
const FACTOR_SD: f64 = 1.0;
/// Rounds of a search.
pub(super) const ROUNDS: usize = 12;

/// The factors on linear and cubic damping that one run shows to who knows all else of it.
pub(super) struct Shown {
    /// Its pass.
    pub(super) pass: Pass,
    factors: [f64; 2],
    covariance: [[f64; 2]; 2],
}

/// What a run shows of its own damping.
pub(super) fn shown(campaign: &Campaign, run: &Stretch) -> Shown {
    let pass = &campaign.passes[run.pass];
    let mut acting = hiding(&campaign.effects);
    for hidden in &mut acting {
        hidden.plan(&mut campaign.passes.clone());
    }
    let target = recorded(campaign.rows(pass, true), [run.from_s, run.to_s], pass.clone());
    let base = campaign.base_of(pass);
    let off = |x: &[f64]| {
        let pass = Pass { scatter: [x[2], x[3]], ..pass.clone() };
        off_target(&target, pass, base, &acting, [x[0], x[1]], target.pass.is_forced())
    };
    let start = started(&target);
    let factor = (1.0, FACTOR_SD);
    let priors = [(start[0], START_SD), (start[1], START_SD), factor, factor];
    // The search sets out from the truth, which is near.
    let x = vec![start[0], start[1], pass.scatter[0], pass.scatter[1]];
    let least = minimise(x, &priors, ROUNDS, |x, with_slopes| {
        vec![Part { residuals: off(x), slopes: slopes(x, with_slopes, &off) }]
    });
    let column = |factor: usize| {
        let mut unit = [0.0; OWN];
        unit[factor] = 1.0;
        let column = solve(&least.matrix, &unit, 0.0).expect("the priors know every unknown");
        [column[2], column[3]]
    };
    let factors = [least.x[2], least.x[3]];
    Shown { pass: pass.clone(), factors, covariance: [column(2), column(3)] }
}

/// Central differences of what is off by each unknown that has a step; none unless wanted.
pub(super) fn slopes(
    x: &[f64],
    are_wanted: bool,
    off: &impl Fn(&[f64]) -> Vec<f64>,
) -> Vec<(usize, Vec<f64>)> {
    let slope = |unknown: usize| {
        let [above, below] = [1.0, -1.0].map(|side| {
            let mut moved = x.to_vec();
            moved[unknown] += side * STEPS[unknown];
            off(&moved)
        });
        let rise = |(a, b): (&f64, &f64)| (a - b) / (2.0 * STEPS[unknown]);
        (unknown, above.iter().zip(&below).map(rise).collect())
    };
    (0..x.len()).filter(|_| are_wanted).map(slope).collect()
}

/// The factors to expect in a pass: `B0` and its growth with speed, and the cubic damping, by
/// least squares through what other runs show, each as sure as it is and as alike as runs are.
pub(super) fn learnt(base: &Base, pass: &Pass, others: &[&Shown], scatter: f64) -> [f64; 2] {
    // Of a lawful damping the share that speed brings: its factor is a line over it.
    let share = |pass: &Pass| 1.0 - base.b0 / base.linear(froude(pass.speed_m_s));
    let mut matrix: Vec<f64> =
        (0..9).map(|i| if i % 4 == 0 { FACTOR_SD.powi(-2) } else { 0.0 }).collect();
    let mut gradient = vec![0.0; 3];
    for other in others {
        let [[a, b], [_, c]] = other.covariance;
        let (a, c) = (a + scatter * scatter, c + scatter * scatter);
        let sure = [[c, -b], [-b, a]].map(|row| row.map(|value| value / (a * c - b * b)));
        // Rows of the law: level and growth of the linear factor, and the cubic one.
        let rows = [[1.0, share(&other.pass), 0.0], [0.0, 0.0, 1.0]];
        for (f, g) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            for i in 0..3 {
                gradient[i] += rows[f][i] * sure[f][g] * (other.factors[g] - 1.0);
                for j in 0..3 {
                    matrix[3 * i + j] += rows[f][i] * sure[f][g] * rows[g][j];
                }
            }
        }
    }
    let [level, growth, cubic] = solve(&matrix, &gradient, 0.0)
        .and_then(|law| law.try_into().ok())
        .expect("the priors know every unknown");
    [1.0 + level + growth * share(pass), 1.0 + cubic]
}
