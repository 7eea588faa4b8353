//! `POST /enter`: a page tells the token once and carries a cookie from then on.

use std::time::Duration;

use axum::Json;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;

use super::guard::Token;

/// How long a wrong token is thought about: nobody tries many.
const DOUBT: Duration = Duration::from_millis(500);

/// What a page tells.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Entering {
    token: String,
}

pub(super) async fn enter(State(token): State<Token>, Json(told): Json<Entering>) -> Response {
    if !token.is(&told.token) {
        tokio::time::sleep(DOUBT).await;
        return (StatusCode::UNAUTHORIZED, "that is not the token\n").into_response();
    }
    ([(header::SET_COOKIE, token.cookie())], "welcome\n").into_response()
}
