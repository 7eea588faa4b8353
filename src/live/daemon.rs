//! The daemon: one session after the other until it is asked to end.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::{self, JoinHandle};

use devices::clock::WallClock;
use replay::{ClosedRecording, Finished, ReplayError};
use tokio::runtime::Runtime;
use tokio::signal::unix::{SignalKind, signal};
use tokio::sync::mpsc;

use super::diagnosing::Diagnoser;
use super::ended::Ended;
use super::error::LiveError;
use super::keeping::recover;
use super::reporting::write;
use super::session::{self, Lent, Plan};
use super::supervisor::Supervisor;
use crate::campaign::{self, Campaign, FILE_NAME};
use crate::judgement::Judgements;
use crate::page::{Board, Listen, Order, Orders, Served, runtime, serve};
use crate::pipeline::{self, Options};
use crate::results::Results;

/// How the daemon works.
#[derive(Debug, Clone, PartialEq)]
pub struct DaemonOptions {
    /// The campaign's folder.
    pub folder: PathBuf,
    /// Age [s] at which a recording gives way to the next when the model is at rest.
    pub rotate_s: f64,
    /// Where the page is served, if anywhere.
    pub listen: Option<Listen>,
}

/// Records, identifies and reports until a signal or an order ends it; what the campaign has
/// taught by then, where that is known.
///
/// # Errors
/// [`LiveError`] when it cannot begin, or a recording cannot be finished; its part is kept.
pub fn run(
    options: &DaemonOptions,
    clock: &Arc<WallClock>,
    (sender, mut orders): (Orders, mpsc::Receiver<Order>),
    board: &Board,
) -> Result<Option<Results>, LiveError> {
    let runtime =
        runtime().map_err(|source| LiveError::System { what: "runtime".to_owned(), source })?;
    listen_to_signals(&runtime, &sender)?;
    let mut campaign = live_campaign(&options.folder)?;
    board.judge(|judgements| judgements.clone_from(&campaign.judgements));
    if let Some(listen) = &options.listen {
        let (board, folder) = (board.clone(), options.folder.clone());
        let served = Served { board: board.clone(), folder, orders: sender.clone() };
        let page = serve(&runtime, listen, served)?;
        board.change(|status| status.page = Some(page));
    }
    recover(&options.folder)?;
    // What was recovered is a recording of the campaign now.
    campaign.recordings = live_campaign(&options.folder)?.recordings;
    let mut supervisor = Supervisor::new();
    let mut text = text_of(&options.folder)?;
    let mut earlier = None;
    let mut diagnoser = Diagnoser::start(campaign.clone(), board, sender.clone());
    let mut converting = Converting::default();
    let (mut paused_by, mut awaits_room, mut taken_over) = (None, false, None);
    let mut left_off = Vec::new();
    loop {
        let plan = Plan {
            text: text.clone(),
            campaign: campaign.clone(),
            earlier,
            diagnoser: diagnoser.clone(),
            rotate_s: options.rotate_s,
            paused_by: paused_by.clone(),
            awaits_room,
            taken_over: taken_over.take(),
            left_off,
        };
        let handle = runtime.handle();
        let lent = Lent {
            runtime: handle,
            clock,
            orders: &mut orders,
            board,
            supervisor: &mut supervisor,
        };
        let left = session::run(plan, lent)?;
        left.closed.map_or(Ok(()), |closed| converting.start(closed))?;
        (earlier, taken_over, left_off) = (left.results, left.handed_over, left.last_heard);
        awaits_room = matches!(left.ended, Ended::BrokenOff);
        match left.ended {
            Ended::Terminated => {
                converting.finish()?;
                campaign.recordings = left.recordings;
                return Ok(earlier.map(|found| last_told(&campaign, found, &diagnoser, board)));
            }
            Ended::Rotated | Ended::RoomAgain | Ended::BrokenOff => {
                campaign.recordings = left.recordings;
            }
            Ended::Paused(by) => (campaign.recordings, paused_by) = (left.recordings, Some(by)),
            Ended::Resumed => (campaign.recordings, paused_by) = (left.recordings, None),
            Ended::Reloaded(new) if particulars(&new.campaign) == particulars(&campaign) => {
                campaign = Campaign { recordings: left.recordings, ..new.campaign };
                text = new.text;
            }
            Ended::Reloaded(new) => {
                // Another model or tank: every recording says something else under it.
                // What could not be finished was told, and is no reason to stop recording.
                converting.finish().ok();
                let read = live_campaign(&options.folder).map(|read| read.recordings);
                let recordings = read.unwrap_or(left.recordings);
                campaign = Campaign { recordings, ..new.campaign };
                (text, earlier) = (new.text, None);
                diagnoser = Diagnoser::start(campaign.clone(), board, sender.clone());
            }
        }
    }
}

