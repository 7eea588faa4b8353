//! What people have judged, laid over what was found: the last step before results are told.

use super::collect::froude_laws;
use crate::judgement::{Judgement, Judgements};
use crate::results::{RejectedStretch, Results};

/// The results without the runs that were rejected by hand, which stand behind the other stretches
/// not used; notes are among the remarks of their runs, and the laws are those of what is left.
pub fn judged(mut results: Results, judgements: &Judgements) -> Results {
    let found = std::mem::take(&mut results.runs);
    for mut run in found {
        let (start_s, end_s) = (run.run.start_s, run.run.end_s);
        if let Some(rejection) = judgements.rejection(&run.recording, start_s, end_s) {
            let Judgement { at, by, why, .. } = rejection;
            let why = if why.is_empty() { "no reason given" } else { why };
            results.rejected.push(RejectedStretch {
                recording: run.recording,
                start_s,
                end_s,
                reason: format!("rejected by hand by {by}, {at}: {why}"),
                run: Some(run.id),
            });
            continue;
        }
        for note in judgements.notes(&run.recording, start_s, end_s) {
            run.identification.remarks.push(note.remark());
        }
        results.runs.push(run);
    }
    results.froude_laws = froude_laws(&results);
    results
}
