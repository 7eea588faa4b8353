//! The moment histories of all runs as one long table.

use super::{Cell, Table};
use crate::results::Results;

/// One row per instant of a run whose history is still kept.
pub(super) fn table(results: &Results) -> Table {
    let headers = [
        "id",
        "time [s]",
        "U mean [rad/s2]",
        "U sd [rad/s2]",
        "U lo95 [rad/s2]",
        "U hi95 [rad/s2]",
        "roll [rad]",
        "roll rate [rad/s]",
        "observable [rad]",
    ];
    let mut rows = Vec::new();
    for run in &results.runs {
        let moment = &run.identification.moment;
        let columns = [
            &moment.time_s,
            &moment.mean_per_s2,
            &moment.sd_per_s2,
            &moment.lo95_per_s2,
            &moment.hi95_per_s2,
            &moment.roll_rad,
            &moment.roll_rate_rad_per_s,
            &moment.observable_rad,
        ];
        for k in 0..moment.time_s.len() {
            let mut row = vec![Cell::Text(run.id.clone())];
            let at = |column: &&Vec<f64>| column.get(k).copied().unwrap_or(f64::NAN);
            row.extend(columns.iter().map(at).map(Cell::Number));
            rows.push(row);
        }
    }
    Table { name: "moment_history", headers: headers.map(str::to_owned).to_vec(), rows }
}
