//! Time as an argument: the host's clock, and the clocks inside the instruments seen from it.

mod brake;
mod corridor;
mod counter;
mod envelope;
mod paced;
mod rhythm;
mod tick_steps;

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant, SystemTime};

use rustix::time::{ClockId, DynamicClockId, clock_gettime, clock_gettime_dynamic};

use brake::Brake;

pub use counter::{Counter, CounterStep};
pub use envelope::{ClockLine, Envelope};
pub use paced::Paced;
pub(crate) use rhythm::{Missing, Rhythm};
pub(crate) use tick_steps::TickSteps;

/// Nanoseconds in a second.
pub(crate) const NS_PER_S: f64 = 1e9;

/// A host clock that never steps back: `CLOCK_MONOTONIC`, or what a test gives.
pub trait Clock: Send + Sync {
    /// Time since the clock's own start [ns].
    fn now_ns(&self) -> u64;

    /// How long the thread has to sleep, so that `duration_ns` pass on this clock.
    fn real(&self, duration_ns: u64) -> Duration;
}

/// The machine's monotonic clock, which may run faster than real time for a simulated tank.
#[derive(Debug, Clone)]
pub struct WallClock {
    start: Instant,
    start_unix_ns: u128,
    speed: f64,
    /// Of a simulation, which can wait for those who are behind.
    brake: Option<Brake>,
}

impl WallClock {
    /// A clock at the speed of the world.
    pub fn start() -> Self {
        Self::start_at_speed(1.0)
    }

    /// A clock on which `speed` seconds pass in one second of the world.
    ///
    /// # Panics
    /// When `speed` is not positive.
    #[expect(clippy::disallowed_methods, reason = "the one place where time enters the program")]
    pub fn start_at_speed(speed: f64) -> Self {
        assert!(speed > 0.0, "a clock at speed {speed}");
        let (start, start_unix_ns) = (Instant::now(), Self::unix_ns());
        Self { start, start_unix_ns, speed, brake: None }
    }

    /// The same for a simulation on a machine that may be busy: [`WallClock::at_most`] holds it.
    ///
    /// # Panics
    /// When `speed` is not positive.
    pub fn start_with_brake(speed: f64) -> Self {
        Self { brake: Some(Brake::open()), ..Self::start_at_speed(speed) }
    }

    /// Lets a clock with a brake go so far [ns]; there it stands until it may go on.
    pub fn at_most(&self, limit_ns: u64) {
        if let Some(brake) = &self.brake {
            brake.at_most(limit_ns);
        }
    }

    /// What the machine's other clock says, which may step: time since 1970 [ns].
    #[expect(clippy::disallowed_methods, reason = "recorded beside the clock that never steps")]
    pub fn unix_ns() -> u128 {
        let since_epoch = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
        since_epoch.map_or(0, |passed| passed.as_nanos())
    }

    /// Atomic time less UTC, as the system knows it [s]; 0 where nobody has told the system.
    pub fn tai_offset_s() -> i32 {
        let Ok(atomic) = clock_gettime_dynamic(DynamicClockId::Tai) else { return 0 };
        let utc = clock_gettime(ClockId::Realtime);
        // The two are read one after the other, so that a second may begin between them.
        let offset_ns = (atomic.tv_sec - utc.tv_sec) * 1_000_000_000 + atomic.tv_nsec - utc.tv_nsec;
        i32::try_from((offset_ns + 500_000_000).div_euclid(1_000_000_000)).unwrap_or_default()
    }

    /// Time zero of this clock since 1970 [ns]; never differenced, as NTP may step that clock.
    pub fn start_unix_ns(&self) -> u128 {
        self.start_unix_ns
    }
}

impl Clock for WallClock {
    fn now_ns(&self) -> u64 {
        let free_ns = (self.start.elapsed().as_nanos() as f64 * self.speed) as u64;
        self.brake.as_ref().map_or(free_ns, |brake| brake.held(free_ns))
    }

    fn real(&self, duration_ns: u64) -> Duration {
        Duration::from_nanos((duration_ns as f64 / self.speed) as u64)
    }
}

/// A clock that stands where it was set.
#[derive(Debug, Default)]
pub struct GivenClock {
    now_ns: AtomicU64,
}

impl GivenClock {
    /// Sets the clock.
    pub fn set_ns(&self, now_ns: u64) {
        self.now_ns.store(now_ns, Ordering::Release);
    }
}

impl Clock for GivenClock {
    fn now_ns(&self) -> u64 {
        self.now_ns.load(Ordering::Acquire)
    }

    fn real(&self, _duration_ns: u64) -> Duration {
        Duration::from_millis(1)
    }
}
