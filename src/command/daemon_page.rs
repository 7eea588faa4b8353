//! What the instruments of a running daemon read, asked for at its page.

use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::PathBuf;
use std::time::Duration;

use ::devices::Quantity;
use clap::Args;
use serde_json::Value;

use super::Failure;
use super::run::token;
use crate::page::status::RecentRaw;

/// Longest wait for an answer.
const PATIENCE: Duration = Duration::from_secs(10);

/// Where the page of a running daemon is.
#[derive(Debug, Args)]
pub(super) struct DaemonPage {
    /// Address of the page of `rolltank run`, which has the ports and reads instead
    #[arg(long, value_name = "ADDRESS")]
    page: Option<SocketAddr>,
    /// File whose first line is the token of that page
    #[arg(long, value_name = "FILE", requires = "page")]
    token_file: Option<PathBuf>,
}

impl DaemonPage {
    /// Whether there is one.
    pub(super) fn is_named(&self) -> bool {
        self.page.is_some()
    }

    /// The raw readings of a channel in the last seconds.
    pub(super) fn recent(&self, quantity: Quantity) -> Result<RecentRaw, Failure> {
        let token = token(self.token_file.as_deref())?;
        let failed = |source| Failure::Page { source };
        let text = self.status(token.as_deref()).map_err(failed)?;
        let status: Value = serde_json::from_str(&text).map_err(|error| failed(error.into()))?;
        let devices = status["devices"].as_array().into_iter().flatten();
        let mut channels = devices.flat_map(|of| of["channels"].as_array().into_iter().flatten());
        let channel = channels.find(|channel| channel["quantity"] == quantity.name());
        let recent = channel.map(|channel| channel["recent"].clone());
        recent.and_then(|recent| serde_json::from_value(recent).ok()).ok_or_else(|| {
            let seen = format!("it has too few readings of the {} yet", quantity.name());
            failed(io::Error::other(seen))
        })
    }

    fn status(&self, token: Option<&str>) -> io::Result<String> {
        let address = self.page.ok_or(io::ErrorKind::AddrNotAvailable)?;
        let mut stream = TcpStream::connect_timeout(&address, PATIENCE)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        let bearer = token.map(|token| format!("Authorization: Bearer {token}\r\n"));
        write!(
            stream,
            "GET /status HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n{}\r\n",
            bearer.unwrap_or_default()
        )?;
        let mut answer = String::new();
        stream.read_to_string(&mut answer)?;
        let (head, body) = answer.split_once("\r\n\r\n").unwrap_or_default();
        let first = head.lines().next().unwrap_or_default();
        if first.split(' ').nth(1) == Some("200") {
            return Ok(body.to_owned());
        }
        Err(io::Error::other(format!("it answers \"{first}\"")))
    }
}
