//! A whole day in the virtual tank: every pass of a scenario, through ports, daemon and reports.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use devices::clock::{Clock, WallClock};

use super::daemon::{DaemonOptions, run};
use super::error::LiveError;
use super::virtual_plan::plan;
use super::virtual_tank::VirtualTank;
use crate::campaign::{self, FILE_NAME};
use crate::page::{Board, Listen, Order, Orders, Status, orders};
use crate::results::Results;
use crate::tank::{FileFormat, Scenario, campaign_head};

/// The instruments of the virtual tank: a board that samples roll and force, a speed log.
const INSTRUMENTS: &str = r#"
[[device]]
name = "daq board"
profile = "cobs-board"
port = "PORTS/daq-board"
settings = { fields = 2, identify = true }
[[device.channel]]
quantity = "roll"
field = 0
calibration = { curve = { gain = 1e-6 }, by = "virtual tank" }
[[device.channel]]
quantity = "force"
field = 1
calibration = { curve = { gain = 1e-4 }, by = "virtual tank" }

[[device]]
name = "carriage"
profile = "arduino-text"
port = "PORTS/carriage"
settings = { pattern = "$CARR,{sequence},{time_us},{0}*{xor}" }
[[device.channel]]
quantity = "speed"
field = 0
calibration = { curve = { gain = 1e-4 }, by = "virtual tank" }
"#;

/// How often the day is looked at.
const LOOK: Duration = Duration::from_millis(20);
/// The clock of the day goes at most so far beyond what the daemon has taken [s]: on a busy machine
/// the day takes longer, and no instrument seems to be late.
const AHEAD_MAX_S: f64 = 1.0;
/// Looks without anything new after which nothing is waited for: the ports are being opened anew.
const LOOKS_MAX: u32 = 50;
/// What an instrument may take to attach and be heard [world's time].
const ATTACH: Duration = Duration::from_mins(1);

/// What a day came to.
pub struct DayEnded {
    /// Everything learnt.
    pub results: Option<Results>,
    /// The daemon's last status.
    pub status: Status,
}

/// How far a day has come.
pub struct DayProgress<'p> {
    /// Time played and to be played [s].
    pub played_s: f64,
    /// All of the day [s].
    pub total_s: f64,
    /// The daemon's status.
    pub status: &'p Status,
}

/// Plays every pass of a scenario before a daemon, condition by condition, in a fresh folder; on a
/// clock of that speed, with the page served there, if anywhere.
///
/// # Errors
/// [`LiveError`] of tank or daemon.
pub fn virtual_day(
    scenario: &Scenario,
    seed: u64,
    folder: &Path,
    (speed, listen): (f64, Option<Listen>),
    progress: &mut dyn FnMut(DayProgress<'_>),
) -> Result<DayEnded, LiveError> {
    let conditions = conditions(scenario);
    let first = conditions.first().map_or("", |(name, _)| name.as_str());
    write_campaign(scenario, folder, first)?;
    let devices = campaign::read(folder)?.live.devices;
    let clock = Arc::new(WallClock::start_with_brake(speed));
    let tank = VirtualTank::plug_in(scenario.clone(), seed, &devices, &clock)?;
    let board = Board::default();
    let (sender, receiver) = orders();
    let options = DaemonOptions { folder: folder.to_owned(), rotate_s: f64::INFINITY, listen };
    let results = thread::scope(|scope| {
        let (clock, board, orders) = (&clock, &board, sender.clone());
        let daemon = scope.spawn(move || run(&options, clock, (orders, receiver), board));
        let mut day = Day {
            folder,
            scenario,
            tank: &tank,
            clock,
            board,
            orders: &sender,
            taken_s: None,
            n_looks: 0,
        };
        let is_over = || daemon.is_finished();
        let played = day.play(&conditions, &is_over, progress);
        // A daemon that has ended by itself has told why.
        sender.blocking_send(Order::Terminate).ok();
        let results = daemon.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        played.and(results)
    })?;
    Ok(DayEnded { results, status: board.now() })
}

/// The conditions in their order, each with its passes.
fn conditions(scenario: &Scenario) -> Vec<(String, Vec<usize>)> {
    let mut conditions: Vec<(String, Vec<usize>)> = Vec::new();
    for index in 0..scenario.pass_count() {
        let name = &scenario.pass_at(index).0.condition;
        match conditions.iter_mut().find(|(known, _)| known == name) {
            Some((_, passes)) => passes.push(index),
            None => conditions.push((name.clone(), vec![index])),
        }
    }
    conditions
}

fn write_campaign(scenario: &Scenario, folder: &Path, condition: &str) -> Result<(), LiveError> {
    let mut live = scenario.clone();
    // Recordings of our own name their channels themselves.
    live.recordings.format = FileFormat::Mcap;
    let ports = folder.join("ports");
    let failed = |source| LiveError::File { path: ports.clone(), source };
    fs::create_dir_all(&ports).map_err(failed)?;
    let ports = ports.canonicalize().map_err(failed)?;
    let instruments = INSTRUMENTS.replace("PORTS", &ports.display().to_string());
    let (head, plan) = (campaign_head(&live), plan(&live));
    let text = format!("{head}{plan}\n[live]\ncondition = \"{condition}\"\n{instruments}");
    let path = folder.join(FILE_NAME);
    fs::write(&path, text).map_err(|source| LiveError::File { path, source })
}

struct Day<'d> {
    folder: &'d Path,
    scenario: &'d Scenario,
    tank: &'d VirtualTank,
    clock: &'d WallClock,
    board: &'d Board,
    orders: &'d Orders,
    /// Until when the daemon has taken everything [s], and for how many looks that has not changed.
    taken_s: Option<f64>,
    n_looks: u32,
}

