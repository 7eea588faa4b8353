//! What the live page costs the daemon: bytes to each page, processor time by the number of pages.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, Builder};
use std::time::Duration;

use devices::Quantity;
use devices::channel::Counts;
use devices::clock::{Clock, WallClock};

use super::pages::{cost, counted};
use super::speed::{Figure, figure};
use crate::page::status::{ChannelStatus, DeviceStatus};
use crate::page::{Board, Listen, Served, orders, runtime, serve};

/// Channels, each at so many samples a second: more than any tank has on one model.
const CHANNELS: usize = 8;
const RATE_HZ: f64 = 1000.0;
/// How often samples come, as from a serial port.
const BATCH: Duration = Duration::from_millis(10);

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
    let cost = cost(address, n_pages)?;
    let pages = counted(n_pages);
    let load = figure(
        format!("{CHANNELS} channels at 1 kHz, {pages}: processor time of board and server"),
        format!("{:.2} % of a core", 100.0 * cost.share),
    );
    let sent = figure(
        format!("{CHANNELS} channels at 1 kHz, {pages}: bytes a second to each"),
        format!("{:.1} kB", cost.bytes_per_s / 1e3),
    );
    Ok(if n_pages == 0 { vec![load] } else { vec![load, sent] })
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
