//! What the service manager is told: ready, reloading, alive, stopping.

use std::time::Duration;

use sd_notify::NotifyState;

/// The link to systemd; without one nothing is told.
pub(super) struct Supervisor {
    /// Whether anybody listens.
    is_heard: bool,
    /// The longest silence that it bears, when it bears not any.
    watchdog: Option<Duration>,
    told: Duration,
}

impl Supervisor {
    pub(super) fn new() -> Self {
        Self {
            is_heard: std::env::var_os("NOTIFY_SOCKET").is_some(),
            watchdog: sd_notify::watchdog_enabled(),
            told: Duration::ZERO,
        }
    }

    /// The instruments are attached and recorded.
    pub(super) fn ready(&self, status: &str) {
        self.tell(&[NotifyState::Ready, NotifyState::Status(status)]);
    }

    /// The campaign file is read again; [`Supervisor::ready`] tells that it was.
    pub(super) fn reloading(&self) {
        match NotifyState::monotonic_usec_now() {
            Ok(now) => self.tell(&[NotifyState::Reloading, now]),
            Err(error) => tracing::warn!("systemd cannot be told of the reload: {error}"),
        }
    }

    /// The loop has taken an event, and the recorder with it; `now` counts from any fixed instant.
    pub(super) fn alive(&mut self, now: Duration) {
        let silent = now.saturating_sub(self.told);
        if self.watchdog.is_some_and(|watchdog| silent >= watchdog / 3) {
            self.told = now;
            self.tell(&[NotifyState::Watchdog]);
        }
    }

    /// The recording is being finished, for which it may take its time.
    pub(super) fn stopping(&self) {
        self.tell(&[NotifyState::Stopping]);
    }

    fn tell(&self, state: &[NotifyState<'_>]) {
        if !self.is_heard {
            return;
        }
        if let Err(error) = sd_notify::notify(state) {
            tracing::warn!("systemd cannot be told: {error}");
        }
    }
}
