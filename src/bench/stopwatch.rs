//! The one clock of the program: nothing that is computed depends on it.

use std::time::Instant;

/// Seconds that `work` takes, and what it gives.
#[expect(clippy::disallowed_methods, reason = "a figure of speed is a difference of two instants")]
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let out = work();
    (start.elapsed().as_secs_f64(), out)
}

/// Fewest seconds that `work` takes, over `n` times: what else the machine does only adds.
pub(super) fn fastest_s<T>(n: usize, mut work: impl FnMut() -> T) -> f64 {
    (0..n).map(|_| timed(|| std::hint::black_box(work())).0).fold(f64::INFINITY, f64::min)
}
