//! The same work for many things, on every core, with answers in their order.

use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

thread_local! {
    /// Whether this thread already is one of several at work.
    static AT_WORK: Cell<bool> = const { Cell::new(false) };
}

/// Does the work for the numbers below `n`; what such work shares out again stays on its core.
///
/// The answers do not depend on the number of cores.
pub(in crate::diagnosis) fn each<T: Send>(n: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let n_threads = thread::available_parallelism().map_or(1, usize::from).min(n);
    if n_threads < 2 || AT_WORK.get() {
        return (0..n).map(work).collect();
    }
    let (next, work) = (AtomicUsize::new(0), &work);
    let mut answers: Vec<(usize, T)> = thread::scope(|scope| {
        let toil = || {
            AT_WORK.set(true);
            let taken = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
            taken.take_while(|k| *k < n).map(|k| (k, work(k))).collect::<Vec<_>>()
        };
        let threads: Vec<_> = (1..n_threads).map(|_| scope.spawn(toil)).collect();
        let mut answers = toil();
        AT_WORK.set(false);
        for thread in threads {
            match thread.join() {
                Ok(more) => answers.extend(more),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        answers
    });
    answers.sort_by_key(|(k, _)| *k);
    answers.into_iter().map(|(_, answer)| answer).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_come_in_order_and_work_within_work_is_done_too() {
        let squares = each(100, |k| each(k % 3, |j| j).len() + k * k);
        assert_eq!(squares, (0..100).map(|k| k * k + k % 3).collect::<Vec<_>>());
    }
}
