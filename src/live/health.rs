//! What the daemon tells over HTTP: whether it lives, whether it is ready, its gauges, its status.

use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::{HeaderValue, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router};
use serde::Serialize;
use tokio::net::TcpListener;

use super::error::LiveError;
use super::event::{Order, Orders};
use super::metrics;
use super::status::{SharedStatus, Status};
use super::zeroing::{ZeroRequest, zero};

/// Where the daemon listens, and to whom.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listen {
    /// Address and port.
    pub address: SocketAddr,
    /// What a request must carry as `Authorization: Bearer TOKEN`; needed beyond loopback.
    pub token: Option<String>,
}

impl Listen {
    /// Where nobody but this machine can ask.
    pub const DEFAULT: &'static str = "127.0.0.1:8440";
}

struct Served {
    status: SharedStatus,
    token: Option<String>,
    folder: PathBuf,
    orders: Orders,
}

/// Serves until the runtime ends.
pub(super) fn serve(
    runtime: &tokio::runtime::Runtime,
    listen: &Listen,
    (folder, status, orders): (&Path, &SharedStatus, &Orders),
) -> Result<(), LiveError> {
    let Listen { address, token } = listen;
    if token.is_none() && !address.ip().is_loopback() {
        return Err(LiveError::NoToken { address: *address });
    }
    let busy = |source| LiveError::Listen { address: *address, source };
    let listener = runtime.block_on(TcpListener::bind(address)).map_err(busy)?;
    // Port 0 is any free one, which nobody could find without being told.
    let address = listener.local_addr().map_err(busy)?;
    tracing::info!(%address, "serving /healthz, /readyz, /metrics and /status");
    let served = Arc::new(Served {
        status: status.clone(),
        token: token.clone(),
        folder: folder.to_owned(),
        orders: orders.clone(),
    });
    let router = Router::new()
        .route("/healthz", get(|| async { "alive\n" }))
        .route("/readyz", get(ready))
        .route("/metrics", get(gauges))
        .route("/status", get(whole_status))
        .route("/zero", post(take_zero))
        .layer(middleware::from_fn_with_state(Arc::clone(&served), only_with_token))
        .with_state(served);
    runtime.spawn(async move {
        if let Err(error) = axum::serve(listener, router).await {
            tracing::error!("no longer served: {error}");
        }
    });
    Ok(())
}

async fn only_with_token(
    State(served): State<Arc<Served>>,
    request: Request,
    next: Next,
) -> Response {
    let given = request.headers().get(header::AUTHORIZATION);
    let given = given.and_then(|value| value.to_str().ok()?.strip_prefix("Bearer "));
    match &served.token {
        Some(token) if !given.is_some_and(|given| is_same(given, token)) => {
            (StatusCode::UNAUTHORIZED, "a token is needed\n").into_response()
        }
        // A name that leads here by the will of another site is not ours.
        None if !is_this_machine(request.headers().get(header::HOST)) => {
            (StatusCode::MISDIRECTED_REQUEST, "ask for this machine by its address\n")
                .into_response()
        }
        _ => next.run(request).await,
    }
}

/// Whether a host is named as only this machine can be.
fn is_this_machine(host: Option<&HeaderValue>) -> bool {
    let Some(host) = host.and_then(|host| host.to_str().ok()) else { return false };
    let without_port = host.rsplit_once(':').map_or(host, |(name, _)| name);
    let loopback = |text: &str| text.trim_matches(['[', ']']).parse::<IpAddr>();
    [host, without_port]
        .into_iter()
        .any(|name| name == "localhost" || loopback(name).is_ok_and(|ip| ip.is_loopback()))
}

/// Compares in a time that tells nothing of where two texts differ.
fn is_same(given: &str, token: &str) -> bool {
    let differing = given.bytes().zip(token.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
    given.len() == token.len() && differing == 0
}

async fn ready(State(served): State<Arc<Served>>) -> Response {
    let status = served.status.now();
    if status.is_ready() {
        return "ready\n".into_response();
    }
    let waits: Vec<String> = status.waits_for();
    (StatusCode::SERVICE_UNAVAILABLE, waits.join("\n") + "\n").into_response()
}

async fn gauges(State(served): State<Arc<Served>>) -> Response {
    match metrics::text(&served.status.now()) {
        Ok(text) => ([(header::CONTENT_TYPE, metrics::CONTENT_TYPE)], text).into_response(),
        Err(error) => (StatusCode::INTERNAL_SERVER_ERROR, error.to_string()).into_response(),
    }
}

/// Schema of the status; its number rises when a field changes its meaning.
const STATUS_SCHEMA: &str = "rolltank.status/1";

#[derive(Serialize)]
struct WholeStatus {
    schema: &'static str,
    #[serde(flatten)]
    status: Status,
}

async fn whole_status(State(served): State<Arc<Served>>) -> Response {
    let whole = WholeStatus { schema: STATUS_SCHEMA, status: served.status.now() };
    match serde_json::to_string_pretty(&whole) {
        Ok(text) => ([(header::CONTENT_TYPE, "application/json")], text).into_response(),
        Err(error) => (StatusCode::INTERNAL_SERVER_ERROR, error.to_string()).into_response(),
    }
}

/// Only JSON is taken, which no page of another site can send without being allowed to.
async fn take_zero(State(served): State<Arc<Served>>, Json(asked): Json<ZeroRequest>) -> Response {
    match zero(&served.folder, &served.status.now(), &asked) {
        Ok(told) => {
            // It comes into force as every change does: at the next rest.
            served.orders.send(Order::Reload).await.ok();
            told.into_response()
        }
        Err(why) => (StatusCode::CONFLICT, why).into_response(),
    }
}

#[cfg(test)]
mod tests {
    use super::{HeaderValue, is_same, is_this_machine};

    #[test]
    fn a_host_is_this_machine_only_by_its_loopback_address() {
        let is = |host: &'static str| is_this_machine(Some(&HeaderValue::from_static(host)));
        let ours = ["localhost", "localhost:8440", "127.0.0.1:8440", "127.0.0.1", "[::1]:8440"];
        assert!(ours.into_iter().all(is));
        let others = ["evil.example", "evil.example:8440", "127.0.0.1.evil.example", "10.0.0.1:80"];
        assert!(!others.into_iter().any(is) && !is_this_machine(None));
    }

    #[test]
    fn a_token_is_the_same_only_whole() {
        assert!(is_same("secret", "secret"));
        for other in ["", "secre", "secrets", "Secret"] {
            assert!(!is_same(other, "secret"), "{other}");
        }
    }
}
