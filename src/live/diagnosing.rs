//! The diagnosis beside the reports: on the campaign so far, in the background, one at a time.

use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use crate::campaign::Campaign;
use crate::diagnosis::Diagnosis;
use crate::pipeline::{self, Observed};
use crate::report;
use crate::results::IdentifiedRun;

/// What is known of the runs so far.
#[derive(Default)]
struct Known {
    observed: Observed,
    /// Runs of the newest diagnosis.
    n_diagnosed: usize,
    diagnosis: Option<Arc<Diagnosis>>,
}

/// Diagnoses whenever there are new runs; what it looks at is bounded, and so is its time.
#[derive(Clone)]
pub(super) struct Diagnoser {
    known: Arc<Mutex<Known>>,
    ask: SyncSender<()>,
}

impl Diagnoser {
    /// Starts its thread, which ends when the last of its handles is gone.
    pub(super) fn start(campaign: Campaign) -> Self {
        // One question waits while another is answered; more would be the same question.
        let (ask, asked) = sync_channel(1);
        let known = Arc::new(Mutex::new(Known::default()));
        let own = Arc::clone(&known);
        thread::spawn(move || answer(&campaign, &own, &asked));
        Self { known, ask }
    }

    /// Takes a run whose histories are still with it.
    pub(super) fn hear(&self, run: &IdentifiedRun, campaign: &Campaign) {
        lock(&self.known).observed.hear(run, campaign);
    }

    /// Asks for a diagnosis of what was heard; the answer comes when it comes.
    pub(super) fn ask(&self) {
        self.ask.try_send(()).ok();
    }

    /// The newest diagnosis.
    pub(super) fn newest(&self) -> Option<Arc<Diagnosis>> {
        lock(&self.known).diagnosis.clone()
    }

    /// The diagnosis of all that was heard.
    pub(super) fn last(&self, campaign: &Campaign) -> Option<Arc<Diagnosis>> {
        diagnose(campaign, &self.known);
        self.newest()
    }
}

fn answer(campaign: &Campaign, known: &Mutex<Known>, asked: &Receiver<()>) {
    while asked.recv().is_ok() {
        diagnose(campaign, known);
    }
}

/// Diagnoses what was heard, if that is more than the newest diagnosis knew, and writes its page.
fn diagnose(campaign: &Campaign, known: &Mutex<Known>) {
    let (observed, n_heard) = {
        let known = lock(known);
        let n_heard = known.observed.n_heard();
        if n_heard == known.n_diagnosed {
            return;
        }
        (known.observed.clone(), n_heard)
    };
    let Some(diagnosis) = observed.diagnosed(campaign).map(Arc::new) else { return };
    // One writer at a time, and never an older diagnosis over a newer one.
    let mut known = lock(known);
    if n_heard > known.n_diagnosed {
        write(campaign, &diagnosis, &pipeline::results_folder(campaign));
        (known.n_diagnosed, known.diagnosis) = (n_heard, Some(diagnosis));
    }
}

fn write(campaign: &Campaign, diagnosis: &Diagnosis, dir: &Path) {
    if let Err(error) = report::write_diagnosis(campaign, Some(diagnosis), dir) {
        tracing::error!("diagnosis not written: {error}");
    }
}

fn lock(known: &Mutex<Known>) -> std::sync::MutexGuard<'_, Known> {
    // A diagnosis that panicked left what was known as it was.
    known.lock().unwrap_or_else(PoisonError::into_inner)
}
