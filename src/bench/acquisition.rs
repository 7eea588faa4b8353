//! What pages cost the daemon while it acquires: its processor time, and whether it loses samples.

use std::fs;
use std::net::SocketAddr;
use std::path::Path;
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use devices::InstrumentError;
use devices::clock::{Clock, WallClock};
use devices::emulator::{EmulatedPort, EmulatorError, emulator};

use super::pages::{cost, counted, stalled};
use super::speed::{Figure, figure};
use crate::campaign::{self, FILE_NAME};
use crate::live::{self, DaemonOptions, LiveError};
use crate::page::{Board, Listen, Order, orders};
use crate::tank::{FileFormat, Scenario, campaign_head};

/// A board of eight fields on a real port; three of them are all that a campaign measures.
const INSTRUMENTS: &str = r#"
[live]
condition = "bare hull"
[[device]]
name = "board"
profile = "cobs-board"
port = "PORTS/board"
settings = { fields = 8 }
[[device.channel]]
quantity = "roll"
field = 0
calibration = { curve = { gain = 1e-6 } }
[[device.channel]]
quantity = "force"
field = 1
calibration = { curve = { gain = 1e-6 } }
[[device.channel]]
quantity = "speed"
field = 2
calibration = { curve = { gain = 1e-6 } }
"#;

/// Samples of every field a second [Hz].
const RATE_HZ: f64 = 1000.0;
/// How often the daemon is looked at, and at most how many times until it hears the board.
const LOOK: Duration = Duration::from_millis(50);
const N_LOOKS: usize = 600;

/// Processor time of the daemon and losses with no page, one, ten, and one that stalls.
///
/// # Errors
/// [`LiveError`] of daemon or board.
pub fn acquisition(folder: &Path) -> Result<Vec<Figure>, LiveError> {
    let _board = plugged_in(folder)?;
    let clock = Arc::new(WallClock::start());
    let (board, (sender, receiver)) = (Board::default(), orders());
    let address = SocketAddr::from(([127, 0, 0, 1], 0));
    let listen = Some(Listen { address, token: None });
    let options = DaemonOptions { folder: folder.to_owned(), rotate_s: f64::INFINITY, listen };
    thread::scope(|scope| {
        let (clock, shown, orders) = (&clock, &board, sender.clone());
        let daemon = scope.spawn(move || live::run(&options, clock, (orders, receiver), shown));
        let figures = measured(&board, &|| daemon.is_finished());
        // A daemon that has ended by itself has told why.
        sender.blocking_send(Order::Terminate).ok();
        daemon.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
        figures
    })
}

fn plugged_in(folder: &Path) -> Result<EmulatedPort, LiveError> {
    let file = |path: &Path| {
        let path = path.to_owned();
        |source| LiveError::File { path, source }
    };
    let ports = folder.join("ports");
    fs::create_dir_all(&ports).map_err(file(&ports))?;
    let ports = ports.canonicalize().map_err(file(&ports))?;
    let path = folder.join(FILE_NAME);
    let mut scenario = Scenario::builtin("short-day").unwrap_or_else(|| unreachable!("built in"));
    scenario.recordings.format = FileFormat::Mcap;
    let head = campaign_head(&scenario);
    let instruments = INSTRUMENTS.replace("PORTS", &ports.display().to_string());
    fs::write(&path, head + &instruments).map_err(file(&path))?;
    let campaign = campaign::read(folder)?;
    let device = &campaign.live.devices[0];
    // Slow enough that no run is found: what identifying costs is measured elsewhere.
    let signal = |field: usize, time_s: f64| 100.0 * (0.1 * time_s + field as f64).sin();
    let other_end = emulator(&device.driver, &device.settings, RATE_HZ, Box::new(signal));
    let other_end = other_end.map_err(|source| InstrumentError::Settings {
        device: device.name.clone(),
        driver: device.driver.clone(),
        source,
    })?;
    let clock: Arc<dyn Clock> = Arc::new(WallClock::start());
    EmulatedPort::plug_in(&device.port, other_end, device.line.byte_ns(), clock)
        .map_err(|EmulatorError { path, source }| LiveError::File { path, source })
}

fn measured(board: &Board, is_over: &dyn Fn() -> bool) -> Result<Vec<Figure>, LiveError> {
    let system = |source| LiveError::System { what: "page".to_owned(), source };
    let silent = || system(std::io::ErrorKind::TimedOut.into());
    let mut n_looks = 0;
    let address = loop {
        let status = board.now();
        if let Some(address) = status.page.filter(|_| status.is_ready()) {
            break address;
        }
        if n_looks == N_LOOKS || is_over() {
            return Err(silent());
        }
        n_looks += 1;
        thread::sleep(LOOK);
    };
    // How the board is taken up is measured by the stories of the daemon.
    let before = samples(board);
    let mut figures = Vec::new();
    let mut tell = |pages: String, share: f64| {
        let name = format!("daemon with a board of 8 fields at 1 kHz, {pages}: processor time");
        figures.push(figure(name, format!("{:.2} % of a core", 100.0 * share)));
    };
    for n_pages in [0, 1, 10] {
        tell(counted(n_pages), cost(address, n_pages).map_err(system)?.share);
    }
    let stalled = stalled(address).map_err(system)?;
    tell("10 pages and one that stalls".to_owned(), cost(address, 10).map_err(system)?.share);
    drop(stalled);
    let after = samples(board);
    let name = "meanwhile, of the samples of its three channels: lost or damaged".to_owned();
    let [received, lost] = [0, 1].map(|k| after[k] - before[k]);
    figures.push(figure(name, format!("{lost} of {}", received + lost)));
    Ok(figures)
}

/// Samples of every channel so far: received, and lost on the way or damaged.
fn samples(board: &Board) -> [u64; 2] {
    let status = board.now();
    let channels = || status.devices.iter().flat_map(|device| &device.channels);
    let received = channels().map(|channel| channel.counts.received).sum();
    let lost = channels().map(|channel| channel.counts.lost + channel.counts.damaged).sum();
    [received, lost]
}