impl Day<'_> {
    fn play(
        &mut self,
        conditions: &[(String, Vec<usize>)],
        is_over: &dyn Fn() -> bool,
        progress: &mut dyn FnMut(DayProgress<'_>),
    ) -> Result<(), LiveError> {
        let n_passes = self.scenario.pass_count();
        let mut n_played = 0;
        let mut spent_s = 0.0;
        for (number, (condition, passes)) in conditions.iter().enumerate() {
            if number > 0 {
                write_campaign(self.scenario, self.folder, condition)?;
                // A daemon that has ended by itself is noticed right below.
                self.orders.blocking_send(Order::Reload).ok();
            }
            self.attached(number as u64 + 1, is_over)?;
            let begins_s = self.now_s();
            let ends_s = self.tank.play(passes);
            n_played += passes.len();
            // The passes to come are as long as those so far, near enough for a bar.
            let per_pass_s = (spent_s + ends_s - begins_s) / n_played as f64;
            let total_s = per_pass_s * n_passes as f64;
            while self.now_s() < ends_s && !is_over() {
                let played_s = spent_s + self.now_s() - begins_s;
                progress(DayProgress { played_s, total_s, status: &self.board.now() });
                self.wait_for_daemon();
                thread::sleep(LOOK);
            }
            spent_s += ends_s - begins_s;
            self.clock.at_most(u64::MAX);
        }
        Ok(())
    }

    /// Holds the clock back while the daemon is behind.
    fn wait_for_daemon(&mut self) {
        let taken_s = self.board.strips().until_s();
        self.n_looks = if taken_s == self.taken_s { self.n_looks + 1 } else { 0 };
        self.taken_s = taken_s;
        let limit_ns = taken_s
            .filter(|_| self.n_looks < LOOKS_MAX)
            .map(|taken_s| ((taken_s + AHEAD_MAX_S) * 1e9) as u64);
        self.clock.at_most(limit_ns.unwrap_or(u64::MAX));
    }

    /// Waits until the session of that number hears every instrument.
    fn attached(&self, session: u64, is_over: &dyn Fn() -> bool) -> Result<(), LiveError> {
        let until = self.clock.real(self.clock.now_ns()) + ATTACH;
        loop {
            let status = self.board.now();
            if is_over() || status.n_sessions >= session && status.is_ready() {
                return Ok(());
            }
            if self.clock.real(self.clock.now_ns()) > until {
                let what = format!("answer of the emulated instruments: {:?}", status.devices);
                let source = std::io::ErrorKind::TimedOut.into();
                return Err(LiveError::System { what, source });
            }
            thread::sleep(LOOK);
        }
    }

    fn now_s(&self) -> f64 {
        self.clock.now_ns() as f64 / 1e9
    }
}
