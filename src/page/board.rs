//! The board between the daemon and its page: what one writes and the other reads.
//!
//! Each lock is held for a copy and no longer, so that no page ever keeps the daemon waiting.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::status::Status;
use super::strips::Strips;
use crate::judgement::{Judgements, Place};

/// The board as several threads see it.
#[derive(Debug, Clone, Default)]
pub struct Board {
    inner: Arc<Inner>,
}

#[derive(Debug, Default)]
struct Inner {
    status: Mutex<Status>,
    strips: Mutex<Strips>,
    judgements: Mutex<Judgements>,
    shown: Mutex<Arc<Shown>>,
    turn: Mutex<()>,
}

/// What was learnt, as pages show it.
#[derive(Debug, Default)]
pub struct Shown {
    /// Rises with every change.
    pub number: u64,
    /// Parts of the live page, each with its name and its HTML.
    pub parts: Vec<(&'static str, String)>,
    /// Files of the report by the name under which they can be asked for.
    pub files: BTreeMap<String, PathBuf>,
    /// Where each run lies that can be judged, by its id.
    pub runs: BTreeMap<String, Place>,
}

impl Board {
    /// A copy of the status.
    pub fn now(&self) -> Status {
        lock(&self.inner.status).clone()
    }

    /// Changes the status.
    pub fn change(&self, change: impl FnOnce(&mut Status)) {
        change(&mut lock(&self.inner.status));
    }

    /// The strips; nothing may be done under this lock but to push and to fetch.
    pub fn strips(&self) -> MutexGuard<'_, Strips> {
        lock(&self.inner.strips)
    }

    /// A copy of what people have judged.
    pub fn judgements(&self) -> Judgements {
        lock(&self.inner.judgements).clone()
    }

    /// Changes what people have judged.
    pub fn judge(&self, change: impl FnOnce(&mut Judgements)) {
        change(&mut lock(&self.inner.judgements));
    }

    /// The turn to judge: one at a time, as long as the disk takes; nobody else waits for it.
    pub fn turn(&self) -> MutexGuard<'_, ()> {
        lock(&self.inner.turn)
    }

    /// Shows what was learnt from now on.
    pub fn show(&self, shown: Shown) {
        let mut now = lock(&self.inner.shown);
        *now = Arc::new(Shown { number: now.number + 1, ..shown });
    }

    /// What was learnt.
    pub fn shown(&self) -> Arc<Shown> {
        Arc::clone(&lock(&self.inner.shown))
    }
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    // Whoever panicked left a whole value behind: each change is one step.
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
