//! Whether the daemon lives, whether it is ready, its gauges, its status.

use std::sync::Arc;

use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;

use super::Served;
use crate::page::metrics;
use crate::page::status::Status;

/// Schema of the status; its number rises when a field changes its meaning.
const STATUS_SCHEMA: &str = "rolltank.status/1";

#[derive(Serialize)]
struct WholeStatus {
    schema: &'static str,
    #[serde(flatten)]
    status: Status,
}

pub(super) async fn alive() -> &'static str {
    "alive\n"
}

pub(super) async fn ready(State(served): State<Arc<Served>>) -> Response {
    let status = served.board.now();
    if status.is_ready() {
        return "ready\n".into_response();
    }
    let waits: Vec<String> = status.waits_for();
    (StatusCode::SERVICE_UNAVAILABLE, waits.join("\n") + "\n").into_response()
}

pub(super) async fn gauges(State(served): State<Arc<Served>>) -> Response {
    match metrics::text(&served.board.now()) {
        Ok(text) => ([(header::CONTENT_TYPE, metrics::CONTENT_TYPE)], text).into_response(),
        Err(error) => (StatusCode::INTERNAL_SERVER_ERROR, error.to_string()).into_response(),
    }
}

pub(super) async fn whole_status(State(served): State<Arc<Served>>) -> Response {
    super::json(&WholeStatus { schema: STATUS_SCHEMA, status: served.board.now() })
}
