//! What the live page costs the daemon: bytes to each page, processor time by the number of pages.

use std::fs;
use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, Builder};
use std::time::Duration;

use devices::Quantity;
use devices::channel::Counts;
use devices::clock::{Clock, WallClock};

use super::speed::{Figure, figure};
use crate::page::status::{ChannelStatus, DeviceStatus};
use crate::page::{Board, Listen, Served, orders, runtime, serve};

/// Channels, each at so many samples a second: more than any tank has on one model.
const CHANNELS: usize = 8;
const RATE_HZ: f64 = 1000.0;
/// How often samples come, as from a serial port.
const BATCH: Duration = Duration::from_millis(10);
/// Over so long each figure is taken.
const OVER: Duration = Duration::from_secs(5);
/// Name of the threads that play browsers, whose own time is none of the daemon's.
const READER: &str = "reader";

/// Bytes a second to one page, and the processor time of board and server with no, one and ten
/// pages; then the page is left open for a browser for `hold`, once `opened` has been told where.
///
/// # Errors
/// What the system said.
pub fn page(
    hold: Duration,
    opened: &mut dyn FnMut(SocketAddr) -> io::Result<()>,
) -> io::Result<Vec<Figure>> {
    let board = Board::default();
    let (orders, _kept) = orders();
    let served = Served { board: board.clone(), folder: PathBuf::new(), orders };
    let listen = Listen { address: SocketAddr::from(([127, 0, 0, 1], 0)), token: None };
    let runtime = runtime()?;
    let address = serve(&runtime, &listen, served).map_err(io::Error::other)?;
    let ended = Arc::new(AtomicBool::new(false));
    let feeder = {
        let ended = Arc::clone(&ended);
        Builder::new().spawn(move || feed(&board, &ended))?
    };
    let mut figures = Vec::new();
    for n_pages in [0, 1, 10] {
        figures.extend(with_pages(address, n_pages)?);
    }
    if !hold.is_zero() {
        opened(address)?;
        thread::sleep(hold);
    }
    ended.store(true, Ordering::Release);
    feeder.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    Ok(figures)
}

fn with_pages(address: SocketAddr, n_pages: usize) -> io::Result<Vec<Figure>> {
    let (n_bytes, ended) = (Arc::new(AtomicU64::new(0)), Arc::new(AtomicBool::new(false)));
    let mut readers = Vec::new();
    for _ in 0..n_pages {
        let (n_bytes, ended) = (Arc::clone(&n_bytes), Arc::clone(&ended));
        let mut stream = TcpStream::connect(address)?;
        write!(stream, "GET /stream HTTP/1.1\r\nHost: {address}\r\n\r\n")?;
        let reader = Builder::new().name(READER.to_owned());
        readers.push(reader.spawn(move || read(&mut stream, &n_bytes, &ended))?);
    }
    // The greeting, with the last minutes in it, is no figure of a second.
    thread::sleep(Duration::from_secs(1));
    let (bytes, busy) = (n_bytes.load(Ordering::Relaxed), busy());
    thread::sleep(OVER);
    let spent = busy_since(&busy).as_secs_f64() / OVER.as_secs_f64();
    let more = n_bytes.load(Ordering::Relaxed) - bytes;
    ended.store(true, Ordering::Release);
    for reader in readers {
        reader.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    }
    let pages = match n_pages {
        0 => "no page".to_owned(),
        1 => "one page".to_owned(),
        n => format!("{n} pages"),
    };
    let load = figure(
        format!("{CHANNELS} channels at 1 kHz, {pages}: processor time of board and server"),
        format!("{:.2} % of a core", 100.0 * spent),
    );
    let bytes_per_s = more as f64 / OVER.as_secs_f64() / n_pages.max(1) as f64;
    let sent = figure(
        format!("{CHANNELS} channels at 1 kHz, {pages}: bytes a second to each"),
        format!("{:.1} kB", bytes_per_s / 1e3),
    );
    Ok(if n_pages == 0 { vec![load] } else { vec![load, sent] })
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

/// Samples and a status as the daemon brings them.
fn feed(board: &Board, ended: &AtomicBool) {
    let clock = WallClock::start();
    board.strips().go_on(vec!["roll"; CHANNELS], 1.0);
    let mut n_samples = 0_u64;
    while !ended.load(Ordering::Acquire) {
        thread::sleep(BATCH);
        let now_s = clock.now_ns() as f64 / 1e9;
        let mut strips = board.strips();
        while (n_samples as f64) < now_s * RATE_HZ {
            let time_s = n_samples as f64 / RATE_HZ;
            for channel in 0..CHANNELS {
                let roll_deg = 10.0 * ((5.0 + channel as f64) * time_s).sin();
                strips.push(channel, time_s, roll_deg + 0.1 * (2e3 * time_s).sin());
            }
            n_samples += 1;
        }
        drop(strips);
        board.change(|status| {
            "eight channels".clone_into(&mut status.campaign);
            status.at_s = now_s;
            status.devices = vec![device(now_s, n_samples)];
        });
    }
}

fn device(now_s: f64, received: u64) -> DeviceStatus {
    let channel = ChannelStatus {
        quantity: Quantity::Roll,
        unit: Quantity::Roll.unit(),
        value: Some(0.1),
        time_s: Some(now_s),
        quality: Vec::new(),
        bound_s: Some(1e-4),
        recent: None,
        counts: Counts { received, ..Counts::default() },
    };
    DeviceStatus {
        name: "board".to_owned(),
        linked: true,
        channels: vec![channel; CHANNELS],
        ..DeviceStatus::default()
    }
}

/// Processor time so far of every thread but the readers.
fn busy() -> Vec<(String, u64)> {
    let threads = fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let time = |path: PathBuf| {
        let name = fs::read_to_string(path.join("comm")).ok()?;
        let told = fs::read_to_string(path.join("schedstat")).ok()?;
        let ns = told.split(' ').next()?.parse().ok()?;
        (name.trim() != READER).then(|| (path.display().to_string(), ns))
    };
    threads.filter_map(|entry| time(entry.path())).collect()
}

fn busy_since(before: &[(String, u64)]) -> Duration {
    let earlier =
        |thread: &str| before.iter().find(|(known, _)| known == thread).map_or(0, |t| t.1);
    let spent_ns = busy().iter().map(|(thread, ns)| ns.saturating_sub(earlier(thread))).sum();
    Duration::from_nanos(spent_ns)
}
