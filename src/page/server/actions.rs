//! `POST /act` and `POST /zero`: what people do on the page, each logged and undoable.

use std::sync::Arc;

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use serde_json::json;

use super::Served;
use crate::judgement::{self, Deed, Judgement, Judgements, Place, Zeroed};
use crate::page::order::Order;
use crate::page::stamp::stamp_of_now;
use crate::page::status::Status;
use crate::page::zeroing::{ZeroRequest, take_again, take_back, zero};

/// Most letters of a name, and of a reason or note.
const NAME_MAX: usize = 80;
const WHY_MAX: usize = 2000;

/// What somebody wants, and why.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Wish {
    by: String,
    #[serde(default)]
    why: String,
    what: What,
}

/// What can be wanted; a run is named by its id.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum What {
    Mark,
    Annotate { run: String },
    Reject { run: String },
    StopRecording,
    StartRecording,
    Undo { of: u64 },
}

/// Why a wish is not granted.
struct Refusal(StatusCode, String);

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (self.0, self.1 + "\n").into_response()
    }
}

fn conflict(why: impl Into<String>) -> Refusal {
    Refusal(StatusCode::CONFLICT, why.into())
}

/// Everything judged, with whether it still holds and the ids of the runs meant, newest last.
pub(super) async fn judgements(State(served): State<Arc<Served>>) -> Response {
    let (judgements, shown) = (served.board.judgements(), served.board.shown());
    let meant = |judgement: &Judgement| -> Vec<&String> {
        let (Deed::Annotate { run: meant } | Deed::Reject { run: meant }) = &judgement.deed else {
            return Vec::new();
        };
        let is_meant = |at: &Place| meant.is(&at.recording, at.start_s, at.end_s);
        shown.runs.iter().filter(|(_, at)| is_meant(at)).map(|(id, _)| id).collect()
    };
    let line = |one: &Judgement| {
        let stands = judgements.stands(one.number);
        json!({ "judgement": one, "stands": stands, "runs": meant(one) })
    };
    let all: Vec<_> = judgements.all().iter().map(line).collect();
    super::json(&json!({ "schema": "rolltank.judgements/1", "judgements": all }))
}

