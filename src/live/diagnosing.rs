//! The diagnosis beside the reports: on the campaign so far, in the background, one at a time.

use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use crate::campaign::Campaign;
use crate::diagnosis::Diagnosis;
use crate::page::{Board, Order, Orders};
use crate::pipeline::{self, Learnt, Observed};
use crate::report;

/// A diagnosis that several look at.
pub(super) type Diagnosed = Arc<Diagnosis>;

/// What is known of the runs so far.
#[derive(Default)]
struct Known {
    observed: Observed,
    /// Runs heard and judgements made when the newest diagnosis was.
    of: (usize, usize),
    diagnosis: Option<Diagnosed>,
}

/// Diagnoses whenever there are new runs; what it looks at is bounded, and so is its time.
#[derive(Clone)]
pub(super) struct Diagnoser {
    known: Arc<Mutex<Known>>,
    board: Board,
    ask: SyncSender<()>,
}

impl Diagnoser {
    /// Starts its thread, which ends when the last of its handles is gone; who wants to hear of
    /// every new diagnosis is asked to tell again.
    pub(super) fn start(campaign: Campaign, board: &Board, orders: Orders) -> Self {
        // One question waits while another is answered; more would be the same question.
        let (ask, asked) = sync_channel(1);
        let observed = Observed::on_disk(&pipeline::results_folder(&campaign));
        let observed = observed.unwrap_or_else(|error| {
            tracing::warn!("runs are kept in memory for the diagnosis: {error}");
            Observed::default()
        });
        let known = Arc::new(Mutex::new(Known { observed, ..Known::default() }));
        let (own, own_board) = (Arc::clone(&known), board.clone());
        thread::spawn(move || answer(&campaign, &own, &own_board, (&asked, &orders)));
        Self { known, board: board.clone(), ask }
    }

    /// Takes a run whose histories are still with it, or what came after one.
    pub(super) fn hear(&self, learnt: Learnt<'_>, campaign: &Campaign) {
        lock(&self.known).observed.hear(learnt, campaign);
    }

    /// Asks for a diagnosis of what was heard; the answer comes when it comes.
    pub(super) fn ask(&self) {
        self.ask.try_send(()).ok();
    }

    /// The newest diagnosis.
    pub(super) fn newest(&self) -> Option<Diagnosed> {
        lock(&self.known).diagnosis.clone()
    }

    /// The diagnosis of all that was heard.
    pub(super) fn last(&self, campaign: &Campaign) -> Option<Diagnosed> {
        diagnose(campaign, &self.known, &self.board);
        self.newest()
    }
}

fn answer(
    campaign: &Campaign,
    known: &Mutex<Known>,
    board: &Board,
    (asked, orders): (&Receiver<()>, &Orders),
) {
    while asked.recv().is_ok() {
        if diagnose(campaign, known, board) {
            // A full queue of orders ends in results that are told anyway.
            orders.try_send(Order::TellAgain).ok();
        }
    }
}

/// Diagnoses what was heard and not rejected by hand, if that is more than the newest diagnosis
/// knew, and writes its page; whether it is a new one.
fn diagnose(campaign: &Campaign, known: &Mutex<Known>, board: &Board) -> bool {
    let judgements = board.judgements();
    let (observed, of) = {
        let known = lock(known);
        let of = (known.observed.n_heard(), judgements.all().len());
        if of == known.of {
            return false;
        }
        (known.observed.clone().judged(&judgements), of)
    };
    let nothing_left = observed.is_empty();
    let mut diagnosis = observed.diagnosed(campaign);
    if diagnosis.is_none() && !nothing_left {
        return false;
    }
    // One writer at a time, and never an older diagnosis over a newer one.
    let mut known = lock(known);
    let is_newer = of > known.of;
    if is_newer {
        write(campaign, diagnosis.as_ref(), &pipeline::results_folder(campaign));
        diagnosis.iter_mut().for_each(Diagnosis::forget_moments);
        (known.of, known.diagnosis) = (of, diagnosis.map(Arc::new));
    }
    is_newer
}

fn write(campaign: &Campaign, diagnosis: Option<&Diagnosis>, dir: &Path) {
    if let Err(error) = report::write_diagnosis(campaign, diagnosis, dir) {
        tracing::error!("diagnosis not written: {error}");
    }
}

fn lock(known: &Mutex<Known>) -> std::sync::MutexGuard<'_, Known> {
    // A diagnosis that panicked left what was known as it was.
    known.lock().unwrap_or_else(PoisonError::into_inner)
}
