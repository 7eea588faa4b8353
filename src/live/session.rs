//! One recording from its first byte to its last, with the threads that it takes.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::sync_channel;
use std::thread;

use devices::clock::{Clock, WallClock};
use replay::ClosedRecording;
use tokio::sync::mpsc;

use super::attaching::TakenOver;
use super::diagnosing::Diagnoser;
use super::ended::{Ended, LeftOff, Over};
use super::error::LiveError;
use super::keeping::{Keeper, fresh_name};
use super::provisional;
use super::reporting::Reporter;
use super::showing::show;
use super::supervisor::Supervisor;
use super::under_way::{State, UnderWay};
use crate::campaign::{Campaign, Recording};
use crate::judgement::Judgements;
use crate::page::{Board, Order};
use crate::pipeline::{self, Learnt, Options};
use crate::results::Results;

/// What a session is made of.
pub(super) struct Plan {
    /// The campaign, earlier recordings included.
    pub(super) campaign: Campaign,
    /// The text of its file.
    pub(super) text: String,
    /// What earlier recordings taught, when that is still known.
    pub(super) earlier: Option<Results>,
    /// What finds out what the simulation gets wrong, with the runs that it knows.
    pub(super) diagnoser: Diagnoser,
    /// Age [s] at which a recording gives way to the next when the model is at rest.
    pub(super) rotate_s: f64,
    /// Who does not want it recorded, if anybody.
    pub(super) paused_by: Option<String>,
    /// Whether it waits for the disk to have room.
    pub(super) awaits_room: bool,
    /// What the session before hands over.
    pub(super) taken_over: Option<TakenOver>,
    /// Where it left links that it does not hand over.
    pub(super) left_off: Vec<LeftOff>,
}

/// What a session leaves.
pub(super) struct Left {
    pub(super) ended: Ended,
    /// The recording, still to be converted, where there was one.
    pub(super) closed: Option<ClosedRecording>,
    /// Everything learnt so far.
    pub(super) results: Option<Results>,
    /// The campaign's recordings, with this one where it is one.
    pub(super) recordings: Vec<Recording>,
    /// What the next one takes over.
    pub(super) handed_over: Option<TakenOver>,
    /// Where links that it does not take over were left.
    pub(super) last_heard: Vec<LeftOff>,
}

/// What the daemon lends to every session.
pub(super) struct Lent<'l> {
    pub(super) runtime: &'l tokio::runtime::Handle,
    pub(super) clock: &'l Arc<WallClock>,
    pub(super) orders: &'l mut mpsc::Receiver<Order>,
    pub(super) board: &'l Board,
    pub(super) supervisor: &'l mut Supervisor,
}

/// Records until something ends the session.
pub(super) fn run(plan: Plan, lent: Lent<'_>) -> Result<Left, LiveError> {
    let Plan {
        mut campaign,
        text,
        earlier,
        diagnoser,
        rotate_s,
        paused_by,
        awaits_room,
        taken_over,
        left_off,
    } = plan;
    let Lent { runtime, clock, orders, board, supervisor } = lent;
    // Whoever takes a judgement back gets the run again, so that none is laid over these.
    campaign.judgements = Judgements::default();
    let before = &campaign.clone();
    let path = named(&mut campaign, clock, paused_by.is_none());
    let campaign = &campaign;
    let keeper = match &paused_by {
        None if awaits_room => Keeper::waiting(&path),
        None => Keeper::start(&path, text.clone(), clock)?,
        Some(_) => Keeper::idle(),
    };
    board.change(|status| status.paused_by = paused_by);
    let options = Options { keep_histories: false, ..Options::default() };
    let is_ending = &AtomicBool::new(false);
    let (links, (sender, events)) = TakenOver::or_new(taken_over);
    let next_sender = sender.clone();
    let (teller, earlier_told) = sync_channel(1);
    let knows_earlier = &AtomicBool::new(false);
    let (recorded, results) = thread::scope(|scope| {
        let heard_by = diagnoser.clone();
        scope.spawn(move || {
            let earlier = earlier.or_else(|| {
                let earlier = replayed(before, is_ending, &heard_by);
                if let Some(earlier) = &earlier {
                    show(before, earlier.clone(), None, board);
                }
                earlier
            });
            // The reporter is there as long as the loop, and waits for this.
            teller.send(earlier).ok();
            knows_earlier.store(true, Ordering::Release);
        });
        let (runs, results) = pipeline::live(scope, campaign, &options);
        let own_clock = Arc::clone(clock) as Arc<dyn Clock>;
        let (offers, provisional) = provisional::start(scope, campaign, board, own_clock);
        let mut under_way = UnderWay {
            campaign,
            clock,
            board,
            supervisor,
            keeper,
            runs: Some(runs),
            offers,
            is_ending,
            rotate_s,
            knows_earlier,
            state: State::default(),
        };
        let attached = under_way.attach(&sender, text, links, &left_off);
        let reporter = Reporter {
            campaign,
            results,
            earlier: earlier_told,
            clock: Arc::clone(clock) as Arc<dyn Clock>,
            diagnoser,
            provisional,
            board,
            events: sender,
        };
        let reporter = scope.spawn(move || reporter.run());
        let recorded = match attached {
            Ok(()) => Ok(runtime.block_on(under_way.record(events, orders))),
            Err(error) => {
                // Whatever was started ends when the loop's end of the queues is gone.
                is_ending.store(true, Ordering::Release);
                drop((under_way, events));
                Err(error)
            }
        };
        (recorded, reporter.join())
    });
    let Over { ended, keeper, links, left_off } = recorded?;
    let closed = keeper.close(ended.reason())?;
    let results = results.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    let recorded = if closed.is_some() { campaign } else { before };
    let recordings = recorded.recordings.clone();
    let handed_over = links.map(|links| TakenOver::new(links, next_sender));
    Ok(Left { ended, closed, results, recordings, handed_over, last_heard: left_off })
}

/// Puts the recording that begins now last in the campaign; its path. One that is not recorded has
/// no name.
fn named(campaign: &mut Campaign, clock: &WallClock, is_recorded: bool) -> PathBuf {
    let fresh = || fresh_name(&campaign.folder, clock, clock.now_ns());
    let name = if is_recorded { fresh() } else { String::new() };
    let path = campaign.folder.join(&name);
    campaign.recordings.push(Recording {
        name,
        files: vec![(None, path.clone())],
        condition: campaign.live.condition.clone(),
        speed_m_s: campaign.live.speed_m_s,
        line: None,
    });
    path
}

/// What earlier recordings of the campaign say, their pages written again; none when the daemon is
/// to end before that is known.
fn replayed(campaign: &Campaign, is_ending: &AtomicBool, diagnoser: &Diagnoser) -> Option<Results> {
    let dir = pipeline::results_folder(campaign);
    let options = Options { keep_histories: false, ..Options::default() };
    let replayed = pipeline::replay(campaign, &options, &mut |_| {}, &mut |learnt| {
        if is_ending.load(Ordering::Acquire) {
            return Err("the daemon is to end".into());
        }
        diagnoser.hear(learnt, campaign);
        if let Learnt::Run(run, overview) = learnt {
            pipeline::write_run_page(campaign, run, overview, &dir)?;
        }
        Ok(())
    });
    match replayed {
        Ok(results) => Some(results),
        Err(_) if is_ending.load(Ordering::Acquire) => None,
        Err(error) => {
            tracing::error!("earlier recordings are not in the results: {error}");
            Some(Results::default())
        }
    }
}
