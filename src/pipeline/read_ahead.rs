//! Playing the recordings of a campaign in their order, the next ones read ahead on other cores.

use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, Scope, available_parallelism};

use super::claims::Claims;
use super::listening::Heard;
use super::play;
use super::workers::Workers;
use super::{Options, PipelineError};
use crate::campaign::Campaign;

/// Messages of one recording that wait for their turn: a day's recording has some dozens.
const N_WAITING: usize = 256;

type Message = Result<Heard, PipelineError>;

/// Plays every recording into `queue` as if one after the other; stops at the first that cannot be
/// read or overlaps an earlier one in time, or when nobody listens.
pub(super) fn campaign(
    campaign: &Campaign,
    options: &Options,
    workers: &Workers,
    queue: &SyncSender<Message>,
) {
    // What is played at a pace is watched, so it is not read ahead.
    let n_ahead = match options.speed {
        Some(_) => 1,
        // More than there are cores: whoever waits for its turn leaves its core to the others.
        None => 2 * available_parallelism().map_or(1, usize::from),
    };
    thread::scope(|scope| {
        let mut indices = 0..campaign.recordings.len();
        let mut ahead = VecDeque::new();
        let mut start = |ahead: &mut VecDeque<Receiver<Message>>| {
            ahead.extend(indices.next().map(|i| started(scope, campaign, options, workers, i)));
        };
        for _ in 0..n_ahead {
            start(&mut ahead);
        }
        let mut claims = Claims::default();
        let names = campaign.recordings.iter().map(|recording| &recording.name);
        for name in names {
            let Some(messages) = ahead.pop_front() else { return };
            for message in messages {
                let message = match message {
                    Ok(Heard::Covered { start_s, end_s }) => {
                        match claims.extend(name, start_s, end_s) {
                            Ok(()) => continue,
                            Err(error) => Err(error),
                        }
                    }
                    other => other,
                };
                let is_last = message.is_err();
                if queue.send(message).is_err() || is_last {
                    return;
                }
            }
            claims.end_recording();
            start(&mut ahead);
        }
    });
}

/// What the recording at `index` tells, played on a thread of its own.
fn started<'s>(
    scope: &'s Scope<'s, '_>,
    campaign: &'s Campaign,
    options: &'s Options,
    workers: &'s Workers,
    index: usize,
) -> Receiver<Message> {
    let (queue, messages) = sync_channel(N_WAITING);
    scope.spawn(move || play::recording(campaign, options, workers, index, &queue));
    messages
}
