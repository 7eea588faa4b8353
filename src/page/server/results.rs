//! What was learnt: parts of the live page, and the files of the report by a list of the daemon's.

use std::sync::Arc;

use axum::extract::{Path, State};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde_json::{Map, Value, json};

use super::Served;
use crate::report;

/// Every part by its name, with the number of this state of knowledge.
pub(super) async fn view(State(served): State<Arc<Served>>) -> Response {
    let shown = served.board.shown();
    let parts: Map<String, Value> = shown
        .parts
        .iter()
        .map(|(name, html)| ((*name).to_owned(), Value::String(html.clone())))
        .collect();
    super::json(&json!({ "number": shown.number, "parts": parts }))
}

/// A file of the report; its name is only ever compared with those that the daemon has listed.
pub(super) async fn file(State(served): State<Arc<Served>>, Path(name): Path<String>) -> Response {
    let Some(path) = served.board.shown().files.get(&name).cloned() else {
        return (StatusCode::NOT_FOUND, "no such result\n").into_response();
    };
    let kind = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    let (content_type, is_page) = match kind {
        "html" => ("text/html; charset=utf-8", true),
        "json" => ("application/json", false),
        "csv" => ("text/csv; charset=utf-8", false),
        "svg" => ("image/svg+xml", false),
        _ => ("application/octet-stream", false),
    };
    let read = tokio::task::spawn_blocking(move || std::fs::read(path)).await;
    let Ok(Ok(bytes)) = read else {
        return (StatusCode::NOT_FOUND, "not written yet\n").into_response();
    };
    let bytes = if is_page {
        report::with_style_beside(&String::from_utf8_lossy(&bytes), "/assets/report.css").into()
    } else {
        bytes
    };
    ([(header::CONTENT_TYPE, content_type)], bytes).into_response()
}
