//! An emulated instrument at the other end of a port, in a thread of its own.

use std::collections::VecDeque;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::cable::Cable;
use super::misread::misread;
use super::{Emulator, Fault, Faults};
use crate::clock::{Clock, NS_PER_S};
use crate::realtime::become_realtime;

/// Longest sleep of the thread [ns]; a line is at most so late.
const TURN_NS: i64 = 500_000;

/// The system gives no pseudo-terminal.
#[derive(Debug, thiserror::Error)]
#[error("no pseudo-terminal for \"{}\"", path.display())]
pub struct EmulatorError {
    /// The name that it was to have.
    pub path: PathBuf,
    /// What the system said.
    pub source: io::Error,
}

enum Command {
    Fault(Fault),
    Unplug,
    Replug,
    Stop,
}

/// An emulated instrument on a port, in a thread of its own.
///
/// The port is a link in a folder of the caller's, as udev's are in `/dev/serial/by-id`.
pub struct EmulatedPort {
    path: PathBuf,
    commands: Sender<Command>,
    done: Receiver<()>,
    thread: Option<JoinHandle<()>>,
}

impl EmulatedPort {
    /// Plugs an instrument in at `path`; its bytes come as fast as a line of `byte_ns` lets them.
    ///
    /// # Errors
    /// [`EmulatorError`] when the system gives no pseudo-terminal.
    pub fn plug_in(
        path: &Path,
        emulator: Box<dyn Emulator>,
        byte_ns: u64,
        clock: Arc<dyn Clock>,
    ) -> Result<Self, EmulatorError> {
        let failed = |source| EmulatorError { path: path.to_owned(), source };
        let cable = Cable::plug_in(path).map_err(failed)?;
        let (commands, orders) = channel();
        let (sender, done) = channel();
        let mut bench = Bench {
            path: path.to_owned(),
            cable: Some(cable),
            emulator,
            faults: Faults::default(),
            byte_ns,
            line_free_ns: 0,
            on_line: VecDeque::new(),
            clock,
        };
        let thread = thread::Builder::new().name("emulator".to_owned());
        let thread = thread.spawn(move || bench.run(&orders, &sender)).map_err(failed)?;
        Ok(Self { path: path.to_owned(), commands, done, thread: Some(thread) })
    }

    /// Where it is plugged in.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Commands a fault, and returns when it is in force.
    pub fn fault(&self, fault: Fault) {
        self.command(Command::Fault(fault));
    }

    /// Pulls the cable, and returns when it is out.
    pub fn unplug(&self) {
        self.command(Command::Unplug);
    }

    /// Puts the cable back, and returns when the port is there.
    pub fn replug(&self) {
        self.command(Command::Replug);
    }

    fn command(&self, command: Command) {
        if self.commands.send(command).is_ok() {
            // An error means that the thread has ended, and then nothing is in force at all.
            self.done.recv().ok();
        }
    }
}

impl Drop for EmulatedPort {
    fn drop(&mut self) {
        self.command(Command::Stop);
        if let Some(thread) = self.thread.take() {
            drop(thread.join());
        }
    }
}

struct Bench {
    path: PathBuf,
    cable: Option<Cable>,
    emulator: Box<dyn Emulator>,
    faults: Faults,
    byte_ns: u64,
    line_free_ns: u64,
    on_line: VecDeque<(u64, Vec<u8>)>,
    clock: Arc<dyn Clock>,
}

impl Bench {
    fn run(&mut self, orders: &Receiver<Command>, done: &Sender<()>) {
        // An instrument keeps its own time, whatever the host is busy with.
        become_realtime();
        loop {
            match orders.try_recv() {
                Ok(Command::Stop) | Err(TryRecvError::Disconnected) => break,
                Ok(command) => self.obey(&command),
                Err(TryRecvError::Empty) => {
                    self.turn();
                    continue;
                }
            }
            if done.send(()).is_err() {
                break;
            }
        }
        self.cable = None;
        done.send(()).ok();
    }

    fn obey(&mut self, command: &Command) {
        match command {
            Command::Fault(fault) => self.faults.command(*fault),
            Command::Unplug => {
                self.cable = None;
                self.on_line.clear();
            }
            Command::Replug if self.cable.is_none() => self.cable = Cable::plug_in(&self.path).ok(),
            Command::Replug | Command::Stop => {}
        }
    }

    /// The speeds of the instrument and of the port [bit/s], where the instrument's is commanded.
    fn speeds(&self) -> Option<(u32, u32)> {
        Some((self.faults.baud?, self.cable.as_ref()?.baud()?))
    }

    fn turn(&mut self) {
        let now_ns = self.clock.now_ns();
        let now_s = now_ns as f64 / NS_PER_S;
        if std::mem::take(&mut self.faults.restart) {
            self.emulator.restart(now_s);
        }
        let mut out = Vec::new();
        if let Some(cable) = &self.cable {
            let mut bytes = cable.read();
            if let Some((own, hosts)) = self.speeds() {
                bytes = misread(&bytes, hosts, own);
            }
            if !bytes.is_empty() {
                self.emulator.receive(&bytes, now_s, &mut self.faults, &mut out);
            }
            cable.release();
        }
        self.emulator.tick(now_s, &mut self.faults, &mut out);
        if !out.is_empty() && !self.faults.mute {
            let mut bytes = self.faults.noise();
            bytes.append(&mut out);
            self.line_free_ns = self.line_free_ns.max(now_ns) + bytes.len() as u64 * self.byte_ns;
            self.on_line.push_back((self.line_free_ns, bytes));
        }
        let now_ns = self.clock.now_ns();
        let speeds = self.speeds();
        while !self.faults.stalled
            && let Some((_, bytes)) = self.on_line.pop_front_if(|(due_ns, _)| *due_ns <= now_ns)
        {
            if let Some(cable) = &mut self.cable {
                let read = speeds.map(|(own, hosts)| misread(&bytes, own, hosts));
                cable.send(read.as_deref().unwrap_or(&bytes));
            }
        }
        if let Some(cable) = &mut self.cable {
            cable.pass_on();
        }
        match &self.cable {
            Some(cable) => {
                // What is on the line arrives when it is due, not a turn later.
                let due_ns = self.on_line.front().map(|(due_ns, _)| due_ns.saturating_sub(now_ns));
                let due_ns = due_ns.filter(|_| !self.faults.stalled);
                let wait = self.clock.real(due_ns.unwrap_or(u64::MAX / 2)).as_nanos();
                cable.wait(i64::try_from(wait).unwrap_or(TURN_NS).clamp(10_000, TURN_NS));
            }
            None => thread::sleep(Duration::from_millis(1)),
        }
    }
}