pub(super) async fn act(State(served): State<Arc<Served>>, Json(wish): Json<Wish>) -> Response {
    let worker = Arc::clone(&served);
    // The disk may take its time.
    match tokio::task::spawn_blocking(move || grant(&worker, wish)).await {
        Ok(Ok((judgement, order))) => {
            if let Some(order) = order {
                served.orders.send(order).await.ok();
            }
            super::json(&json!({ "number": judgement.number, "judgement": judgement }))
        }
        Ok(Err(refusal)) => refusal.into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

/// Takes zeros, logs them, and has them come into force as every change does: at the next rest.
pub(super) async fn take_zero(
    State(served): State<Arc<Served>>,
    Json(asked): Json<ZeroRequest>,
) -> Response {
    let worker = Arc::clone(&served);
    let zeroed = tokio::task::spawn_blocking(move || {
        let (by, note) = said(&asked.by, &asked.note)?;
        let _turn = worker.board.turn();
        let (told, channels) =
            zero(&worker.folder, &worker.board.now(), &asked).map_err(conflict)?;
        keep(&worker, by, note, Deed::Zero { channels })?;
        Ok(told)
    });
    match zeroed.await {
        Ok(Ok(told)) => {
            served.orders.send(Order::Reload).await.ok();
            told.into_response()
        }
        Ok(Err(refusal)) => Refusal::into_response(refusal),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

/// Does what is wanted and logs it; the order that follows from it.
fn grant(served: &Served, wish: Wish) -> Result<(Judgement, Option<Order>), Refusal> {
    let (by, why) = said(&wish.by, &wish.why)?;
    let _turn = served.board.turn();
    let judgements = served.board.judgements();
    let status = served.board.now();
    let (deed, order) = match wish.what {
        What::Mark => {
            (Deed::Mark { recording: status.recording, time_s: status.at_s }, Order::TellAgain)
        }
        What::Annotate { run } => (Deed::Annotate { run: place(served, &run)? }, Order::TellAgain),
        What::Reject { run } => {
            let place = place(served, &run)?;
            (reject(&judgements, place)?, Order::TellAgain)
        }
        What::StopRecording => (Deed::StopRecording, stop_recording(&status, &by)?),
        What::StartRecording => (Deed::StartRecording, start_recording(&status)?),
        What::Undo { of } => (Deed::Undo { of }, undo(served, &judgements, of, &by)?),
    };
    let judgement = keep(served, by, why, deed)?;
    Ok((judgement, Some(order)))
}

fn reject(judgements: &Judgements, run: Place) -> Result<Deed, Refusal> {
    match judgements.rejection(&run.recording, run.start_s, run.end_s) {
        Some(earlier) => {
            let Judgement { number, by, .. } = earlier;
            Err(conflict(format!("the run is rejected already, by {by} as number {number}")))
        }
        None => Ok(Deed::Reject { run }),
    }
}

fn stop_recording(status: &Status, by: &str) -> Result<Order, Refusal> {
    match status.paused_by {
        Some(_) => Err(conflict("nothing is recorded already")),
        None => Ok(Order::StopRecording { by: by.to_owned() }),
    }
}

fn start_recording(status: &Status) -> Result<Order, Refusal> {
    match status.paused_by {
        None => Err(conflict("it is recorded already")),
        Some(_) => Ok(Order::StartRecording),
    }
}

/// Does what undoing a number needs beside its line, and the undoing of an undo; the order that
/// follows.
fn undo(served: &Served, judgements: &Judgements, of: u64, by: &str) -> Result<Order, Refusal> {
    let meant = judgements.meant(of).filter(|_| judgements.stands(of));
    let Some((judgement, is_again)) = meant else {
        return Err(conflict(format!("number {of} does not stand, so that nothing can be undone")));
    };
    match (&judgement.deed, is_again) {
        (Deed::StopRecording, true) | (Deed::StartRecording, false) => {
            stop_recording(&served.board.now(), by)
        }
        (Deed::StopRecording, false) | (Deed::StartRecording, true) => {
            start_recording(&served.board.now())
        }
        (Deed::Zero { channels }, _) => {
            require_newest(judgements, judgement.number, channels)?;
            let put = if is_again { take_again } else { take_back };
            put(&served.folder, channels).map_err(conflict)?;
            Ok(Order::Reload)
        }
        (Deed::Reject { run }, true) => reject(judgements, run.clone()).map(|_| Order::TellAgain),
        (
            Deed::Mark { .. } | Deed::Annotate { .. } | Deed::Reject { .. } | Deed::Undo { .. },
            _,
        ) => Ok(Order::TellAgain),
    }
}

/// A zero is changed only while no later one of its channels stands.
fn require_newest(
    judgements: &Judgements,
    number: u64,
    channels: &[Zeroed],
) -> Result<(), Refusal> {
    let is_newer = |later: &&&Judgement| match &later.deed {
        Deed::Zero { channels: newer } if later.number > number => newer
            .iter()
            .any(|newer| channels.iter().any(|zeroed| zeroed.quantity == newer.quantity)),
        _ => false,
    };
    match judgements.in_force().iter().find(is_newer) {
        Some(newer) => Err(conflict(format!("zero {} came later: undo that first", newer.number))),
        None => Ok(()),
    }
}

fn keep(served: &Served, by: String, why: String, deed: Deed) -> Result<Judgement, Refusal> {
    let number = served.board.judgements().next_number();
    let judgement = Judgement { number, at: stamp_of_now(), by, why, deed };
    judgement::append(&served.folder, &judgement).map_err(|error| {
        let told = format!("not kept, so that it does not count: {error}");
        Refusal(StatusCode::INTERNAL_SERVER_ERROR, told)
    })?;
    served.board.judge(|judgements| judgements.push(judgement.clone()));
    tracing::info!(number, by = judgement.by, why = judgement.why, "judged");
    Ok(judgement)
}

fn place(served: &Served, run: &str) -> Result<Place, Refusal> {
    let place = served.board.shown().runs.get(run).cloned();
    place.ok_or_else(|| conflict(format!("there is no run {run}")))
}

/// The name and the words as they are kept.
fn said(by: &str, why: &str) -> Result<(String, String), Refusal> {
    let clean = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let (by, why) = (clean(by), clean(why));
    let wrong = |told: &str| Err(Refusal(StatusCode::UNPROCESSABLE_ENTITY, told.to_owned()));
    match (by.chars().count(), why.chars().count()) {
        (0, _) => wrong("say who you are: nothing is judged without a name"),
        (letters, _) if letters > NAME_MAX => wrong("the name is longer than 80 letters"),
        (_, letters) if letters > WHY_MAX => wrong("the reason is longer than 2000 letters"),
        _ => Ok((by, why)),
    }
}
