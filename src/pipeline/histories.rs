//! Letting go of what only a run's own page shows, sample by sample.

use crate::inverse::identification::{MomentHistory, Resimulation};
use crate::results::IdentifiedRun;
use crate::run::Series;

/// Keeps the numbers of a run and drops its histories, so that a day of runs fits into memory.
pub(super) fn drop_from(run: &mut IdentifiedRun) {
    run.run.roll = Series::default();
    run.run.drive = Series::default();
    let identification = &mut run.identification;
    identification.moment = MomentHistory::default();
    identification.least_squares_per_s2 = Vec::new();
    let rmse_rad = identification.resimulation.rmse_rad;
    identification.resimulation = Resimulation { rmse_rad, ..Resimulation::default() };
    if let Some(forced) = &mut identification.forced {
        forced.moment_time_s = Vec::new();
        forced.moment_n_m = Vec::new();
    }
    if let Some(chain) = &mut identification.chain {
        chain.traces = Vec::new();
    }
}
