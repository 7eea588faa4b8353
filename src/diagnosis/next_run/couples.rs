//! Two runs that may decide together, and of many which says most.

use super::foretold::RELINEARISED;
use super::plan::Plan;
use crate::diagnosis::fit::cores;
use crate::run::RunKind;

/// Times that rivals are linearised to tell a couple of runs roughly.
const ROUGHLY: usize = 2;
/// Couples that are told in full before it is seen whether another may say more.
const TOLD_AT_ONCE: usize = 8;
/// How much more a later run must say than an earlier one to be asked for instead.
const NEARLY: f64 = 1.05;

/// The couple of runs that says most, with what `told` says of it; `told` is given the places of
/// the runs and how often their rivals are linearised, `best` is the run that says most alone.
///
/// Told roughly a couple says too much, for its rivals have not come as near as they can: one that
/// says less then than another in full is not the best.
pub(super) fn best_couple(
    plans: &[(Plan, f64)],
    best: usize,
    told: impl Fn([usize; 2], usize) -> f64 + Sync,
) -> Option<(f64, [usize; 2])> {
    let couples = couples(plans, best);
    let roughly = cores::each(couples.len(), |k| told(couples[k], ROUGHLY));
    let mut order: Vec<usize> = (0..couples.len()).filter(|k| roughly[*k].is_finite()).collect();
    order.sort_by(|a, b| roughly[*b].total_cmp(&roughly[*a]));
    let mut logs = vec![f64::NAN; couples.len()];
    let mut largest = f64::NEG_INFINITY;
    for some in order.chunks(TOLD_AT_ONCE) {
        if NEARLY * roughly[some[0]] <= largest {
            break;
        }
        let in_full = cores::each(some.len(), |i| told(couples[some[i]], RELINEARISED));
        for (k, log) in some.iter().zip(in_full) {
            logs[*k] = log;
            largest = largest.max(log);
        }
    }
    most(logs.into_iter()).map(|(log, k)| (log, couples[k]))
}

/// The place of what says most: of those that say much the same, the first.
pub(super) fn most(logs: impl Iterator<Item = f64>) -> Option<(f64, usize)> {
    let finite = logs.enumerate().filter(|(_, log)| log.is_finite());
    finite.fold(None, |best, (k, log)| match best {
        Some((most, _)) if log <= NEARLY * most => best,
        _ => Some((log, k)),
    })
}

/// Places of two runs that may decide together: the rod at two speeds, or any run beside the best.
fn couples(plans: &[(Plan, f64)], best: usize) -> Vec<[usize; 2]> {
    let mut all: Vec<_> = (0..plans.len()).map(|other| [best, other]).collect();
    for (k, (one, _)) in plans.iter().enumerate() {
        let is_like = |(other, _): &(Plan, f64)| Plan { froude: one.froude, ..*other } == *one;
        let others = k + 1..plans.len();
        let at_other_speed = others.filter(|j| one.kind == RunKind::Forced && is_like(&plans[*j]));
        all.extend(at_other_speed.map(|other| [k, other]));
    }
    all
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn the_best_couple_is_found_without_telling_all_of_them_in_full() {
        let plan = |k: usize| {
            let (froude, amplitude_deg) = (0.1 * (k % 3) as f64, 5.0 + k as f64);
            (Plan { kind: RunKind::Decay, froude, amplitude_deg, tuning: 1.0 }, 20.0)
        };
        let plans: Vec<_> = (0..60).map(plan).collect();
        let n_in_full = AtomicUsize::new(0);
        // Roughly told, each says half as much again.
        let told = |[_, other]: [usize; 2], rounds: usize| {
            let in_full = 30.0 - (other as f64 - 41.0).abs();
            if rounds < RELINEARISED {
                return 1.5 * in_full;
            }
            n_in_full.fetch_add(1, Ordering::Relaxed);
            in_full
        };
        // Those that say nearly as much come first.
        let expected = most((0..60).map(|other| told([7, other], RELINEARISED)));
        n_in_full.store(0, Ordering::Relaxed);
        let (log, couple) = best_couple(&plans, 7, told).expect("one is best");
        assert_eq!((Some((log, couple[1])), couple[0]), (expected, 7));
        assert!(n_in_full.into_inner() < 40);
    }
}
