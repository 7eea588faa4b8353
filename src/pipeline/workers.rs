//! Identifying several runs at once; who asked keeps the answers in order.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex};
use std::thread::{self, Scope};

use super::QUEUE_LENGTH;
use crate::campaign::Campaign;
use crate::diagnosis::Reversed;
use crate::inverse::identification::Identification;
use crate::inverse::{self, Setting};
use crate::run::Run;

/// A run with what it says, or the reason why it says nothing.
pub(super) struct Identified {
    pub(super) run: Run,
    pub(super) identification: Result<Identification, String>,
    /// What was known beside the run; none where it was not asked about.
    pub(super) setting: Option<Setting>,
}

/// A run that waits to be identified.
struct Job {
    run: Run,
    setting: Setting,
    reply: SyncSender<Identified>,
}

/// The threads that identify, one per core.
#[derive(Clone)]
pub(super) struct Workers {
    jobs: SyncSender<Job>,
}

impl Workers {
    /// Starts the threads; they end when every clone of the workers is dropped.
    pub(super) fn start<'s>(scope: &'s Scope<'s, '_>) -> Self {
        let (jobs, waiting) = sync_channel(QUEUE_LENGTH);
        let waiting = Arc::new(Mutex::new(waiting));
        for _ in 0..thread::available_parallelism().map_or(1, usize::from).min(QUEUE_LENGTH) {
            let waiting = Arc::clone(&waiting);
            scope.spawn(move || work(&waiting));
        }
        Self { jobs }
    }

    /// Hands a run to the next free thread; its answer arrives where this says.
    pub(super) fn identify(&self, run: Run, setting: Setting) -> Receiver<Identified> {
        let (reply, answer) = sync_channel(1);
        let job = Job { run, setting, reply };
        self.jobs.send(job).expect("the threads live as long as their jobs can come");
        answer
    }

    /// The answer for a run that need not be asked about.
    pub(super) fn refuse(run: Run, reason: &str) -> Receiver<Identified> {
        let (reply, answer) = sync_channel(1);
        let refused = Identified { run, identification: Err(reason.to_owned()), setting: None };
        reply.send(refused).expect("there is room for one answer");
        answer
    }
}

impl Identified {
    /// The run as one whose force has the wrong sign, where that is why it says nothing.
    pub(super) fn reversed(&self, campaign: &Campaign) -> Option<Reversed> {
        self.identification.as_ref().err().and_then(|_| Reversed::of(&self.run, campaign))
    }
}

fn work(waiting: &Mutex<Receiver<Job>>) {
    loop {
        let next = waiting.lock().expect("nothing panics while a job is taken").recv();
        let Ok(Job { run, setting, reply }) = next else { return };
        let identification = inverse::identify(&run, &setting);
        // Nobody waits for the answer any more when the replay has ended early.
        drop(reply.send(Identified { run, identification, setting: Some(setting) }));
    }
}
