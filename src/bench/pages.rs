//! Browsers that are none: they read the live page's stream, and their time is not the daemon's.

use std::fs;
use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, Builder, JoinHandle};
use std::time::Duration;

/// Name of the threads that read.
const READER: &str = "reader";
/// Threads whose time is none of the daemon's: readers, and the instruments at the other end.
const OTHERS: [&str; 2] = [READER, "emulator"];
/// Over so long each figure is taken.
pub(super) const OVER: Duration = Duration::from_secs(5);
/// After so long the greeting, with the last minutes in it, has been read.
const GREETED: Duration = Duration::from_secs(1);

/// What some pages cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cost {
    /// Processor time of the process without the others, of one core [-].
    pub(super) share: f64,
    /// Sent to each page [bytes/s].
    pub(super) bytes_per_s: f64,
}

/// A page that asks for the stream and never reads it.
pub(super) fn stalled(address: SocketAddr) -> io::Result<TcpStream> {
    let mut stream = TcpStream::connect(address)?;
    write!(stream, "GET /stream HTTP/1.1\r\nHost: {address}\r\n\r\n")?;
    Ok(stream)
}

/// Opens so many pages, and measures.
pub(super) fn cost(address: SocketAddr, n_pages: usize) -> io::Result<Cost> {
    let (n_bytes, ended) = (Arc::new(AtomicU64::new(0)), Arc::new(AtomicBool::new(false)));
    let mut readers: Vec<JoinHandle<()>> = Vec::new();
    for _ in 0..n_pages {
        let (n_bytes, ended) = (Arc::clone(&n_bytes), Arc::clone(&ended));
        let mut stream = stalled(address)?;
        let reader = Builder::new().name(READER.to_owned());
        readers.push(reader.spawn(move || read(&mut stream, &n_bytes, &ended))?);
    }
    thread::sleep(GREETED);
    let (bytes, busy) = (n_bytes.load(Ordering::Relaxed), busy());
    thread::sleep(OVER);
    let share = busy_since(&busy).as_secs_f64() / OVER.as_secs_f64();
    let more = n_bytes.load(Ordering::Relaxed) - bytes;
    ended.store(true, Ordering::Release);
    for reader in readers {
        reader.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    }
    let bytes_per_s = more as f64 / OVER.as_secs_f64() / n_pages.max(1) as f64;
    Ok(Cost { share, bytes_per_s })
}

/// So many pages, in words.
pub(super) fn counted(n_pages: usize) -> String {
    match n_pages {
        0 => "no page".to_owned(),
        1 => "one page".to_owned(),
        n => format!("{n} pages"),
    }
}

/// Reads as a browser would, and counts.
fn read(stream: &mut TcpStream, n_bytes: &AtomicU64, ended: &AtomicBool) {
    let mut buffer = [0; 16_384];
    while !ended.load(Ordering::Acquire) {
        match stream.read(&mut buffer) {
            Ok(n) if n > 0 => n_bytes.fetch_add(n as u64, Ordering::Relaxed),
            _ => return,
        };
    }
}

/// Processor time so far of every thread but the others.
fn busy() -> Vec<(String, u64)> {
    let threads = fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let time = |path: PathBuf| {
        let name = fs::read_to_string(path.join("comm")).ok()?;
        let told = fs::read_to_string(path.join("schedstat")).ok()?;
        let ns = told.split(' ').next()?.parse().ok()?;
        (!OTHERS.contains(&name.trim())).then(|| (path.display().to_string(), ns))
    };
    threads.filter_map(|entry| time(entry.path())).collect()
}

fn busy_since(before: &[(String, u64)]) -> Duration {
    let earlier =
        |thread: &str| before.iter().find(|(known, _)| known == thread).map_or(0, |t| t.1);
    let spent_ns = busy().iter().map(|(thread, ns)| ns.saturating_sub(earlier(thread))).sum();
    Duration::from_nanos(spent_ns)
}
