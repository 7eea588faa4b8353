//! Replaying a campaign with progress on the terminal, for every command that needs its runs.

use std::path::Path;

use ::replay::{Note, Severity};

use super::method::Identifying;
use super::terminal::Terminal;
use super::{Exit, Failure};
use crate::campaign::Campaign;
use crate::pipeline::{self, Learnt, Observed, Options, Progress};
use crate::report;
use crate::results::Results;

/// What a replay brought.
pub(super) struct Replayed {
    /// Runs, rejections, laws.
    pub(super) results: Results,
    /// Done, or incomplete when data was lost, or a listed recording or the whole campaign gave no
    /// run.
    pub(super) exit: Exit,
}

/// Replays a campaign; with a folder, writes each run's page there at once and the rest at the end.
pub(super) fn replay(
    campaign: &Campaign,
    identifying: Identifying,
    speed: Option<f64>,
    into: Option<&Path>,
) -> Result<Replayed, Failure> {
    let (method, seed) = (identifying.method(), identifying.seed());
    replay_with(campaign, Options { method, seed, speed, keep_histories: false }, into)
}

/// Replays a campaign and keeps the histories of all its runs in memory.
pub(super) fn with_histories(
    campaign: &Campaign,
    identifying: Identifying,
) -> Result<Replayed, Failure> {
    let (method, seed) = (identifying.method(), identifying.seed());
    replay_with(campaign, Options { method, seed, ..Options::default() }, None)
}

fn replay_with(
    campaign: &Campaign,
    options: Options,
    into: Option<&Path>,
) -> Result<Replayed, Failure> {
    let terminal = Terminal::new();
    let mut n_lost = 0;
    let mut observed = Observed::default();
    let results = pipeline::replay(
        campaign,
        &options,
        &mut |progress| match progress {
            Progress::Read { recording, bytes_read, bytes_total, n_runs } => {
                let message = format!("{recording}, {n_runs} runs");
                terminal.show(bytes_read, bytes_total, message);
            }
            Progress::Ended { recording, notes } => {
                n_lost += terminal.pause(|| log_notes(recording, notes));
            }
        },
        &mut |learnt| {
            if into.is_some() {
                observed.hear(learnt, campaign);
            }
            let Learnt::Run(run, overview) = learnt else { return Ok(()) };
            terminal.line(&format!("{}  Fr {:.3}  {}", run.id, run.froude, run.condition));
            if let Some(dir) = into {
                pipeline::write_run_page(campaign, run, overview, dir)?;
            }
            Ok(())
        },
    )?;
    drop(terminal);
    if let Some(dir) = into {
        let observed = observed.judged(&campaign.judgements);
        for reason in observed.left_out() {
            tracing::warn!("left out of the diagnosis: {reason}");
        }
        let diagnosis = observed.diagnosed(campaign);
        pipeline::write_appendix(campaign, &options, dir)?;
        pipeline::write_results(campaign, &results, diagnosis.as_ref(), dir)?;
        report::write_diagnosis(campaign, diagnosis.as_ref(), dir)
            .map_err(pipeline::WriteError::from)?;
    }
    for sentence in pipeline::without_runs(&results) {
        tracing::warn!("{sentence}");
    }
    let complete = n_lost == 0 && !pipeline::is_unanswered(campaign, &results);
    Ok(Replayed { results, exit: if complete { Exit::Done } else { Exit::Incomplete } })
}

/// Logs what was mended or lost in a recording; returns how many things were lost.
pub(super) fn log_notes(recording: &str, notes: &[Note]) -> usize {
    for note in notes {
        match note.severity {
            Severity::Lost => tracing::error!("recording \"{recording}\": {}", note.message),
            Severity::Mended => tracing::warn!("recording \"{recording}\": {}", note.message),
        }
    }
    notes.iter().filter(|note| note.severity == Severity::Lost).count()
}