/// The results as people have judged them, written with the diagnosis of every run.
fn last_told(campaign: &Campaign, found: Results, diagnoser: &Diagnoser, board: &Board) -> Results {
    let results = pipeline::judged(found, &board.judgements());
    let diagnosis = diagnoser.last(campaign);
    let dir = pipeline::results_folder(campaign);
    if let Err(error) = pipeline::write_appendix(campaign, &Options::default(), &dir) {
        tracing::error!("appendix not written: {error}");
    }
    write(campaign, &results, diagnosis.as_deref(), &dir);
    results
}

/// Conversions of finished recordings, on threads of their own.
#[derive(Default)]
struct Converting {
    threads: Vec<Conversion>,
}

type Conversion = JoinHandle<Result<Finished, ReplayError>>;

impl Converting {
    fn start(&mut self, closed: ClosedRecording) -> Result<(), LiveError> {
        self.threads.extract_if(.., |thread| thread.is_finished()).for_each(|thread| {
            // It was told, and the part of what failed is kept.
            joined(thread).ok();
        });
        let thread = thread::Builder::new().name("convert".to_owned());
        let system = |source| LiveError::System { what: "thread".to_owned(), source };
        self.threads.push(thread.spawn(move || closed.convert()).map_err(system)?);
        Ok(())
    }

    /// Waits for all of them; every error is told, and the first one returned.
    fn finish(&mut self) -> Result<(), LiveError> {
        let all: Vec<_> = self.threads.drain(..).map(joined).collect();
        all.into_iter().collect()
    }
}

/// Waits for a conversion and tells what came of it.
fn joined(thread: Conversion) -> Result<(), LiveError> {
    match thread.join() {
        Ok(Ok(finished)) => {
            let path = finished.path.display().to_string();
            tracing::info!(path, file_bytes = finished.file_bytes, "recording finished");
            Ok(())
        }
        Ok(Err(error)) => {
            tracing::error!("recording not finished, its part is kept: {error}");
            Err(error.into())
        }
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

/// Turns SIGTERM, SIGINT and SIGHUP into orders.
fn listen_to_signals(runtime: &Runtime, orders: &Orders) -> Result<(), LiveError> {
    let signals = [
        (SignalKind::terminate(), Order::Terminate),
        (SignalKind::interrupt(), Order::Terminate),
        (SignalKind::hangup(), Order::Reload),
    ];
    let _inside = runtime.enter();
    for (kind, order) in signals {
        let what = || "signal".to_owned();
        let system = |source| LiveError::System { what: what(), source };
        let mut signals = signal(kind).map_err(system)?;
        let orders = orders.clone();
        runtime.spawn(async move {
            while signals.recv().await.is_some() {
                if orders.send(order.clone()).await.is_err() {
                    return;
                }
            }
        });
    }
    Ok(())
}

/// What results depend on beside the recordings; while it stays, they need not be made again.
fn particulars(campaign: &Campaign) -> Campaign {
    let live = campaign::Live::default();
    // What people judge is laid over results, whatever file they were made under.
    let judgements = Judgements::default();
    Campaign { recordings: Vec::new(), live, judgements, ..campaign.clone() }
}

fn live_campaign(folder: &Path) -> Result<Campaign, LiveError> {
    let campaign = campaign::read(folder)?;
    if campaign.live.devices.is_empty() {
        return Err(LiveError::NoDevices { folder: folder.to_owned() });
    }
    Ok(campaign)
}

fn text_of(folder: &Path) -> Result<String, LiveError> {
    let path = folder.join(FILE_NAME);
    fs::read_to_string(&path).map_err(|source| LiveError::File { path, source })
}
