//! Results on standard output, for people or for programs.

use std::io::{self, Write};

use crate::campaign::Campaign;
use crate::report;
use crate::results::Results;

/// Stretches told on a terminal; the JSON and the report hold every one.
const STRETCHES_TOLD: usize = 10;

/// The damping table, the laws and what was left out.
pub(super) fn human(out: &mut dyn Write, results: &Results) -> io::Result<()> {
    writeln!(out, "{}", report::damping_table(results).trim_end())?;
    not_used(out, results)?;
    let (_, changeovers) = results.refusals_and_changeovers();
    if !changeovers.is_empty() {
        let n = changeovers.len();
        writeln!(out, "\n{n} changeovers between excitations left out; the report lists them")?;
    }
    Ok(())
}

/// The first of the stretches that were not used, with their reasons.
pub(super) fn not_used(out: &mut dyn Write, results: &Results) -> io::Result<()> {
    let (refused, _) = results.refusals_and_changeovers();
    if !refused.is_empty() {
        writeln!(out, "\nnot used:")?;
    }
    for stretch in refused.iter().take(STRETCHES_TOLD) {
        let (recording, start_s, end_s) = (&stretch.recording, stretch.start_s, stretch.end_s);
        writeln!(out, "  {recording}  {start_s:.2} to {end_s:.2} s: {}", stretch.reason)?;
    }
    if let Some(more) = refused.len().checked_sub(STRETCHES_TOLD).filter(|more| *more > 0) {
        writeln!(out, "  and {more} more; the report and --json hold every one")?;
    }
    Ok(())
}

/// The identification in the versioned JSON of the contract.
pub(super) fn json(out: &mut dyn Write, campaign: &Campaign, results: &Results) -> io::Result<()> {
    out.write_all(report::identification_json(campaign, results).as_bytes())
}
