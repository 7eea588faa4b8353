//! What happened on a link, to and from the record of it.

use std::sync::Arc;

use devices::port::LinkEvent;

use crate::record::{Direction, Raw};

impl Raw {
    /// The record of what happened; none for what no decoding depends on.
    ///
    /// `now_s` is the time of an event that has no instant of its own.
    pub fn of_link(device: &Arc<str>, event: &LinkEvent, now_s: f64) -> Option<Self> {
        let (direction, bytes) = match event {
            LinkEvent::Opened { .. } => (Direction::Opened, Vec::new()),
            LinkEvent::Round { due_ns, .. } => (Direction::Joined, due_ns.to_string().into_bytes()),
            LinkEvent::Sent { bytes, .. } => (Direction::Sent, bytes.clone()),
            LinkEvent::Received { bytes, .. } => (Direction::Received, bytes.clone()),
            LinkEvent::Waited { .. } => (Direction::Waited, Vec::new()),
            LinkEvent::Lost { seen, .. } => (Direction::Lost, seen.clone().into_bytes()),
            LinkEvent::Overflow { n_events } => {
                (Direction::Dropped, n_events.to_string().into_bytes())
            }
            LinkEvent::Silence { .. } | LinkEvent::Absent { .. } => return None,
        };
        let time_s = event.at_ns().map_or(now_s, |at_ns| at_ns as f64 / 1e9);
        Some(Self { device: Arc::clone(device), time_s, direction, bytes })
    }

    /// What happened, to be decoded anew; none where it only marks whose the rest is.
    pub fn link_event(&self) -> Option<LinkEvent> {
        // Exact for 26 days of nanoseconds, far more than a recording lasts.
        let at_ns = (self.time_s * 1e9).round() as u64;
        let (bytes, decoded) = (self.bytes.clone(), Vec::new());
        let text = || String::from_utf8_lossy(&self.bytes).into_owned();
        Some(match self.direction {
            Direction::Before | Direction::Begun => return None,
            Direction::Opened => LinkEvent::Opened { at_ns },
            Direction::Joined => {
                LinkEvent::Round { at_ns, due_ns: text().parse().unwrap_or(at_ns) }
            }
            Direction::Sent => LinkEvent::Sent { at_ns, bytes, decoded },
            Direction::Received => LinkEvent::Received { at_ns, bytes, decoded },
            Direction::Waited => LinkEvent::Waited { at_ns, decoded },
            Direction::Lost => LinkEvent::Lost { at_ns, seen: text() },
            Direction::Dropped => {
                LinkEvent::Overflow { n_events: text().parse().unwrap_or_default() }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_event_comes_back_from_its_record_to_the_nanosecond() {
        let device: Arc<str> = "cell".into();
        for at_ns in [0, 1, 123_456_789_012_345, 2_199_999_999_999_999] {
            let (bytes, decoded) = (vec![1, 2, 255], Vec::new());
            for event in [
                LinkEvent::Opened { at_ns },
                LinkEvent::Round { at_ns, due_ns: at_ns.saturating_sub(7) },
                LinkEvent::Sent { at_ns, bytes: bytes.clone(), decoded: decoded.clone() },
                LinkEvent::Received { at_ns, bytes, decoded: decoded.clone() },
                LinkEvent::Waited { at_ns, decoded },
                LinkEvent::Lost { at_ns, seen: "it has vanished".to_owned() },
                LinkEvent::Overflow { n_events: 7 },
            ] {
                let raw = Raw::of_link(&device, &event, 0.5).expect("it is recorded");
                assert_eq!(raw.link_event(), Some(event));
            }
        }
    }
}
