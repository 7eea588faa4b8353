//! The run under way before its end is known: what it says if it ends now, told as provisional.
//!
//! Whether a run is over takes seconds to be sure of, and what it says some milliseconds. So the
//! loop offers the run so far now and then, a thread beside it identifies the newest offer when it
//! is free, and writes it as a report that the final one replaces. Nothing final waits for it, and
//! nothing of it enters a recording.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::Scope;

use devices::clock::Clock;

use crate::campaign::Campaign;
use crate::inverse::estimate::Estimate;
use crate::page::Board;
use crate::pipeline::{self, FoundRun, RunSoFar};
use crate::report::{self, PROVISIONAL_FILE, PROVISIONAL_ID};
use crate::results::{IdentifiedRun, Overview};

/// Time of the roll from one offer to the next [s]: some offers a half cycle of most models.
const EVERY_S: f64 = 0.25;

/// A report of a run whose end was not known yet.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Told {
    /// First and last instant of the run as it was then [s].
    pub(super) start_s: f64,
    pub(super) end_s: f64,
    /// When its last sample was taken, and when the report was on disk [ns].
    pub(super) offered_ns: u64,
    pub(super) at_ns: u64,
    /// Damping at the amplitude at which runs are compared.
    pub(super) damping_per_s: Option<Estimate>,
}

/// The loop's end: offers the run under way.
pub(super) struct Offers {
    shared: Arc<Shared>,
    ask: SyncSender<Option<Offer>>,
    offered_s: f64,
    /// Whether there was a run in the last offer.
    is_told: bool,
}

struct Offer {
    run: RunSoFar,
    at_ns: u64,
}

struct Shared {
    dir: PathBuf,
    board: Board,
    is_busy: AtomicBool,
    /// Until when the thread rests [ns], so that it works half of the time at most.
    rests_until_ns: AtomicU64,
    /// Number of the last run whose end is known.
    n_ended: AtomicU64,
    files: Mutex<Files>,
}

#[derive(Default)]
struct Files {
    /// Number of the run whose report is there, if any.
    of: Option<u64>,
    told: Vec<Told>,
}

/// The reporter's end: replaces what is provisional.
#[derive(Clone)]
pub(super) struct Provisional(Arc<Shared>);

/// Starts the thread, which ends when the loop's end is gone.
pub(super) fn start<'s, 'e>(
    scope: &'s Scope<'s, 'e>,
    campaign: &'e Campaign,
    board: &Board,
    clock: Arc<dyn Clock>,
) -> (Offers, Provisional) {
    let (ask, asked) = sync_channel(1);
    let shared = Arc::new(Shared {
        dir: pipeline::results_folder(campaign),
        board: board.clone(),
        is_busy: AtomicBool::new(false),
        rests_until_ns: AtomicU64::new(0),
        n_ended: AtomicU64::new(0),
        files: Mutex::default(),
    });
    // A daemon that was killed may have left some.
    shared.remove(&mut shared.files());
    let own = Arc::clone(&shared);
    scope.spawn(move || answer(campaign, &own, &asked, clock.as_ref()));
    let offers =
        Offers { shared: Arc::clone(&shared), ask, offered_s: f64::NEG_INFINITY, is_told: false };
    (offers, Provisional(shared))
}

impl Offers {
    /// Offers the run under way at a time of the roll [s], when that is due and the thread is free.
    pub(super) fn offer(
        &mut self,
        time_s: f64,
        at_ns: u64,
        so_far: impl FnOnce() -> Option<RunSoFar>,
    ) {
        let shared = &self.shared;
        let rests = at_ns < shared.rests_until_ns.load(Ordering::Acquire);
        if time_s < self.offered_s + EVERY_S || rests || shared.is_busy.load(Ordering::Acquire) {
            return;
        }
        self.offered_s = time_s;
        let offer = so_far().map(|run| Offer { run, at_ns });
        // What is no run any more is withdrawn, once.
        let was_told = std::mem::replace(&mut self.is_told, offer.is_some());
        if was_told || offer.is_some() {
            shared.is_busy.store(true, Ordering::Release);
            // It is free, and so there is room.
            self.ask.try_send(offer).ok();
        }
    }

