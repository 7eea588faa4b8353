//! Plain HTTP for stories, as a program speaks it that is no browser.

use std::io::{Read, Write};
use std::net::TcpStream;

/// An answer.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) status: u16,
    pub(crate) head: String,
    pub(crate) body: String,
}

impl Answer {
    /// The value of a header; empty when it is not there.
    pub(crate) fn header(&self, name: &str) -> &str {
        let mut lines = self.head.lines().filter_map(|line| line.split_once(": "));
        lines.find(|(known, _)| known.eq_ignore_ascii_case(name)).map_or("", |(_, value)| value)
    }
}

/// Headers of a request beside the host.
pub(crate) type Headers<'h> = [(&'h str, &'h str)];

/// Asks for a path, with headers; a `Host` among them replaces the usual one.
pub(crate) fn get(address: &str, path: &str, headers: &Headers) -> Answer {
    ask(address, &format!("GET {path}"), headers, "")
}

/// Posts JSON.
pub(crate) fn post(address: &str, path: &str, headers: &Headers, body: &str) -> Answer {
    let json = ("Content-Type", "application/json");
    let named = headers.iter().any(|(name, _)| *name == "Content-Type");
    let headers: Vec<_> = headers.iter().copied().chain((!named).then_some(json)).collect();
    ask(address, &format!("POST {path}"), &headers, body)
}

fn ask(address: &str, what: &str, headers: &Headers, body: &str) -> Answer {
    let mut stream = begin(address, what, headers, body);
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).expect("it answers");
    let answer = String::from_utf8_lossy(&answer).into_owned();
    let (head, body) = answer.split_once("\r\n\r\n").expect("a head and a body");
    let status = head.split(' ').nth(1).and_then(|status| status.parse().ok());
    let status = status.unwrap_or_else(|| panic!("no status: {head}"));
    Answer { status, head: head.to_owned(), body: body.to_owned() }
}

/// Sends a request and leaves the answer to be read, or not.
pub(crate) fn begin(address: &str, what: &str, headers: &Headers, body: &str) -> TcpStream {
    let mut stream = TcpStream::connect(address).expect("the daemon listens");
    let host = headers.iter().find(|(name, _)| *name == "Host").map_or(&address, |(_, host)| host);
    let length = body.len().to_string();
    let more = [("Host", *host), ("Connection", "close"), ("Content-Length", &length)];
    let others = headers.iter().copied().filter(|(name, _)| *name != "Host");
    let lines: Vec<String> =
        more.into_iter().chain(others).map(|(name, value)| format!("{name}: {value}")).collect();
    write!(stream, "{what} HTTP/1.1\r\n{}\r\n\r\n{body}", lines.join("\r\n"))
        .expect("it takes a request");
    stream
}
