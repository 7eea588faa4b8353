//! The server: its routes, each behind the guard.

mod actions;
mod guard;
mod health;
mod login;
mod results;
mod shell;
mod state;
mod stream;

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::http::{StatusCode, header};
use axum::middleware::{from_fn, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use serde::Serialize;
use tokio::net::TcpListener;
use tokio::runtime::{Builder, Runtime};

use super::board::Board;
use super::order::Orders;
use stream::Stream;

/// Where the daemon listens, and to whom.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listen {
    /// Address and port.
    pub address: SocketAddr,
    /// What a request must carry as `Authorization: Bearer TOKEN`, or a page's cookie; needed
    /// beyond loopback.
    pub token: Option<String>,
}

impl Listen {
    /// Where nobody but this machine can ask.
    pub const DEFAULT: &'static str = "127.0.0.1:8440";
}

/// Why nothing is served.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// Listening beyond this machine without a token.
    #[error("listening on {address}, beyond this machine, needs a token")]
    NoToken {
        /// The address.
        address: SocketAddr,
    },
    /// An address that cannot be listened on.
    #[error("cannot listen on {address}")]
    Listen {
        /// The address.
        address: SocketAddr,
        /// What the system said.
        source: io::Error,
    },
}

impl ServeError {
    /// What to do about it.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::NoToken { .. } => "name a file with --token-file, or listen on 127.0.0.1",
            Self::Listen { .. } => {
                "another daemon may run; name another address with --listen, port 0 for any"
            }
        }
    }
}

/// What the server works with.
#[derive(Debug)]
pub struct Served {
    /// What it shows.
    pub board: Board,
    /// The campaign's folder, into which judgements and calibrations are written.
    pub folder: PathBuf,
    /// Whom it asks.
    pub orders: Orders,
}

/// Largest body of a request [bytes]: a note of some lines.
const BODY_MAX: usize = 16 * 1024;

/// The runtime of signals, timers and sockets: one thread beside the daemon's own.
///
/// # Errors
/// What the system said.
pub fn runtime() -> io::Result<Runtime> {
    Builder::new_multi_thread().worker_threads(1).enable_all().build()
}

/// Serves until the runtime ends; the address, which is told where port 0 was asked for.
///
/// # Errors
/// [`ServeError`] when the address is taken, or needs a token.
pub fn serve(runtime: &Runtime, listen: &Listen, served: Served) -> Result<SocketAddr, ServeError> {
    let Listen { address, token } = listen;
    if token.is_none() && !address.ip().is_loopback() {
        return Err(ServeError::NoToken { address: *address });
    }
    let busy = |source| ServeError::Listen { address: *address, source };
    let listener = runtime.block_on(TcpListener::bind(address)).map_err(busy)?;
    let address = listener.local_addr().map_err(busy)?;
    tracing::info!(%address, "serving the page, /healthz, /readyz, /metrics and /status");
    let token = guard::Token::new(token.as_deref());
    let stream = {
        let _inside = runtime.enter();
        Stream::start(served.board.clone())
    };
    let served = Arc::new(served);
    let router = Router::new()
        .route("/", get(shell::page))
        .route("/assets/{name}", get(shell::asset))
        .route("/favicon.ico", get(shell::icon))
        .route("/enter", post(login::enter).with_state(token.clone()))
        .route("/stream", get(stream::stream).with_state(stream))
        .route("/view", get(results::view))
        .route("/results/{name}", get(results::file))
        .route("/judgements", get(actions::judgements))
        .route("/act", post(actions::act))
        .route("/zero", post(actions::take_zero))
        .route("/healthz", get(health::alive))
        .route("/readyz", get(health::ready))
        .route("/metrics", get(health::gauges))
        .route("/status", get(health::whole_status))
        .layer(DefaultBodyLimit::max(BODY_MAX))
        .layer(from_fn_with_state(token, guard::admit))
        .layer(from_fn(guard::with_headers))
        .with_state(served);
    runtime.spawn(async move {
        if let Err(error) = axum::serve(listener, router).await {
            tracing::error!("no longer served: {error}");
        }
    });
    Ok(address)
}

/// An answer in JSON.
fn json(value: &impl Serialize) -> Response {
    match serde_json::to_string_pretty(value) {
        Ok(text) => ([(header::CONTENT_TYPE, "application/json")], text).into_response(),
        Err(error) => (StatusCode::INTERNAL_SERVER_ERROR, error.to_string()).into_response(),
    }
}