    /// The end of a run is known: whatever is still said of it comes too late.
    pub(super) fn ended(&self, number: u64) {
        self.shared.n_ended.store(number, Ordering::Release);
    }
}

impl Provisional {
    /// The page of a run is there; gives what was told of it before.
    pub(super) fn told_of(&self, found: &FoundRun) -> Vec<Told> {
        let mut files = self.0.files();
        let told = std::mem::take(&mut files.told);
        let (before, after) = told.into_iter().partition(|told| told.start_s < found.end_s);
        files.told = after;
        let mut of_it: Vec<Told> = before;
        of_it.retain(|told| told.end_s > found.start_s);
        of_it
    }

    /// The results hold the runs up to that number, and nothing provisional of them is needed.
    pub(super) fn replaced(&self, number: u64) {
        let mut files = self.0.files();
        // Another run may be under way already, and told.
        if files.of.is_some_and(|told| told <= number) {
            self.0.remove(&mut files);
        }
    }

    /// The recording has ended, and the results hold its runs.
    pub(super) fn withdraw(&self) {
        self.0.remove(&mut self.0.files());
    }
}

impl Shared {
    fn files(&self) -> MutexGuard<'_, Files> {
        // Whoever panicked left at worst a file that is there.
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Removes what is there of a run that is none any more; one that has ended is replaced.
    fn withdraw(&self) {
        let mut files = self.files();
        if files.of.is_some_and(|number| number > self.n_ended.load(Ordering::Acquire)) {
            self.remove(&mut files);
        }
    }

    fn remove(&self, files: &mut Files) {
        for name in [page_name().as_str(), PROVISIONAL_FILE] {
            // It may never have been there.
            fs::remove_file(self.dir.join(name)).ok();
        }
        files.of = None;
        self.board.change(|status| status.provisional = None);
    }
}

fn answer(
    campaign: &Campaign,
    shared: &Shared,
    asked: &Receiver<Option<Offer>>,
    clock: &dyn Clock,
) {
    while let Ok(offer) = asked.recv() {
        let started_ns = clock.now_ns();
        if let Some(offer) = offer {
            tell(campaign, shared, offer, clock);
        } else {
            shared.withdraw();
        }
        let now_ns = clock.now_ns();
        shared.rests_until_ns.store(2 * now_ns - started_ns, Ordering::Release);
        shared.is_busy.store(false, Ordering::Release);
    }
}

fn tell(campaign: &Campaign, shared: &Shared, Offer { run, at_ns }: Offer, clock: &dyn Clock) {
    let number = run.number;
    // Half a run may be what nothing was made for, and nothing final may suffer from it.
    let identified = catch_unwind(AssertUnwindSafe(|| run.identify(campaign, PROVISIONAL_ID)));
    let Ok(identified) = identified else {
        return tracing::error!("the run under way could not be identified: a panic");
    };
    let Some((run, overview)) = identified else { return };
    let mut files = shared.files();
    // The final report is there, or will be at once.
    if number <= shared.n_ended.load(Ordering::Acquire) {
        return;
    }
    if let Err(error) = write(campaign, &run, &overview, &shared.dir) {
        tracing::error!("provisional report not written: {error}");
        return;
    }
    files.of = Some(number);
    files.told.push(Told {
        start_s: run.run.start_s,
        end_s: run.run.end_s,
        offered_ns: at_ns,
        at_ns: clock.now_ns(),
        damping_per_s: run.at_comparison().map(|at| at.fitted_per_s),
    });
    let words = report::provisional_words(&run);
    shared.board.change(|status| status.provisional = Some(words));
}

fn write(
    campaign: &Campaign,
    run: &IdentifiedRun,
    overview: &Overview,
    dir: &Path,
) -> Result<(), pipeline::WriteError> {
    pipeline::write_run_page(campaign, run, overview, dir)?;
    let text = report::provisional_json(campaign, run);
    report::write_whole(dir, PROVISIONAL_FILE, text.as_bytes())?;
    Ok(())
}

fn page_name() -> String {
    report::run_file_name(PROVISIONAL_ID).unwrap_or_default()
}
