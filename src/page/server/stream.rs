//! `GET /stream`: what happens, as server-sent events, the same text to every page.
//!
//! Server-sent events and no web socket: everything flows one way, a browser takes the stream up
//! again by itself when the daemon comes back, and cookies, origins and hosts are checked as for
//! any other request.
//!
//! One task writes each event once into a ring that all pages read from. A page that does not keep
//! up is passed by the ring and then told everything anew; the ring never waits for it, and the
//! daemon never waits for the ring.

use std::convert::Infallible;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use tokio::sync::broadcast::error::RecvError;
use tokio::sync::broadcast::{self, Receiver};
use tokio::sync::{OwnedSemaphorePermit, Semaphore, mpsc};
use tokio::time::{MissedTickBehavior, interval};

use super::state::state;
use crate::page::board::Board;

/// How often strips are sent: so often that thirty a second arrive on a busy machine too.
const FRAME: Duration = Duration::from_millis(25);
/// Frames from one look at the state to the next, and to the one that is sent though nothing but
/// time has passed.
const FRAMES_PER_LOOK: u32 = 4;
const FRAMES_PER_STATE: u32 = 20;
/// Events that the ring holds: some seconds.
const RING: usize = 128;
/// Events on their way into one socket.
const ON_THE_WAY: usize = 4;
/// Pages at once; a forgotten tab costs memory.
const PAGES_MAX: usize = 64;

/// The ring, and who may still join.
#[derive(Clone)]
pub(super) struct Stream {
    board: Board,
    ring: broadcast::Sender<Bytes>,
    places: Arc<Semaphore>,
}

impl Stream {
    /// Starts the task that writes; it ends with the runtime.
    pub(super) fn start(board: Board) -> Self {
        let (ring, _) = broadcast::channel(RING);
        let stream = Self { board, ring, places: Arc::new(Semaphore::new(PAGES_MAX)) };
        tokio::spawn(write(stream.clone()));
        stream
    }

    /// Everything that a page needs to begin with.
    fn greeting(&self) -> Bytes {
        let past = self.board.strips().past();
        let (state, _) = state(&self.board);
        let retry = "retry: 500\n";
        Bytes::from(format!("{retry}{}{}", event("past", &past), event("state", &state)))
    }
}

fn event(name: &str, data: &str) -> String {
    format!("event: {name}\ndata: {data}\n\n")
}

async fn write(stream: Stream) {
    let mut frames = interval(FRAME);
    frames.set_missed_tick_behavior(MissedTickBehavior::Skip);
    let mut told = String::new();
    for number in 0_u32.. {
        frames.tick().await;
        // Fetched though nobody looks, so that a page that comes finds the last minutes.
        let strips = stream.board.strips().fetch();
        if stream.ring.receiver_count() == 0 {
            continue;
        }
        let mut text = strips.map(|strips| event("strips", &strips)).unwrap_or_default();
        if number % FRAMES_PER_LOOK == 0 {
            let (whole, slow) = state(&stream.board);
            if slow != told || number % FRAMES_PER_STATE == 0 {
                told = slow;
                text += &event("state", &whole);
            }
        }
        if !text.is_empty() {
            // Nobody may have stayed to read it.
            stream.ring.send(Bytes::from(text)).ok();
        }
    }
}

pub(super) async fn stream(State(stream): State<Stream>) -> Response {
    let Ok(place) = Arc::clone(&stream.places).try_acquire_owned() else {
        return (StatusCode::SERVICE_UNAVAILABLE, "too many pages are open\n").into_response();
    };
    let events = stream.ring.subscribe();
    let (sender, socket) = mpsc::channel(ON_THE_WAY);
    tokio::spawn(pass_on(stream, events, sender, place));
    let body = Body::from_stream(Socket(socket));
    ([(header::CONTENT_TYPE, "text/event-stream")], body).into_response()
}

/// Passes events on to one socket until it is closed; its place is free again then.
async fn pass_on(
    stream: Stream,
    mut events: Receiver<Bytes>,
    socket: mpsc::Sender<Bytes>,
    _place: OwnedSemaphorePermit,
) {
    let mut next = stream.greeting();
    while socket.send(next).await.is_ok() {
        next = match events.recv().await {
            Ok(event) => event,
            // It was passed: what it missed is told anew as one.
            Err(RecvError::Lagged(_)) => {
                events = events.resubscribe();
                stream.greeting()
            }
            Err(RecvError::Closed) => return,
        };
    }
}

/// What a socket takes, as the stream that axum wants.
struct Socket(mpsc::Receiver<Bytes>);

impl futures_core::Stream for Socket {
    type Item = Result<Bytes, Infallible>;

    fn poll_next(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        self.0.poll_recv(context).map(|event| event.map(Ok))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_that_is_passed_by_the_ring_is_told_everything_anew_and_the_ring_never_waits() {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build().unwrap();
        runtime.block_on(async {
            let board = Board::default();
            let (ring, _) = broadcast::channel(RING);
            let places = Arc::new(Semaphore::new(1));
            let stream = Stream { board, ring: ring.clone(), places };
            let place = Arc::clone(&stream.places).try_acquire_owned().unwrap();
            let (sender, mut socket) = mpsc::channel(ON_THE_WAY);
            tokio::spawn(pass_on(stream.clone(), ring.subscribe(), sender, place));
            for number in 0..10 * RING {
                ring.send(Bytes::from(format!("{number}"))).unwrap();
                tokio::task::yield_now().await;
            }
            let mut told = Vec::new();
            for _ in 0..2 * ON_THE_WAY + 2 {
                told.push(socket.recv().await.unwrap());
                tokio::task::yield_now().await;
                ring.send(Bytes::from("after")).unwrap();
            }
            let is_greeting = |text: &Bytes| text.starts_with(b"retry: ");
            assert!(is_greeting(&told[0]));
            assert_eq!(told[1..].iter().filter(|text| is_greeting(text)).count(), 1, "{told:?}");
            assert!(told.last().is_some_and(|text| text == "after"), "{told:?}");
            drop(socket);
            ring.send(Bytes::new()).ok();
            tokio::task::yield_now().await;
            assert!(stream.places.try_acquire().is_ok(), "a page that is gone leaves its place");
        });
    }
}
